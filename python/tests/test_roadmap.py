"""Roadmaps: arrays, queries, and what other programs are given."""

from __future__ import annotations

import io
import pathlib
import subprocess
import xml.etree.ElementTree
from typing import Any

import networkx
import numpy as np
import pytest

import roadmill
from roadmill._program import call, find_program

# Valid configurations of `walls`, either side of the walls.
ENDS = ([1.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0], [7.0, 2.0, 2.0, 1.0, 0.0, 0.0, 0.0])


def test_arrays_are_what_is_exported(walls: roadmill.Roadmap, tmp_path: pathlib.Path) -> None:
    call("export", walls.run, "--format", "npz", "--out", tmp_path / "walls.npz")
    with np.load(tmp_path / "walls.npz") as exported:
        for name in ("nodes", "edges", "weights", "components", "planners"):
            array = getattr(walls, name)
            assert array.dtype == exported[name].dtype
            np.testing.assert_array_equal(array, exported[name])
        assert walls.dof_names == list(exported["dof_names"])
        assert walls.dof_units == list(exported["dof_units"])
    nodes = len(walls)
    assert walls.nodes.shape == (nodes, 7) and walls.edges.shape == (len(walls.weights), 2)
    assert walls.peaks is None and walls.values == {}
    np.testing.assert_array_equal(walls.weights_back, walls.weights)


def test_arrays_are_aligned_views_that_nobody_writes(walls: roadmill.Roadmap) -> None:
    for array in (walls.nodes, walls.edges, walls.weights, walls.components, walls.planners):
        assert array.flags.aligned and not array.flags.owndata and not array.flags.writeable
        assert array.ctypes.data % 64 == 0
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_components_are_the_graphs(walls: roadmill.Roadmap) -> None:
    graph = walls.to_networkx()
    expected = {min(nodes): nodes for nodes in networkx.connected_components(graph)}
    assert len(expected) == walls.status().components
    for name, nodes in expected.items():
        assert {int(walls.components[node]) for node in nodes} == {name}
    edge = walls.edges[0]
    assert graph.edges[int(edge[0]), int(edge[1])]["weight"] == walls.weights[0]
    assert graph.nodes[5]["configuration"] == tuple(walls.nodes[5])


def by_program(run: pathlib.Path, ends: tuple[Any, Any], *options: str) -> np.ndarray[Any, Any] | None:
    start, goal = (" ".join(repr(float(value)) for value in q) for q in ends)
    arguments = [find_program(), "query", str(run), "--start", start, "--goal", goal, *options]
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode == 3:
        return None
    assert done.returncode == 0, done.stderr
    return np.loadtxt(io.StringIO(done.stdout), delimiter=",", skiprows=1, ndmin=2)


@pytest.mark.parametrize("shorten", [False, True])
def test_queries_give_the_programs_bits(walls: roadmill.Roadmap, shorten: bool) -> None:
    options = ["--shorten"] if shorten else []
    random = np.random.default_rng(1)
    asked = [ENDS, (ENDS[1], ENDS[0])]
    asked += [tuple(walls.nodes[random.integers(len(walls), size=2)]) for _ in range(8)]
    for start, goal in asked:
        path = walls.query(start, goal, shorten=shorten)
        expected = by_program(walls.run, (start, goal), *options)
        assert path is not None and expected is not None
        assert path.configurations.tobytes() == expected.tobytes()
        assert not path.configurations.flags.writeable


def test_the_problems_own_query(walls: roadmill.Roadmap) -> None:
    path = walls.path
    assert path is not None
    again = walls.query()
    assert again is not None and again.configurations.tobytes() == path.configurations.tobytes()
    assert again.length == path.length
    short = walls.query(shorten=50)
    assert short is not None and short.length < path.length


def test_no_path_is_none_with_a_reason(problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    sealed = roadmill.build(problems / "sealed.toml", out=tmp_path / "sealed", threads=1, max_nodes=200)
    assert sealed.query() is None
    answer = sealed.ask()
    assert answer.path is None and answer.reason is not None and "component" in answer.reason


def test_clearances_are_the_programs_and_the_widest_path_is_the_clearest(
    walls: roadmill.Roadmap, tmp_path: pathlib.Path
) -> None:
    call("export", walls.run, "--format", "clearance", "--out", tmp_path / "walls.csv")
    nodes = np.loadtxt(tmp_path / "walls.csv", delimiter=",", skiprows=1)
    edges = np.loadtxt(tmp_path / "walls.edges.csv", delimiter=",", skiprows=1)
    np.testing.assert_array_equal(walls.node_clearances, nodes[:, 1])
    np.testing.assert_array_equal(walls.edge_clearances, edges[:, 3:5])
    widest, weighted, shortest = walls.clearest(), walls.clearest(by="weighted"), walls.query()
    assert widest is not None and weighted is not None and shortest is not None
    expected = by_program(walls.run, (widest.configurations[0], widest.configurations[-1]), "--clearest", "widest")
    assert expected is not None and widest.configurations.tobytes() == expected.tobytes()
    least = [path.measures["least_clearance"] for path in (widest, weighted)]
    assert least[0] is not None and least[1] is not None and least[0] >= least[1] - 0.1
    assert widest.length >= shortest.length and weighted.length >= shortest.length


def test_a_run_without_obstacles_has_no_clearances(problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    roadmap = roadmill.build(problems / "muller-brown.toml", out=tmp_path / "energy", threads=1)
    for ask in (lambda: roadmap.node_clearances, roadmap.clearest):
        with pytest.raises(roadmill.UsageError, match="clearances"):
            ask()


def test_an_invalid_end_is_an_error(walls: roadmill.Roadmap) -> None:
    with pytest.raises(roadmill.UsageError, match="start: 2 values found, 7 expected"):
        walls.query([1.0, 2.0], ENDS[1])
    with pytest.raises(roadmill.UsageError, match="goal"):
        walls.query(ENDS[0], [2.0, 0.3, 2.0, 1.0, 0.0, 0.0, 0.0])


def test_an_energy_has_values_peaks_and_directions(problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    roadmap = roadmill.build(problems / "muller-brown.toml", out=tmp_path / "energy", threads=1)
    assert roadmap.peaks is not None and roadmap.values["energy"].shape == (len(roadmap),)
    low, high = roadmap.edges.T
    # The climbs end at the peak, from either end.
    energy = roadmap.values["energy"]
    np.testing.assert_allclose(energy[low] + roadmap.weights, roadmap.peaks, atol=1e-9)
    np.testing.assert_allclose(energy[high] + roadmap.weights_back, roadmap.peaks, atol=1e-9)
    graph = roadmap.to_networkx()
    assert graph.is_directed() and graph.number_of_edges() == 2 * len(roadmap.edges)
    path, expected = roadmap.query(), by_program(roadmap.run, ([-0.558, 1.442], [0.623, 0.028]))
    assert path is not None and expected is not None
    assert path.configurations.tobytes() == expected.tobytes()


def test_several_paths(walls: roadmill.Roadmap, problems: pathlib.Path, tmp_path: pathlib.Path) -> None:
    paths = walls.paths(3)
    assert len(paths) == 3 and [path.length for path in paths] == sorted(path.length for path in paths)
    assert paths[0].measures["cost"] == paths[0].length and paths[0].passes is None
    far = walls.paths(2, start=ENDS[0], goal=ENDS[1], dissimilar=0.5)
    np.testing.assert_array_equal(far[0].configurations[0], ENDS[0])
    maze = roadmill.build(problems / "maze.toml", out=tmp_path / "maze", threads=1)
    assert all(path.passes is not None for path in maze.paths(2, distinct=True))


def test_verify(walls: roadmill.Roadmap) -> None:
    assert walls.verify(threads=1)
    assert walls.verify(sets=["uniform:0"], workers=1)
    assert walls.verify(share=0.1, threads=2)
    with pytest.raises(ValueError, match="share: 0 found; more than 0, at most 1 expected"):
        walls.verify(share=0)
    with pytest.raises(ValueError, match="not several of them"):
        walls.verify(share=0.1, everything=True)


def test_what_differs_or_is_damaged_is_an_error(walls: roadmill.Roadmap, tmp_path: pathlib.Path) -> None:
    with pytest.raises(roadmill.UsageError):
        len(roadmill.Roadmap(tmp_path / "nothing"))
    damaged = tmp_path / "damaged"
    damaged.mkdir()
    ledger = bytearray((walls.run / "ledger").read_bytes())
    ledger[len(ledger) // 2] ^= 1
    (damaged / "ledger").write_bytes(ledger)
    with pytest.raises(roadmill.BrokenRun):
        len(roadmill.Roadmap(damaged))
    with pytest.raises(roadmill.BrokenRun):
        roadmill.Roadmap(damaged).status()


def test_a_notebook_shows_a_picture(walls: roadmill.Roadmap) -> None:
    picture = walls.picture()
    assert xml.etree.ElementTree.fromstring(picture).tag.endswith("svg")
    page = walls._repr_html_()
    assert "data:image/svg+xml;base64," in page and str(len(walls)) in page
    xml.etree.ElementTree.fromstring(page)


def test_exports(walls: roadmill.Roadmap, tmp_path: pathlib.Path) -> None:
    file = walls.export(tmp_path / "walls.graphml")
    assert networkx.read_graphml(file, node_type=int).number_of_nodes() == len(walls)
    assert walls.export(tmp_path / "roadmap", format="vtk").stat().st_size > 0
    with pytest.raises(roadmill.UsageError, match="hologram"):
        walls.export(tmp_path / "walls.hologram")


def test_it_says_what_it_is(walls: roadmill.Roadmap) -> None:
    assert walls.name == "walls" and walls.seed == 1
    assert repr(walls).startswith(f"<Roadmap walls: {len(walls)} nodes, ")
