//! What of a structure file is the protein, and what is the ligand.

use super::docking_of;
use crate::model::docking::Docking;
use crate::problem::Problem;

/// A dipeptide with a zinc ion, a water, a sulphate, a haem's iron and a cap, and a ligand beside it, benzene.
const FILE: &str = "\
ATOM      1  C   ACE A   0       0.000   0.000   0.000  1.00  0.00           C
ATOM      2  O   ACE A   0       0.000   1.230   0.000  1.00  0.00           O
ATOM      3  N   GLY A   1       1.330   0.000   0.000  1.00  0.00           N
ATOM      4  H   GLY A   1       1.830   0.870   0.000  1.00  0.00           H
ATOM      5  CA  GLY A   1       2.000  -1.300   0.000  1.00  0.00           C
ATOM      6  C   GLY A   1       3.500  -1.200   0.000  1.00  0.00           C
ATOM      7  O   GLY A   1       4.100  -0.100   0.000  1.00  0.00           O
ATOM      8  N   SER B   7      11.330   0.000   0.000  1.00  0.00           N
ATOM      9  CA  SER B   7      12.000  -1.300   0.000  1.00  0.00           C
ATOM     10  C   SER B   7      13.500  -1.200   0.000  1.00  0.00           C
ATOM     11  O   SER B   7      14.100  -0.100   0.000  1.00  0.00           O
HETATM   12 ZN    ZN A 101       5.000   5.000   5.000  1.00  0.00          ZN
HETATM   13 CL    CL A 102       5.000   9.000   5.000  1.00  0.00          CL
HETATM   14  O   HOH A 103       9.000   5.000   5.000  1.00  0.00           O
HETATM   15  S   SO4 A 104      20.000   5.000   5.000  1.00  0.00           S
HETATM   16  O1  SO4 A 104      21.450   5.000   5.000  1.00  0.00           O
HETATM   17  C1  BNZ A 105       1.390   0.000   6.000  1.00  0.00           C
HETATM   18  C2  BNZ A 105       0.695   1.204   6.000  1.00  0.00           C
HETATM   19  C3  BNZ A 105      -0.695   1.204   6.000  1.00  0.00           C
HETATM   20  C4  BNZ A 105      -1.390   0.000   6.000  1.00  0.00           C
HETATM   21  C5  BNZ A 105      -0.695  -1.204   6.000  1.00  0.00           C
HETATM   22  C6  BNZ A 105       0.695  -1.204   6.000  1.00  0.00           C
END
";

fn parse(protein: &str, more: &str) -> Result<Problem, String> {
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("x.pdb"), FILE).unwrap();
    let text = format!(
        "[docking]\nprotein = {{ file = \"x.pdb\"{protein} }}\nligand = {{ file = \"x.pdb\", residue = \"BNZ\" }}\n{more}"
    );
    let problem = Problem::parse(&scratch.path().join("p.toml"), &text);
    problem.map_err(|error| error.to_string())
}

fn docking(protein: &str, more: &str) -> Docking {
    docking_of(&parse(protein, more).unwrap_or_else(|error| panic!("{error}")))
}

fn names(docking: &Docking) -> String {
    let residues = docking.chains().iter().flat_map(|chain| &chain.residues);
    residues.map(|residue| residue.name.as_str()).collect::<Vec<_>>().join(" ")
}

#[test]
fn metals_and_caps_stay_and_others_do_not() {
    assert_eq!(names(&docking("", "")), "GLY ACE ZN SER");
    assert_eq!(names(&docking(", metals = \"remove\"", "")), "GLY ACE SER");
    assert_eq!(names(&docking(", waters = \"keep\"", "")), "GLY ACE ZN HOH SER");
    assert_eq!(names(&docking(", others = \"keep\"", "")), "GLY ACE ZN CL SO4 SER");
    assert_eq!(names(&docking(", keep = [\"SO4\"]", "")), "GLY ACE ZN SO4 SER");
    assert_eq!(names(&docking(", chains = [\"B\"]", "")), "SER");
    // The group that is the ligand is never a part of the protein.
    assert_eq!(names(&docking(", keep = [\"BNZ\"]", "")), "GLY ACE ZN SER");
}

#[test]
fn hydrogens_stay_if_they_are_to() {
    let atoms = |of: &Docking| {
        of.chains().iter().flat_map(|chain| &chain.residues).map(|of| of.atoms.len()).sum::<usize>()
    };
    assert_eq!(atoms(&docking("", "")), 11);
    assert_eq!(atoms(&docking("", "hydrogens = \"keep\"\n")), 12);
}

#[test]
fn what_was_left_out_is_said() {
    let notes = parse("", "").unwrap().notes().join("\n");
    assert!(notes.contains("left out 1 CL, 1 HOH, 1 SO4"), "{notes}");
    assert!(notes.contains("bonds are perceived from distances"), "{notes}");
    assert!(notes.contains("1 hydrogens"), "{notes}");
}

#[test]
fn a_ligand_far_away_is_said_to_be() {
    let far = FILE.replace("   6.000  1.00", "  90.000  1.00");
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(scratch.path().join("x.pdb"), far).unwrap();
    let text = "[docking]\nprotein = { file = \"x.pdb\" }\nligand = { file = \"x.pdb\", residue = \"BNZ\" }\n";
    let problem = Problem::parse(&scratch.path().join("p.toml"), text).unwrap();
    let notes = problem.notes().join("\n");
    assert!(notes.contains("only its shape is used"), "{notes}");
    assert!(problem.context().model().native().is_none());
}
