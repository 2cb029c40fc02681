use super::*;
use crate::math;
use crate::model::protein::chains::{Numbers, crooked, read};
use crate::model::protein::placed::Site;
use crate::structure::Point;
use fearless_simd::Fallback;

/// All coordinates of a conformation, in one order.
fn bits(placed: &Placed) -> Vec<u64> {
    placed.rows.iter().flat_map(|row| row.0).flatten().map(f64::to_bits).collect()
}

/// The greatest distance of an atom from where the plain linkage puts it, Å.
fn off(conformer: &Conformer, linkage: &Linkage, q: &[f64]) -> f64 {
    let mut placed = conformer.placed();
    conformer.place(q, &mut placed);
    let motions = linkage.motions(q);
    let mut off = 0.0f64;
    for (i, atoms) in conformer.atoms().iter().enumerate() {
        let mut look = |name: &str, source: &Point, at: Point| {
            let expected = motions[linkage.body(i, name)].apply(source);
            off = off.max((expected - at).norm());
        };
        look("N", &atoms.n, placed.at(Site::N, i));
        look("CA", &atoms.ca, placed.at(Site::CA, i));
        look("C", &atoms.c, placed.at(Site::C, i));
        look("O", &atoms.o, placed.at(Site::O, i));
        look("CB", &atoms.cb.unwrap_or(atoms.ca), placed.at(Site::CB, i));
        look("CB", &atoms.centroid.unwrap_or(atoms.ca), placed.at(Site::Centroid, i));
        look("H", &atoms.hydrogen.unwrap_or(atoms.ca), placed.at(Site::H, i));
    }
    off
}

#[test]
fn every_chain_stands_where_the_linkage_puts_it() {
    for len in [1, 2, 3, 4, 5, 7, 8, 9, 31, 64] {
        for seed in 0..4 {
            let residues = crooked(len, seed + 10 * len as u64);
            let linkage = Linkage::of(&residues).expect("it is whole");
            let conformer = Conformer::of(&residues, &linkage).expect("it is whole");
            let source = off(&conformer, &linkage, &linkage.source());
            assert!(source < 1e-9, "{len} residues, at the source: {source}");
            let mut numbers = Numbers::new(seed);
            // Some torsions are many turns away, and one beyond what the sines in lanes take.
            let turned = |q: &f64| q + 40.0 * numbers.normal();
            let mut q: Vec<f64> = linkage.source().iter().map(turned).collect();
            q.first_mut().into_iter().for_each(|q| *q += 5000.0 * math::TURN);
            let turned = off(&conformer, &linkage, &q);
            assert!(turned < 1e-9, "{len} residues, turned: {turned}");
        }
    }
    assert!(Conformer::of(&[], &Linkage { torsions: Vec::new(), gaps: Vec::new() }).is_some());
}

#[test]
fn axes_that_are_parallel_or_nearly_so_do_no_harm() {
    for tilt in [0.0, 1e-14, 1e-11, 1e-6] {
        let mut residues = crooked(6, 3);
        // A bond CA–C in the direction of the next N–CA.
        let next = residues[3].position("CA").unwrap() - residues[3].position("N").unwrap();
        let ca = residues[2].position("CA").unwrap();
        let c = residues[2].atoms.iter_mut().find(|atom| atom.name == "C").unwrap();
        c.position = ca + next + Point::new(0.0, tilt, 0.0);
        let linkage = Linkage::of(&residues).expect("it is whole");
        let conformer = Conformer::of(&residues, &linkage).expect("it is whole");
        let q: Vec<f64> = linkage.source().iter().map(|q| q + 0.7).collect();
        let off = off(&conformer, &linkage, &q);
        assert!(off < 1e-9, "tilted by {tilt}: {off}");
    }
}

#[test]
fn lanes_and_what_was_there_before_change_no_bit() {
    for len in [1, 6, 37] {
        let residues = crooked(len, len as u64);
        let linkage = Linkage::of(&residues).expect("it is whole");
        let mut conformer = Conformer::of(&residues, &linkage).expect("it is whole");
        let mut numbers = Numbers::new(7);
        for _ in 0..20 {
            let q: Vec<f64> = linkage.source().iter().map(|q| q + numbers.normal()).collect();
            let mut plain = conformer.placed();
            conformer.chain.place(Fallback::new(), &q, &mut plain);
            for lanes in Lanes::all() {
                conformer.lanes = lanes;
                let mut placed = conformer.placed();
                conformer.place(&q, &mut placed);
                assert_eq!(bits(&placed), bits(&plain), "{lanes:?}");
                placed.poison();
                conformer.place(&q, &mut placed);
                assert_eq!(bits(&placed), bits(&plain), "{lanes:?}, poisoned");
            }
        }
    }
}

#[test]
fn a_few_torsions_that_turn_give_the_bits_of_all() {
    for len in [1, 6, 37] {
        let residues = crooked(len, len as u64);
        let linkage = Linkage::of(&residues).expect("it is whole");
        let mut conformer = Conformer::of(&residues, &linkage).expect("it is whole");
        let mut numbers = Numbers::new(8);
        for lanes in Lanes::all() {
            conformer.lanes = lanes;
            let (mut kept, mut q) = (conformer.placed(), linkage.source());
            for turned in [0, 1, 1, 1, 2, 3, q.len(), 1, 1] {
                for _ in 0..turned.min(q.len()) {
                    let torsion = (numbers.next() * q.len() as f64) as usize;
                    q[torsion] += numbers.normal();
                }
                let mut placed = conformer.placed();
                conformer.place(&q, &mut placed);
                conformer.place(&q, &mut kept);
                assert_eq!(bits(&kept), bits(&placed), "{turned} torsions, {lanes:?}");
            }
        }
    }
}

#[test]
fn torsions_that_are_no_numbers_are_no_panic() {
    let residues = crooked(9, 1);
    let linkage = Linkage::of(&residues).expect("it is whole");
    let conformer = Conformer::of(&residues, &linkage).expect("it is whole");
    let mut placed = conformer.placed();
    for value in [f64::NAN, f64::INFINITY, f64::MAX] {
        conformer.place(&vec![value; linkage.torsions.len()], &mut placed);
    }
    assert!(!placed.at(Site::CA, 5).x.is_nan(), "the largest number is an angle");
}

#[test]
fn structures_come_back_from_their_torsions() {
    for name in ["1CFD.pdb", "1CLL.pdb", "1PGA.pdb", "1BDD.pdb", "1MI0.pdb"] {
        let Some(residues) = read(name) else { return };
        let linkage = Linkage::of(&residues).expect("it is whole");
        let conformer = Conformer::of(&residues, &linkage).expect("it is whole");
        let off = off(&conformer, &linkage, &linkage.source());
        assert!(off < 1e-9, "{name}: {off}");
    }
}
