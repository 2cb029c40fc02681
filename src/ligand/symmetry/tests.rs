//! Numbers of symmetries that can be counted by hand, and least sums beside those of all symmetries.

use super::super::{Atom, Bond, BondOrder, Element, Ligand, from_smiles};
use super::*;
use crate::math;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed, Stream};

fn stream(ordinal: u64) -> Stream {
    Seed::of_set(1, "symmetries", Ordinal(ordinal)).stream(Purpose::Sampling)
}

fn of(smiles: &str) -> Symmetries {
    Symmetries::of(&from_smiles(smiles).unwrap()).unwrap()
}

fn points(count: usize, stream: &mut Stream) -> Vec<Point> {
    let mut draw = || 10.0 * stream.unit();
    (0..count).map(|_| Point::new(draw(), draw(), draw())).collect()
}

/// Atoms of these elements, and single bonds of them.
fn ligand(elements: &[Element], bonds: &[[usize; 2]]) -> Ligand {
    let atom = |element: &Element| Atom {
        name: String::new(),
        element: *element,
        position: None,
        formal_charge: None,
        partial_charge: None,
    };
    let bond = |atoms: &[usize; 2]| Bond { atoms: *atoms, order: BondOrder::Single };
    let (atoms, bonds) = (elements.iter().map(atom).collect(), bonds.iter().map(bond).collect());
    Ligand::new("", atoms, bonds).unwrap()
}

#[test]
fn symmetries_are_as_many_as_can_be_counted_by_hand() {
    for (smiles, count) in [
        ("CC", 2.0),
        ("CCC", 2.0),
        ("CCO", 1.0),
        ("CCCC", 2.0),
        ("CC(C)(C)C", 24.0),
        ("C1=CC=CC=C1", 12.0),
        ("c1ccccc1", 12.0),
        ("Cc1ccccc1", 2.0),
        ("C1CCCCC1", 12.0),
        // The double bond stays where it is: one mirror.
        ("C1CCCC=C1", 2.0),
        ("NC(=[NH2+])c1ccccc1", 4.0),
        ("CC(=O)[O-]", 2.0),
        ("CC(=O)OC", 1.0),
        ("OS(=O)(=O)O", 24.0),
        // The CH2 of isobutene is not one of its CH3; those of acetone and of 1,1-difluoroethene are alike.
        ("C=C(C)C", 2.0),
        ("CC(=O)C", 2.0),
        ("C=C(F)F", 2.0),
        // Both halves, and each ring's.
        ("c1ccccc1-c1ccccc1", 8.0),
        ("FC(F)(F)C(F)(F)F", 72.0),
        // Cubane, adamantane, dodecahedrane: 48, 24, 120.
        ("C12C3C4C1C5C2C3C45", 48.0),
        ("C1C2CC3CC1CC(C2)C3", 24.0),
        ("C12C3C4C5C1C6C7C2C8C3C9C4C1C5C6C2C7C8C9C12", 120.0),
        // Two of three arms are alike.
        ("CCN(CC)CCC", 2.0),
        ("CC(C)(C)c1cc(C(C)(C)C)cc(C(C)(C)C)c1", 1296.0),
    ] {
        let found = of(smiles);
        assert_eq!(found.count(), count, "{smiles}");
        let listed = found.listed.as_ref().unwrap();
        let mut distinct = listed.clone();
        distinct.sort();
        distinct.dedup();
        assert_eq!((listed.len() as f64, distinct.len() as f64), (count, count), "{smiles}");
        // Every one keeps elements and bonds.
        let ligand = from_smiles(smiles).unwrap();
        let has_bond =
            |a, b| ligand.bonds().iter().any(|bond| bond.atoms == [a, b] || bond.atoms == [b, a]);
        for to in listed {
            for (atom, goal) in to.iter().enumerate() {
                assert_eq!(ligand.atoms()[atom].element, ligand.atoms()[*goal].element);
            }
            assert!(
                ligand.bonds().iter().all(|Bond { atoms: [a, b], .. }| has_bond(to[*a], to[*b]))
            );
        }
    }
}

#[test]
fn the_least_sum_is_that_of_trying_all() {
    let mut stream = stream(0);
    for smiles in [
        "CC(C)(C)C",
        "c1ccccc1-c1ccccc1",
        "FC(F)(F)C(F)(F)F",
        "CC(C)(C)c1cc(C(C)(C)C)cc(C(C)(C)C)c1",
        "C12C3C4C5C1C6C7C2C8C3C9C4C1C5C6C2C7C8C9C12",
        "FC(F)(F)c1cc(C(F)(F)F)cc(C2CCCCC2)c1",
        "OP(O)(=O)OP(=O)(O)OP(O)(O)=O",
        "CC(C)CN(CC(C)C)CCN(CC(C)C)CC(C)C",
    ] {
        let found = of(smiles);
        let listed = found.listed.as_ref().unwrap();
        for _ in 0..20 {
            let [a, b] = [(); 2].map(|()| points(found.atoms, &mut stream));
            let least =
                listed.iter().map(|to| found.squares(to, &a, &b)).fold(f64::INFINITY, f64::min);
            let sum = least::sum(&found.tree, &found.images, &a, &b);
            assert!((sum - least).abs() < 1e-9, "{smiles}: {sum} {least}");
            let to = least::symmetry(&found.tree, &found.images, &a, &b);
            assert!((found.squares(&to, &a, &b) - least).abs() < 1e-9, "{smiles}");
            assert!(listed.contains(&to), "{smiles}");
            let rmsd = found.rmsd(&a, &b);
            assert!((rmsd - (least / a.len() as f64).sqrt()).abs() < 1e-12);
            assert!(found.rmsd_superposed(&a, &b) <= rmsd + 1e-12);
        }
    }
}

#[test]
fn a_pose_whose_like_atoms_are_exchanged_and_moved_has_the_same_shape() {
    let found = of("NC(=[NH2+])c1ccccc1");
    let mut stream = stream(1);
    let a = points(found.atoms, &mut stream);
    let (sine, cosine) = (math::sin(0.7), math::cos(0.7));
    for to in found.listed.as_ref().unwrap() {
        let mut b = a.clone();
        to.iter().enumerate().for_each(|(atom, goal)| b[*goal] = a[atom]);
        assert_eq!(found.rmsd(&a, &b), 0.0);
        for p in &mut b {
            *p = Point::new(cosine * p.x - sine * p.y + 5.0, sine * p.x + cosine * p.y, p.z);
        }
        assert!(found.rmsd(&a, &b) > 1.0 && found.rmsd_superposed(&a, &b) < 1e-12);
    }
    // Hydrogens do not count, wherever they are.
    let methanol =
        ligand(&["C", "O", "H"].map(|s| Element::of_symbol(s).unwrap()), &[[0, 1], [1, 2]]);
    let found = Symmetries::of(&methanol).unwrap();
    let a = points(3, &mut stream);
    let mut b = a.clone();
    b[2].x += 3.0;
    b[0].y += 2.0;
    assert!((found.rmsd(&a, &b) - 2f64.sqrt()).abs() < 1e-12);
}

#[test]
fn ligands_with_too_many_symmetries_to_list_have_the_exact_rmsd_in_place() {
    // Thirty trifluoromethyl groups along a chain, and two that are alike at its ends: 6^30 and twice.
    let mut smiles = "FC(F)(F)C".to_owned();
    (0..28).for_each(|_| smiles += "C(C(F)(F)F)");
    smiles += "CC(F)(F)F";
    let found = of(&smiles);
    let expected = (0..30).fold(2.0, |count, _| 6.0 * count);
    assert!((found.count() / expected - 1.0).abs() < 1e-12, "{}", found.count());
    assert!(!found.is_listed());
    let mut stream = stream(2);
    let a = points(found.atoms, &mut stream);
    // The fluorines of every group in turn, and the whole from its end.
    let mut b = a.clone();
    let elements = from_smiles(&smiles).unwrap();
    let fluorines: Vec<usize> =
        (0..b.len()).filter(|at| elements.atoms()[*at].element.symbol() == "F").collect();
    for group in fluorines.chunks(3) {
        (b[group[0]], b[group[1]], b[group[2]]) = (a[group[1]], a[group[2]], a[group[0]]);
    }
    assert_eq!(found.rmsd(&a, &b), 0.0);
    // The bound of the best shape is not above what is found in place.
    let shifted: Vec<Point> = b.iter().map(|point| point + Point::new(0.3, 0.0, 0.0)).collect();
    assert!(found.rmsd(&a, &shifted) <= 0.3 + 1e-12);
    assert!(found.rmsd_superposed(&a, &b) <= found.rmsd(&a, &b) + 1e-12);
}

#[test]
fn graphs_that_are_no_molecules_end_in_bounded_time() {
    let [carbon, sulphur] = [Element::CARBON, Element::SULPHUR];
    // A star of 900 equal atoms.
    let star = ligand(&[carbon; 901], &std::array::from_fn::<_, 900, _>(|at| [0, at + 1]));
    let found = Symmetries::of(&star).unwrap();
    assert_eq!(found.count(), f64::MAX);
    let mut stream = stream(3);
    let a = points(901, &mut stream);
    let mut b = a.clone();
    b[1..].rotate_left(400);
    assert!(found.rmsd(&a, &b) < 1e-6);
    // All atoms bonded to all: as many symmetries as permutations.
    let all: Vec<[usize; 2]> = (0..40).flat_map(|a| (0..a).map(move |b| [a, b])).collect();
    let error = Symmetries::of(&ligand(&[sulphur; 40], &all)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a ring system of 40 atoms with too many symmetries found; at most 1000 expected"
    );
    // Two columns of atoms, all of one bonded to all of the other.
    let two: Vec<[usize; 2]> = (0..30).flat_map(|a| (30..60).map(move |b| [a, b])).collect();
    assert_eq!(Symmetries::of(&ligand(&[carbon; 60], &two)).unwrap_err().atoms, 60);
    // A sheet of squares has eight symmetries, and they are found.
    let at = |row: usize, column: usize| 30 * row + column;
    let squares = (0..30).flat_map(|row| (0..29).map(move |column| (row, column)));
    let squares: Vec<[usize; 2]> =
        squares.flat_map(|(i, j)| [[at(i, j), at(i, j + 1)], [at(j, i), at(j + 1, i)]]).collect();
    assert_eq!(Symmetries::of(&ligand(&[carbon; 900], &squares)).unwrap().count(), 8.0);
}

#[test]
fn odd_ligands_and_odd_positions_have_an_answer() {
    let [hydrogen, fluorine] = ["H", "F"].map(|symbol| Element::of_symbol(symbol).unwrap());
    let none = Symmetries::of(&ligand(&[hydrogen; 2], &[[0, 1]])).unwrap();
    let two = [Point::zeros(), Point::x()];
    assert_eq!(
        (none.count(), none.rmsd(&two, &two), none.rmsd_superposed(&two, &two)),
        (1.0, 0.0, 0.0)
    );
    // A hydrogen between two atoms holds them together.
    let bridged =
        Symmetries::of(&ligand(&[fluorine, hydrogen, fluorine], &[[0, 1], [1, 2]])).unwrap();
    let [a, b, c] = [Point::zeros(), Point::x(), Point::x() * 2.0];
    assert_eq!((bridged.count(), bridged.rmsd(&[a, b, c], &[c, a, a])), (2.0, 0.0));

    let found = of("CC(C)(C)C");
    let fine = vec![Point::zeros(); 5];
    assert!(found.rmsd(&fine[..4], &fine).is_nan() && found.rmsd_superposed(&fine, &two).is_nan());
    let mut bad = fine.clone();
    bad[3].z = f64::NAN;
    assert!(found.rmsd(&fine, &bad).is_nan() && found.rmsd_superposed(&bad, &fine).is_nan());
    // So large that squares overflow.
    bad[3].z = 1e300;
    assert!(
        !found.rmsd(&bad, &fine).is_finite() && !found.rmsd_superposed(&bad, &fine).is_finite()
    );
    let star = ligand(&[fluorine; 31], &std::array::from_fn::<_, 30, _>(|at| [0, at + 1]));
    let found = Symmetries::of(&star).unwrap();
    let mut large = vec![Point::zeros(); 31];
    (large[3].x, large[7].y) = (1e200, -1e200);
    assert!(!found.rmsd(&large, &vec![Point::x(); 31]).is_finite());
    assert!(!found.rmsd_superposed(&large, &vec![Point::x(); 31]).is_finite());
}
