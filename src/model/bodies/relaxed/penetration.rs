//! Bodies that may overlap as far as a short motion would free them.

use crate::model::bodies::BodyValidity;
use crate::model::bodies::validity::MotionChecking;
use crate::model::relaxation::{CannotRelax, Penetration};
use crate::model::{Cost, Model, Reason, Scratch, Validity};
use crate::space::{FactorKind, Space};

/// At which shares of the depth a valid configuration is looked for.
const SHARES: [f64; 2] = [0.5, 1.0];

/// What is promised of motions at a level.
///
/// # Errors
/// A motion of the depth leads from anywhere to anywhere, so that nearly everything would be valid.
pub(super) fn allowed(
    asked: &Penetration,
    level: f64,
    space: &Space,
) -> Result<MotionChecking, CannotRelax> {
    let (depth, farthest) = (asked.depth, space.diameter());
    // Written so that NaN fails it.
    if depth < farthest {
        return Ok(MotionChecking::Penetrating { depth: depth * (1.0 - level) });
    }
    let expected = format!("less than the largest distance in the space, {farthest}, expected");
    Err(CannotRelax::new("depth", format!("{depth} found; {expected}")))
}

/// Bodies among which a configuration is valid, too, that is near a valid one.
///
/// *What is valid.* A configuration within the bounds from which one of some fixed motions leads to a configuration that is valid for the
/// bodies themselves: half the depth and the whole depth, by the metric of the space, along every coordinate of the space in either
/// direction. The coordinates are those of the base's position; every angle; about the three axes of its own frame every rotation; and the
/// diagonals of the base's position, between two axes. So a configuration that is found valid is within the depth of a valid one, by the
/// metric. Not every configuration that is within the depth of a valid one is found valid.
///
/// *What is promised of motions.* That they are valid at steps no farther apart than the resolution. Nothing is proved of what lies between
/// them.
pub(in crate::model::bodies) struct BodiesWithPenetration {
    bodies: BodyValidity,
    /// The motions that are tried, in the space's own units, as [`Space::moved`] takes them.
    motions: Vec<Vec<f64>>,
}

impl BodiesWithPenetration {
    /// Bodies, and the depth by which they may overlap, a length in the metric.
    pub fn new(bodies: BodyValidity, depth: f64) -> BodiesWithPenetration {
        let motions = motions(bodies.space(), depth);
        BodiesWithPenetration { bodies, motions }
    }

    /// Whether a configuration within the bounds, which is not valid for the bodies themselves, is near one that is.
    fn is_near_valid(&self, q: &[f64], scratch: &mut Scratch) -> bool {
        let mut moved = vec![0.0; q.len()];
        self.motions.iter().any(|by| {
            self.bodies.space().moved(q, by, &mut moved);
            self.bodies.is_valid(&moved, scratch)
        })
    }
}

/// The motions that are tried, the shorter ones first.
pub(super) fn motions(space: &Space, depth: f64) -> Vec<Vec<f64>> {
    // Per number that a tangent vector has: what it weighs in the metric.
    let mut weights = Vec::new();
    for factor in space.factors() {
        let count = if factor.kind == FactorKind::Rotation { 3 } else { 1 };
        weights.extend(std::iter::repeat_n(factor.weight, count));
    }
    // A factor without weight costs nothing in the metric, and moves nothing.
    let numbers = || (0..weights.len()).filter(|at| weights[*at] > 0.0);
    let mut directions: Vec<Vec<(usize, f64)>> = Vec::new();
    for at in numbers() {
        directions.extend([1.0, -1.0].map(|sign| vec![(at, sign)]));
    }
    let positions = space.translations();
    for first in 0..positions {
        for second in first + 1..positions {
            for (one, other) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                let half = std::f64::consts::FRAC_1_SQRT_2;
                directions.push(vec![(first, one * half), (second, other * half)]);
            }
        }
    }
    let mut motions = Vec::new();
    for share in SHARES {
        for direction in &directions {
            let mut by = vec![0.0; weights.len()];
            for (at, part) in direction {
                by[*at] = depth * share * part / weights[*at];
            }
            motions.push(by);
        }
    }
    motions
}

impl Model for BodiesWithPenetration {
    fn space(&self) -> &Space {
        self.bodies.space()
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        match self.bodies.validity(q, scratch) {
            Validity::Invalid if self.is_near_valid(q, scratch) => Validity::Valid,
            validity => validity,
        }
    }

    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let steps = self.bodies.steps(a, b, refinement);
        let valid = self
            .bodies
            .all_between(a, b, steps, &mut vec![0.0; a.len()], |q| self.is_valid(q, scratch));
        valid.then_some(Cost::Metric)
    }

    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        match self.is_valid(q, &mut Scratch::new()) {
            true => Vec::new(),
            false => self.bodies.reasons(q, depths),
        }
    }

    fn is_obstructed(&self) -> bool {
        self.bodies.is_obstructed()
    }
}
