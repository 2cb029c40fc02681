#!/usr/bin/env python3
"""In which order the parts of proteins form, over several routes from each unstructured conformation instead of the cheapest alone.

    ROADMILL_DATA=/path/to/data python3 bench/folding_routes.py 1PGA 1MI0:A --seeds 1-10 --nodes 5000

Needs NumPy and gemmi. Takes the runs that `bench/folding.py` has made with the same words (variant `fold`), exports their roadmaps, and derives
the conformations, contacts, parts and pathways anew, with nothing of roadmill's but the roadmap and the secondary structure. A row per
seed and pair of parts; the shares of pathways on which the first forms before the second, and the second before the first:

  cheapest      over the routes of the least Σ −ln P, as `roadmill orders` counts
  shortest      over the shortest routes in the metric of all torsions, whatever their energies
  fewest        over the routes of the fewest motions
  each last     over the cheapest routes through each motion into the native conformation, every such motion having one vote, at most
                `--last` of them, evenly taken in the order of their nodes

and how many of the last motions there are, over how many the cheapest routes lead, what these climb in all, and how far the energy falls from
their beginnings to their end: medians, kT.
"""

import argparse
import heapq
import pathlib
import re
import subprocess
import sys

import gemmi
import numpy

from folding import PAIRS, seeds_of

REACH = 7.0  # Å between two Cα in contact
APART = 4  # places along the chain at least
PAIRING_LEAST = 3  # contacts of a pairing
FRAMES_APART = numpy.radians(0.5)  # root of the mean squared turn between two frames of a motion
KT = 2.479  # kJ/mol at 298 K
FORMED = 0.6  # of its contacts, from which on a part is formed


def torsion(a, b, c, d):
    ab, bc, cd = a - b, c - b, d - c
    bc = bc / numpy.linalg.norm(bc)
    x, y = ab - (ab @ bc) * bc, cd - (cd @ bc) * bc
    return numpy.arctan2(numpy.cross(bc, x) @ y, x @ y)


def wrapped(angles):
    return (angles + numpy.pi) % (2 * numpy.pi) - numpy.pi


class Chain:
    """A backbone whose phi and psi turn, all bonds, angles and omegas being those of its file."""

    def __init__(self, file, names, native):
        residues = gemmi.read_structure(str(file))[0][0]
        atoms = [list(residue.find_atom(atom, "*").pos) for residue in residues for atom in ("N", "CA", "C")]
        self.atoms = numpy.array(atoms)
        bonds = numpy.diff(self.atoms, axis=0)
        self.lengths = numpy.linalg.norm(bonds, axis=1)
        cosines = -(bonds[:-1] * bonds[1:]).sum(1) / self.lengths[:-1] / self.lengths[1:]
        self.angles = numpy.arccos(cosines)
        self.torsions = [torsion(*self.atoms[at : at + 4]) for at in range(len(self.atoms) - 3)]
        # Which torsion of a configuration places an atom: phi of residue i its C, psi of it the N that follows.
        self.column = {}
        for at, name in enumerate(names):
            kind, residue = name.split("_")
            self.column[3 * (int(residue) - 1) + 2 if kind == "phi" else 3 * int(residue)] = at
        self.native = native

    def alphas(self, configurations):
        """The Cα of many configurations, each atom placed from the three before it."""
        turns = configurations - self.native
        placed = numpy.empty((len(self.atoms), len(configurations), 3))
        placed[:3] = self.atoms[:3, None]
        for at in range(3, len(self.atoms)):
            turn = turns[:, self.column[at]] if at in self.column else numpy.zeros(len(turns))
            a, b, c = placed[at - 3 : at]
            along = (c - b) / self.lengths[at - 2]
            across = numpy.cross(b - a, along)
            across /= numpy.linalg.norm(across, axis=1)[:, None]
            angle, round_ = self.angles[at - 2], (self.torsions[at - 3] + turn)[:, None]
            side = numpy.cos(round_) * numpy.cross(across, along) + numpy.sin(round_) * across
            placed[at] = c + self.lengths[at - 1] * (numpy.sin(angle) * side - numpy.cos(angle) * along)
        return placed[1::3].transpose(1, 0, 2)


def elements_of(program, file):
    """Helices of at least four residues and strands of at least two, along the chain: name, kind, residues from 0 on."""
    said = subprocess.run([program, "protein", "info", file], capture_output=True, text=True, check=True).stdout.splitlines()
    at = next(at for at, line in enumerate(said) if line.startswith("chain")) + 1
    states = ""
    while match := re.fullmatch(r"(\s+\d+ )([A-Z]+)", said[at]):
        first, width = len(match[1]), len(match[2])
        states += said[at + 1][first : first + width].ljust(width)
        at += 2
    found = []
    for kind, letters, least in (("α", "HGI", 4), ("β", "E", 2)):
        runs = [run for run in re.finditer(f"[{letters}]+", states) if run.end() - run.start() >= least]
        found += [(run.start(), f"{kind}{number}", kind, range(run.start(), run.end())) for number, run in enumerate(runs, 1)]
    return [element[1:] for element in sorted(found)]


def parts_of(elements, contacts):
    """Helices, strands and pairings, each with the contacts that make it."""
    of = lambda residue: next((name for name, _, residues in elements if residue in residues), None)
    ends = [(of(a), of(b)) for a, b in contacts]
    strands = {name for name, kind, _ in elements if kind == "β"}
    parts = {}
    for name, kind, _ in elements:
        if kind == "α":
            parts[name] = [at for at, pair in enumerate(ends) if pair == (name, name)]
        else:
            parts[name] = [at for at, (a, b) in enumerate(ends) if a != b and name in (a, b) and {a, b} <= strands]
    names = [name for name, _, _ in elements]
    for b, second in enumerate(names):
        for first in names[:b]:
            pairing = [at for at, pair in enumerate(ends) if pair == (first, second)]
            if len(pairing) >= PAIRING_LEAST:
                parts[f"{first}–{second}"] = pairing
    return {name: part for name, part in parts.items() if part}


class Roadmap:
    """A roadmap from the native conformation, its parts, and its pathways."""

    def __init__(self, file, structure, elements, unstructured):
        arrays = numpy.load(file)
        self.nodes, edges = arrays["nodes"], arrays["edges"].astype(int)
        self.energies = arrays["values"][:, 0]
        self.chain = Chain(structure, arrays["dof_names"], self.nodes[0])
        alphas = self.chain.atoms[1::3]
        distances = numpy.linalg.norm(alphas[:, None] - alphas, axis=2)
        self.contacts = numpy.array([(a, b) for a in range(len(alphas)) for b in range(a + APART, len(alphas)) if distances[a, b] <= REACH])
        self.parts = parts_of(elements, self.contacts.tolist())
        # The native conformation may be several nodes.
        self.native = {int(node) for node in numpy.flatnonzero(abs(wrapped(self.nodes - self.nodes[0])).max(1) < 1e-9)}
        self.starts = [int(node) for node in numpy.flatnonzero(self.kept(self.nodes).sum(1) <= unstructured)]
        lengths = numpy.linalg.norm(wrapped(self.nodes[edges[:, 0]] - self.nodes[edges[:, 1]]), axis=1)
        # By rank, what every motion that leads to a node costs, walked toward it: (from, cost).
        there = {"cheapest": arrays["weights"], "shortest": lengths, "fewest": numpy.ones(len(edges))}
        back = there | {"cheapest": arrays["weights_back"]}
        self.into = {rank: [[] for _ in self.nodes] for rank in there}
        for rank, into in self.into.items():
            for (low, high), forth, backward in zip(edges.tolist(), there[rank].tolist(), back[rank].tolist()):
                into[high].append((low, forth))
                into[low].append((high, backward))
        self.known = {}

    def kept(self, configurations):
        """Which native contacts configurations have."""
        some = []
        for at in range(0, len(configurations), 4000):
            alphas = self.chain.alphas(configurations[at : at + 4000])
            some.append(numpy.linalg.norm(alphas[:, self.contacts[:, 0]] - alphas[:, self.contacts[:, 1]], axis=2) <= REACH)
        return numpy.concatenate(some)

    def tree(self, roots, rank, without=frozenset()):
        """The cheapest routes to the nearest of `roots`: per node the next one, nodes in the order in which they are reached, and costs."""
        cost, following, reached = dict(roots), {}, []
        open_, done = [(value, node) for node, value in roots.items()], set()
        heapq.heapify(open_)
        while open_:
            value, node = heapq.heappop(open_)
            if node in done:
                continue
            done.add(node)
            reached.append(node)
            for before, more in self.into[rank][node]:
                if before not in done and before not in without and value + more < cost.get(before, numpy.inf):
                    cost[before], following[before] = value + more, node
                    heapq.heappush(open_, (cost[before], before))
        return following, reached, cost

    def look(self, motions):
        """Finds for motions (from, to) how many frames they have, and for each part at which frame from `to` on it is first not formed."""
        new = [motion for motion in motions if motion not in self.known]
        if not new:
            return
        apart, frames, counts = FRAMES_APART * self.nodes.shape[1] ** 0.5, [], []
        for here, there in new:
            turn = wrapped(self.nodes[here] - self.nodes[there])
            counts.append(max(1, int(numpy.ceil(numpy.linalg.norm(turn) / apart))))
            frames.append(self.nodes[there] + turn * (numpy.arange(1, counts[-1] + 1) / counts[-1])[:, None])
        kept = self.kept(numpy.concatenate(frames))
        broken = numpy.stack([kept[:, part].sum(1) < FORMED * len(part) - 1e-9 for part in self.parts.values()], axis=1)
        at = 0
        for motion, count in zip(new, counts):
            of_motion = broken[at : at + count]
            self.known[motion] = count, numpy.where(of_motion.any(0), of_motion.argmax(0), count)
            at += count

    def formation(self, following, reached, ends):
        """Per start with a route how many frames before its end each part forms; `ends` has the same of the nodes where routes end, with
        which parts are formed from there on."""
        on_way = set()
        for node in self.starts:
            while node in following and node not in on_way:
                on_way.add(node)
                node = following[node]
        self.look([(node, following[node]) for node in on_way])
        state = dict(ends)
        for node in reached:
            if node in on_way:
                depth, formed = state[following[node]]
                count, first = self.known[node, following[node]]
                state[node] = numpy.where(formed, depth + first, depth), formed & (first == count)
        return numpy.array([state[node][0] for node in self.starts if node in state and node not in self.native])

    def shares(self, depths, pair):
        """On which share of pathways the first of a pair forms before the second, and the second before the first."""
        names = list(self.parts)
        first, second = (depths[:, names.index(part)] for part in pair)
        return numpy.array([(first > second).mean(), (second > first).mean()])

    def whole(self, rank):
        """The formation over the best routes by a rank, over how many last motions they lead, and what they climb and fall, kT."""
        following, reached, cost = self.tree(dict.fromkeys(self.native, 0.0), rank)
        start = numpy.zeros(len(self.parts), int), numpy.ones(len(self.parts), bool)
        depths = self.formation(following, reached, dict.fromkeys(self.native, start))
        last = set()
        for node in self.starts:
            while node in following and following[node] not in self.native:
                node = following[node]
            last.add(node)
        begun = [node for node in self.starts if node in following]
        climbs = numpy.median([cost[node] for node in begun]) if begun else numpy.nan
        falls = numpy.median(self.energies[begun] - self.energies[0]) / KT if begun else numpy.nan
        return depths, len(last), climbs, falls

    def last_motions(self):
        """The nodes next to the native conformation, each with the native node that it is joined to at the least cost."""
        found = {}
        for root in sorted(self.native):
            for before, cost in self.into["cheapest"][root]:
                if before not in self.native and cost < found.get(before, (numpy.inf, root))[0]:
                    found[before] = cost, root
        return {before: root for before, (_, root) in sorted(found.items())}

    def through(self, before, root):
        """The formation over the cheapest routes that end with the motion from `before` to the native conformation."""
        following, reached, _ = self.tree({before: 0.0}, "cheapest", self.native)
        self.look([(before, root)])
        count, first = self.known[before, root]
        return self.formation(following, reached, {before: (first, first == count)})


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("proteins", nargs="+", metavar="ENTRY[:CHAIN]", help="as of bench/folding.py")
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-5"), metavar="FIRST-LAST", help="base seeds")
    parser.add_argument("--nodes", type=int, default=10000, help="nodes of each roadmap")
    parser.add_argument("--last", type=int, default=40, help="so many last motions have a vote at most")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("runs/folding"), help="where the runs are")
    parser.add_argument("--roadmill", default="target/release/roadmill", help="the program")
    return parser.parse_args()


def main():
    args = arguments()
    print("| protein, seed | pair | cheapest | shortest | fewest | each last | last motions | of the cheapest | climbs | falls |\n|" + " --- |" * 10)
    for name in args.proteins:
        entry, _, _ = name.partition(":")
        structure = args.work / f"{entry}-structures/source.cif"
        text = (args.work / f"{entry}.toml").read_text(encoding="utf-8")
        unstructured = int(re.search(r"unstructured = (\d+)", text)[1])
        elements = elements_of(args.roadmill, structure)
        for seed in args.seeds:
            run = args.work / f"{entry}-fold-{args.nodes}-{seed}"
            exported = run.with_name(run.name + ".npz")
            if not run.exists():
                sys.exit(f"{run}: not there; `bench/folding.py {name} --seeds … --nodes {args.nodes}` makes it")
            if not exported.exists():
                subprocess.run([args.roadmill, "export", run, "--format", "npz", "--out", exported], check=True, capture_output=True)
            roadmap = Roadmap(exported, structure, elements, unstructured)
            ranked = {rank: roadmap.whole(rank) for rank in ("cheapest", "shortest", "fewest")}
            last = list(roadmap.last_motions().items())
            taken = last[:: -(-len(last) // args.last)]
            votes = [depths for depths in (roadmap.through(*motion) for motion in taken) if len(depths)]
            _, count, climbs, falls = ranked["cheapest"]
            for pair in PAIRS.get(entry, []):
                cells = [roadmap.shares(depths, pair) for depths, *_ in ranked.values()]
                cells.append(numpy.mean([roadmap.shares(depths, pair) for depths in votes], axis=0))
                cells = " | ".join(f"{first:.2f} {second:.2f}" for first, second in cells)
                print(f"| {entry}, {seed} | {pair[0]} < {pair[1]} | {cells} | {len(last)} | {count} | {climbs:.0f} | {falls:.0f} |", flush=True)


if __name__ == "__main__":
    main()
