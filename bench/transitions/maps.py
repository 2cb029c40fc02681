"""roadmill's part of the comparison: its program is run, and its runs and paths are read."""

import csv
import json
import re
import resource
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np

from measures import ANGLES
from structures import exists, read_pdb, torsions

# The options of `roadmill paths`.
PATHS = ["--count", "5", "--dissimilar", "--tries", "6", "--shorten-tries", "20", "--format", "pdb,csv"]
PATHS += [word for name, ranges in ANGLES.items() for word in ("--angle", f"{name}={ranges}")]


def run(program, *words):
    """Runs roadmill and returns the CPU seconds that it and its workers took; ends the program if it fails."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [str(word) for word in (program, *words)]
    # A configuration of a protein is some thousand characters.
    print(
        "$ " + " ".join(word if len(word) < 100 else word[:40] + "…" for word in command), file=sys.stderr, flush=True
    )
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        sys.exit(f"{program}: {error.strerror}; the program roadmill expected (--roadmill)")
    # 3: a limit has ended the build, which is what limits are for.
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Map:
    """A run of roadmill and the dissimilar paths that were exported of it."""

    def __init__(self, folder, program, again):
        self.folder, self.program = Path(folder), program
        summary = exists(
            self.folder / "summary.json", "the folder of a run that has ended (roadmill transition, roadmill build)"
        )
        self.summary = json.loads(summary.read_text())
        self.problem = exists(f"{folder}.toml", "the problem file beside the run, as `roadmill transition` writes it")
        self.source = backbone_of(folder)
        self.paths_folder = Path(f"{folder}-paths")
        self.paths_cpu = None
        if not self.paths_folder.exists():
            self.paths_cpu = run(program, "paths", self.folder, *PATHS, "--out", self.paths_folder)
            (self.paths_folder / "cpu.txt").write_text(f"{self.paths_cpu:.2f}\n")
        elif (self.paths_folder / "cpu.txt").exists():
            self.paths_cpu = float((self.paths_folder / "cpu.txt").read_text())
        with open(exists(self.paths_folder / "paths.csv", "what `roadmill paths --out` wrote")) as file:
            self.rows = list(csv.DictReader(file))
        self.paths = []
        for row in self.rows:
            file = exists(self.paths_folder / f"path-{row['path']}.pdb", "paths with --format pdb,csv")
            self.paths.append(read_pdb(file))
        self.same = self.built_again(again)

    def built_again(self, make):
        """Whether a second build of the problem, in one thread, and the paths out of it are the same in every bit; None if there is none.

        It is in the folder of the run's name with `-again` behind it, and is made there if `make` says so.
        """
        other = Path(f"{self.folder}-again")
        if not (other / "summary.json").exists():
            if not make:
                return None
            run(self.program, "build", self.problem, "--out", other, "--threads", 1, *self.limits())
        paths = Path(f"{other}-paths")
        if not paths.exists():
            run(self.program, "paths", other, *PATHS, "--out", paths)
        digest = json.loads((other / "summary.json").read_text())["digest"]
        files = [file.name for file in self.paths_folder.iterdir() if file.name.startswith(("path", "matrix"))]
        same = [(self.paths_folder / name).read_bytes() == (paths / name).read_bytes() for name in sorted(files)]
        return digest == self.summary["digest"] and all(same)

    def limits(self):
        """The limit that ended the build, if one did, so that another build ends there, too."""
        return ["--max-sets", self.summary["sets"]] if self.summary["stop"] != "satisfied" else []

    def roadmap(self):
        """The run's nodes."""
        return Roadmap(self.folder, self.program)

    def off_kinematics(self):
        """How far the CA that `alphas_of` computes are from those that roadmill wrote, at the first path's own configurations, Å."""
        with open(self.paths_folder / "path-1.csv") as file:
            header = next(csv.reader(file))
            configs = np.array([[float(value) for value in line] for line in csv.reader(file)])
        names = [re.sub(r" \[.*", "", name) for name in header]
        with open(self.paths_folder / "path-1.frames.csv") as file:
            own = [row["own"] == "1" for row in csv.DictReader(file)]
        alphas = alphas_of(configs, names, self.source)
        return float(np.abs(alphas - self.paths[0].alphas[own]).max())


class Roadmap:
    """The distinct nodes of a run: a roadmap may have a configuration several times, of which the first counts."""

    def __init__(self, folder, program):
        self.folder, file = folder, Path(f"{folder}-nodes.npz")
        if not file.exists():
            run(program, "export", folder, "--format", "npz", "--out", file)
        with np.load(file) as roadmap:
            configs, energies, self.names = roadmap["nodes"], roadmap["values"][:, 0], list(roadmap["dof_names"])
        self.source = backbone_of(folder)
        self.numbers = np.array(self.source[0])  # of the residues
        self.all = len(configs)
        # Numbers of the nodes in the roadmap; torsions, radians, a row each; energies, model kJ/mol; CA, Å, (nodes, residues, 3).
        self.ids = np.sort(np.unique(configs, axis=0, return_index=True)[1])
        self.configs, self.energies = configs[self.ids], energies[self.ids]
        self.alphas = self.alphas_of(self.configs)

    def alphas_of(self, configs):
        """The CA of some configurations, Å, `(configurations, residues, 3)`."""
        return alphas_of(configs, self.names, self.source)

    def ends(self):
        """The configurations of the problem's start and goal."""
        with open(exists(f"{self.folder}.toml", "the problem file beside the run"), "rb") as file:
            query = tomllib.load(file)["query"]
        return np.array(query["start"]), np.array(query["goal"])


def backbone_of(folder):
    """Numbers, and N, CA and C, `(residues, 3 atoms, 3)`, of the structure beside a run of which its problem's linkage is made."""
    import gemmi

    source = exists(f"{folder}-structures/source.cif", "the structures beside the problem file")
    structure = gemmi.read_structure(str(source))
    residues = [r for r in structure[0][0] if gemmi.find_tabulated_residue(r.name).is_amino_acid()]
    atoms = [[r[name][0].pos.tolist() for name in ("N", "CA", "C")] for r in residues]
    return [r.seqid.num for r in residues], np.array(atoms)


def alphas_of(configs, names, source):
    """The CA of conformations that are given by torsions, `(conformations, residues, 3)`, Å.

    `configs` has a row per conformation and a column, in radians, for each of `names` (`phi_2`, `psi_2`, …). Bonds, angles and what does not
    turn are those of the source. From the N terminus on, each torsion turns all that comes after it about its bond; done
    in the source's own coordinates, and from the last bond to the first, these turns give where everything is.
    """
    numbers, atoms = source
    n, ca, c = atoms[:, 0], atoms[:, 1], atoms[:, 2]
    phi = torsions(c[:-1], n[1:], ca[1:], c[1:])
    psi = torsions(n[:-1], ca[:-1], c[:-1], n[1:])
    column = {name: configs[:, k] for k, name in enumerate(names)}
    turn, shift = np.broadcast_to(np.eye(3), (len(configs), 3, 3)), np.zeros((len(configs), 3))
    alphas = np.empty((len(configs), len(numbers), 3))
    for i, number in enumerate(numbers):
        alphas[:, i] = turn @ ca[i] + shift
        for name, native, base, tip in (
            (f"phi_{number}", phi[i - 1], n[i], ca[i]),
            (f"psi_{number}", psi[i] if i < len(psi) else 0.0, ca[i], c[i]),
        ):
            if name in column:
                rotation = rotations(tip - base, column[name] - native)
                # x → turn (rotation (x − base) + base) + shift
                shift = shift + (turn @ (base - rotation @ base)[:, :, None])[:, :, 0]
                turn = turn @ rotation
    return alphas


def rotations(axis, angles):
    """The rotation matrices about one axis, `(angles, 3, 3)` (Rodrigues)."""
    x, y, z = axis / np.linalg.norm(axis)
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sines, cosines = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.eye(3) + sines * across + (1 - cosines) * (across @ across)
