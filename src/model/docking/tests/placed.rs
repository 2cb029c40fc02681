//! From positions to configurations, and back.

use super::{BIOTIN, biotin, docking};
use crate::ligand::{self, Ligand};
use crate::model::Description;
use crate::model::docking::kinematics::BASE;
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
    let again = docking.shaped(&positions).unwrap();
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

/// Both oxygens of biotin's carboxylate are alike, and another file may have them the other way around: the pose is the same.
#[test]
fn atoms_that_are_alike_may_be_numbered_the_other_way_around() {
    let docking = docking(BIOTIN);
    let ligand = docking.ligand();
    let given = ligand.positions().unwrap();
    let mut atoms = ligand.atoms().to_vec();
    let oxygens = [1, 2].map(|atom| (atoms[atom].name.clone(), atoms[atom].position));
    assert_eq!([&*oxygens[0].0, &*oxygens[1].0], ["O11", "O12"]);
    (atoms[1].position, atoms[2].position) = (oxygens[1].1, oxygens[0].1);
    let bonds = ligand.bonds().to_vec();
    let other = Ligand::new("other", atoms, bonds).unwrap();
    assert_ne!(other.positions().unwrap(), given);
    assert_eq!(docking.positions_in(&other).unwrap(), given);
}
