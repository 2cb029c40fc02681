#!/usr/bin/env python3
"""Derives what `roadmill paths` says of a protein's paths again, from exported files alone.

    python3 bench/check_paths.py FOLDER SOURCE [TARGET] [--kt 100] [--angle NAME=a-b/c-d/e-f ...]

FOLDER is what `roadmill paths RUN --format pdb,csv --out FOLDER` wrote; SOURCE and TARGET are the structures of the problem
(`source.cif`, `target.cif` beside the problem file; one chain of amino acids is taken of each, the first). Needs gemmi, mdtraj and numpy.

The energy is written anew here: hydrogen bonds of either structure by Kabsch and Sander (below -0.5 kcal/mol, hydrogens
1.01 A opposite to the carbonyl before), 100 kJ/(mol A) {[(d - 2)^2 + 4]^0.5 - 2} for each, disulphides likewise at their
native distance of side chains, -20 kJ/mol for each pair of hydrophobic side chains within 6 A, and the smooth minimum of the two
structures. Of every frame are looked at: the energy (against frames.csv), the distances of CA (3.0 A for |i - j| > 2
at the path's own configurations, 2.7 A at the others), of side chains (2.4 and 1.0 A), of N and O (2.4 A) and of other backbone atoms
(2.6 A) at its own configurations, the virtual bonds against those of both structures, and residues with phi > 0. Printed is a table as
Markdown; the exit code is 1 if anything differs or breaks a rule.
"""
import argparse
import csv
import sys

import gemmi
import mdtraj
import numpy as np

HYDROPHOBIC = set("AVILMFWCPY")
BACKBONE = ["N", "CA", "C", "O", "CB"]


def chain_of(path):
    structure = gemmi.read_structure(path)
    structure.setup_entities()
    for chain in structure[0]:
        residues = [r for r in chain if gemmi.find_tabulated_residue(r.name).is_amino_acid()]
        if residues:
            return [Residue(r) for r in residues]
    sys.exit(f"{path}: no chain of amino acids")


class Residue:
    def __init__(self, residue):
        self.number, self.name = residue.seqid.num, residue.name
        self.code = gemmi.find_tabulated_residue(residue.name).one_letter_code.upper()
        heavy = [a for a in residue if not a.element.is_hydrogen]
        self.at = {a.name: np.array(a.pos.tolist()) for a in heavy}
        side = [self.at[a.name] for a in heavy if a.name not in ("N", "CA", "C", "O", "OXT")]
        self.side = np.mean(side, axis=0) if side and self.code != "G" else None


def hydrogens(chain):
    found = [None] * len(chain)
    for i in range(1, len(chain)):
        before, here = chain[i - 1], chain[i]
        if here.code == "P" or np.linalg.norm(before.at["C"] - here.at["N"]) > 2.5:
            continue
        direction = before.at["C"] - before.at["O"]
        found[i] = here.at["N"] + 1.01 * direction / np.linalg.norm(direction)
    return found


def bonds(chain):
    found, of = [], hydrogens(chain)
    for i, h in enumerate(of):
        if h is None:
            continue
        for j, other in enumerate(chain):
            if abs(i - j) < 2:
                continue
            n, c, o = chain[i].at["N"], other.at["C"], other.at["O"]
            if np.linalg.norm(n - o) > 6.0:
                continue
            near = lambda a, b: 1.0 / np.linalg.norm(a - b)
            energy = 0.42 * 0.20 * 332.0 * (near(o, n) + near(c, h) - near(o, h) - near(c, n))
            if energy < -0.5:
                found.append((i, j))
    return found


def disulphides(chain):
    found = []
    for i, a in enumerate(chain):
        for j in range(i + 1, len(chain)):
            b = chain[j]
            if "SG" in a.at and "SG" in b.at and np.linalg.norm(a.at["SG"] - b.at["SG"]) <= 2.5:
                found.append((i, j, np.linalg.norm(a.side - b.side)))
    return found


def term(distance, native):
    return 100.0 * (np.sqrt((distance - native) ** 2 + 4.0) - 2.0)


def constraint_energy(chain, hydrogen_bonds, sulphurs):
    of, total = hydrogens(chain), 0.0
    for i, j in hydrogen_bonds:
        if of[i] is not None:
            total += term(np.linalg.norm(of[i] - chain[j].at["O"]), 2.0)
    for i, j, native in sulphurs:
        if chain[i].side is not None and chain[j].side is not None:
            total += term(np.linalg.norm(chain[i].side - chain[j].side), native)
    return total


def hydrophobic_energy(chain):
    at = [(i, r.side) for i, r in enumerate(chain) if r.code in HYDROPHOBIC and r.side is not None]
    near = lambda a, b: b[0] - a[0] >= 2 and np.linalg.norm(a[1] - b[1]) < 6.0
    return -20.0 * sum(near(a, b) for k, a in enumerate(at) for b in at[k + 1 :])


def smooth_minimum(values, kt):
    low = min(values)
    return low - kt * np.log(sum(np.exp(-(value - low) / kt) for value in values))


def least(points_a, points_b, apart):
    """The least distance of the points of residues i and j, |i - j| >= apart."""
    (ia, a), (ib, b) = points_a, points_b
    if len(a) == 0 or len(b) == 0:
        return np.inf
    distances = np.linalg.norm(a[:, None] - b[None], axis=2)
    return np.min(np.where(np.abs(ia[:, None] - ib[None]) >= apart, distances, np.inf))


def points(chain, name):
    at = [(i, r.at[name]) for i, r in enumerate(chain) if name in r.at]
    return np.array([i for i, _ in at], int), np.array([p for _, p in at])


def broken(chain, own):
    sides = [(i, r.side) for i, r in enumerate(chain) if r.side is not None]
    sides = np.array([i for i, _ in sides], int), np.array([p for _, p in sides])
    slack = 2e-3  # coordinates of a PDB file are rounded to 0.001 A
    found = []
    if least(points(chain, "CA"), points(chain, "CA"), 3) < (3.0 if own else 2.7) - slack:
        found.append("CA")
    if least(sides, sides, 1) < (2.4 if own else 1.0) - slack:
        found.append("side chains")
    if own:
        for a in BACKBONE:
            for b in BACKBONE:
                limit = 2.4 if {a, b} == {"N", "O"} else 2.6
                if least(points(chain, a), points(chain, b), 3) < limit - slack:
                    found.append(f"{a} {b}")
    return found


def virtual_bonds(chain):
    at = points(chain, "CA")[1]
    return np.linalg.norm(at[1:] - at[:-1], axis=1)


def positive_phi(chain):
    count = 0
    for before, here in zip(chain, chain[1:]):
        if here.code == "G":
            continue
        a, b, c, d = before.at["C"], here.at["N"], here.at["CA"], here.at["C"]
        n1, n2 = np.cross(b - a, c - b), np.cross(c - b, d - c)
        if np.dot(np.cross(n1, n2), c - b) > 0:
            count += 1
    return count


def angle(chain, ranges):
    at = lambda text: np.mean(
        [r.at["CA"] for r in chain if int(text.split("-")[0]) <= r.number <= int(text.split("-")[1])], axis=0
    )
    a, b, c = (at(text) for text in ranges)
    cosine = np.dot(a - b, c - b) / np.linalg.norm(a - b) / np.linalg.norm(c - b)
    return np.degrees(np.arccos(cosine))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("source")
    parser.add_argument("target", nargs="?")
    parser.add_argument("--kt", type=float, default=100.0)
    parser.add_argument("--angle", action="append", default=[])
    asked = parser.parse_args()
    ends = [chain_of(path) for path in (asked.source, asked.target) if path]
    basins = [(bonds(chain), disulphides(chain)) for chain in ends]
    if len(ends) == 2 and [r.number for r in ends[0]] != [r.number for r in ends[1]]:
        sys.exit("source and target have other residues; ranges that both have expected")
    angles = dict(text.split("=") for text in asked.angle)
    native = [virtual_bonds(chain) for chain in ends]
    print("constraints: " + ", ".join(f"{len(b)} hydrogen bonds, {len(s)} disulphides" for b, s in basins))
    names = "".join(f" {name} midway at |" for name in angles)
    print(f"| path | frames | length, Å | barrier, kJ/mol | broken rules | virtual bonds off, Å | phi > 0 | energy off, kJ/mol |{names}")
    print("| --- |" + " --- |" * (7 + len(angles)))
    bad = False
    with open(f"{asked.folder}/paths.csv") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        name = f"{asked.folder}/path-{row['path']}"
        structure = gemmi.read_structure(f"{name}.pdb")
        frames = [[Residue(r) for r in model[0]] for model in structure]
        with open(f"{name}.frames.csv") as file:
            table = list(csv.DictReader(file))
        trajectory = mdtraj.load(f"{name}.pdb")
        alphas = trajectory.atom_slice(trajectory.topology.select("name CA"))
        steps = [10 * mdtraj.rmsd(alphas[k + 1 : k + 2], alphas, k)[0] for k in range(len(frames) - 1)]
        energies, off, rules = [], 0.0, []
        for frame, said in zip(frames, table):
            values = [constraint_energy(frame, b, s) for b, s in basins]
            energy = smooth_minimum(values, asked.kt) + hydrophobic_energy(frame)
            energies.append(energy)
            off = max(off, abs(energy - float(said["energy [kJ/mol]"])))
            rules += broken(frame, said["own"] == "1")
        stretched = max(
            np.max(np.min([np.abs(virtual_bonds(frame) - of) for of in native], axis=0)) for frame in frames
        )
        share = np.concatenate([[0.0], np.cumsum(steps)]) / np.sum(steps)
        midways = ""
        for ranges in angles.values():
            along = np.array([angle(frame, ranges.split("/")) for frame in frames])
            middle = (along[0] + along[-1]) / 2
            crossed = np.nonzero((along[:-1] - middle) * (along[1:] - middle) <= 0)[0]
            if len(crossed):
                # Between two frames the angle is taken to be linear.
                k, turned = crossed[0], along[crossed[0] + 1] - along[crossed[0]]
                part = (middle - along[k]) / turned if turned else 0.0
                midways += f" {share[k] + part * (share[k + 1] - share[k]):.2f} |"
            else:
                midways += " never |"
        barrier = max(energies) - energies[0]
        most = max(positive_phi(frame) for frame in frames)
        of_ends = max(positive_phi(frames[0]), positive_phi(frames[-1]))
        length = float(row["length [Å]"])
        # A pair at 6.000 A may fall on either side where coordinates are rounded, and is worth 20 kJ/mol.
        rounding = 45.0
        differs = off > rounding or abs(sum(steps) - length) > 0.02 * length + 0.02
        differs |= barrier > float(row["barrier [kJ/mol]"]) + rounding
        bad |= differs or bool(rules) or stretched > 0.3
        print(
            f"| {row['path']} | {len(frames)} | {sum(steps):.2f} | {barrier:.0f} (said {float(row['barrier [kJ/mol]']):.0f}) | "
            f"{', '.join(sorted(set(rules))) or 'none'} | {stretched:.3f} | {most} (ends {of_ends}) | {off:.1f} |{midways}"
            + ("  DIFFERS" if differs else "")
        )
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
