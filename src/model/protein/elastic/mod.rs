//! A chain as an elastic network about a conformation: which steps of the torsions keep what is near one another.
//!
//! Springs join pairs of sites (`springs.rs`). With J the derivatives of their lengths by the torsions and K their stiffnesses,
//! H = Jᵀ K J + ρ I is what a small step costs to second order, in kT. A thermal step has the covariance H⁻¹: it goes far where
//! the network is soft and hardly moves what the springs hold (M. M. Tirion, Phys. Rev. Lett. 77, 1996, for Cartesian
//! coordinates; torsions: F. Tama, D. Perahia, N. Go et al.). It costs one factorization H = Uᵀ U and then, for each step, the solution of U δ = z
//! with normal deviates z. A step toward another shape adds squares of distances from it, and solves one system.
//!
//! The steps are linear in torsions, so that no bond is stretched, and finite: they are scaled until the Cα have moved
//! as far as is asked.

mod springs;

#[cfg(test)]
mod tests;

pub(super) use springs::Springs;

use super::equations::{
    Factor, Kind, Line, NormalEquations, POSE, Pull, Screw, Sites, add_lines, add_pulls, columns,
    screws,
};
use super::kinematics::Conformer;
use super::linkage::Linkage;
use super::placed::{Placed, Site};
use crate::math;
use crate::model::{Draw, Elastic};
use crate::structure::Point;
use crate::structure::measure::{CentredPoints, superpose};
use springs::Spring;
use std::cell::RefCell;

/// ρ, per rad²: torsions that nothing holds turn by about half a radian. Held less, loose ends and single hinges take all of a step,
/// and fewer steps are valid.
const FREE_TORSION: f64 = 4.0;

/// What holds the pose where nothing is drawn, so that the equations have a solution; the pose is not part of a step.
const FREE_POSE: f64 = 1e-6;

/// How strongly a torsion is drawn, per rad², where its residue's Cα is drawn with 1 kT/Å²: so little that it decides where
/// positions leave a choice.
const OF_TORSIONS: f64 = 2.0;

/// How near a step's length comes to what is asked, as a share of it, and how often it is scaled at most.
const LENGTH_TOLERANCE: f64 = 0.02;
const SCALINGS: usize = 8;

/// By how much a step grows at most from one try to the next.
const SCALING_MAX: f64 = 10.0;

/// No step turns a torsion by more than this, radians: beyond it what was near one another says little. The torsions of loose ends, which
/// nothing holds, come to it first, and the others go on.
const TURN_MAX: f64 = 1.0;

/// No torsion turns by more than this only to relax springs, radians.
const RELAXED_MAX: f64 = 0.2;

/// What does not depend on the conformation.
#[derive(Clone, Debug)]
pub(super) struct Network {
    linkage: Linkage,
    sites: Sites,
    alphas: Vec<usize>,
    springs: Springs,
    /// Places the chain faster than the motions of bodies do.
    conformer: Conformer,
}

impl Network {
    /// Of a chain whose sites are these.
    pub fn new(linkage: Linkage, sites: Sites, springs: Springs, conformer: Conformer) -> Network {
        let alpha =
            |residue| sites.number(residue, Kind::AlphaCarbon).expect("every residue has one");
        let alphas = (0..sites.residues()).map(alpha).collect();
        Network { linkage, sites, alphas, springs, conformer }
    }

    /// The network about a configuration.
    pub fn about(&self, q: &[f64]) -> About<'_> {
        let motions = self.linkage.motions(q);
        let positions = self.sites.place(&motions);
        let torsions = screws(&self.linkage, &motions);
        let columns = columns(&torsions);
        let mut equations = NormalEquations::zeros(columns.len());
        for column in 0..columns.len() {
            let ridge = if column < POSE { FREE_POSE } else { FREE_TORSION };
            equations.matrix.row_mut(column)[0] += ridge;
        }
        let line = |spring: Spring| {
            let Spring { first, second, stiffness, force } = spring;
            let is_ordered = self.sites.body(first) <= self.sites.body(second);
            let (a, b) = if is_ordered { (first, second) } else { (second, first) };
            let bodies = (self.sites.body(a), self.sites.body(b));
            Line { bodies, ends: [positions[a], positions[b]], stiffness, force }
        };
        let springs = self.springs.about(&self.sites, &positions).into_iter();
        add_lines(&mut equations, &torsions, &springs.map(line).collect::<Vec<_>>());
        let shape = CentredPoints::new(&self.alphas(&positions));
        let placed = RefCell::new(self.conformer.placed());
        About { network: self, q: q.to_vec(), positions, columns, equations, shape, placed }
    }

    fn alphas(&self, positions: &[Point]) -> Vec<Point> {
        self.alphas.iter().map(|site| positions[*site]).collect()
    }
}

/// The network about a configuration.
pub(super) struct About<'a> {
    network: &'a Network,
    q: Vec<f64>,
    positions: Vec<Point>,
    columns: Vec<Screw>,
    /// What the springs and free torsions come to.
    equations: NormalEquations,
    shape: CentredPoints,
    /// A conformation to be placed.
    placed: RefCell<Placed>,
}

impl About<'_> {
    /// Where the Cα are at a configuration.
    fn alphas_at(&self, q: &[f64]) -> Vec<Point> {
        let mut placed = self.placed.borrow_mut();
        self.network.conformer.place(q, &mut placed);
        (0..placed.len()).map(|residue| placed.at(Site::CA, residue)).collect()
    }

    /// The configuration a step away, and how far its shape is from here, Å.
    fn after(&self, step: impl Fn(usize) -> f64) -> (Vec<f64>, f64) {
        let turned = |(k, value): (usize, &f64)| math::wrap_angle(value + step(k));
        let q: Vec<f64> = self.q.iter().enumerate().map(turned).collect();
        let length = CentredPoints::new(&self.alphas_at(&q)).rmsd(&self.shape);
        (q, length)
    }

    /// The configuration a step away whose shape is `length` from here, about: the step is `first`, and then so much of `more`
    /// as is needed, no torsion turning by more than [`TURN_MAX`]. Where that is bounded, it is at most once `more`. `first` is kept
    /// whole, since a spring that is relaxed by half only still pulls: where it alone leads farther than `length`, hardly anything
    /// of `more` is added, and the step is longer than is asked.
    fn scaled(
        &self,
        first: &[f64],
        more: &[f64],
        length: f64,
        is_bounded: bool,
    ) -> Option<Vec<f64>> {
        if !more.iter().any(|turn| *turn != 0.0) {
            return None;
        }
        let mut scale = 1.0;
        for last in [false; SCALINGS].into_iter().chain([true]) {
            let turn = |k: usize| (first[k] + scale * more[k]).clamp(-TURN_MAX, TURN_MAX);
            let (q, reached) = self.after(turn);
            let is_enough = (reached - length).abs() <= LENGTH_TOLERANCE * length;
            let is_all = is_bounded && scale >= 1.0 && reached <= length;
            if is_enough || is_all || last {
                return reached.is_finite().then_some(q);
            }
            // The length is nearly proportional to the scale.
            let factor = length / reached;
            if !factor.is_finite() {
                return None;
            }
            scale *= factor.min(SCALING_MAX);
            if is_bounded {
                scale = f64::min(scale, 1.0);
            }
        }
        None
    }
}

/// A network with what its steps have in common.
pub(super) struct Prepared<'a> {
    about: About<'a>,
    factor: Option<Factor>,
    /// The step that relaxes the springs.
    relaxing: Vec<f64>,
}

impl<'a> Prepared<'a> {
    /// Of a network.
    pub fn of(about: About<'a>) -> Prepared<'a> {
        let factor = about.equations.matrix.clone().factor();
        let downhill: Vec<f64> = about.equations.gradient.iter().map(|slope| -slope).collect();
        let solved = factor.as_ref().and_then(|factor| factor.solve(&downhill));
        let mut relaxing = solved.map_or(vec![0.0; about.q.len()], |step| step[POSE..].to_vec());
        let widest = relaxing.iter().fold(0.0f64, |widest, turn| widest.max(turn.abs()));
        if widest > RELAXED_MAX {
            relaxing.iter_mut().for_each(|turn| *turn *= RELAXED_MAX / widest);
        }
        Prepared { about, factor, relaxing }
    }
}

impl Elastic for Prepared<'_> {
    fn random(&self, deviates: &[f64], length: f64) -> Option<Vec<f64>> {
        if deviates.len() != self.about.q.len() {
            return None;
        }
        let mut y = vec![0.0; POSE];
        y.extend(deviates);
        let step = self.factor.as_ref()?.solve_upper(y)?;
        self.about.scaled(&self.relaxing, &step[POSE..], length, false)
    }

    fn toward(&self, draw: &Draw, length: f64) -> Option<Vec<f64>> {
        let About { network, positions, columns, equations, q, .. } = &self.about;
        let (alphas, drawn) = (&network.alphas, &draw.residues);
        if draw.target.len() != q.len() || drawn.start >= drawn.end || drawn.end > alphas.len() {
            return None;
        }
        let target = self.about.alphas_at(draw.target);
        let is_whole = drawn.len() == alphas.len();
        let laid_by = || (0..alphas.len()).filter(|at| is_whole || !drawn.contains(at));
        let from: Vec<Point> = laid_by().map(|at| target[at]).collect();
        let to: Vec<Point> = laid_by().map(|at| positions[alphas[at]]).collect();
        let laid = superpose(&from, &to);
        let pull = |(at, site): (usize, &usize)| {
            let there =
                if drawn.contains(&at) { laid.apply(&target[at]) } else { positions[*site] };
            Pull { site: *site, to: there, weight: draw.strength }
        };
        let pulls: Vec<Pull> = alphas.iter().enumerate().map(pull).collect();
        let mut equations = equations.clone();
        add_pulls(&mut equations, columns, (&pulls, &network.sites), positions);
        for (k, torsion) in network.linkage.torsions.iter().enumerate() {
            if drawn.contains(&torsion.residue) {
                let weight = OF_TORSIONS * draw.strength;
                equations.matrix.row_mut(POSE + k)[0] += weight;
                let turn = math::wrap_angle(draw.target[k] - q[k]);
                equations.gradient[POSE + k] -= weight * turn;
            }
        }
        let downhill: Vec<f64> = equations.gradient.iter().map(|slope| -slope).collect();
        let step = equations.matrix.solve(&downhill)?;
        self.about.scaled(&vec![0.0; q.len()], &step[POSE..], length, true)
    }
}
