//! Two ends on one linkage: the configuration of one structure's linkage that comes nearest to another structure.
//!
//! Two structures of a protein differ not only in phi and psi but also in bond lengths, bond angles and omega, which a
//! linkage takes from its source. Each of these differences is small, but along a chain they add up: with the target's phi
//! and psi copied, the end of the chain is far from where it ought to be. The refit lets all torsions give a little, so that
//! every atom comes near to its place.
//!
//! **Method.** Least squares by Levenberg and Marquardt with the analytic Jacobian (`equations/`, `objective.rs`), from
//! the copied torsions:
//!
//! 1. The first residues of the chain are fitted, then ever more of them, until it is the whole chain. So the fit
//!    is never far off, and does not end in a configuration where a peptide is turned the wrong way.
//! 2. The whole chain is fitted, N, CA, C and O alike.
//! 3. The final sum: CA count most, and there are terms for the target's hydrogen bonds, their lengths and their energies,
//!    and for pairs that are nearer than the rules allow. Both are zero where the target itself is.
//! 4. While a hydrogen bond is lost, a pair is too near or N, C and O are too far from the target's, the weights of these
//!    are raised, a few times.
//!
//! There is no chance in it, and all sums have one order: the same structures give the same bits.
//!
//! Prolines keep the source's phi, all residues the source's omega; the first residue has no phi and the last no psi. So the
//! last residue's O, which psi would place, stays as it is in the source; it is not fitted, but it counts in the RMSD.

mod error;
mod hydrogen_bonds;
mod least_squares;
mod measure;
mod objective;
mod report;

#[cfg(test)]
mod tests;

pub use error::RefitError;
pub use report::{Clash, End, Refit};

use super::atoms::ResidueAtoms;
use super::equations::{Contacts, Exceptions, FITTED, Kind, Pull, Sites};
use super::kinematics::Conformer;
use super::linkage::{Linkage, Motion, Torsion};
use super::validity::Rules;
use crate::math;
use crate::structure::measure::{WEAKEST_HYDROGEN_BOND, centroid, hydrogen_bonds, superpose};
use crate::structure::{Point, Residue};
use hydrogen_bonds::Bond;
use least_squares::{Stop, minimize};
use measure::Measured;
use objective::{Kept, Objective, State};

/// The weights of the squares in the final sum, and what terms hold back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Of the distance of each CA from the target's, per Å².
    pub alpha_carbon: f64,
    /// Of the distances of N, C and O, per Å²; raised where these are farther than `backbone_rmsd`.
    pub backbone: f64,
    /// The RMSD of N, CA, C and O that is aimed at, Å.
    pub backbone_rmsd: f64,
    /// Of the difference of H···O in each hydrogen bond from the target's, per Å².
    pub bond_length: f64,
    /// Of the excess of each hydrogen bond's energy over −0.52 kcal/mol, or over what it has in the target if that is more;
    /// per (kcal/mol)².
    pub bond_energy: f64,
    /// Of what each pair lacks of its least distance and 0.05 Å, or of what it has in the target if that is less; per Å².
    pub contact: f64,
}

impl Default for Weights {
    fn default() -> Weights {
        Weights {
            alpha_carbon: 1.0,
            backbone: 0.04,
            backbone_rmsd: 0.3,
            bond_length: 0.02,
            bond_energy: 3.0,
            contact: 10.0,
        }
    }
}

/// How far below the limit the energies of hydrogen bonds are to be, kcal/mol.
const ENERGY_MARGIN: f64 = 0.02;

/// How far above their limits distances are to be, Å.
const DISTANCE_MARGIN: f64 = 0.05;

/// The residues by which the fitted part of a chain grows: this many, or as many as make it whole in 64 turns.
const GROWTH: usize = 4;
const TURNS: usize = 64;

/// When a part of the chain is near enough for the next residues.
const OF_PARTS: Stop = Stop { steps: 30, decrease: 1e-2 };

/// When the whole chain is as near as it gets.
const OF_WHOLE: Stop = Stop { steps: 200, decrease: 1e-6 };

/// The longest chains that are fitted, residues: the matrix of twice as many torsions takes 288 MB.
const RESIDUES_MAX: usize = 3_000;

/// How often weights are raised, and by which factors: those of what is lost or too near, and that of N, C and O.
const RAISES: usize = 5;
const RAISE: f64 = 4.0;
const RAISE_OF_BACKBONE: f64 = 1.5;

/// Fits the linkage of the source to the target, residue for residue. Which end's bonds are kept is the caller's choice: call
/// it with the roles exchanged for the other.
///
/// # Errors
///
/// If the chains are not equally long, or longer than 3000 residues, if a residue lacks one of N, CA, C and O, if atoms stand on one another, or if
/// the linkage is not that of the source.
pub fn refit(
    source: &[Residue],
    linkage: &Linkage,
    target: &[Residue],
    rules: &Rules,
    weights: &Weights,
) -> Result<Refit, RefitError> {
    fit((source, linkage), target, None, rules, weights)
}

/// As [`refit`], from torsions that are near already instead of the copied ones, in radians: the whole chain is fitted at once.
/// So a series of targets, each near the one before, becomes a series of configurations of which each is near the one before.
/// [`Refit::copied_rmsd`] is that of `start`.
///
/// # Errors
///
/// As [`refit`], and if `start` has not as many torsions as the linkage, or numbers that are not finite.
pub fn refit_from(
    source: &[Residue],
    linkage: &Linkage,
    target: &[Residue],
    start: &[f64],
    rules: &Rules,
    weights: &Weights,
) -> Result<Refit, RefitError> {
    let is_of_linkage = start.len() == linkage.torsions.len();
    if !is_of_linkage || !start.iter().all(|value| value.is_finite()) {
        return Err(RefitError::OtherLinkage);
    }
    fit((source, linkage), target, Some(start), rules, weights)
}

/// Fits from torsions that are near, or from the copied ones.
fn fit(
    (source, linkage): (&[Residue], &Linkage),
    target: &[Residue],
    start: Option<&[f64]>,
    rules: &Rules,
    weights: &Weights,
) -> Result<Refit, RefitError> {
    if source.len() != target.len() {
        let (source_len, target_len) = (source.len(), target.len());
        return Err(RefitError::Lengths { source_len, target_len });
    }
    if source.len() > RESIDUES_MAX {
        return Err(RefitError::TooLong { residues: source.len(), max: RESIDUES_MAX });
    }
    let source_atoms = atoms(source, End::Source)?;
    let target_atoms = atoms(target, End::Target)?;
    let target_linkage = Linkage::of(target).ok_or(RefitError::NoBackbone(End::Target))?;
    if linkage.torsions.iter().any(|torsion| torsion.residue >= source.len()) {
        return Err(RefitError::OtherLinkage);
    }
    let sites = Sites::of(&source_atoms, linkage);
    let contacts = Contacts::of(rules.at_nodes(), &sites);
    let target_sites = Sites::of(&target_atoms, &target_linkage);
    let exceptions = exceptions(&sites, &target_sites, rules);
    let bonds = hydrogen_bonds(target);
    let target_positions = target_sites.source();
    let kept = bonds.iter().filter_map(|bond| {
        let in_target = Bond::of(bond, &target_sites)?;
        Some(Kept {
            bond: Bond::of(bond, &sites)?,
            length: in_target.length(&target_positions),
            length_weight: 0.0,
            highest: bond.energy_kcal.max(WEAKEST_HYDROGEN_BOND - ENERGY_MARGIN),
            energy_weight: 0.0,
        })
    });
    let mut objective = Objective {
        linkage,
        sites: &sites,
        pulls: Vec::new(),
        bonds: kept.collect(),
        contacts: &contacts,
        exceptions: &exceptions,
        margin: DISTANCE_MARGIN,
        contact_weight: 0.0,
    };
    let first = start.map_or_else(|| copied(linkage, &target_linkage), <[f64]>::to_vec);
    let pulls = pulls(&sites, &target_sites);
    let mut fit = Fit { state: State::unposed(first.clone()), steps: 0 };
    match start {
        None => fit.grow(&mut objective, &pulls),
        Some(_) => fit.lay(&objective, &pulls),
    }
    fit.whole(&mut objective, &pulls, weights);
    let q: Vec<f64> = fit.state.q.iter().map(|angle| math::wrap_angle(*angle)).collect();
    let conformer = Conformer::of(source, linkage).ok_or(RefitError::NoBackbone(End::Source))?;
    let target_conformer =
        Conformer::of(target, &target_linkage).ok_or(RefitError::NoBackbone(End::Target))?;
    let measured = Measured {
        objective: &objective,
        conformer: &conformer,
        target: &target_sites,
        target_conformer: (&target_conformer, target_linkage.source()),
        bonds: &bonds,
    };
    Ok(measured.refit(&first, q, fit.steps))
}

/// The atoms of a chain.
fn atoms(residues: &[Residue], end: End) -> Result<Vec<ResidueAtoms>, RefitError> {
    for residue in residues {
        for kind in FITTED {
            let atom = kind.name();
            let position = residue.position(atom).ok_or_else(|| RefitError::NoAtom {
                end,
                residue: residue.to_string(),
                atom,
            })?;
            if !position.iter().all(|coordinate| coordinate.is_finite()) {
                return Err(RefitError::NoBackbone(end));
            }
        }
    }
    ResidueAtoms::of(residues).ok_or(RefitError::NoBackbone(end))
}

/// The target's torsions on the linkage; the source's where the target has none.
fn copied(linkage: &Linkage, target: &Linkage) -> Vec<f64> {
    let value = |torsion: &Torsion| {
        let same = target
            .torsions
            .binary_search_by_key(&(torsion.residue, torsion.kind as usize), |other| {
                (other.residue, other.kind as usize)
            });
        same.map_or(torsion.source, |index| target.torsions[index].source)
    };
    linkage.torsions.iter().map(value).collect()
}

/// What draws N, CA, C and O to where the target has them, with weight 1, or 0 for the last O, which no psi places. The target
/// is moved so that its centroid is the origin, about which poses turn.
fn pulls(sites: &Sites, target: &Sites) -> Vec<Pull> {
    let positions = target.source();
    let center = centroid(&target.of_kind(Kind::AlphaCarbon, &positions));
    let last = sites.residues().saturating_sub(1);
    let of = |residue: usize, kind: Kind| {
        let to = positions[target.number(residue, kind)?] - center;
        let weight = if residue == last && kind == Kind::Oxygen { 0.0 } else { 1.0 };
        Some(Pull { site: sites.number(residue, kind)?, to, weight })
    };
    let residues = 0..sites.residues();
    residues.flat_map(|residue| FITTED.map(|kind| of(residue, kind))).flatten().collect()
}

/// The pairs that are nearer in the target than their limit and the margin, with the distance that they have there.
fn exceptions(sites: &Sites, target: &Sites, rules: &Rules) -> Exceptions {
    let found = Contacts::of(rules.at_nodes(), target).find(
        &target.source(),
        DISTANCE_MARGIN,
        &Exceptions::new(),
    );
    let same = |number: usize| {
        let site = &target.sites[number];
        sites.number(site.residue, site.kind)
    };
    found
        .iter()
        .filter_map(|contact| {
            Some(((same(contact.first)?, same(contact.second)?), contact.distance))
        })
        .collect()
}

/// A fit on its way.
struct Fit {
    state: State,
    steps: usize,
}

impl Fit {
    fn minimize(&mut self, objective: &Objective, stop: Stop) {
        let minimum = minimize(objective, self.state.clone(), stop);
        self.state = minimum.state;
        self.steps += minimum.steps;
    }

    /// Lays the chain upon what these draw to.
    fn lay(&mut self, objective: &Objective, pulls: &[Pull]) {
        let positions = objective.positions(&self.state);
        let (from, to): (Vec<Point>, Vec<Point>) =
            pulls.iter().map(|pull| (positions[pull.site], pull.to)).unzip();
        let laid = superpose(&from, &to);
        self.state.pose = Motion { rotation: laid.rotation, translation: laid.translation };
    }

    /// Fits the first residues, then ever more of them.
    fn grow(&mut self, objective: &mut Objective, pulls: &[Pull]) {
        let residues = objective.sites.residues();
        let growth = GROWTH.max(residues.div_ceil(TURNS));
        let mut end = growth.min(residues);
        let reached = |end: usize| {
            let of = |pull: &&Pull| objective.sites.sites[pull.site].residue < end;
            pulls.iter().filter(of).copied().collect::<Vec<Pull>>()
        };
        self.lay(objective, &reached(end));
        while end < residues {
            let pulls = reached(end);
            self.minimize(&Objective { pulls, ..objective.clone() }, OF_PARTS);
            end += growth;
        }
    }

    /// Fits the whole chain.
    fn whole(&mut self, objective: &mut Objective, pulls: &[Pull], weights: &Weights) {
        objective.pulls = pulls.to_vec();
        self.minimize(objective, OF_WHOLE);
        let is_center = |pull: &Pull| objective.sites.sites[pull.site].kind == Kind::AlphaCarbon;
        for pull in &mut objective.pulls {
            pull.weight *= if is_center(pull) { weights.alpha_carbon } else { weights.backbone };
        }
        for kept in &mut objective.bonds {
            kept.length_weight = weights.bond_length;
            kept.energy_weight = weights.bond_energy;
        }
        objective.contact_weight = weights.contact;
        self.minimize(objective, OF_WHOLE);
        for _ in 0..RAISES {
            let positions = objective.positions(&self.state);
            let mut is_raised = false;
            for kept in &mut objective.bonds {
                if kept.bond.energy(&positions) >= WEAKEST_HYDROGEN_BOND {
                    kept.energy_weight *= RAISE;
                    is_raised = true;
                }
            }
            if !objective.contacts.find(&positions, 0.0, objective.exceptions).is_empty() {
                objective.contact_weight *= RAISE;
                is_raised = true;
            }
            let squares = |sum, pull: &Pull| sum + (positions[pull.site] - pull.to).norm_squared();
            let mean = objective.pulls.iter().fold(0.0, squares) / objective.pulls.len() as f64;
            if mean > weights.backbone_rmsd * weights.backbone_rmsd {
                let others = objective.pulls.iter_mut().filter(|pull| !is_center(pull));
                others.for_each(|pull| pull.weight *= RAISE_OF_BACKBONE);
                is_raised = true;
            }
            if !is_raised {
                break;
            }
            self.minimize(objective, OF_WHOLE);
        }
    }
}
