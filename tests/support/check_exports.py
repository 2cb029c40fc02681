"""Reads a roadmap's GraphML, CSV and NPZ exports and checks that they say the same, to the bit.

Usage: check_exports.py FOLDER, which holds roadmap.graphml, roadmap.csv, roadmap.edges.csv,
roadmap.npz and summary.json.
"""

import csv
import json
import sys
from pathlib import Path

import networkx as nx
import numpy as np
from lxml import etree

folder = Path(sys.argv[1])
summary = json.loads((folder / "summary.json").read_text())
n, m = summary["nodes"], summary["edges"]

# NPZ: shapes, types, and what they may hold.
arrays = np.load(folder / "roadmap.npz", allow_pickle=False)
names = [str(name) for name in arrays["dof_names"]]
units = [str(unit) for unit in arrays["dof_units"]]
for name, shape, kind in [
    ("nodes", (n, len(names)), "<f8"),
    ("components", (n,), "<u4"),
    ("edges", (m, 2), "<u4"),
    ("weights", (m,), "<f8"),
    ("planners", (m,), "|u1"),
]:
    assert arrays[name].shape == shape, (name, arrays[name].shape, shape)
    assert arrays[name].dtype.str == kind, (name, arrays[name].dtype.str, kind)
nodes, edges, weights = arrays["nodes"], arrays["edges"], arrays["weights"]
components, planners = arrays["components"], arrays["planners"]
assert (edges[:, 0] < edges[:, 1]).all() and edges.max() < n
assert len(set(components.tolist())) == summary["components"]
assert np.isfinite(nodes).all() and (weights >= 0).all()


def same_bits(a, b):
    a, b = np.asarray(a, dtype="<f8"), np.asarray(b, dtype="<f8")
    return a.shape == b.shape and a.tobytes() == b.tobytes()


# CSV against NPZ.
header, *rows = list(csv.reader((folder / "roadmap.csv").open(newline="")))
assert header == ["node", *(f"{d} [{u}]" for d, u in zip(names, units)), "component"], header
assert [int(row[0]) for row in rows] == list(range(n))
assert same_bits([[float(value) for value in row[1:-1]] for row in rows], nodes)
assert [int(row[-1]) for row in rows] == components.tolist()
header, *rows = list(csv.reader((folder / "roadmap.edges.csv").open(newline="")))
assert header == ["low", "high", "weight [length]", "planner", "planner_tag"], header
assert [[int(row[0]), int(row[1])] for row in rows] == edges.tolist()
assert same_bits([float(row[2]) for row in rows], weights)
assert [int(row[4]) for row in rows] == planners.tolist()
planner_names = [row[3] for row in rows]

# GraphML: valid, and the same graph with attributes of the right types.
schema = etree.XMLSchema(etree.parse(Path(__file__).parent / "graphml.xsd"))
schema.assertValid(etree.parse(folder / "roadmap.graphml"))
graph = nx.read_graphml(folder / "roadmap.graphml", node_type=int)
assert not graph.is_directed()
assert graph.graph["digest"] == summary["digest"], graph.graph
assert graph.graph["seed"] == str(summary["seed"]), graph.graph
assert sorted(graph.nodes) == list(range(n))
assert graph.number_of_edges() == m
for node, data in graph.nodes(data=True):
    assert sorted(data) == sorted([*names, "component"]), data
    assert all(type(data[name]) is float for name in names), data
    assert type(data["component"]) is int and data["component"] == components[node]
assert same_bits([[graph.nodes[node][name] for name in names] for node in range(n)], nodes)
for (low, high), weight, tag, planner in zip(edges.tolist(), weights, planners, planner_names):
    data = graph.edges[low, high]
    assert type(data["weight"]) is float and same_bits(data["weight"], weight)
    assert type(data["planner_tag"]) is int and data["planner_tag"] == tag
    assert type(data["planner"]) is str and data["planner"] == planner
    expected = "straight-line" if tag == 0 else f"rotate-at-{tag - 1}"
    assert planner == expected, planner
least = {node: min(part) for part in nx.connected_components(graph) for node in part}
assert all(least[node] == components[node] for node in range(n))

print(f"{n} nodes, {m} edges: GraphML, CSV and NPZ agree")
