#!/usr/bin/env python3
"""Which domain of adenylate kinase moves first, and whether the other order is open: paths by way of chosen nodes of a map.

    python3 bench/transitions/orders.py RUN --out FOLDER [--roadmill PROGRAM] [--nodes N]

RUN is a run from 4AKE to 1AKE with its structures beside it. The *closure* of a domain is how far its angle (NMP, LID; `measures.py`) has gone from the
run's start, 0, to its goal, 1. Of all distinct nodes those are taken in which the LID is closed and the NMP still open the most, by the difference of
their closures, and those with the reverse; N of either (3), no two within 1 Å CA RMSD. For each `roadmill paths --dissimilar --count 1` looks for a
path from the start to it and from it to the goal, and what both together come to is printed as Markdown: the barrier, the highest energy
above that of the start; the cost there; and at which share of the whole length each angle is midway. FOLDER gets the paths.
"""
import argparse
import csv
import sys
from pathlib import Path

import numpy as np

import maps
from measures import ANGLES, angle, midway, rmsds, shares
from structures import exists, read_pdb

# How the two halves are looked for.
SEARCH = ["--count", "1", "--dissimilar", "--tries", "3", "--shorten-tries", "20", "--format", "pdb,csv"]


def farthest(difference, alphas, count):
    """The nodes of the largest difference, each at least 1 Å from all before."""
    taken = []
    for node in np.argsort(-difference, kind="stable"):
        if all(rmsds(alphas[node : node + 1], alphas[other : other + 1])[0, 0] > 1 for other in taken):
            taken.append(int(node))
        if len(taken) == count:
            break
    return taken


def half(asked, name, option, config):
    """A path between an end of the problem and a configuration: its frames, and its line of paths.csv; None if there is none."""
    folder = asked.out / name
    if not (folder / "paths.csv").exists():
        values = ",".join(repr(float(value)) for value in config)
        maps.run(asked.roadmill, "paths", asked.run, *SEARCH, f"{option}={values}", "--out", folder)
    if not (folder / "path-1.pdb").exists():
        return None
    with open(folder / "paths.csv") as file:
        return read_pdb(folder / "path-1.pdb").alphas, next(csv.DictReader(file))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path)
    parser.add_argument("--out", type=Path, required=True, help="folder of the paths; those that are there are taken")
    parser.add_argument("--roadmill", default="roadmill", help="the program [default: the one in PATH]")
    parser.add_argument("--nodes", type=int, default=3, help="how many nodes of either kind are tried [default: 3]")
    asked = parser.parse_args()
    roadmap = maps.Roadmap(asked.run, asked.roadmill)
    start, goal = (roadmap.alphas_of(end[None]) for end in roadmap.ends())
    asked.out.mkdir(parents=True, exist_ok=True)
    closure = {}
    for name, ranges in ANGLES.items():
        at = lambda alphas: angle(alphas, ranges, roadmap.numbers)
        closure[name] = (at(roadmap.alphas) - at(start)) / (at(goal) - at(start))
    first, second = ANGLES
    print(f"{len(roadmap.alphas)} distinct nodes; closures of {first} and {second} of the nodes tried, and the paths by way of them")
    print(f"\n| first | node | {first} closure | {second} closure | energy | barrier there, kJ/mol | cost, kT | length, Å | {first} midway | {second} midway |")
    print("|" + " --- |" * 10)
    for name, other in ((second, first), (first, second)):
        for node in farthest(closure[name] - closure[other], roadmap.alphas, asked.nodes):
            id, config = roadmap.ids[node], roadmap.configs[node]
            halves = [half(asked, f"{id}-there", "--goal", config), half(asked, f"{id}-on", "--start", config)]
            cells = [name, str(id), f"{closure[first][node]:.2f}", f"{closure[second][node]:.2f}", f"{roadmap.energies[node]:.0f}"]
            if None in halves:
                print("| " + " | ".join(cells + ["no path"] + [""] * 4) + " |", flush=True)
                continue
            (there, row), (on, row_on) = halves
            whole = np.concatenate([there, on[1:]])
            share = shares(whole)
            halfway = [midway(angle(whole, ranges, roadmap.numbers), share) for ranges in ANGLES.values()]
            peak = max(float(r["peak [kJ/mol]"]) for r in (row, row_on))
            barrier = peak - (float(row["peak [kJ/mol]"]) - float(row["barrier [kJ/mol]"]))
            cost = sum(float(r["cost [kT]"]) for r in (row, row_on))
            length = sum(float(r["length [Å]"]) for r in (row, row_on))
            cells += [f"{barrier:.0f}", f"{cost:.0f}", f"{length:.1f}", *(f"{at:.2f}" for at in halfway)]
            print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
