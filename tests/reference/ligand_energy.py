"""The energy of a ligand at a protein, a second time: plain sums over all pairs, with numbers and formulas of their own.

    python3 tests/reference/ligand_energy.py ENERGIES.json

The file is a list of cases. Each has

    spec      parameters ("autodock4" or "uff"), cutoff (Å), dielectric (the factor D of D r, or null), hydrophobic
    protein   elements, charges (e), hydrophobic (whether each atom is), positions (Å)
    ligand    elements, charges, hydrophobic; own_pairs: pairs of its atoms that act upon each other
    poses     of each pose the positions of the ligand's atoms (Å)
    energies  of each pose what it is compared with: van_der_waals, coulomb, hydrophobic and own (kJ/mol); any may be left out

It ends with 1 if an energy differs by more than 1e-9 of its size, or of 1 kJ/mol where it is smaller than that.

Only numpy is needed. Sources: AD4.1_bound.dat of AutoDock 4 (Rii, epsii; Huey et al. 2007), UFF (x1, D1; Rappé et al.
1992) as in RDKit's Params.cpp, AutoDock Vina 1.2 (radii, weight and ramp of the hydrophobic term; Trott & Olson 2010),
CHARMM's switching function (Brooks et al. 1983).
"""

import json
import sys

import numpy as np

KCAL = 4.184
# Rii in Å, epsii in kcal/mol.
AUTODOCK4 = {
    "H": (2.00, 0.020), "C": (4.00, 0.150), "N": (3.50, 0.160), "O": (3.20, 0.200), "F": (3.09, 0.080),
    "Mg": (1.30, 0.875), "P": (4.20, 0.200), "S": (4.00, 0.200), "Cl": (4.09, 0.276), "Ca": (1.98, 0.550),
    "Mn": (1.30, 0.875), "Fe": (1.30, 0.010), "Zn": (1.48, 0.550), "Br": (4.33, 0.389), "I": (4.72, 0.550),
}
# x1 in Å, D1 in kcal/mol.
UFF = {
    "H": (2.886, 0.044), "B": (4.083, 0.180), "C": (3.851, 0.105), "N": (3.660, 0.069), "O": (3.500, 0.060),
    "F": (3.364, 0.050), "Na": (2.983, 0.030), "Mg": (3.021, 0.111), "Si": (4.295, 0.402), "P": (4.147, 0.305),
    "S": (4.035, 0.274), "Cl": (3.947, 0.227), "K": (3.812, 0.035), "Ca": (3.399, 0.238), "Mn": (2.961, 0.013),
    "Fe": (2.912, 0.013), "Co": (2.872, 0.014), "Ni": (2.834, 0.015), "Cu": (3.495, 0.005), "Zn": (2.763, 0.124),
    "Se": (4.205, 0.291), "Br": (4.189, 0.251), "I": (4.500, 0.339),
}
VINA_RADII = {"C": 1.9, "F": 1.5, "Cl": 1.8, "Br": 2.0, "I": 2.2}
# e²/(4 π ε0) times Avogadro's number, in kJ Å/mol, from the exact charge and number of the SI and CODATA's ε0.
COULOMB = 1389.35458


def pair_parameters(spec, one, other):
    """Distance (Å) and depth (kJ/mol) of the least energy of two elements."""
    if spec["parameters"] == "autodock4":
        one, other = (AUTODOCK4.get(element, UFF.get(element)) for element in (one, other))
        distance = (one[0] + other[0]) / 2
    else:
        one, other = UFF[one], UFF[other]
        distance = (one[0] * other[0]) ** 0.5
    return distance, (one[1] * other[1]) ** 0.5 * KCAL


def switch(spec, r):
    off = spec["cutoff"]
    on = off - 2.0
    between = (off**2 - r**2) ** 2 * (off**2 + 2 * r**2 - 3 * on**2) / (off**2 - on**2) ** 3
    return np.where(r <= on, 1.0, np.where(r >= off, 0.0, between))


def van_der_waals(spec, distance, depth, r):
    r = np.maximum(r, 0.1)
    return depth * ((distance / r) ** 12 - 2 * (distance / r) ** 6) * switch(spec, r)


def repulsion(distance, depth, r):
    """12-6 terms up to their minimum, raised to zero there (Weeks, Chandler and Andersen 1971)."""
    r = max(r, 0.1)
    return 0.0 if r >= distance else depth * ((distance / r) ** 12 - 2 * (distance / r) ** 6 + 1)


def coulomb(spec, charges, r):
    if spec["dielectric"] is None:
        return 0.0 * r
    r = np.maximum(r, 0.1)
    return COULOMB * charges / (spec["dielectric"] * r * r) * switch(spec, r)


def hydrophobic(spec, radii, r):
    surface = np.maximum(r, 0.1) - radii
    return -0.035069 * KCAL * np.clip(1.5 - surface, 0.0, 1.0)


class Case:
    def __init__(self, case):
        self.spec, self.protein, self.ligand = case["spec"], case["protein"], case["ligand"]
        self.at = np.array(self.protein["positions"])
        self.charges = np.array(self.protein["charges"])
        self.is_hydrophobic = np.array(self.protein["hydrophobic"])
        self.radii = np.array([VINA_RADII.get(element, 0.0) for element in self.protein["elements"]])
        self.pairs = {}
        for element in set(self.ligand["elements"]):
            pairs = [pair_parameters(self.spec, element, other) for other in self.protein["elements"]]
            self.pairs[element] = np.array(pairs).T

    def energies(self, pose):
        parts = {"van_der_waals": 0.0, "coulomb": 0.0, "hydrophobic": 0.0, "own": 0.0}
        ligand = self.ligand
        atoms = zip(pose, ligand["elements"], ligand["charges"], ligand["hydrophobic"], strict=True)
        for at, element, charge, is_hydrophobic in atoms:
            r = np.sqrt(((self.at - at) ** 2).sum(axis=1))
            distance, depth = self.pairs[element]
            parts["van_der_waals"] += van_der_waals(self.spec, distance, depth, r).sum()
            parts["coulomb"] += coulomb(self.spec, charge * self.charges, r).sum()
            if self.spec["hydrophobic"] and is_hydrophobic:
                terms = hydrophobic(self.spec, self.radii + VINA_RADII[element], r)
                parts["hydrophobic"] += terms[self.is_hydrophobic].sum()
        for one, other in ligand.get("own_pairs", []):
            r = np.linalg.norm(pose[one] - pose[other])
            distance, depth = pair_parameters(self.spec, ligand["elements"][one], ligand["elements"][other])
            if self.spec["own"] == "repulsion":
                parts["own"] += repulsion(distance, depth, r)
                continue
            charges = ligand["charges"][one] * ligand["charges"][other]
            parts["own"] += van_der_waals(self.spec, distance, depth, r) + coulomb(self.spec, charges, r)
        return parts


def main():
    worst, compared, numbers = 0.0, 0, 0
    with open(sys.argv[1], encoding="utf-8") as file:
        cases = json.load(file)
    for number, case in enumerate(cases):
        energies = Case(case)
        for index, (pose, given) in enumerate(zip(case["poses"], case["energies"], strict=True)):
            expected = energies.energies(np.array(pose))
            for part, value in given.items():
                error = abs(value - expected[part]) / max(abs(expected[part]), 1.0)
                # Written so that no number fails it.
                if not error <= 1e-9:
                    print(f"case {number}, pose {index}: {part} {value!r} found; {expected[part]!r} expected")
                    return 1
                worst, numbers = max(worst, error), numbers + 1
            compared += 1
    print(f"{compared} poses agree in {numbers} energies: the largest difference is {worst:.1e} of its size")
    return 0


if __name__ == "__main__":
    sys.exit(main())
