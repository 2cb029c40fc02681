"""Holds measures of structures against mdtraj and gemmi.

Usage: against_mdtraj.py FOLDER, which holds the PDB files; what was measured comes as JSON on stdin.

gemmi reads the files and superposes, within 1e-6 A. numpy computes radii of gyration, contacts and shares of contacts here.
mdtraj measures in single precision: radii of gyration and superpositions within 0.001 A, areas of atoms within two of
the 960 points that stand for a sphere and their sums within 0.1 %. Energies of hydrogen bonds agree within 0.1 kcal/mol, as
mdtraj's N-H is 1.00 A long and not 1.01 A; so a bond of about -0.5 kcal/mol may be one by one of the two alone. Secondary
structure is the same letter by letter, but where mdtraj has a pi helix: it prefers those to alpha helices, as DSSP does
since 2.1 and the paper does not.
"""

import json
import sys
import tempfile
import warnings
from pathlib import Path

import gemmi
import mdtraj
import numpy as np

warnings.filterwarnings("ignore")
folder = Path(sys.argv[1])
given = json.load(sys.stdin)


def protein(file, chain, model=0):
    """The chain's amino acid residues in a structure of its own, of alternative positions the first."""
    structure = gemmi.read_structure(str(folder / f"{file}.pdb"))
    structure.remove_alternative_conformations()
    source = structure[model]
    found = gemmi.Structure()
    found.add_model(gemmi.Model(1))
    found[0].add_chain(gemmi.Chain("A"))
    names = [c.name for c in source]
    for c in source:
        if c.name in (chain, "") or len(names) == 1:
            for residue in c:
                known = gemmi.find_tabulated_residue(residue.name)
                if known.is_amino_acid():
                    found[0][0].add_residue(residue)
    return found


def ca_positions(structure, numbers=None):
    """Copies, since gemmi's positions do not keep their structure alive."""
    return [
        gemmi.Position(*residue["CA"][0].pos.tolist())
        for residue in structure[0][0]
        if numbers is None or residue.seqid.num in numbers
    ]


def trajectory(structure):
    structure = structure.clone()
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / "chain.pdb"
        structure.write_minimal_pdb(str(path))
        return mdtraj.load(str(path), standard_names=False)


letters = pi = bonds = weak = 0
for chain in given["chains"]:
    structure = protein(chain["file"], chain["chain"])
    residues = list(structure[0][0])
    name = f"{chain['file']} {chain['chain']}"
    assert [r.seqid.num for r in residues] == chain["numbers"], name
    atoms = [atom for residue in residues for atom in residue]
    at = np.array([atom.pos.tolist() for atom in atoms])

    # Radii of gyration.
    radius = np.sqrt(((at - at.mean(0)) ** 2).sum(1).mean())
    assert abs(radius - chain["radius"]) < 1e-9, (name, radius, chain["radius"])
    weights = np.array([atom.element.weight for atom in atoms])
    centre = (at * weights[:, None]).sum(0) / weights.sum()
    radius = np.sqrt((((at - centre) ** 2).sum(1) * weights).sum() / weights.sum())
    assert abs(radius - chain["radius_by_mass"]) < 1e-4, (name, radius, chain["radius_by_mass"])

    # Contacts.
    ca = np.array([p.tolist() for p in ca_positions(structure)])
    distances = np.linalg.norm(ca[:, None] - ca, axis=2)
    pairs = [[i, j] for i in range(len(ca)) for j in range(i + 4, len(ca)) if distances[i, j] <= 7]
    assert pairs == chain["contacts"], name

    traj = trajectory(structure)
    assert traj.n_atoms == len(atoms) and traj.n_residues == len(residues), name
    radius = mdtraj.compute_rg(traj)[0] * 10
    assert abs(radius - chain["radius"]) < 1e-3, (name, radius, chain["radius"])

    # Areas.
    areas = mdtraj.shrake_rupley(traj)[0] * 100
    worst = np.abs(areas - chain["areas"]).max()
    total = abs(areas.sum() - sum(chain["areas"])) / areas.sum()
    assert worst < 0.27 and total < 1e-3, (name, worst, total)

    # Hydrogen bonds: of each donor, mdtraj gives the two strongest.
    matrix = mdtraj.kabsch_sander(traj)[0].T.tocoo()
    theirs = {(int(d), int(a)): float(e) for d, a, e in zip(matrix.row, matrix.col, matrix.data)}
    ours = {(int(d), int(a)): e for d, a, e in chain["bonds"]}
    for key in set(theirs) ^ set(ours):
        energy = theirs.get(key, ours.get(key))
        assert -0.51 < energy < -0.5, (name, key, energy)
        weak += 1
    for key in set(theirs) & set(ours):
        assert abs(theirs[key] - ours[key]) < 0.1, (name, key, theirs[key], ours[key])
        bonds += 1

    # Secondary structure, in eight states and in three.
    eight = zip(mdtraj.compute_dssp(traj, simplified=False)[0], chain["letters"], strict=True)
    three = zip(mdtraj.compute_dssp(traj)[0], chain["three"], strict=True)
    for residue, (theirs, ours), (theirs_of_three, ours_of_three) in zip(residues, eight, three):
        letters += 1
        if theirs != ours:
            assert theirs == "I", (name, str(residue), theirs, ours)
            pi += 1
        else:
            assert theirs_of_three == ours_of_three, (name, str(residue))
print(f"{bonds} bonds are the same, {weak} of about -0.5 kcal/mol are not;", end=" ")
print(f"{pi} of {letters} residues are in pi helices by mdtraj alone")
assert pi <= 5 and weak <= 12

for pair in given["pairs"]:
    numbers = range(pair["first"], pair["last"] + 1)
    moved, fixed = (ca_positions(protein(file, "A"), numbers) for file in pair["files"])
    found = gemmi.superpose_positions(fixed, moved)
    assert abs(found.rmsd - pair["rmsd"]) < 1e-6, (pair, found.rmsd)
    rotation = np.array(found.transform.mat.tolist())
    assert np.abs(rotation.ravel() - pair["rotation"]).max() < 1e-6, (pair, rotation)
    translation = found.transform.vec.tolist()
    assert np.abs(np.array(translation) - pair["translation"]).max() < 1e-4, (pair, translation)
    a, b = (
        mdtraj.Trajectory(np.array([[p.tolist() for p in points]]) / 10, None)
        for points in (moved, fixed)
    )
    assert abs(mdtraj.rmsd(a, b)[0] * 10 - pair["rmsd"]) < 1e-3, pair

# Best, Hummer & Eaton's Q.
native, other = protein("1L2Y", "A"), protein("1L2Y", "A", 19)
heavy = [[(i, a.pos.tolist()) for i, r in enumerate(s[0][0]) for a in r if not a.is_hydrogen()] for s in (native, other)]
index = np.array([i for i, _ in heavy[0]])
a, b = (np.array([p for _, p in h]) for h in heavy)
first, second = np.triu_indices(len(a), 1)
lengths = [np.linalg.norm(p[first] - p[second], axis=1) for p in (a, b)]
chosen = (lengths[0] < 4.5) & (index[second] - index[first] > 3)
share = np.mean(1 / (1 + np.exp(5 * (lengths[1][chosen] - 1.8 * lengths[0][chosen]))))
assert chosen.sum() == given["native"]["count"]
assert abs(share - given["native"]["share"]) < 1e-12, (share, given["native"])
print("agree")
