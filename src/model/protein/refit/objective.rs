//! What a refit minimizes, as a sum of squares of the configuration and of the chain's pose.
//!
//! The parts of its JᵀJ are in `equations/`.

use super::hydrogen_bonds::Bond;
use super::least_squares::SumOfSquares;
use crate::math;
use crate::model::protein::equations::{
    Contact, Contacts, Exceptions, NormalEquations, POSE, Pull, Sites, add_pulls, columns,
    distance_gradient, screws,
};
use crate::model::protein::linkage::{Linkage, Motion};
use crate::structure::Point;
use nalgebra::{Matrix3, Unit};

/// A configuration, and the pose of body 0 in the target's frame.
#[derive(Clone, Debug)]
pub struct State {
    /// The torsions in radians.
    pub q: Vec<f64>,
    /// Where body 0 is.
    pub pose: Motion,
}

impl State {
    /// A configuration with body 0 where it is in the source.
    pub fn unposed(q: Vec<f64>) -> State {
        let pose = Motion { rotation: Matrix3::identity(), translation: Point::zeros() };
        State { q, pose }
    }
}

/// A hydrogen bond that is to be kept.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    /// The bond.
    pub bond: Bond,
    /// H···O in the target, Å.
    pub length: f64,
    /// The weight of the squared difference from it.
    pub length_weight: f64,
    /// What its energy is to be at most, kcal/mol.
    pub highest: f64,
    /// The weight of the squared excess of its energy over that.
    pub energy_weight: f64,
}

impl Kept {
    /// The excess of its energy, at least 0.
    fn excess(&self, positions: &[Point]) -> f64 {
        (self.bond.energy(positions) - self.highest).max(0.0)
    }
}

/// The sum of squares.
#[derive(Clone, Debug)]
pub struct Objective<'a> {
    /// The linkage.
    pub linkage: &'a Linkage,
    /// Its sites.
    pub sites: &'a Sites,
    /// What draws them to the target.
    pub pulls: Vec<Pull>,
    /// The hydrogen bonds.
    pub bonds: Vec<Kept>,
    /// What finds pairs that are too near.
    pub contacts: &'a Contacts<'a>,
    /// Pairs that are held to other distances.
    pub exceptions: &'a Exceptions,
    /// How far above its limit a distance is to be, Å.
    pub margin: f64,
    /// The weight of the squared lack of distance; 0 for none.
    pub contact_weight: f64,
}

impl Objective<'_> {
    /// The motions of all bodies at a state, in the target's frame.
    pub fn motions(&self, state: &State) -> Vec<Motion> {
        let posed = |motion: Motion| Motion {
            rotation: state.pose.rotation * motion.rotation,
            translation: state.pose.rotation * motion.translation + state.pose.translation,
        };
        self.linkage.motions(&state.q).into_iter().map(posed).collect()
    }

    /// Where the sites are at a state.
    pub fn positions(&self, state: &State) -> Vec<Point> {
        self.sites.place(&self.motions(state))
    }

    /// The pairs that are too near, if any count.
    fn too_near(&self, positions: &[Point]) -> Vec<Contact> {
        if self.contact_weight == 0.0 {
            return Vec::new();
        }
        self.contacts.find(positions, self.margin, self.exceptions)
    }
}

/// A turn about an axis through the origin by an angle in radians; no turn where the vector is zero.
fn turn(vector: &Point) -> Matrix3<f64> {
    let angle = vector.norm();
    let Some(axis) = Unit::try_new(*vector, 0.0) else { return Matrix3::identity() };
    let (sin, cos) = (math::sin(angle), math::cos(angle));
    let cross = axis.cross_matrix();
    Matrix3::identity() + sin * cross + (1.0 - cos) * (cross * cross)
}

impl SumOfSquares for Objective<'_> {
    type State = State;

    fn cost(&self, state: &State) -> f64 {
        let positions = self.positions(state);
        let mut sum = 0.0;
        for pull in &self.pulls {
            sum += pull.weight * (positions[pull.site] - pull.to).norm_squared();
        }
        for kept in &self.bonds {
            let stretch = kept.bond.length(&positions) - kept.length;
            let excess = kept.excess(&positions);
            sum += kept.length_weight * stretch * stretch + kept.energy_weight * excess * excess;
        }
        for contact in self.too_near(&positions) {
            let lack = contact.required - contact.distance;
            sum += self.contact_weight * lack * lack;
        }
        0.5 * sum
    }

    fn normal_equations(&self, state: &State) -> NormalEquations {
        let motions = self.motions(state);
        let positions = self.sites.place(&motions);
        let torsions = screws(self.linkage, &motions);
        let columns = columns(&torsions);
        let mut equations = NormalEquations::zeros(columns.len());
        add_pulls(&mut equations, &columns, (&self.pulls, self.sites), &positions);
        // A pair of sites: a residual of its distance, by the slope and the root of its weight.
        let mut add_distance = |a: usize, b: usize, weight: f64, residual: f64| {
            let (a, b) = if self.sites.body(a) <= self.sites.body(b) { (a, b) } else { (b, a) };
            let bodies = (self.sites.body(a), self.sites.body(b));
            let root = weight.sqrt();
            let row: Vec<f64> = distance_gradient(&torsions, bodies, &positions[a], &positions[b])
                .map(|slope| root * slope)
                .collect();
            equations.add(POSE + bodies.0, &row, root * residual);
        };
        for kept in &self.bonds {
            let stretch = kept.bond.length(&positions) - kept.length;
            add_distance(kept.bond.hydrogen, kept.bond.oxygen, kept.length_weight, stretch);
        }
        for contact in self.too_near(&positions) {
            let lack = contact.distance - contact.required;
            add_distance(contact.first, contact.second, self.contact_weight, lack);
        }
        for kept in &self.bonds {
            let excess = kept.excess(&positions);
            if excess > 0.0 && kept.energy_weight > 0.0 {
                let root = kept.energy_weight.sqrt();
                let mut row = kept.bond.energy_gradient(self.sites, &torsions, &positions);
                row.iter_mut().for_each(|slope| *slope *= root);
                let (least, _) = kept.bond.bodies(self.sites);
                equations.add(POSE + least, &row, root * excess);
            }
        }
        equations
    }

    fn after(&self, state: &State, step: &[f64]) -> State {
        let turn = turn(&Point::new(step[0], step[1], step[2]));
        let shift = Point::new(step[3], step[4], step[5]);
        State {
            q: state.q.iter().zip(&step[POSE..]).map(|(value, step)| value + step).collect(),
            pose: Motion {
                rotation: turn * state.pose.rotation,
                translation: turn * state.pose.translation + shift,
            },
        }
    }
}
