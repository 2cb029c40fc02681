#!/usr/bin/env python3
"""Adenylate kinase from open to closed: roadmill's paths beside a molecular dynamics' and ProDy's, by one command.

    ROADMILL_DATA=/path/to/data python3 bench/transitions/compare.py --work FOLDER [--map RUN ...] [--again] [--picture FILE.svg]

Prints tables as Markdown and a list of what was found about every map, and draws all paths over two domain angles. Compared are

- roadmill's maps from 4AKE to 1AKE, chain A, and five dissimilar paths out of each: `FOLDER/usual`, with the settings that are usual,
  `FOLDER/hold-0`, whose ends are left as they are, and the runs given by `--map`, each with its problem RUN.toml and its structures
  RUN-structures beside it. The first two are built if they are not there (about a minute of CPU each); paths are exported into RUN-paths,
  and nodes into RUN-nodes.npz, where these are not there.
- ProDy's adaptive ANM in its three modes, on CA, with the settings that are usual; with `--module`, that of a Python file, too.
- the 98 frames of dynamic importance sampling that MDAnalysis is tested with (O. Beckstein, E. Denning, J. Perilla, T. Woolf,
  J. Mol. Biol. 394, 2009), all atoms; it is no program that could be run again.

Of the last map nodes are taken in which one domain is closed and the other open, and paths looked for by way of them (orders.py).

Terms. *Torn*: a frame with a virtual bond, from one CA to the next, that is farther than 0.3 Å from its lengths in both crystals. *Length*: the sum
of the CA RMSD of successive frames, each two superposed. *Midway*: the smallest share of a path's length at which a domain angle has come to the
middle between its values at the path's two ends. *Same again*: a second run gave the same bits; of a map, another build in one thread, in
RUN-again, which `--again` makes, and the files of its paths. All distances are CA RMSD after the superposition that makes each least.

Needs roadmill, and of Python numpy, gemmi, ProDy, MDAnalysis, MDAnalysisTests and matplotlib.
"""

import argparse
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import adaptive
import maps
import orders
from measures import ANGLES, TORN, angle, frechet, hausdorff, midway, off_bonds, rmsds, shares, steps, virtual_bonds
from structures import Backbone, exists, read_dims, read_pdb, same_residues


@dataclass
class Way:
    """A path of the comparison, whosever it is."""

    name: str
    backbone: Backbone

    @property
    def alphas(self):
        return self.backbone.alphas


class Table:
    """Rows that are printed as Markdown."""

    def __init__(self, *columns):
        print("\n| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))

    def row(self, *cells):
        print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def words(same):
    return {None: "not tried", True: "yes", False: "no"}[same]


def summed_up(paths, ends):
    """Of all frames of some paths: how many, how many are torn, the extremes of virtual bonds, and phi."""
    frames = np.concatenate([path.alphas for path in paths])
    off, bonds = off_bonds(frames, ends), virtual_bonds(frames)
    backbones = [path.backbone for path in paths]
    most = max(b.positive_phi().max() for b in backbones) if backbones[0].atoms is not None else "no backbone"
    starts = max(rmsds(path.alphas[:1], ends[0][None])[0, 0] for path in paths)
    goals = max(rmsds(path.alphas[-1:], ends[1][None])[0, 0] for path in paths)
    return (
        len(frames),
        int((off > TORN).sum()),
        f"{off.max():.3f}",
        f"{bonds.min():.2f} to {bonds.max():.2f}",
        most,
        f"{starts:.2f}, {goals:.2f}",
    )


def row_of(path, ends, dims, numbers):
    """What the second table says of a path."""
    share, off = shares(path.alphas), off_bonds(path.alphas, ends)
    halves = [midway(angle(path.alphas, ranges, numbers), share) for ranges in ANGLES.values()]
    distances = rmsds(path.alphas, dims)
    return (
        path.name,
        len(path.alphas),
        f"{steps(path.alphas).sum():.2f}",
        int((off > TORN).sum()),
        f"{hausdorff(distances):.2f}",
        f"{frechet(distances):.2f}",
        *(f"{half:.2f}" for half in halves),
    )


def prepared(asked, data):
    """roadmill's maps, built if they are not there."""
    crystals = [data / f"{name}.pdb" for name in ("4AKE", "1AKE")]
    asked.work.mkdir(parents=True, exist_ok=True)
    for name, options in (("usual", []), ("hold-0", ["--hold", "0"])):
        folder = asked.work / name
        if not (folder / "summary.json").exists():
            problem = f"{folder}.toml"
            maps.run(asked.roadmill, "protein", "problem", *crystals, "--chain", "A", *options, "--out", problem)
            maps.run(asked.roadmill, "build", problem, "--out", folder, "--workers", 2)
    folders = [asked.work / "usual", asked.work / "hold-0", *asked.map]
    return [maps.Map(folder, asked.roadmill, asked.again) for folder in folders]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=Path, required=True, help="folder of the maps that are built")
    parser.add_argument(
        "--map", type=Path, action="append", default=[], help="another run; the last one is shown path by path"
    )
    parser.add_argument("--roadmill", default="roadmill", help="the program [default: the one in PATH]")
    parser.add_argument("--again", action="store_true", help="build every map and export its paths a second time")
    parser.add_argument("--module", type=Path, help="a Python file with another calcAdaptiveANM")
    parser.add_argument(
        "--nodes", type=int, default=2, help="nodes of the last map by way of which either order is tried [default: 2]"
    )
    parser.add_argument("--picture", type=Path, help="an SVG file to be written")
    asked = parser.parse_args()
    if asked.module:
        exists(asked.module, "a Python file with a function calcAdaptiveANM")
    if asked.picture:
        exists(asked.picture.resolve().parent, "a folder for the picture")
    if "ROADMILL_DATA" not in os.environ:
        sys.exit("ROADMILL_DATA: not set; the folder with structures/4AKE.pdb and structures/1AKE.pdb expected")
    data = exists(Path(os.environ["ROADMILL_DATA"]) / "structures", "the folder of structures below ROADMILL_DATA")
    crystals = [read_pdb(exists(data / f"{name}.pdb", "a crystal structure")) for name in ("4AKE", "1AKE")]
    numbers, ends = crystals[0].numbers, [crystal.alphas[0] for crystal in crystals]
    same_residues(crystals[1], crystals[0], "1AKE.pdb beside 4AKE.pdb")

    dims = read_dims()
    same_residues(dims, crystals[0], "the topology of the DIMS trajectory")
    near = rmsds(dims.alphas[[0, -1]], np.array(ends))
    if near[0, 0] > near[0, 1]:  # It goes from closed to open.
        dims.alphas, dims.atoms = dims.alphas[::-1], dims.atoms[::-1]
    dims = Way("DIMS", dims)

    found = prepared(asked, data)
    for one in found:
        for path in one.paths:
            same_residues(path, crystals[0], one.paths_folder)
    walks = []
    modules = [("ProDy aANM", "prody")] + ([(f"ProDy {asked.module.stem}", str(asked.module))] if asked.module else [])
    for name, module in modules:
        for mode in adaptive.MODES:
            if module != "prody" and mode == "both-ways":
                continue
            frames, cpu, same = adaptive.walk(data / "4AKE.pdb", data / "1AKE.pdb", mode, module, asked.work)
            walks.append((Way(f"{name}, {mode}", Backbone(numbers, crystals[0].names, frames, None)), cpu, same))

    print("### What each gives")
    columns = [
        "of",
        "nodes",
        "CPU s",
        "alternatives",
        "frames",
        "torn frames",
        "virtual bonds off by, Å",
        "virtual bonds, Å",
    ]
    table = Table(*columns, "most phi > 0", "ends off the crystals, Å", "same again")
    shown = None
    for one in found:
        shown = [Way(f"{one.folder.name}, path {k + 1}", path) for k, path in enumerate(one.paths)]
        cpu = f"{one.summary['cpu_seconds']:.0f}" + (f" + {one.paths_cpu:.0f}" if one.paths_cpu is not None else "")
        table.row(
            f"roadmill, {one.folder.name}",
            one.summary["nodes"],
            cpu,
            len(shown),
            *summed_up(shown, ends),
            words(one.same),
        )
    for path, cpu, same in walks:
        table.row(path.name, "", f"{cpu:.1f}", 1, *summed_up([path], ends), words(same))
    table.row("DIMS", "", "not known", 1, *summed_up([dims], ends), "not tried")

    print("\n### Paths one by one")
    midways = [f"{name} midway" for name in ANGLES]
    table = Table("path", "frames", "length, Å", "torn", "Hausdorff to DIMS, Å", "Fréchet to DIMS, Å", *midways)
    for path in [*shown, *(path for path, _, _ in walks), dims]:
        table.row(*row_of(path, ends, dims.alphas, numbers))

    print("\n### Maps")
    for one in found:
        roadmap = one.roadmap()
        nodes = roadmap.alphas
        lines = [
            f"{len(nodes)} distinct nodes of {roadmap.all}, {int((off_bonds(nodes, ends) > TORN).sum())} of them torn"
        ]
        lines.append(f"CA computed here from torsions within {one.off_kinematics():.4f} Å of those that roadmill wrote")
        for path in (dims, walks[0][0]):
            nearest = rmsds(nodes, path.alphas).min(axis=0)
            lines.append(
                f"frames of {path.name}: the nearest node {np.median(nearest):.2f} Å away in the median, {nearest.max():.2f} Å at most"
            )
        print(f"\n{one.folder.name}:\n" + "\n".join(f"- {line}" for line in lines), flush=True)

    ways = orders.detours(roadmap, asked.roadmill, asked.nodes)
    closures = [f"{name} closure" for name in ANGLES]
    print(f"\n### By way of nodes of {one.folder.name} in which one domain is closed and the other open")
    table = Table(
        "moves first", "node", *closures, "energy, kJ/mol", "barrier, kJ/mol", "cost, kT", "length, Å", *midways
    )
    for way in ways:
        cells = [way.first, way.node, *(f"{way.closures[name]:.2f}" for name in ANGLES), f"{way.energy:.0f}"]
        if way.path is None:
            table.row(*cells, "no path", "", "", "", "")
            continue
        share = shares(way.path.alphas)
        halves = [midway(angle(way.path.alphas, ranges, numbers), share) for ranges in ANGLES.values()]
        length = steps(way.path.alphas).sum()
        table.row(*cells, f"{way.barrier:.0f}", f"{way.cost:.0f}", f"{length:.1f}", *(f"{half:.2f}" for half in halves))

    if asked.picture:
        import picture

        both = lambda alphas: np.array([angle(alphas, ranges, numbers) for ranges in ANGLES.values()])
        others = [("DIMS", "tab:red", both(dims.alphas)), (walks[0][0].name, "tab:orange", both(walks[0][0].alphas))]
        for name, colour in zip(ANGLES, ("black", "deeppink")):
            best = min(
                (way for way in ways if way.first == name and way.path),
                key=lambda way: (way.barrier, way.cost),
                default=None,
            )
            if best:
                others.append((f"roadmill, {name} first (node {best.node})", colour, both(best.path.alphas)))
        marks = [(name, both(end[None])[:, 0]) for name, end in zip(("4AKE, open", "1AKE, closed"), ends)]
        picture.draw(
            asked.picture,
            list(ANGLES),
            both(nodes),
            roadmap.energies,
            [both(path.alphas) for path in shown],
            others,
            marks,
        )
        print(f"\n{asked.picture}: written, {asked.picture.stat().st_size} bytes")


if __name__ == "__main__":
    main()
