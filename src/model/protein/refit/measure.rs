//! How near a configuration is to the target, and what that costs.

use super::hydrogen_bonds::Bond;
use super::objective::{Objective, State};
use super::report::{Clash, Refit};
use crate::math;
use crate::model::protein::energy::{Constraint, Constraints};
use crate::model::protein::equations::{Exceptions, FITTED, Kind, Sites};
use crate::model::protein::kinematics::Conformer;
use crate::structure::Point;
use crate::structure::measure::{HydrogenBond, WEAKEST_HYDROGEN_BOND, superpose};
use crate::structure::torsion;
use std::f64::consts::FRAC_PI_2;

/// What is measured, and against what.
pub struct Measured<'a> {
    /// What was minimized.
    pub objective: &'a Objective<'a>,
    /// The chain of the source.
    pub conformer: &'a Conformer,
    /// The target's sites.
    pub target: &'a Sites,
    /// The chain of the target, and its torsions.
    pub target_conformer: (&'a Conformer, Vec<f64>),
    /// The target's hydrogen bonds.
    pub bonds: &'a [HydrogenBond],
}

impl Measured<'_> {
    /// Of these kinds, the positions of the refitted chain and of the target.
    fn pairs(&self, kinds: &[Kind], positions: &[Point]) -> (Vec<Point>, Vec<Point>) {
        let in_target = self.target.source();
        let of = |kind: &Kind| {
            let fitted = self.objective.sites.of_kind(*kind, positions);
            fitted.into_iter().zip(self.target.of_kind(*kind, &in_target))
        };
        kinds.iter().flat_map(of).unzip()
    }

    /// RMSD of N, CA, C and O after superposition, Å.
    pub fn backbone_rmsd(&self, q: &[f64]) -> f64 {
        let positions = self.objective.positions(&State::unposed(q.to_vec()));
        let (fitted, target) = self.pairs(&FITTED, &positions);
        superpose(&fitted, &target).rmsd
    }

    /// The residues the omega before which differs by more than a quarter of a turn.
    fn turned_peptides(&self) -> Vec<usize> {
        let omega = |sites: &Sites, residue: usize| {
            let at =
                |residue, kind| Some(sites.sites[sites.number(residue, kind)?].carried.position);
            let before = residue.checked_sub(1)?;
            let (a, b) = (at(before, Kind::AlphaCarbon)?, at(before, Kind::Carbon)?);
            let (c, d) = (at(residue, Kind::Nitrogen)?, at(residue, Kind::AlphaCarbon)?);
            Some(torsion(&a, &b, &c, &d))
        };
        let is_turned = |residue: &usize| {
            let source = omega(self.objective.sites, *residue);
            let angles = source.zip(omega(self.target, *residue));
            angles.is_some_and(|(a, b)| math::angle_between(a, b) > FRAC_PI_2)
        };
        (0..self.target.residues()).filter(is_turned).collect()
    }

    /// What violates the rules, and does not in the target.
    fn new_clashes(&self, positions: &[Point]) -> Vec<Clash> {
        let Objective { sites, contacts, exceptions, .. } = self.objective;
        let found = contacts.find(positions, 0.0, &Exceptions::new());
        let is_new = |pair: (usize, usize), least: f64| {
            exceptions.get(&pair).is_none_or(|in_target| *in_target >= least)
        };
        let end = |number: usize| (sites.sites[number].residue, sites.sites[number].kind);
        found
            .iter()
            .filter(|contact| is_new((contact.first, contact.second), contact.required))
            .map(|contact| {
                let ends = (end(contact.first), end(contact.second));
                Clash::of(ends.0, ends.1, contact.distance, contact.required)
            })
            .collect()
    }

    /// The energies of the constraints that the hydrogen bonds make, in the target and at a configuration.
    fn energies(&self, q: &[f64]) -> [f64; 2] {
        let has_sites = |bond: &&HydrogenBond| Bond::of(bond, self.objective.sites).is_some();
        let constraint = |bond: &HydrogenBond| Constraint::hydrogen_bond(bond.donor, bond.acceptor);
        let constraints = self.bonds.iter().filter(has_sites).map(constraint).collect();
        let constraints = Constraints::new(constraints);
        let (target, torsions) = &self.target_conformer;
        [(*target, torsions.as_slice()), (self.conformer, q)].map(|(conformer, q)| {
            let mut placed = conformer.placed();
            conformer.place(q, &mut placed);
            constraints.energy(&placed)
        })
    }

    /// The report on a configuration that so many steps have found from the copied one.
    pub fn refit(&self, copied: &[f64], q: Vec<f64>, steps: usize) -> Refit {
        let positions = self.objective.positions(&State::unposed(q.clone()));
        let (fitted, target) = self.pairs(&[Kind::AlphaCarbon], &positions);
        let laid = superpose(&fitted, &target);
        let distance = |(a, b): (&Point, &Point)| (laid.apply(a) - b).norm();
        let is_lost = |bond: &&HydrogenBond| {
            let sites = Bond::of(bond, self.objective.sites);
            sites.is_none_or(|sites| {
                let energy = sites.energy(&positions);
                energy.is_nan() || energy >= WEAKEST_HYDROGEN_BOND
            })
        };
        let lost = self.bonds.iter().filter(is_lost);
        Refit {
            copied_rmsd: self.backbone_rmsd(copied),
            ca_rmsd: laid.rmsd,
            backbone_rmsd: self.backbone_rmsd(&q),
            deviations: fitted.iter().zip(&target).map(distance).collect(),
            hydrogen_bonds: self.bonds.len(),
            lost_hydrogen_bonds: lost.map(|bond| (bond.donor, bond.acceptor)).collect(),
            energy: self.energies(&q),
            new_clashes: self.new_clashes(&positions),
            turned_peptides: self.turned_peptides(),
            steps,
            q,
        }
    }
}
