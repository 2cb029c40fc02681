//! Whole chains, broken ones, and two conformations of one.

use super::matching::{MatchedBy, match_chains};
use super::{
    AminoAcid, Atom, Chain, Point, Residue, ResidueNumber, backbone, comparison, disulphides,
    peptides,
};
use std::f64::consts::PI;

/// Residues of these letters from number 1 on, with N, CA, C, O and CB, in a zigzag with trans peptide bonds.
fn chain(letters: &str) -> Chain {
    let codes = ["ALA", "CYS", "ASP", "GLY", "LYS", "PRO", "SER", "TRP"];
    let residue = |(place, letter): (usize, char)| {
        let known = codes.iter().filter_map(|code| AminoAcid::of_code(code));
        let amino_acid = known.into_iter().find(|known| known.letter() == letter).unwrap();
        let x = 3.6 * place as f64;
        let up = if place % 2 == 0 { 1.0 } else { -1.0 };
        let atoms = [
            ("N", [x, 0.0, 0.0]),
            ("CA", [x + 1.2, 0.8 * up, 0.0]),
            ("C", [x + 2.4, 0.0, 0.0]),
            ("O", [x + 2.4, -1.2 * up, 0.3]),
            ("CB", [x + 1.2, 1.6 * up, 1.3]),
        ];
        let is_there = |name: &str| name != "CB" || amino_acid != AminoAcid::Glycine;
        Residue {
            number: ResidueNumber { number: place as i32 + 1, insertion: None },
            name: amino_acid.code().to_owned(),
            amino_acid: Some(amino_acid),
            atoms: atoms
                .into_iter()
                .filter(|(name, _)| is_there(name))
                .map(|(name, position)| Atom {
                    name: name.to_owned(),
                    element: name[..1].to_owned(),
                    position: position.into(),
                })
                .collect(),
        }
    };
    Chain {
        name: "A".to_owned(),
        residues: letters.chars().enumerate().map(residue).collect(),
        others: Vec::new(),
    }
}

fn remove(chain: &mut Chain, residue: usize, atom: &str) {
    chain.residues[residue].atoms.retain(|other| other.name != atom);
}

fn add(chain: &mut Chain, residue: usize, name: &str, position: Point) {
    let element = name[..1].to_owned();
    chain.residues[residue].atoms.push(Atom { name: name.to_owned(), element, position });
}

#[test]
fn a_whole_chain_has_no_gaps_and_a_missing_atom_is_named() {
    let mut chain = chain("AGCK");
    let found = backbone::check(&chain).unwrap();
    assert!(found.gaps.is_empty() && found.without_side_chain.is_empty());
    remove(&mut chain, 3, "CB");
    assert_eq!(backbone::check(&chain).unwrap().without_side_chain, [3]);
    remove(&mut chain, 2, "O");
    let error = backbone::check(&chain).unwrap_err().to_string();
    assert!(error.starts_with("chain `A`: CYS 3 without its atom O found"), "{error}");
}

#[test]
fn a_gap_is_named_with_the_residues_on_both_sides() {
    let mut chain = chain("AGCKA");
    chain.residues.remove(2);
    assert_eq!(backbone::completeness(&chain).unwrap().gaps[0].before, 1);
    let error = backbone::check(&chain).unwrap_err().to_string();
    assert!(error.contains("a gap between GLY 2 and LYS 4 found (1 in all)"), "{error}");
    assert!(error.contains("C and N 4.80 Å apart"), "{error}");
}

#[test]
fn cis_peptides_are_those_with_omega_near_zero() {
    let mut chain = chain("AAPA");
    assert!(peptides::cis_peptides(&chain.residues).is_empty());
    let omega = peptides::omega(&chain.residues[0], &chain.residues[1]).unwrap();
    assert!((omega.abs() - PI).abs() < 1e-9);
    // The alpha carbon of the proline to the other side of the bond.
    chain.residues[2].atoms[1].position.y *= -1.0;
    let cis = peptides::cis_peptides(&chain.residues);
    assert_eq!(cis.iter().map(|cis| cis.before).collect::<Vec<_>>(), [1, 2]);
    assert!(cis[0].omega.abs() < 1e-9);
}

#[test]
fn disulphides_join_sulphurs_that_are_near() {
    let mut chain = chain("CAC");
    add(&mut chain, 0, "SG", Point::new(0.0, 5.0, 0.0));
    add(&mut chain, 2, "SG", Point::new(0.0, 5.0, 2.03));
    let mut other = chain.clone();
    other.residues[0].atoms.last_mut().unwrap().position.z = 50.0;
    other.residues[2].atoms.last_mut().unwrap().position.z = -2.0;
    let bonds = disulphides::disulphides(&[chain, other]);
    let ends: Vec<_> = bonds.iter().map(|bond| (bond.first, bond.second)).collect();
    assert_eq!(ends, [((0, 0), (0, 2)), ((0, 0), (1, 2))]);
    assert!((bonds[0].distance - 2.03).abs() < 1e-9);
}

#[test]
fn residues_are_matched_by_number_and_atoms_compared() {
    let first = chain("AGCKAAAAAAAA");
    let mut second = first.clone();
    second.residues.truncate(10);
    second.residues.remove(0);
    second.residues[0].amino_acid = Some(AminoAcid::Serine);
    remove(&mut second, 3, "CB");
    add(&mut second, 4, "OXT", Point::new(9.0, 9.0, 9.0));
    add(&mut second, 4, "H", Point::new(9.0, 9.0, 9.0));
    second.residues[4].atoms.last_mut().unwrap().element = "H".to_owned();
    let matching = match_chains(&first, &second).unwrap();
    assert_eq!((matching.by, matching.pairs.len()), (MatchedBy::Sequence, 9));
    second.residues[0].amino_acid = Some(AminoAcid::Glycine);
    let matching = match_chains(&first, &second).unwrap();
    assert_eq!((matching.by, matching.pairs.len()), (MatchedBy::Number, 9));
    assert_eq!((matching.only_first, matching.only_second), (vec![0, 10, 11], vec![]));
    assert_eq!(matching.pairs[3].only_first, ["CB"]);
    assert_eq!(matching.pairs[4].only_second, ["OXT"]);
}

#[test]
fn residues_numbered_otherwise_are_matched_by_sequence() {
    let first = chain("AGCKSWDPAGCK");
    let mut second = chain("KSWDPAG");
    second.name = "B".to_owned();
    let matching = match_chains(&first, &second).unwrap();
    assert_eq!(matching.by, MatchedBy::Sequence);
    let pairs: Vec<_> = matching.pairs.iter().map(|pair| (pair.first, pair.second)).collect();
    assert_eq!(pairs, (0..7).map(|place| (place + 3, place)).collect::<Vec<_>>());
    assert_eq!((matching.identity, matching.atoms_that_differ()), (1.0, 0));
}

#[test]
fn two_proteins_do_not_match() {
    let error = match_chains(&chain("AAAAAAAA"), &chain("AGKSWDPC")).unwrap_err().to_string();
    assert!(
        error
            .contains("chains `A` (8 residues) and `A` (8) found, of which 1 residues agree, 12 %"),
        "{error}"
    );
    assert!(error.contains("at least 50 %"), "{error}");
    let none = chain("");
    assert!(match_chains(&none, &none).is_err());
}

#[test]
fn a_turned_and_moved_conformation_differs_by_nothing_and_a_bent_one_where_it_bends() {
    let first = chain("AGCKSWDP");
    let mut second = first.clone();
    for atom in second.residues.iter_mut().flat_map(|residue| &mut residue.atoms) {
        let at = atom.position;
        atom.position = Point::new(-at.y + 4.0, at.x, at.z - 7.0);
    }
    let comparison = comparison::compare(&first, &second).unwrap();
    assert!(comparison.superposition.rmsd < 1e-9);
    assert!(comparison.motions.iter().all(|motion| motion.unwrap() < 1e-9));
    assert!(comparison.turns.iter().all(|turn| turn.turn < 1e-9));
    // All that is behind the C of residue 4 a half turn about its bond CA–C: psi of 4 alone.
    let [ca, c] = ["CA", "C"].map(|name| second.residues[3].position(name).unwrap());
    let axis = (c - ca).normalize();
    let turned = |at: Point| {
        let from = at - c;
        c + axis * (2.0 * from.dot(&axis)) - from
    };
    for residue in &mut second.residues[4..] {
        for atom in &mut residue.atoms {
            atom.position = turned(atom.position);
        }
    }
    let comparison = comparison::compare(&first, &second).unwrap();
    let turn = &comparison.turns[0];
    assert_eq!((turn.pair, turn.torsion), (3, "psi"));
    assert!((turn.turn - PI).abs() < 1e-9 && comparison.turns[1].turn < 1e-9);
    assert!(comparison.superposition.rmsd > 1.0);
}
