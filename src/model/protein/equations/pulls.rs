//! Sites that are drawn to positions: their part of the normal equations.
//!
//! A sum of squares over atoms has a structure that makes its JᵀJ cheap. The entry for the torsions k and l, l the later one,
//! is Σ w (s_k at x)·(s_l at x) over the atoms after l: the mass matrix of the chain if its atoms had the weights as masses.
//! It is found as composite rigid bodies are (Walker & Orin 1982): the moments of all that is after l, applied to screw l,
//! are the wrench that is multiplied with every earlier screw. That takes 6 products per entry, however many atoms there are.

use super::normal::NormalEquations;
use super::screws::Screw;
use super::sites::Sites;
use crate::structure::Point;
use nalgebra::Matrix3;

/// The unknowns of the pose, which come before the torsions: a turn about the axes and a shift along them.
pub const POSE: usize = 6;

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

/// The columns of the equations: those of the pose, then those of the torsions' screws.
pub fn columns(torsions: &[Screw]) -> Vec<Screw> {
    let (zero, axes) = (Point::zeros(), [Point::x(), Point::y(), Point::z()]);
    axes.iter()
        .map(|axis| Screw { angular: *axis, linear: zero })
        .chain(axes.iter().map(|axis| Screw { angular: zero, linear: *axis }))
        .chain(torsions.iter().copied())
        .collect()
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

/// Adds the part of the equations that draws sites to positions. `columns` are those of [`columns`], and `positions` are the
/// sites' where these columns are.
pub fn add_pulls(
    equations: &mut NormalEquations,
    columns: &[Screw],
    (pulls, sites): (&[Pull], &Sites),
    positions: &[Point],
) {
    let mut of_body = vec![Moments::zero(); columns.len() - POSE + 1];
    for pull in pulls {
        let x = &positions[pull.site];
        let body = sites.body(pull.site);
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
