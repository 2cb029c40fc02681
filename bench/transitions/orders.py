"""In which order the domains of adenylate kinase move: paths by way of chosen nodes of a map.

The *closure* of a domain is how far its angle has gone from the problem's start, 0, to its goal, 1. Nodes are chosen in which one domain is closed and
the other still open the most, by the difference of their closures. `roadmill paths --dissimilar --count 1` looks for a path from the start to such a
node, and for one from it to the goal; both together are a path on which that domain moves first.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import maps
from measures import ANGLES, angle, rmsds
from structures import Backbone, read_pdb

# How the two halves are looked for.
SEARCH = ["--count", "1", "--dissimilar", "--tries", "3", "--shorten-tries", "20", "--format", "pdb,csv"]
# How far two chosen nodes of one order are apart at least, Å CA RMSD.
APART = 1.0


@dataclass
class Detour:
    """A node and the path by way of it."""

    first: str  # the domain that moves first
    node: int  # its number in the roadmap
    closures: dict  # of each domain
    energy: float  # model kJ/mol
    path: Backbone | None  # None if the node cannot be reached from the start, or the goal from it
    barrier: float = np.inf  # the highest energy on the path above that of the start, model kJ/mol
    cost: float = np.inf  # kT


def detours(roadmap, program, count):
    """`count` nodes of either order, and the paths by way of them; these are kept in the folder of the run's name with `-orders` behind it."""
    start, goal = (roadmap.alphas_of(end[None]) for end in roadmap.ends())
    closure = {}
    for name, ranges in ANGLES.items():
        first, last = (angle(end, ranges, roadmap.numbers) for end in (start, goal))
        closure[name] = (angle(roadmap.alphas, ranges, roadmap.numbers) - first) / (last - first)
    found = []
    for name in ANGLES:
        (other,) = set(ANGLES) - {name}
        for k in farthest(closure[name] - closure[other], roadmap.alphas, count):
            id, config = int(roadmap.ids[k]), roadmap.configs[k]
            detour = Detour(name, id, {name: closure[name][k] for name in ANGLES}, roadmap.energies[k], None)
            there = half(roadmap, program, f"{id}-there", "--goal", config)
            on = half(roadmap, program, f"{id}-on", "--start", config)
            if there and on:
                (path, row), (rest, row_on) = there, on
                atoms = np.concatenate([path.atoms, rest.atoms[1:]])
                detour.path = Backbone(path.numbers, path.names, atoms[:, :, 1], atoms)
                peaks = [float(r["peak [kJ/mol]"]) for r in (row, row_on)]
                detour.barrier = max(peaks) - (peaks[0] - float(row["barrier [kJ/mol]"]))
                detour.cost = sum(float(r["cost [kT]"]) for r in (row, row_on))
            found.append(detour)
    return found


def farthest(difference, alphas, count):
    """The nodes of the largest difference, each at least `APART` from all before."""
    taken = []
    for node in np.argsort(-difference, kind="stable"):
        if all(rmsds(alphas[node : node + 1], alphas[other : other + 1])[0, 0] >= APART for other in taken):
            taken.append(int(node))
        if len(taken) == count:
            break
    return taken


def half(roadmap, program, name, option, config):
    """A path between an end of the problem and a configuration: its frames and its line of paths.csv; None if there is none."""
    folder = Path(f"{roadmap.folder}-orders") / name
    folder.parent.mkdir(exist_ok=True)
    if not folder.exists():
        values = ",".join(repr(float(value)) for value in config)
        maps.run(program, "paths", roadmap.folder, *SEARCH, f"{option}={values}", "--out", folder)
    if not (folder / "paths.csv").exists():
        return None
    with open(folder / "paths.csv") as file:
        return read_pdb(folder / "path-1.pdb"), next(csv.DictReader(file))
