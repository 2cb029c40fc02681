#!/usr/bin/env python3
"""AutoDock Vina on the complexes that `roadmill ligand` is measured on, and both beside each other.

    python3 -m venv peers && peers/bin/pip install vina meeko rdkit gemmi numpy scipy
    export ROADMILL_DATA=/path/to/data
    peers/bin/python bench/peers/docking.py prepare --crystal crystal          # boxes, and the crystal ligands as SDF
    peers/bin/python bench/peers/docking.py dock --seeds 1-10 --csv vina.csv   # runs that are in the file are not made again
    peers/bin/python bench/peers/docking.py table vina.csv [--ours ours.csv]

Receptor: the protein's atoms and metals; waters, chloride and other ligands are left out. Of alternative locations the one with the
highest occupancy is taken. Residues that lack atoms of their side chain become alanine, or glycine without a beta carbon, and are named when docking begins. Meeko
adds hydrogens and gives AutoDock's atom types; of thrombin the hydrogens of the file are kept. The oxidised cysteines of 1HVR
(CSO) are cysteines with their oxygen. Vina reads no charges, and scores a metal as a donor of hydrogen bonds.

Ligand: the crystal's heavy atoms, with the bond orders of a file or of a SMILES template, and hydrogens from RDKit. Bond lengths, bond
angles and rings are the crystal's, as in `roadmill ligand`. The torsions that Vina turns, the orientation and the place in the box are drawn anew
for each seed, so that Vina starts from nothing of the crystal's pose. Rings stay as they are, large ones, too. Meeko's
rule for torsions is Vina's usual one: it turns C-OH and C-NH3 bonds, too, and no amides, so that its number is not
that of `roadmill ligand`.

Box: a cube around the centroid of the crystal ligand's heavy atoms, 22.5 Å wide, or the ligand's longest side and 5 Å at both ends where
that is wider. Vina docks in it with one thread and exhaustiveness 8, and gives up to 20 poses at least 1 Å apart. Its time is the
process's CPU seconds (user and system) for Vina's maps and its search; preparation is not counted.

A row of the CSV is a pose: complex, seed, pose (from 1, by energy), energy (kcal/mol, as Vina prints it), rmsd and rmsd_rotated (Å, heavy atoms,
the least over the ligand's symmetries, without and with the best superposition), cpu_s (of the run, the same in all its rows).
`roadmill ligand poses` gives a CSV with the same columns.
"""

import argparse
import csv
import io
import os
import pathlib
import resource
import statistics
import sys
import tempfile
from dataclasses import dataclass

COLUMNS = ["complex", "seed", "pose", "energy", "rmsd", "rmsd_rotated", "cpu_s"]
BOXES = pathlib.Path(__file__).with_name("docking-boxes.csv")
SIDE, MARGIN = 22.5, 5.0
EXHAUSTIVENESS, POSES, SPACING = 8, 20, 0.375
SUCCESS = 2.0
METALS = {"CA", "MG", "MN", "ZN", "FE"}
CAPS = {"ACE", "NME"}
BACKBONE = {"N", "CA", "C", "O", "OXT"}


@dataclass(frozen=True)
class Complex:
    """A protein and the ligand whose pose in it is known."""

    name: str
    # Relative to ROADMILL_DATA.
    protein: str
    # Chains of the receptor; empty: all.
    chains: str
    # Residue name and chain of the ligand in the protein's file, or nothing where `ligand` has its positions.
    group: tuple[str, str] | None
    # SDF with positions and orders of the ligand: its first molecule.
    ligand: str | None = None
    # Where the orders come from if there is no such file. States of protonation are those of a solution at pH 7.
    smiles: str | None = None
    # Whether the hydrogens of the protein's file are kept.
    hydrogens: bool = False


BIOTIN = "O=C1N[C@@H]2[C@H](CCCCC(=O)[O-])SC[C@@H]2N1"
METHOTREXATE = "CN(Cc1cnc2nc(N)nc(N)c2n1)c1ccc(cc1)C(=O)N[C@@H](CCC(=O)[O-])C(=O)[O-]"
XK263 = "O=C1N(Cc2ccc3ccccc3c2)[C@H](Cc2ccccc2)[C@H](O)[C@@H](O)[C@@H](Cc2ccccc2)N1Cc1ccc2ccccc2c1"
PROGESTERONE = "CC(=O)[C@H]1CC[C@H]2[C@@H]3CCC4=CC(=O)CC[C@]4(C)[C@H]3CC[C@]12C"

COMPLEXES = [
    Complex("3PTB", "structures/3PTB.pdb", "A", None, ligand="structures/3PTB_BEN.sdf"),
    Complex("1STP", "structures/1STP.pdb", "A", ("BTN", "A"), smiles=BIOTIN),
    Complex("4DFR-A", "structures/4DFR.pdb", "A", ("MTX", "A"), smiles=METHOTREXATE),
    Complex("4DFR-B", "structures/4DFR.pdb", "B", ("MTX", "B"), smiles=METHOTREXATE),
    Complex("1HVR", "structures/1HVR.pdb", "AB", ("XK2", "A"), smiles=XK263),
    Complex("1A28", "structures/1A28.pdb", "A", ("STR", "A"), smiles=PROGESTERONE),
    Complex("thrombin", "ligands/thrombin/protein.pdb", "", None, ligand="ligands/thrombin/ligands.sdf", hydrogens=True),
]


def data():
    """The folder of structures."""
    folder = os.environ.get("ROADMILL_DATA")
    if not folder:
        sys.exit("ROADMILL_DATA is not set; it must name the folder with structures/ and ligands/")
    return pathlib.Path(folder)


def protein_structure(entry):
    """The receptor's residues, one location of each atom, and apart from them the atoms that Meeko has no template of, with their types."""
    import gemmi

    structure = gemmi.read_structure(str(data() / entry.protein))
    if not entry.hydrogens:
        structure.remove_hydrogens()
    model = gemmi.Model(1)
    cut, apart = [], []
    for chain in structure[0]:
        if entry.chains and chain.name not in entry.chains:
            continue
        kept = gemmi.Chain(chain.name)
        for residue in chain:
            if residue.name in METALS and len(residue) == 1:
                apart.append((residue[0].clone(), residue[0].element.name))
            elif residue.name == "CSO":
                apart.append((residue["OD"][0].clone(), "OA"))
                kept.add_residue(with_atoms(residue, "CYS", BACKBONE | {"CB", "SG"}))
            elif residue.name in CAPS or gemmi.find_tabulated_residue(residue.name).is_amino_acid():
                if lacks_atoms(residue):
                    cut.append(f"{residue.name} {chain.name}{residue.seqid}")
                    beta = {"CB"} if "CB" in residue else set()
                    kept.add_residue(with_atoms(residue, "ALA" if beta else "GLY", BACKBONE | beta))
                else:
                    kept.add_residue(with_atoms(residue, residue.name, None))
        model.add_chain(kept)
    receptor = gemmi.Structure()
    receptor.add_model(model)
    if cut:
        print(f"{entry.name}: without all side-chain atoms, thus alanine or glycine: {', '.join(cut)}", file=sys.stderr)
    return receptor, apart


def with_atoms(residue, name, atoms):
    """A copy of the residue with another name and one location of each of its atoms (of all, if none are named)."""
    import gemmi

    copy = gemmi.Residue()
    copy.name, copy.seqid, copy.het_flag = name, residue.seqid, "A"
    names = list(dict.fromkeys(atom.name for atom in residue))
    for wanted in names:
        if atoms is None or wanted in atoms:
            places = [atom for atom in residue if atom.name == wanted]
            best = max(places, key=lambda atom: (atom.occ, -ord(atom.altloc))).clone()
            best.altloc = "\0"
            copy.add_atom(best)
    return copy


# Heavy atoms of whole residues, without the OXT of the last.
HEAVY = {
    **{"GLY": 4, "ALA": 5, "SER": 6, "CYS": 6, "THR": 7, "VAL": 7, "PRO": 7, "ASP": 8, "ASN": 8, "LEU": 8, "ILE": 8, "MET": 8},
    **{"GLU": 9, "GLN": 9, "LYS": 9, "HIS": 10, "PHE": 11, "ARG": 11, "TYR": 12, "TRP": 14},
}


def lacks_atoms(residue):
    """Whether atoms of the residue are not in the file."""
    there = len({atom.name for atom in residue if atom.name != "OXT" and not atom.element.is_hydrogen})
    return there < HEAVY.get(residue.name, 0)


def receptor_pdbqt(entry):
    """The receptor as text in PDBQT."""
    from meeko import MoleculePreparation, PDBQTWriterLegacy, Polymer, ResidueChemTemplates

    structure, apart = protein_structure(entry)
    polymer = Polymer.from_pdb_string(
        structure.make_pdb_string(),
        ResidueChemTemplates.create_from_defaults(),
        MoleculePreparation(),
        allow_bad_res=False,
        blunt_ends=[],
    )
    rigid, _ = PDBQTWriterLegacy.write_string_from_polymer(polymer)
    text = io.StringIO()
    text.write(rigid if rigid.endswith("\n") else rigid + "\n")
    for number, (atom, kind) in enumerate(apart, start=90001):
        place = f"{atom.pos.x:8.3f}{atom.pos.y:8.3f}{atom.pos.z:8.3f}"
        text.write(f"ATOM  {number:5d} {atom.name:>4s} ION Z{number - 90000:4d}    {place}  1.00  0.00     0.000 {kind:<2s}\n")
    return text.getvalue()


def crystal_ligand(entry):
    """The ligand in its crystal pose with orders and hydrogens (RDKit)."""
    from rdkit import Chem
    from rdkit.Chem import AllChem

    if entry.ligand:
        molecule = next(iter(Chem.SDMolSupplier(str(data() / entry.ligand), removeHs=False)))
        return Chem.AddHs(molecule, addCoords=True)
    import gemmi

    residue_name, chain_name = entry.group
    structure = gemmi.read_structure(str(data() / entry.protein))
    residue = next(r for r in structure[0][chain_name] if r.name == residue_name)
    lines = []
    for number, atom in enumerate((a for a in residue if not a.element.is_hydrogen), start=1):
        place = f"{atom.pos.x:8.3f}{atom.pos.y:8.3f}{atom.pos.z:8.3f}"
        lines.append(f"HETATM{number:5d} {atom.name:<4s} {residue_name} A   1    {place}  1.00  0.00          {atom.element.name:>2s}")
    bare = Chem.MolFromPDBBlock("\n".join(lines) + "\nEND\n", removeHs=True, proximityBonding=True)
    template = Chem.MolFromSmiles(entry.smiles)
    molecule = AllChem.AssignBondOrdersFromTemplate(template, bare)
    Chem.AssignStereochemistryFrom3D(molecule)
    if Chem.MolToSmiles(molecule) != Chem.MolToSmiles(template):
        print(f"{entry.name}: the crystal has {Chem.MolToSmiles(molecule)}, the template {Chem.MolToSmiles(template)}", file=sys.stderr)
    molecule = Chem.AddHs(molecule, addCoords=True)
    molecule.SetProp("_Name", residue_name)
    return molecule


def box(ligand):
    """Centre and side of the box, in Å with three decimals, from the ligand's heavy atoms."""
    places = heavy_places(ligand)
    centre = places.mean(axis=0)
    extent = float((places.max(axis=0) - places.min(axis=0)).max())
    return [round(float(x), 3) for x in centre], round(max(SIDE, extent + 2 * MARGIN), 3)


def heavy_places(molecule):
    """Positions of the heavy atoms, an array with a row each."""
    heavy = [atom.GetIdx() for atom in molecule.GetAtoms() if atom.GetAtomicNum() > 1]
    return molecule.GetConformer().GetPositions()[heavy]


def prepare_ligand(molecule):
    """Meeko's setup of a ligand whose rings stay as they are."""
    from meeko import MoleculePreparation

    return MoleculePreparation(rigid_macrocycles=True).prepare(molecule)[0]


def randomised(ligand, seed, centre):
    """The ligand with other torsions, orientation and place: within 2 Å of the box's centre along each axis."""
    import numpy
    from rdkit import Chem
    from rdkit.Chem import rdMolTransforms
    from rdkit.Geometry import Point3D

    draw = numpy.random.default_rng(seed)
    molecule = Chem.Mol(ligand)
    conformer = molecule.GetConformer()
    for first, second in turning_bonds(molecule):
        before = next(n.GetIdx() for n in molecule.GetAtomWithIdx(first).GetNeighbors() if n.GetIdx() != second)
        after = next(n.GetIdx() for n in molecule.GetAtomWithIdx(second).GetNeighbors() if n.GetIdx() != first)
        rdMolTransforms.SetDihedralDeg(conformer, before, first, second, after, float(draw.uniform(-180, 180)))
    quaternion = draw.normal(size=4)
    w, x, y, z = quaternion / numpy.linalg.norm(quaternion)
    turn = numpy.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    middle = heavy_places(molecule).mean(axis=0)
    places = (conformer.GetPositions() - middle) @ turn.T + numpy.array(centre) + draw.uniform(-2, 2, size=3)
    for index, place in enumerate(places):
        conformer.SetAtomPosition(index, Point3D(*map(float, place)))
    return molecule


def turning_bonds(molecule):
    """The bonds that Meeko lets Vina turn, as pairs of atoms, each lower index first."""
    setup = prepare_ligand(molecule)
    return sorted(tuple(sorted(pair)) for pair, bond in setup.bond_info.items() if bond.rotatable)


def rmsds(pose, crystal):
    """Heavy-atom RMSD over the ligand's symmetries, without and with superposition."""
    from rdkit import Chem
    from rdkit.Chem import rdMolAlign

    pose, crystal = Chem.RemoveHs(pose), Chem.RemoveHs(crystal)
    plain = rdMolAlign.CalcRMS(Chem.Mol(pose), crystal)
    rotated = rdMolAlign.GetBestRMS(Chem.Mol(pose), crystal)
    return plain, rotated


def cpu_seconds():
    """User and system time of this process."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def dock(entry, receptor, crystal, seed):
    """One run of Vina: rows of the CSV."""
    from meeko import PDBQTMolecule, PDBQTWriterLegacy, RDKitMolCreate
    from vina import Vina

    centre, side = box(crystal)
    ligand, fine, why = PDBQTWriterLegacy.write_string(prepare_ligand(randomised(crystal, seed, centre)))
    if not fine:
        raise RuntimeError(f"{entry.name}: Meeko cannot write the ligand: {why}")
    with tempfile.NamedTemporaryFile("w", suffix=".pdbqt") as file:
        file.write(receptor)
        file.flush()
        search = Vina(sf_name="vina", cpu=1, seed=seed, verbosity=0)
        search.set_receptor(file.name)
        search.set_ligand_from_string(ligand)
    before = cpu_seconds()
    search.compute_vina_maps(center=centre, box_size=[side] * 3, spacing=SPACING)
    search.dock(exhaustiveness=EXHAUSTIVENESS, n_poses=POSES, min_rmsd=1.0)
    cpu = cpu_seconds() - before
    energies = search.energies(n_poses=POSES, energy_range=1000.0)
    found = PDBQTMolecule(search.poses(n_poses=POSES, energy_range=1000.0), skip_typing=True)
    poses = RDKitMolCreate.from_pdbqt_mol(found)[0]
    rows = []
    for index, conformer in enumerate(poses.GetConformers()):
        pose = one_conformer(poses, conformer)
        plain, rotated = rmsds(pose, crystal)
        energy = float(energies[index][0])
        rows.append([entry.name, seed, index + 1, f"{energy:.3f}", f"{plain:.3f}", f"{rotated:.3f}", f"{cpu:.2f}"])
    return rows


def one_conformer(molecule, conformer):
    """The molecule with one conformer alone."""
    from rdkit import Chem

    alone = Chem.Mol(molecule)
    alone.RemoveAllConformers()
    alone.AddConformer(Chem.Conformer(conformer), assignId=True)
    return alone


def prepare(entries, crystal_folder):
    """Writes the boxes, and the crystal ligands as SDF."""
    from rdkit import Chem

    rows = []
    for entry in entries:
        ligand = crystal_ligand(entry)
        centre, side = box(ligand)
        rows.append([entry.name, *centre, side])
        bonds = len(turning_bonds(ligand))
        print(f"{entry.name}: {len(heavy_places(ligand))} heavy atoms, {bonds} torsions, {Chem.MolToSmiles(Chem.RemoveHs(ligand))}")
        if crystal_folder:
            crystal_folder.mkdir(parents=True, exist_ok=True)
            with Chem.SDWriter(str(crystal_folder / f"{entry.name}.sdf")) as file:
                file.write(ligand)
    with BOXES.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["complex", "center_x", "center_y", "center_z", "side"])
        writer.writerows(rows)


def dock_all(entries, seeds, path):
    """Docks what is not yet in the CSV, seed by seed, so that an interrupted series has all complexes."""
    done = {(row["complex"], int(row["seed"])) for row in read_rows(path)} if path.exists() else set()
    if not path.exists():
        path.write_text(",".join(COLUMNS) + "\n")
    prepared = {}
    for seed in seeds:
        for entry in entries:
            if (entry.name, seed) in done:
                continue
            if entry.name not in prepared:
                prepared[entry.name] = receptor_pdbqt(entry), crystal_ligand(entry)
            text = io.StringIO()
            csv.writer(text, lineterminator="\n").writerows(dock(entry, *prepared[entry.name], seed))
            # All rows of a run at once: a run that is in the file is there whole.
            with path.open("a") as file:
                file.write(text.getvalue())


def read_rows(path):
    """The rows of a CSV, as dictionaries."""
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@dataclass
class Summary:
    """What the runs of one complex say."""

    runs: int
    # Medians over seeds, in Å.
    first: float
    best: float
    first_rotated: float
    # Shares of seeds with at most 2 Å.
    first_share: float
    best_share: float
    # Median, in seconds.
    cpu: float


def summaries(path):
    """The summary of each complex of a CSV, with the columns above, of Vina or of ours."""
    runs = {}
    for row in read_rows(path):
        runs.setdefault((row["complex"], row["seed"]), []).append(row)
    of = {}
    for (name, _), rows in runs.items():
        rows.sort(key=lambda row: int(row["pose"]))
        rmsd = [float(row["rmsd"]) for row in rows]
        of.setdefault(name, []).append((rmsd[0], min(rmsd), float(rows[0]["rmsd_rotated"]), float(rows[0]["cpu_s"])))
    result = {}
    for name, values in of.items():
        first, best, rotated, cpu = zip(*values, strict=True)
        result[name] = Summary(
            runs=len(values),
            first=statistics.median(first),
            best=statistics.median(best),
            first_rotated=statistics.median(rotated),
            first_share=sum(x <= SUCCESS for x in first) / len(values),
            best_share=sum(x <= SUCCESS for x in best) / len(values),
            cpu=statistics.median(cpu),
        )
    return result


HEAD = ["seeds", "first pose, Å", "best pose, Å", "first ≤ 2 Å", "best ≤ 2 Å", "first, rotated, Å", "CPU s"]


def cells(summary):
    """The cells of a summary, in the order of HEAD."""
    if summary is None:
        return ["–"] * len(HEAD)
    reached = [f"{round(share * summary.runs)} of {summary.runs}" for share in (summary.first_share, summary.best_share)]
    lengths = [f"{summary.first:.2f}", f"{summary.best:.2f}"]
    return [str(summary.runs), *lengths, *reached, f"{summary.first_rotated:.2f}", f"{summary.cpu:.1f}"]


def print_table(vina, ours=None):
    """One Markdown table: a row per complex, Vina's columns and, if given, ours beside them. RMSDs and times are medians over seeds."""
    sides = [("Vina", summaries(vina))] + ([("roadmill", summaries(ours))] if ours else [])
    head = ["complex"] + [f"{name}: {column}" if ours else column for name, _ in sides for column in HEAD]
    print("| " + " | ".join(head) + " |")
    print("|---" * len(head) + "|")
    known = [entry.name for entry in COMPLEXES]
    names = {name for _, side in sides for name in side}
    for name in sorted(names, key=lambda n: (known.index(n) if n in known else len(known), n)):
        row = [name] + [cell for _, side in sides for cell in cells(side.get(name))]
        print("| " + " | ".join(row) + " |")


def whole_numbers(text):
    """`1-10` or `1,4,7` as numbers."""
    numbers = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        numbers += range(int(first), int(last or first) + 1)
    return numbers


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    make = commands.add_parser("prepare", help=f"write {BOXES.name}, and the crystal ligands as SDF")
    make.add_argument("--crystal", type=pathlib.Path, help="folder of the crystal ligands")
    run = commands.add_parser("dock", help="dock with Vina")
    run.add_argument("--seeds", type=whole_numbers, default=whole_numbers("1-10"))
    run.add_argument("--csv", type=pathlib.Path, required=True)
    for command in (make, run):
        command.add_argument("--complexes", help="names with commas between; all if not given")
    show = commands.add_parser("table", help="print the table")
    show.add_argument("vina", type=pathlib.Path)
    show.add_argument("--ours", type=pathlib.Path)
    arguments = parser.parse_args()
    if arguments.command == "table":
        print_table(arguments.vina, arguments.ours)
        return
    wanted = arguments.complexes.split(",") if arguments.complexes else [entry.name for entry in COMPLEXES]
    unknown = set(wanted) - {entry.name for entry in COMPLEXES}
    if unknown:
        sys.exit(f"no such complex: {', '.join(sorted(unknown))}")
    entries = [entry for entry in COMPLEXES if entry.name in wanted]
    if arguments.command == "prepare":
        prepare(entries, arguments.crystal)
    else:
        dock_all(entries, arguments.seeds, arguments.csv)


if __name__ == "__main__":
    main()
