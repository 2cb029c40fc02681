"""Conformations out of files: crystals, paths that roadmill wrote, and the trajectory that comes with MDAnalysis."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass
class Backbone:
    """A chain in one or more conformations."""

    numbers: np.ndarray  # of the residues, `(residues,)`
    names: list  # of the residues: MET, ARG, …
    alphas: np.ndarray  # CA, Å, `(frames, residues, 3)`
    atoms: np.ndarray | None  # N, CA and C, Å, `(frames, residues, 3 atoms, 3)`; None where there is no backbone

    def positive_phi(self):
        """Residues other than glycine with phi > 0, for each frame."""
        n, ca, c = (self.atoms[:, :, k] for k in range(3))
        phi = torsions(c[:, :-1], n[:, 1:], ca[:, 1:], c[:, 1:])
        other = np.array([name != "GLY" for name in self.names[1:]])
        return ((phi > 0) & other).sum(axis=1)


def torsions(a, b, c, d):
    """The torsions of four points each, radians, positive as IUPAC has it; arrays `(…, 3)`."""
    first, middle, last = b - a, c - b, d - c
    n1, n2 = np.cross(first, middle), np.cross(middle, last)
    sine = (np.cross(n1, n2) * middle).sum(axis=-1) / np.linalg.norm(middle, axis=-1)
    return np.arctan2(sine, (n1 * n2).sum(axis=-1))


def read_pdb(path):
    """The first chain of amino acids of every model of a PDB file, by N, CA and C; other conformations than the first are passed over."""
    models, at, names = [], {}, {}
    with open(path) as file:
        for line in file:
            if line.startswith("ENDMDL"):
                models.append(at)
                at = {}
            if not line.startswith("ATOM") or line[12:16].strip() not in ("N", "CA", "C") or line[16] not in " A1":
                continue
            number = int(line[22:26])
            residue = at.setdefault((line[21], number), {})
            residue[line[12:16].strip()] = [float(line[k : k + 8]) for k in (30, 38, 46)]
            names[line[21], number] = line[17:20]
    models += [at] if at else []
    if not models:
        sys.exit(f"{path}: no atom N, CA or C found; a PDB file of a protein expected")
    chain = next(iter(models[0]))[0]
    keys = [key for key, residue in models[0].items() if key[0] == chain and len(residue) == 3]
    atoms = np.array([[[model[key][name] for name in ("N", "CA", "C")] for key in keys] for model in models])
    return Backbone(np.array([key[1] for key in keys]), [names[key] for key in keys], atoms[:, :, 1], atoms)


def read_dims():
    """The transition of adenylate kinase that MDAnalysis is tested with, by dynamic importance sampling (98 frames, all atoms)."""
    import warnings

    import MDAnalysis
    from MDAnalysisTests.datafiles import DCD, PSF

    # Readers of DCD files will change in a way that does not matter here.
    warnings.filterwarnings("ignore", category=DeprecationWarning, module="MDAnalysis")
    universe = MDAnalysis.Universe(PSF, DCD)
    of = [universe.select_atoms(f"name {name}") for name in ("N", "CA", "C")]
    atoms = np.array([[group.positions for group in of] for _ in universe.trajectory], float).transpose(0, 2, 1, 3)
    # CHARMM names histidines by their protons.
    names = ["HIS" if name in ("HSD", "HSE", "HSP") else name for name in of[1].resnames]
    return Backbone(of[1].resids, names, atoms[:, :, 1], atoms)


def same_residues(backbone, crystal, what):
    """Ends the program unless both are the same residues under the same numbers."""
    if list(backbone.numbers) == list(crystal.numbers) and list(backbone.names) == list(crystal.names):
        return
    differ = [
        f"{a} {m} and {b} {n}"
        for a, m, b, n in zip(backbone.names, backbone.numbers, crystal.names, crystal.numbers)
        if (a, m) != (b, n)
    ]
    counts = f"{len(backbone.names)} and {len(crystal.names)} residues"
    sys.exit(f"{what}: {', '.join(differ[:3]) or counts} found; the residues of the crystals expected")


def exists(path, what):
    """The path, if there is something; otherwise the program ends and says what was expected there."""
    if not Path(path).exists():
        sys.exit(f"{path}: not there; {what} expected")
    return Path(path)
