//! Which charges atoms have, and which are hydrophobic.

use super::super::{Particle, ligand_particles, protein_particles};
use crate::ligand::{Atom as LigandAtom, Bond, BondOrder, Element, Ligand, read_bytes};
use crate::structure::{AminoAcid, Atom, Point, Residue, ResidueNumber};

/// A residue of atoms given by names, elements and coordinates in Å.
fn residue(name: &str, is_amino_acid: bool, atoms: &[(&str, &str, [f64; 3])]) -> Residue {
    Residue {
        number: ResidueNumber { number: 1, insertion: None },
        name: name.to_owned(),
        amino_acid: is_amino_acid.then(|| AminoAcid::of_code(name).unwrap_or(AminoAcid::Alanine)),
        atoms: atoms
            .iter()
            .map(|(name, element, at)| Atom {
                name: (*name).to_owned(),
                element: (*element).to_owned(),
                position: Point::from(*at),
            })
            .collect(),
    }
}

/// A residue whose atoms are far from one another, so that none is bonded.
fn scattered(name: &str, atoms: &[&str]) -> Residue {
    let atoms: Vec<(&str, &str, [f64; 3])> = atoms
        .iter()
        .enumerate()
        .map(|(number, atom)| (*atom, &atom[..1], [10.0 * number as f64, 0.0, 0.0]))
        .collect();
    residue(name, true, &atoms)
}

fn charges(chain: Vec<Residue>) -> Vec<f64> {
    protein_particles(&[chain]).unwrap().iter().map(|particle| particle.charge).collect()
}

#[test]
fn ionised_groups_share_their_charges() {
    for (name, atoms, expected) in [
        ("ASP", &["CA", "OD1", "OD2"][..], &[0.0, -0.5, -0.5][..]),
        ("GLU", &["CA", "OE1", "OE2"], &[0.0, -0.5, -0.5]),
        ("GLU", &["CA", "OE1"], &[0.0, -1.0]),
        ("LYS", &["CA", "NZ"], &[0.0, 1.0]),
        ("ARG", &["NE", "NH1", "NH2"], &[0.0, 0.5, 0.5]),
        ("HIS", &["ND1", "NE2"], &[0.0, 0.0]),
        ("HIP", &["ND1", "NE2"], &[0.5, 0.5]),
        ("ASH", &["OD1", "OD2"], &[0.0, 0.0]),
        // The ends: a first nitrogen, and a last residue with both oxygens.
        ("ALA", &["N", "CA", "C", "O"], &[1.0, 0.0, 0.0, 0.0]),
        ("ALA", &["CA", "C", "O", "OXT"], &[0.0, 0.0, -0.5, -0.5]),
        ("LYS", &["N", "NZ", "O", "OXT"], &[1.0, 1.0, -0.5, -0.5]),
    ] {
        assert_eq!(charges(vec![scattered(name, atoms)]), expected, "{name}");
    }
    // The second residue's nitrogen is none of an end, and every chain has its own.
    let ala = || scattered("ALA", &["N", "CA"]);
    assert_eq!(charges(vec![ala(), ala()]), [1.0, 0.0, 0.0, 0.0]);
    let two = protein_particles(&[vec![ala()], vec![ala()]]).unwrap();
    assert_eq!(two.iter().map(|particle| particle.charge).sum::<f64>(), 2.0);
}

#[test]
fn a_capped_nitrogen_is_neutral_and_ions_have_their_charges() {
    let first = residue(
        "ALA",
        true,
        &[("N", "N", [0.0; 3]), ("CA", "C", [1.46, 0.0, 0.0]), ("CB", "C", [2.0, 1.4, 0.0])],
    );
    assert_eq!(charges(vec![first.clone()]), [1.0, 0.0, 0.0]);
    let cap = residue("ACE", false, &[("C", "C", [-0.7, 1.1, 0.0]), ("O", "O", [-1.9, 1.2, 0.0])]);
    assert_eq!(charges(vec![cap, first.clone()]), [0.0; 5]);
    let ions = [
        ("ZN", "Zn", 2.0),
        ("NA", "Na", 1.0),
        ("CL", "Cl", -1.0),
        ("HOH", "O", 0.0),
        ("LA", "La", 3.0),
    ];
    for (name, element, expected) in ions {
        assert_eq!(charges(vec![residue(name, false, &[(name, element, [0.0; 3])])]), [expected]);
    }
    // A metal in a larger group is no ion by itself.
    let haem = residue("HEM", false, &[("FE", "Fe", [0.0; 3]), ("NA", "N", [2.0, 0.0, 0.0])]);
    assert_eq!(charges(vec![haem]), [0.0, 0.0]);
    let error = protein_particles(&[vec![residue("CF", false, &[("CF", "Cf", [0.0; 3])])]]);
    assert_eq!(
        error.unwrap_err().to_string(),
        "CF 1: atom CF of element \"Cf\" found; elements from hydrogen to curium expected"
    );
}

#[test]
fn carbons_without_other_neighbours_are_hydrophobic() {
    let leucine = residue(
        "SER",
        true,
        &[
            ("N", "N", [0.0; 3]),
            ("CA", "C", [1.46, 0.0, 0.0]),
            ("C", "C", [2.0, 1.4, 0.0]),
            ("O", "O", [3.2, 1.4, 0.0]),
            ("CB", "C", [2.0, -0.8, 1.2]),
            ("CG", "C", [3.5, -0.8, 1.2]),
            ("CD", "C", [4.3, -0.8, 2.5]),
            ("OG", "O", [5.7, -0.8, 2.5]),
            ("HG", "H", [6.1, -0.8, 3.3]),
        ],
    );
    let of = |residue: Residue| -> Vec<bool> {
        let particles = protein_particles(&[vec![residue]]).unwrap();
        particles.iter().map(|particle| particle.is_hydrophobic).collect()
    };
    let expected = [false, false, false, false, true, true, false, false, false];
    assert_eq!(of(leucine.clone()), expected);
    // A backbone's carbons are bonded to nitrogens that may have gone unseen.
    let mut seen_in_part = leucine;
    seen_in_part.atoms.drain(0..1);
    assert_eq!(of(seen_in_part)[..3], [false, false, false]);
}

/// A molecule of elements with formal charges and bonds (1, 2 or 0: unknown), on a line, as only bonds count.
fn molecule(atoms: &[(&str, i8)], bonds: &[(usize, usize, u8)]) -> Vec<Particle> {
    let atoms = atoms.iter().enumerate().map(|(number, (symbol, charge))| LigandAtom {
        name: String::new(),
        element: Element::of_symbol(symbol).unwrap(),
        position: Some(Point::new(2.0 * number as f64, 0.0, 0.0)),
        formal_charge: Some(*charge),
        partial_charge: None,
    });
    let bonds = bonds.iter().map(|(one, other, order)| Bond {
        atoms: [*one, *other],
        order: match order {
            1 => BondOrder::Single,
            2 => BondOrder::Double,
            _ => BondOrder::Unknown,
        },
    });
    let ligand = Ligand::new("", atoms.collect(), bonds.collect()).unwrap();
    ligand_particles(&ligand, false)
}

fn found(particles: &[Particle]) -> Vec<f64> {
    particles.iter().map(|particle| particle.charge).collect()
}

#[test]
fn resonant_groups_of_ligands_are_symmetric() {
    let third = 1.0 / 3.0;
    for (what, atoms, bonds, expected) in [
        (
            "carboxylate",
            &[("C", 0), ("C", 0), ("O", 0), ("O", -1)][..],
            &[(0, 1, 1), (1, 2, 2), (1, 3, 1)][..],
            &[0.0, 0.0, -0.5, -0.5][..],
        ),
        (
            "carboxylate of unknown orders",
            &[("C", 0), ("C", 0), ("O", 0), ("O", -1)],
            &[(0, 1, 0), (1, 2, 0), (1, 3, 0)],
            &[0.0, 0.0, -0.5, -0.5],
        ),
        (
            "amidinium",
            &[("C", 0), ("C", 0), ("N", 0), ("N", 1)],
            &[(0, 1, 1), (1, 2, 1), (1, 3, 2)],
            &[0.0, 0.0, 0.5, 0.5],
        ),
        (
            "guanidinium",
            &[("C", 0), ("N", 0), ("C", 0), ("N", 1), ("N", 0)],
            &[(0, 1, 1), (1, 2, 1), (2, 3, 2), (2, 4, 1)],
            &[0.0, 0.0, 0.0, 0.5, 0.5],
        ),
        (
            "phosphate",
            &[("C", 0), ("O", 0), ("P", 0), ("O", 0), ("O", -1), ("O", -1)],
            &[(0, 1, 1), (1, 2, 1), (2, 3, 2), (2, 4, 1), (2, 5, 1)],
            &[0.0, 0.0, 0.0, -2.0 * third, -2.0 * third, -2.0 * third],
        ),
        (
            "sulphonate",
            &[("C", 0), ("S", 0), ("O", 0), ("O", 0), ("O", -1)],
            &[(0, 1, 1), (1, 2, 2), (1, 3, 2), (1, 4, 1)],
            &[0.0, 0.0, -third, -third, -third],
        ),
        (
            "nitro",
            &[("C", 0), ("N", 1), ("O", 0), ("O", -1)],
            &[(0, 1, 1), (1, 2, 2), (1, 3, 1)],
            &[0.0, 1.0, -0.5, -0.5],
        ),
        (
            "hydrogen phosphate: the neutral hydroxyl keeps none",
            &[("C", 0), ("O", 0), ("P", 0), ("O", 0), ("O", 0), ("O", -1)],
            &[(0, 1, 1), (1, 2, 1), (2, 3, 2), (2, 4, 1), (2, 5, 1)],
            &[0.0, 0.0, 0.0, -0.5, 0.0, -0.5],
        ),
        (
            "diol with one alkoxide",
            &[("C", 0), ("O", 0), ("O", -1)],
            &[(0, 1, 1), (0, 2, 1)],
            &[0.0, 0.0, -1.0],
        ),
        (
            "ammonium beside an amine",
            &[("C", 0), ("N", 1), ("N", 0)],
            &[(0, 1, 1), (0, 2, 1)],
            &[0.0, 1.0, 0.0],
        ),
    ] {
        assert_eq!(found(&molecule(atoms, bonds)), expected, "{what}");
    }
}

#[test]
fn hydrophobic_atoms_of_ligands_are_vinas() {
    let particles = molecule(
        &[("C", 0), ("C", 0), ("C", 0), ("Cl", 0), ("O", 0), ("I", 0), ("C", 0)],
        &[(0, 1, 1), (1, 2, 1), (2, 3, 1), (0, 4, 1), (1, 6, 1), (6, 5, 1)],
    );
    let found: Vec<bool> = particles.iter().map(|particle| particle.is_hydrophobic).collect();
    assert_eq!(found, [false, true, false, true, false, true, false]);
}

#[test]
fn partial_charges_are_taken_and_hydrogens_united() {
    let text = "@<TRIPOS>MOLECULE\nmethanol\n3 2 0 0 0\nSMALL\nUSER_CHARGES\n\n@<TRIPOS>ATOM\n\
        1 C 0.0 0.0 0.0 C.3 1 MOH 0.2\n2 O 1.4 0.0 0.0 O.3 1 MOH -0.6\n3 H 1.7 0.9 0.0 H 1 MOH 0.4\n\
        @<TRIPOS>BOND\n1 1 2 1\n2 2 3 1\n";
    let ligand = read_bytes(text.as_bytes()).unwrap().remove(0);
    assert_eq!(found(&ligand_particles(&ligand, false)), [0.2, -0.6, 0.4]);
    let united = found(&ligand_particles(&ligand, true));
    assert!((united[1] + 0.2).abs() < 1e-15 && united[2] == 0.0 && united[0] == 0.2, "{united:?}");
}
