//! What is read, counted and refused.

mod files;
mod formats;
mod fuzz;
mod pdb;
mod refusals;
mod rules;

use super::{Ligand, LigandError, LinkRule, read_bytes};
use std::path::PathBuf;

/// The folder of `ROADMILL_DATA`, or `None`, said aloud. Where `ROADMILL_REQUIRE_DATA` is 1 it must be there.
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("ROADMILL_DATA").map(PathBuf::from);
    let is_whole =
        |folder: &PathBuf| ["structures", "ligands"].iter().all(|part| folder.join(part).is_dir());
    if let Some(folder) = folder.filter(is_whole) {
        return Some(folder);
    }
    let required = std::env::var_os("ROADMILL_REQUIRE_DATA").is_some_and(|value| value == "1");
    let message = "ROADMILL_DATA names no folder with `structures` and `ligands` in it";
    assert!(!required, "{message}");
    println!("skipped: {message}");
    None
}

/// The one molecule of a text.
fn one(text: &str) -> Ligand {
    let mut ligands = read_bytes(text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(ligands.len(), 1);
    ligands.remove(0)
}

/// What is wrong with a text.
fn error(text: &str) -> LigandError {
    read_bytes(text.as_bytes()).unwrap_err()
}

/// How many links there are with amides among them, and without.
fn links(ligand: &Ligand) -> (usize, usize) {
    let count = |amides| ligand.torsion_links(LinkRule { amides }).len();
    (count(true), count(false))
}

/// The symbols of its atoms' elements.
fn symbols(ligand: &Ligand) -> Vec<&'static str> {
    ligand.atoms().iter().map(|atom| atom.element.symbol()).collect()
}

/// The atoms of every bond, the lower one first, in rising order.
fn sorted_bonds(ligand: &Ligand) -> Vec<[usize; 2]> {
    let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
    let mut bonds: Vec<_> = ligand.bonds().iter().map(|bond| sorted(bond.atoms)).collect();
    bonds.sort_unstable();
    bonds
}

/// Ethanol without hydrogens in V2000, with a charge and data behind it.
const ETHANOL: &str = "ethanol
  program 01010120003D

  3  2  0  0  0  0  0  0  0  0999 V2000
    0.0000    0.0000    0.0000 C   0  0
    1.5200    0.0000    0.0000 C   0  0
    2.0000    1.3500    0.0000 O   0  5
  1  2  1  0
  2  3  1  0
M  END
> <note>
$$ no end

$$$$
";

/// The same in V3000, with a line that goes on in the next, and numbers of atoms that have gaps.
const ETHANOL_V3000: &str = "ethanol
  program 01010120003D

  0  0  0     0  0            999 V3000
M  V30 BEGIN CTAB
M  V30 COUNTS 3 2 0 0 0
M  V30 BEGIN ATOM
M  V30 10 C 0.0 0.0 0.0 0
M  V30 20 C 1.52 0.0 -
M  V30 0.0 0
M  V30 30 O 2.0 1.35 0.0 0 CHG=-1
M  V30 END ATOM
M  V30 BEGIN BOND
M  V30 1 1 10 20
M  V30 2 1 20 30
M  V30 END BOND
M  V30 BEGIN SGROUP
M  V30 1 SUP 0 ATOMS=(1 30) LABEL=\"\u{3000}é\"
M  V30 END SGROUP
M  V30 END CTAB
M  END
$$$$
";

/// Acetamide in MOL2, with comments, a name with a blank, and a bond that is none.
const ACETAMIDE: &str = "# made by hand
@<TRIPOS>MOLECULE
acet amide
 4 4 0
SMALL
USER_CHARGES

@<TRIPOS>ATOM
 1 C1 -1.5000 0.0000 0.0000 C.3 1 ACM -0.3660
 2 C2  0.0000 0.0000 0.0000 C.2 1 ACM  0.6160
# the oxygen
 3 O1  0.6200 1.0600 0.0000 O.2 1 ACM -0.5040
 4 N1  0.6700 -1.1600 0.0000 N.am 1 ACM -0.7
@<TRIPOS>BOND
 1 1 2 1
 2 2 3 2
 3 2 4 am
 4 3 4 nc
@<TRIPOS>SUBSTRUCTURE
 1 ACM 1
";

/// Diethyl ether, one of its ends in a branch, in PDBQT.
const ETHER: &str = "REMARK  Name = ether
ROOT
HETATM    1  O1  UNL A   1       0.000   0.000   0.000  1.00  0.00    -0.380 OA
HETATM    2  C1  UNL A   1       1.430   0.000   0.000  1.00  0.00     0.100 C
HETATM    3  C2  UNL A   1       1.930   1.440   0.000  1.00  0.00    +0.040 C
ENDROOT
BRANCH   1   4
HETATM    4  C3  UNL A   1      -0.480  -1.340   0.000  1.00  0.00     0.100 C
HETATM    5  C4  UNL A   1      -2.000  -1.340   0.000  1.00  0.00     0.040 C
ENDBRANCH   1   4
TORSDOF 2
";

/// Acetone with a water and an ion, CONECT records with the double bond twice, and alternative locations.
const ACETONE: &str = "\
HETATM    1  C1  ACN A   1      -1.290  -0.740   0.000  1.00  0.00           C
HETATM    2  C2  ACN A   1       0.000   0.050   0.000  1.00  0.00           C
HETATM    3  C3 AACN A   1       1.290  -0.740   0.000  0.40  0.00           C
HETATM    4  C3 BACN A   1       1.290  -0.740   0.100  0.60  0.00           C
HETATM    5  O1  ACN A   1       0.000   1.270   0.000  1.00  0.00           O1-
HETATM    6  O   HOH A   2       9.000   9.000   9.000  1.00  0.00           O
HETATM    7 CA    CA A   3       8.000   8.000   8.000  1.00  0.00          CA
CONECT    1    2
CONECT    2    1    4    5    5
CONECT    4    2
CONECT    5    2    2    7
END
";
