//! From positions to configurations, and back.

use super::{BIOTIN, Docking, biotin, docking};
use crate::ligand::{self, Ligand};
use crate::model::Description;
use crate::model::docking::kinematics::BASE;
use crate::structure::Point;
use crate::structure::measure::rmsd_in_place;

#[test]
fn positions_of_a_configuration_give_it_back() {
    let docking = docking(&biotin(""));
    let mut q = docking.given();
    q[..BASE].copy_from_slice(&[9.0, 1.0, -10.0, 0.1, -0.7, 0.5, 0.5]);
    for (number, angle) in q[BASE..].iter_mut().enumerate() {
        *angle = 1.0 + number as f64;
    }
    docking.space().canonicalize(&mut q).unwrap();
    let positions = docking.positions_at(&q);
    let (again, _) = docking.shaped(&positions).unwrap();
    assert!(rmsd_in_place(&positions, &docking.positions_at(&again)) < 1e-9, "{again:?}");
    // The given shape alone comes as near as its torsions allow, no nearer.
    let rigid = docking.placed(&positions).unwrap();
    assert!(rigid[BASE..].iter().all(|angle| *angle == 0.0));
    assert!(rmsd_in_place(&positions, &docking.positions_at(&rigid)) > 0.1);
    assert_eq!(docking.placed(&positions[1..]), None);
}

#[test]
fn a_pose_of_another_file_is_the_same_molecule_or_an_error() {
    let docking = docking(BIOTIN);
    let given = docking.ligand().positions().unwrap();
    let in_file = docking.positions_in(docking.ligand()).unwrap();
    assert_eq!(in_file, given);
    let other = ligand::from_smiles("OC(=O)CCCCC1SCC2NC(=O)NC12").unwrap();
    let error = docking.positions_in(&other).unwrap_err();
    assert!(error.contains("no positions found"), "{error}");
    let other = ligand::from_smiles("NC(=[NH2+])c1ccccc1").unwrap();
    let error = docking.positions_in(&other).unwrap_err();
    assert!(
        error.starts_with("9 atoms with 9 bonds found") && error.contains("16 atoms"),
        "{error}"
    );
}

/// Benzamidine with an isopropyl group in meta position.
const ISOPROPYL: &str = "ISO


 12 12  0  0  0  0  0  0  0  0999 V2000
   -1.8530   14.3110   16.6580 C   0  0  0  0  0  0  0  0  0  0  0  0
   -2.1070   15.6530   16.7580 C   0  0  0  0  0  0  0  0  0  0  0  0
   -1.7740   16.3410   17.9320 C   0  0  0  0  0  0  0  0  0  0  0  0
   -1.1750   15.6620   19.0050 C   0  0  0  0  0  0  0  0  0  0  0  0
   -0.9140   14.2950   18.8850 C   0  0  0  0  0  0  0  0  0  0  0  0
   -1.2570   13.6340   17.7080 C   0  0  0  0  0  0  0  0  0  0  0  0
   -2.1930   13.6270   15.4960 C   0  0  0  0  0  0  0  0  0  0  0  0
   -2.7970   14.2350   14.4910 N   0  0  0  0  0  4  0  0  0  0  0  0
   -1.7620   12.3910   15.3090 N   0  0  0  0  0  0  0  0  0  0  0  0
   -2.0605   17.8193   18.0439 C   0  0  0  0  0  0  0  0  0  0  0  0
   -2.3400   18.2413   19.4877 C   0  0  0  0  0  0  0  0  0  0  0  0
   -3.2810   18.2307   17.2180 C   0  0  0  0  0  0  0  0  0  0  0  0
  1  2  2  0
  1  6  1  0
  1  7  1  0
  2  3  1  0
  3  4  2  0
  4  5  1  0
  5  6  2  0
  7  8  2  3
  7  9  1  0
  3 10  1  0
 10 11  1  0
 10 12  1  0
M  END
$$$$
";

/// Both nitrogens of the amidine are alike, and so are both ends of the isopropyl group, mirror images of each other.
fn isopropyl() -> (tempfile::TempDir, Docking) {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("iso.sdf");
    std::fs::write(&path, ISOPROPYL).unwrap();
    let file = format!("ligand = {{ file = {path:?} }}");
    let table =
        BIOTIN.replace("ligand = { file = \"structures/1STP.pdb\", residue = \"BTN\" }", &file);
    assert!(table.contains("iso.sdf"));
    (scratch, docking(&table))
}

/// The ligand with other positions.
fn at(ligand: &Ligand, positions: &[Point]) -> Ligand {
    let mut atoms = ligand.atoms().to_vec();
    for (atom, position) in atoms.iter_mut().zip(positions) {
        atom.position = Some(*position);
    }
    Ligand::new("other", atoms, ligand.bonds().to_vec()).unwrap()
}

/// Torsions of a pose of another file are read right, also where atoms that are alike are numbered the other way around there.
#[test]
fn a_pose_of_another_file_keeps_its_torsions() {
    let (_scratch, docking) = isopropyl();
    assert_eq!(docking.given().len(), BASE + 2);
    for angle in [0.5, 1.6, 2.1, 3.1] {
        let mut q = docking.given();
        q[BASE..].fill(angle);
        let positions = docking.positions_at(&q);
        for pairs in [&[][..], &[(10, 11)], &[(7, 8), (10, 11)]] {
            let mut exchanged = positions.clone();
            pairs.iter().for_each(|(a, b)| exchanged.swap(*a, *b));
            let in_file = docking.positions_in(&at(docking.ligand(), &exchanged)).unwrap();
            let (shaped, misfit) = docking.shaped(&in_file).unwrap();
            let far = rmsd_in_place(&positions, &docking.positions_at(&shaped));
            assert!(misfit < 1e-9 && far < 1e-9, "{angle}, {pairs:?}: {misfit}, {far}");
        }
    }
}

/// Another file may have atoms that are alike the other way around: the given shape is placed where it is.
#[test]
fn atoms_that_are_alike_may_be_numbered_the_other_way_around() {
    let (_scratch, docking) = isopropyl();
    let given = docking.ligand().positions().unwrap();
    let near = |positions: &[Point]| {
        let placed = docking.placed(positions).unwrap();
        rmsd_in_place(&given, &docking.positions_at(&placed))
    };
    assert!(near(&given) < 1e-9);
    for pairs in [&[(7, 8)][..], &[(10, 11)], &[(7, 8), (10, 11)]] {
        let mut positions = given.clone();
        pairs.iter().for_each(|(a, b)| positions.swap(*a, *b));
        assert!(rmsd_in_place(&given, &positions) > 0.5);
        assert!(near(&positions) < 1e-9, "{pairs:?}");
    }
    assert_eq!(docking.placed(&given[1..]), None);
}
