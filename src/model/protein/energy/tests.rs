use super::*;
use crate::lanes::Lanes;
use crate::math;
use crate::model::protein::chains::{Numbers, crooked, read};
use crate::model::protein::kinematics::Conformer;
use crate::model::protein::linkage::{Linkage, TorsionKind};
use crate::model::protein::placed::{Placed, Site};
use crate::structure::{Point, Residue};

fn conformer(residues: &[Residue]) -> (Conformer, Linkage) {
    let linkage = Linkage::of(residues).expect("it is whole");
    (Conformer::of(residues, &linkage).expect("it is whole"), linkage)
}

/// The term of a pair, as the formula has it.
fn term(distance: f64, native: f64) -> f64 {
    let stretch = distance - native;
    100.0 * ((stretch * stretch + 4.0).sqrt() - 2.0)
}

#[test]
fn constraints_are_summed_as_their_formula_says_and_to_the_same_bits_in_all_lanes() {
    let (conformer, linkage) = conformer(&crooked(30, 2));
    let mut numbers = Numbers::new(1);
    let mut placed = conformer.placed();
    for count in 0..12 {
        let q: Vec<f64> = linkage.source().iter().map(|q| q + numbers.normal()).collect();
        conformer.place(&q, &mut placed);
        let mut residue = || (numbers.next() * 30.0) as usize;
        let constraint = |number| match number % 3 {
            0 => Constraint::disulphide(residue(), residue(), 3.5),
            _ => Constraint::hydrogen_bond(residue(), residue()),
        };
        let mut constraints = Constraints::new((0..count).map(constraint).collect());
        let of = |c: &Constraint| match c.kind {
            ConstraintKind::HydrogenBond => {
                placed.at(Site::H, c.first) - placed.at(Site::O, c.second)
            }
            ConstraintKind::Disulphide => {
                placed.at(Site::Centroid, c.first) - placed.at(Site::Centroid, c.second)
            }
        };
        let terms = constraints.list().iter().map(|c| term(of(c).norm(), c.distance));
        let (expected, bits) = (terms.sum::<f64>(), constraints.energy(&placed).to_bits());
        assert!((constraints.energy(&placed) - expected).abs() <= 1e-12 * expected);
        for lanes in Lanes::all() {
            constraints.set_lanes(lanes);
            assert_eq!(constraints.energy(&placed).to_bits(), bits, "{lanes:?}");
        }
    }
}

#[test]
fn hydrophobic_pairs_are_those_that_a_plain_count_finds() {
    let mut numbers = Numbers::new(2);
    for len in [0, 1, 2, 5, 8, 13, 40, 41, 42, 43, 90] {
        let (conformer, linkage) = conformer(&crooked(len, len as u64));
        let atoms = conformer.atoms();
        let mut hydrophobic = Hydrophobic::of(atoms);
        let mut placed = conformer.placed();
        let q: Vec<f64> = linkage.source().iter().map(|q| q + numbers.normal()).collect();
        conformer.place(&q, &mut placed);
        let counts = |i: usize| atoms[i].is_hydrophobic && atoms[i].centroid.is_some();
        let mut expected = 0;
        for i in (0..len).filter(|i| counts(*i)) {
            for j in (i + 2..len).filter(|j| counts(*j)) {
                let distance = (placed.at(Site::Centroid, i) - placed.at(Site::Centroid, j)).norm();
                expected += usize::from(distance < 6.0);
            }
        }
        for lanes in Lanes::all() {
            hydrophobic.set_lanes(lanes);
            assert_eq!(hydrophobic.pairs(&placed), expected, "{len} residues, {lanes:?}");
        }
    }
}

#[test]
fn the_smooth_minimum_is_below_both_and_near_the_lower() {
    for (a, b) in [(0.0, 0.0), (1e5, 1e5 + 3.0), (120.0, 4e4), (-300.0, 1e6), (1e300, 0.0)] {
        for kt in [0.01, 2.5, 100.0] {
            let mixed = smooth_minimum(a, b, kt);
            assert_eq!(mixed.to_bits(), smooth_minimum(b, a, kt).to_bits());
            let low = f64::min(a, b);
            assert!(
                mixed <= low && mixed >= low - kt * std::f64::consts::LN_2 - 1e-9,
                "{a} {b} {kt}"
            );
        }
    }
    assert_eq!(smooth_minimum(1.0, 1.0, 2.0), 1.0 - 2.0 * math::ln(2.0));
}

#[test]
fn union_and_intersection_take_common_constraints_once() {
    let (conformer, _) = conformer(&crooked(20, 2));
    let mut placed = conformer.placed();
    for i in 0..20 {
        placed.put(Site::H, i, &Point::new(0.0, 0.0, i as f64));
        placed.put(Site::O, i, &Point::new(2.0, 0.0, 2.0 * i as f64));
    }
    let bonds = |pairs: &[(usize, usize)]| {
        Constraints::new(pairs.iter().map(|(i, j)| Constraint::hydrogen_bond(*i, *j)).collect())
    };
    let (a, b) = (bonds(&[(4, 3), (9, 2)]), bonds(&[(4, 3), (12, 1)]));
    let energy = |mixing| Mixture::of_two(a.clone(), b.clone(), mixing, None).energy(&placed);
    let of = |pairs| bonds(pairs).energy(&placed);
    assert_eq!(energy(Mixing::Union {}), of(&[(4, 3), (9, 2), (12, 1)]));
    assert_eq!(energy(Mixing::Intersection {}), of(&[(4, 3)]));
    let smooth = smooth_minimum(a.energy(&placed), b.energy(&placed), 5.0);
    assert_eq!(energy(Mixing::SmoothMinimum { kt: 5.0 }), smooth);
}

/// All phi and psi of a chain, in degrees.
fn regular(linkage: &Linkage, phi: f64, psi: f64) -> Vec<f64> {
    let of = |kind| if kind == TorsionKind::Phi { phi } else { psi };
    linkage.torsions.iter().map(|torsion| of(torsion.kind).to_radians()).collect()
}

/// The backbone N–H···O=C with H···O below 2.5 Å, the nearest acceptor of every donor: the rule with which the energies of
/// native, helical and extended chains were measured before there was this model.
fn nearest_acceptors(conformer: &Conformer) -> Vec<Constraint> {
    let atoms = conformer.atoms();
    let mut bonds = Vec::new();
    for (donor, atoms_of_donor) in atoms.iter().enumerate() {
        let Some(hydrogen) = atoms_of_donor.hydrogen else { continue };
        let near = |acceptor: usize| ((hydrogen - atoms[acceptor].o).norm(), acceptor);
        let others = (0..atoms.len()).filter(|other| other.abs_diff(donor) >= 2);
        let nearest = others.map(near).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, acceptor)) = nearest.filter(|(distance, _)| *distance < 2.5) {
            bonds.push(Constraint::hydrogen_bond(donor, acceptor));
        }
    }
    bonds
}

#[test]
fn native_chains_are_told_from_helices_and_from_stretched_ones() {
    // Residues, bonds, energies of bonds and of hydrophobic pairs: native, helical, extended; model kJ/mol. Hydrogens are
    // placed by another ideal rule there, so that energies differ by some kJ/mol near native.
    let measured = [
        ("1PGA.pdb", 56, 36, [32.0, -500.0], [55_633.0, -120.0], [147_093.0, -40.0]),
        ("1MI0.pdb", 61, 34, [38.0, -520.0], [51_452.0, -200.0], [132_296.0, -20.0]),
        ("1BDD.pdb", 46, 30, [57.0, -340.0], [313.0, -120.0], [17_341.0, -40.0]),
        ("1CFD.pdb", 148, 88, [120.0, -1400.0], [26_015.0, -420.0], [107_062.0, -60.0]),
        ("1CLL.pdb", 144, 93, [99.0, -1060.0], [21_328.0, -400.0], [109_881.0, -40.0]),
    ];
    for (name, len, count, native, helix, extended) in measured {
        let Some(residues) = read(name) else { return };
        let (conformer, linkage) = conformer(&residues);
        let bonds = Constraints::new(nearest_acceptors(&conformer));
        let hydrophobic = Hydrophobic::of(conformer.atoms());
        let mut placed = conformer.placed();
        let mut energies = |q: &[f64]| {
            conformer.place(q, &mut placed);
            [bonds.energy(&placed), hydrophobic.energy(&placed)]
        };
        assert_eq!((residues.len(), bonds.list().len()), (len, count), "{name}");
        let states = [
            (linkage.source(), native, 4.0),
            (regular(&linkage, -57.0, -47.0), helix, 60.0),
            (regular(&linkage, -139.0, 135.0), extended, 0.05 * extended[0]),
        ];
        for (q, expected, within) in states {
            let found = energies(&q);
            assert!((found[0] - expected[0]).abs() <= within, "{name}: {found:?}, {expected:?}");
            assert_eq!(found[1], expected[1], "{name}");
        }
    }
}

/// What is not looked at by a term is not looked at.
#[test]
fn energies_of_nothing_are_zero() {
    let placed = Placed::default();
    assert_eq!(Constraints::default().energy(&placed), 0.0);
    assert_eq!(Hydrophobic::of(&[]).energy(&placed), 0.0);
    assert_eq!(Mixture::single(Constraints::default(), None).energy(&placed), 0.0);
}
