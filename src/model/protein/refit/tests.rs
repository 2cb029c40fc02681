use super::least_squares::SumOfSquares;
use super::*;
use crate::model::protein::chains::{Numbers, crooked, read};
use crate::model::protein::validity::{Obstacles, Screen};
use crate::structure::{AminoAcid, ResidueNumber};

/// A chain with every torsion turned by up to `amount` radians.
fn turned(source: &[Residue], amount: f64) -> (Vec<f64>, Vec<Residue>) {
    let linkage = Linkage::of(source).expect("it is whole");
    let mut numbers = Numbers::new(7);
    let turn = |angle: &f64| math::wrap_angle(angle + amount * (2.0 * numbers.next() - 1.0));
    let q: Vec<f64> = linkage.source().iter().map(turn).collect();
    let motions = linkage.motions(&q);
    let mut moved = source.to_vec();
    for (number, residue) in moved.iter_mut().enumerate() {
        for atom in &mut residue.atoms {
            atom.position = motions[linkage.body(number, &atom.name)].apply(&atom.position);
        }
    }
    (q, moved)
}

fn with_defaults(source: &[Residue], target: &[Residue]) -> Result<Refit, RefitError> {
    let linkage = Linkage::of(source).ok_or(RefitError::NoBackbone(End::Source))?;
    refit(source, &linkage, target, &Rules::default(), &Weights::default())
}

#[test]
fn derivatives_are_those_of_differences() {
    let source = crooked(9, 3);
    let linkage = Linkage::of(&source).expect("it is whole");
    let sites = Sites::of(&ResidueAtoms::of(&source).expect("it is whole"), &linkage);
    let contacts = Contacts::of(Rules::default().at_nodes(), &sites);
    let exceptions = Exceptions::new();
    let hydrogen_bond = |donor, acceptor| {
        let bond = Bond {
            nitrogen: sites.number(donor, Kind::Nitrogen)?,
            hydrogen: sites.number(donor, Kind::Hydrogen)?,
            oxygen: sites.number(acceptor, Kind::Oxygen)?,
            carbon: sites.number(acceptor, Kind::Carbon)?,
        };
        let (length_weight, energy_weight) = (0.7, 0.9);
        Some(Kept { bond, length: 2.0, length_weight, highest: -5.0, energy_weight })
    };
    let mut objective = Objective {
        linkage: &linkage,
        sites: &sites,
        pulls: Vec::new(),
        bonds: Vec::new(),
        contacts: &contacts,
        exceptions: &exceptions,
        margin: 4.0,
        contact_weight: 0.0,
    };
    let mut numbers = Numbers::new(5);
    let state = State::unposed(linkage.source().iter().map(|a| a + numbers.next()).collect());
    let positions = objective.positions(&state);
    let pull = |site: usize, numbers: &mut Numbers| {
        let to = positions[site] + Point::from_fn(|_, _| numbers.next());
        Pull { site, to, weight: 0.5 + numbers.next() }
    };
    objective.pulls = (0..sites.sites.len()).map(|site| pull(site, &mut numbers)).collect();
    let after = |objective: &Objective, unknown: usize, size: f64| {
        let mut step = vec![0.0; linkage.torsions.len() + 6];
        step[unknown] = size;
        objective.after(&state, &step)
    };
    // JᵀJ of the positions, by differences of these.
    let size = 1e-5;
    let columns: Vec<Vec<Point>> = (0..linkage.torsions.len() + 6)
        .map(|unknown| {
            let ends =
                [-size, size].map(|size| objective.positions(&after(&objective, unknown, size)));
            ends[1].iter().zip(&ends[0]).map(|(b, a)| (b - a) / (2.0 * size)).collect()
        })
        .collect();
    let mut equations = objective.normal_equations(&state);
    for (row, a) in columns.iter().enumerate() {
        for (column, b) in columns.iter().enumerate().skip(row) {
            let product = |pull: &Pull| pull.weight * a[pull.site].dot(&b[pull.site]);
            let expected: f64 = objective.pulls.iter().map(product).sum();
            let found = equations.matrix.row_mut(row)[column - row];
            assert!((found - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{row} {column}");
        }
    }
    // The gradient of the whole, with bonds and contacts.
    let pairs = (0..9).flat_map(|a| (0..9).map(move |b| (a, b)));
    let bonds: Vec<Kept> = pairs
        .filter(|(a, b): &(usize, usize)| a.abs_diff(*b) >= 2)
        .filter_map(|(a, b)| hydrogen_bond(a, b))
        .collect();
    assert!(bonds.len() > 20 && contacts.find(&positions, 4.0, &exceptions).len() > 20);
    let objective = Objective { bonds, contact_weight: 0.3, ..objective };
    let equations = objective.normal_equations(&state);
    for (unknown, found) in equations.gradient.iter().enumerate() {
        let [a, b] = [-size, size].map(|size| objective.cost(&after(&objective, unknown, size)));
        let expected = (b - a) / (2.0 * size);
        assert!((found - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{found} {expected}");
    }
}

#[test]
fn contacts_are_what_the_rules_count() {
    // Wider than usual, since these chains are stretched.
    let rules = Rules {
        alpha_carbons: 7.0,
        side_chains: 5.0,
        nitrogen_oxygen: 5.5,
        backbone: 6.0,
        ..Rules::default()
    };
    let limits = rules.at_nodes();
    for seed in 0..5 {
        let source = crooked(60, seed);
        let linkage = Linkage::of(&source).expect("it is whole");
        let conformer = Conformer::of(&source, &linkage).expect("it is whole");
        let sites = Sites::of(conformer.atoms(), &linkage);
        let found = Contacts::of(limits, &sites).find(&sites.source(), 0.0, &Exceptions::new());
        // Two CA may violate two rules, and are one pair.
        let is_twice = |contact: &&crate::model::protein::equations::Contact| {
            let kinds = [contact.first, contact.second].map(|number| sites.sites[number].kind);
            kinds == [Kind::AlphaCarbon; 2] && contact.distance < limits.backbone
        };
        let twice = found.iter().filter(is_twice).count();
        let mut placed = conformer.placed();
        conformer.place(&linkage.source(), &mut placed);
        let counts = limits.count(&placed, &Obstacles::default(), &mut Screen::default());
        assert!(found.len() > 10);
        assert_eq!(found.len() + twice, counts.total(), "{counts:?}");
    }
}

#[test]
fn a_chain_refitted_on_itself_stays() {
    for source in [crooked(1, 2), crooked(2, 2), crooked(25, 2)] {
        let found = with_defaults(&source, &source).expect("it is whole");
        let torsions = Linkage::of(&source).expect("it is whole").source();
        for (found, torsion) in found.q.iter().zip(&torsions) {
            assert!(math::angle_between(*found, *torsion) < 1e-9);
        }
        assert!(found.backbone_rmsd < 1e-9 && found.copied_rmsd < 1e-9);
        assert_eq!((found.lost_hydrogen_bonds.len(), found.new_clashes.len()), (0, 0));
        assert!((found.energy[0] - found.energy[1]).abs() < 1e-6);
    }
}

#[test]
fn what_the_same_linkage_can_do_is_found_from_elsewhere() {
    let source = crooked(30, 4);
    let (q, target) = turned(&source, 0.3);
    let linkage = Linkage::of(&source).expect("it is whole");
    let sites = Sites::of(&ResidueAtoms::of(&source).expect("it is whole"), &linkage);
    let target_sites = Sites::of(&ResidueAtoms::of(&target).expect("it is whole"), &linkage);
    let contacts = Contacts::of(Rules::none().at_nodes(), &sites);
    let exceptions = Exceptions::new();
    let mut objective = Objective {
        linkage: &linkage,
        sites: &sites,
        pulls: Vec::new(),
        bonds: Vec::new(),
        contacts: &contacts,
        exceptions: &exceptions,
        margin: 0.0,
        contact_weight: 0.0,
    };
    let pulls = pulls(&sites, &target_sites);
    // From the source's torsions, which are up to 0.3 off.
    let mut fit = Fit { state: State::unposed(linkage.source()), steps: 0 };
    fit.grow(&mut objective, &pulls);
    fit.whole(&mut objective, &pulls, &Weights::default());
    let positions = objective.positions(&fit.state);
    for pull in &pulls {
        assert!((positions[pull.site] - pull.to).norm() < 1e-6);
    }
    for (found, expected) in fit.state.q.iter().zip(&q) {
        assert!(math::angle_between(math::wrap_angle(*found), *expected) < 1e-6);
    }
    // And by the way in for everybody, who begins where the target's torsions are.
    let found = with_defaults(&source, &target).expect("it is whole");
    assert!(found.ca_rmsd < 1e-6 && found.backbone_rmsd < 1e-6, "{found:?}");
    assert!(found.deviations.iter().all(|deviation| *deviation < 1e-6));
}

/// From torsions that are near, without copying those of the target.
#[test]
fn a_refit_goes_on_from_torsions_that_are_near() {
    let source = crooked(30, 4);
    let (q, target) = turned(&source, 1.0);
    let linkage = Linkage::of(&source).expect("it is whole");
    let (rules, weights) = (Rules::none(), Weights::default());
    let from = |start: &[f64]| refit_from(&source, &linkage, &target, start, &rules, &weights);
    let mut numbers = Numbers::new(11);
    let near: Vec<f64> = q.iter().map(|q| math::wrap_angle(q + 0.02 * numbers.normal())).collect();
    let found = from(&near).expect("it is whole");
    assert!(found.copied_rmsd > 0.1 && found.backbone_rmsd < 1e-6, "{found:?}");
    for (found, expected) in found.q.iter().zip(&q) {
        assert!(math::angle_between(*found, *expected) < 1e-6);
    }
    let nonsense = vec![f64::NAN; q.len()];
    for start in [&q[1..], &nonsense, &[]] {
        assert_eq!(from(start), Err(RefitError::OtherLinkage));
    }
}

#[test]
fn two_structures_of_different_bonds_come_near_to_each_other_the_same_way_each_time() {
    let source = crooked(20, 6);
    let (_, mut target) = turned(&source, 0.5);
    let mut numbers = Numbers::new(9);
    for atom in target.iter_mut().flat_map(|residue| &mut residue.atoms) {
        atom.position += 0.05 * Point::from_fn(|_, _| numbers.next() - 0.5);
    }
    let found = with_defaults(&source, &target).expect("it is whole");
    assert!(found.copied_rmsd > 2.0 * found.backbone_rmsd, "{found:?}");
    assert!(found.ca_rmsd < 0.1 && found.steps > 0, "{found:?}");
    assert_eq!(with_defaults(&source, &target), Ok(found));
}

#[test]
fn prolines_keep_phi_and_turned_peptides_are_named() {
    let mut source = crooked(12, 8);
    source[5].amino_acid = Some(AminoAcid::Proline);
    let linkage = Linkage::of(&source).expect("it is whole");
    let (_, mut target) = turned(&source, 0.2);
    target[5].amino_acid = Some(AminoAcid::Alanine);
    // Everything after a peptide bond is turned half about it.
    let at = |residue: usize, name: &str| target[residue].position(name).expect("it is there");
    let (c, n) = (at(7, "C"), at(8, "N"));
    let axis = (n - c).normalize();
    for atom in target[8..].iter_mut().flat_map(|residue| &mut residue.atoms) {
        let from = atom.position - n;
        atom.position = n + 2.0 * axis * axis.dot(&from) - from;
    }
    let found = with_defaults(&source, &target).expect("it is whole");
    assert_eq!(found.q.len(), linkage.torsions.len());
    assert_eq!(found.turned_peptides, [8]);
}

#[test]
fn what_cannot_be_fitted_is_refused_by_name() {
    let chain = crooked(6, 1);
    let refusal = |source: &[Residue], target: &[Residue]| {
        with_defaults(source, target).expect_err("it cannot be fitted").to_string()
    };
    assert_eq!(
        refusal(&chain, &chain[1..]),
        "the source has 6 residues and the target 5, where a refit needs residue for residue"
    );
    let mut lacking = chain.clone();
    lacking[3].atoms.retain(|atom| atom.name != "O");
    lacking[3].number = ResidueNumber { number: 52, insertion: Some('A') };
    assert!(refusal(&chain, &lacking).ends_with(
        "52A of the target has no atom O, where a refit needs N, CA, C and O of every residue"
    ));
    let mut strange = chain.clone();
    strange[2].atoms[0].position.x = f64::NAN;
    assert!(refusal(&chain, &strange).contains("of the target has"));
    strange[2].atoms[0].position = strange[2].atoms[1].position;
    assert!(refusal(&strange, &chain).contains("of the source has"));
    let long = Linkage::of(&crooked(9, 1)).expect("it is whole");
    let (rules, weights) = (Rules::default(), Weights::default());
    assert_eq!(refit(&chain, &long, &chain, &rules, &weights), Err(RefitError::OtherLinkage));
    assert_eq!(with_defaults(&[], &[]).map(|found| found.q), Ok(Vec::new()));
    // Coordinates beyond all measure end somewhere, and do not panic.
    let mut far = chain.clone();
    far[4].atoms[1].position.x = 1e300;
    let _ = (with_defaults(&chain, &far), with_defaults(&far, &chain));
}

/// Both ends of the two proteins whose ends the papers, or others, have joined. What is asked for is CA 0.15 Å; where the bonds of
/// the other end do not allow it (`docs/refit.md`), what they allow.
#[test]
fn both_ends_of_calmodulin_and_of_adenylate_kinase_fit_on_either_linkage() {
    let part = |name, numbers: std::ops::RangeInclusive<i32>| {
        let mut residues = read(name)?;
        residues.retain(|residue| numbers.contains(&residue.number.number));
        Some(residues)
    };
    let calmodulin = ["1CFD.pdb", "1CLL.pdb"].map(|name| part(name, 4..=147));
    let kinase = ["4AKE.pdb", "1AKE.pdb"].map(|name| part(name, 1..=214));
    for (ends, residues, ca_rmsd, bonds) in
        [(calmodulin, 144, [0.12, 0.17], [110, 101]), (kinase, 214, [0.15, 0.23], [159, 160])]
    {
        let [Some(first), Some(second)] = ends else { return };
        assert_eq!((first.len(), second.len()), (residues, residues));
        for (k, (source, target)) in [(&first, &second), (&second, &first)].into_iter().enumerate()
        {
            let found = with_defaults(source, target).expect("it is whole");
            assert!(found.copied_rmsd > 5.0);
            assert!(found.ca_rmsd < ca_rmsd[k], "CA {}", found.ca_rmsd);
            assert!(found.backbone_rmsd < 0.3, "N, CA, C, O {}", found.backbone_rmsd);
            assert_eq!(found.hydrogen_bonds, bonds[k]);
            assert!(found.kept() >= 0.95, "{:?}", found.lost_hydrogen_bonds);
            assert_eq!(found.new_clashes, []);
            assert_eq!(found.turned_peptides, []);
            let linkage = Linkage::of(source).expect("it is whole");
            let conformer = Conformer::of(source, &linkage).expect("it is whole");
            let mut placed = conformer.placed();
            conformer.place(&found.q, &mut placed);
            assert_eq!(Rules::default().first_violation(&placed), None);
            assert!(found.energy[1] < 1.35 * found.energy[0], "{:?}", found.energy);
        }
    }
}
