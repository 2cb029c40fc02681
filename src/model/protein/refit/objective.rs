//! What a refit minimizes, as a sum of squares of the configuration and of the chain's pose.
//!
//! The sum over atoms has a structure that makes its JᵀJ cheap. The entry for the torsions k and l, l the later one, is
//! Σ w (s_k at x)·(s_l at x) over the atoms after l: the mass matrix of the chain if its atoms had the weights as masses.
//! It is found as composite rigid bodies are (Walker & Orin 1982): the moments of all that is after l, applied to screw l,
//! are the wrench that is multiplied with every earlier screw. That takes 6 products per entry, however many atoms there are.

use super::contacts::{Contact, Contacts, Exceptions};
use super::hydrogen_bonds::Bond;
use super::jacobian::{Screw, distance_gradient, screws};
use super::least_squares::{NormalEquations, SumOfSquares};
use super::sites::Sites;
use crate::math;
use crate::model::protein::linkage::{Linkage, Motion};
use crate::structure::Point;
use nalgebra::{Matrix3, Unit};

/// The unknowns of the pose, which come before the torsions: a turn about the axes and a shift along them.
const POSE: usize = 6;

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

/// A site that is drawn to a position.
#[derive(Clone, Copy, Debug)]
pub struct Pull {
    /// The site.
    pub site: usize,
    /// The position, Å.
    pub to: Point,
    /// The weight of the squared distance.
    pub weight: f64,
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

/// The moments of weighted points: what makes wrenches of screws.
#[derive(Clone, Copy)]
struct Moments {
    weight: f64,
    first: Point,
    /// Σ w (|x|² I − x xᵀ).
    second: Matrix3<f64>,
    /// Σ w r and Σ w x × r, for residuals r.
    force: Point,
    torque: Point,
}

impl Moments {
    fn zero() -> Moments {
        let zero = Point::zeros();
        Moments { weight: 0.0, first: zero, second: Matrix3::zeros(), force: zero, torque: zero }
    }

    fn add(&mut self, weight: f64, x: &Point, residual: &Point) {
        let xx = Matrix3::new(
            x.y * x.y + x.z * x.z,
            -(x.x * x.y),
            -(x.x * x.z),
            -(x.x * x.y),
            x.x * x.x + x.z * x.z,
            -(x.y * x.z),
            -(x.x * x.z),
            -(x.y * x.z),
            x.x * x.x + x.y * x.y,
        );
        self.weight += weight;
        self.first += weight * x;
        self.second += weight * xx;
        self.force += weight * residual;
        self.torque += weight * x.cross(residual);
    }

    /// Σ w x × v and Σ w v for the velocities v of a screw.
    fn wrench(&self, screw: &Screw) -> (Point, Point) {
        let torque = self.second * screw.angular + self.first.cross(&screw.linear);
        let force = screw.angular.cross(&self.first) + self.weight * screw.linear;
        (torque, force)
    }
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

    /// The part of the equations that draws sites to the target.
    fn add_pulls(&self, equations: &mut NormalEquations, columns: &[Screw], positions: &[Point]) {
        let mut of_body = vec![Moments::zero(); columns.len() - POSE + 1];
        for pull in &self.pulls {
            let x = &positions[pull.site];
            let body = self.sites.body(pull.site);
            of_body[body].add(pull.weight, x, &(x - pull.to));
        }
        let mut after = Moments::zero();
        // Torsion k, column k + 6, moves the bodies from k + 1 on. The pose's columns move all: the last of them comes upon
        // body 0, and the others upon no more.
        for last in (0..columns.len()).rev() {
            if let Some(body) = (last + 1).checked_sub(POSE) {
                let body = &of_body[body];
                after.weight += body.weight;
                after.first += body.first;
                after.second += body.second;
                after.force += body.force;
                after.torque += body.torque;
            }
            let screw = &columns[last];
            let (torque, force) = after.wrench(screw);
            equations.gradient[last] +=
                screw.angular.dot(&after.torque) + screw.linear.dot(&after.force);
            for (first, screw) in columns[..=last].iter().enumerate() {
                equations.matrix.row_mut(first)[last - first] +=
                    screw.angular.dot(&torque) + screw.linear.dot(&force);
            }
        }
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
        let (zero, axes) = (Point::zeros(), [Point::x(), Point::y(), Point::z()]);
        let columns: Vec<Screw> = axes
            .iter()
            .map(|axis| Screw { angular: *axis, linear: zero })
            .chain(axes.iter().map(|axis| Screw { angular: zero, linear: *axis }))
            .chain(torsions.iter().copied())
            .collect();
        let mut equations = NormalEquations::zeros(columns.len());
        self.add_pulls(&mut equations, &columns, &positions);
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
