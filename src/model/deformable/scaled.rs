//! Bodies whose robot may be smaller than it is (§4.1 of the paper).

use super::SCALE;
use super::weight;
use crate::model::bodies::BodyValidity;
use crate::model::bodies::validity::BodyScratch;
use crate::model::{Cost, Model, NodeValue, Reason, Scratch, Validity};
use crate::space::Space;

/// Bodies among which a configuration is valid if the robot is free there at one of some scales, the bounds included: a smaller
/// robot is within them where the robot itself is not.
///
/// A configuration's scale is the largest at which the robot is free. A motion is judged whole, its ends included, by the robot at
/// the smaller of its ends' scales, and what is promised of it is what the bodies promise. It costs what both ends shrink by, each
/// 1 − scale, together.
pub(super) struct ScaledBodies {
    /// From the largest down; at least one.
    rungs: Vec<Rung>,
}

/// The bodies with the robot at one scale.
struct Rung {
    scale: f64,
    bodies: BodyValidity,
}

impl ScaledBodies {
    /// Bodies at each of these scales, from the largest down.
    pub fn new(scales: Vec<(f64, BodyValidity)>) -> ScaledBodies {
        let rungs = scales.into_iter().map(|(scale, bodies)| Rung { scale, bodies });
        ScaledBodies { rungs: rungs.collect() }
    }

    fn least(&self) -> &Rung {
        self.rungs.last().expect("a sound description has at least one scale")
    }

    /// The index of the largest scale at which the robot is free.
    ///
    /// # Errors
    /// The verdict at the least scale.
    fn rung(&self, q: &[f64], scratch: &mut BodyScratch) -> Result<usize, Validity> {
        if !self.space().within_bounds(q) {
            return Err(Validity::OutOfBounds);
        }
        let mut verdict = Validity::Invalid;
        for (index, rung) in self.rungs.iter().enumerate() {
            verdict = rung.bodies.look(q, scratch);
            if verdict == Validity::Valid {
                return Ok(index);
            }
        }
        Err(verdict)
    }

    /// By how much the robot at a scale is smaller than the robot itself.
    fn shrink(&self, rung: usize) -> f64 {
        1.0 - self.rungs[rung].scale
    }
}

impl Model for ScaledBodies {
    fn space(&self) -> &Space {
        self.rungs[0].bodies.space()
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        let found = self.rung(q, scratch.for_configuration());
        // Every further scale is a further check.
        for _ in 0..found.unwrap_or(self.rungs.len() - 1) {
            scratch.count_configuration();
        }
        found.map_or_else(|verdict| verdict, |_| Validity::Valid)
    }

    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let scratch: &mut BodyScratch = scratch.for_motion();
        let (a, b) = weight::in_order(a, b);
        let rungs = [self.rung(a, scratch).ok()?, self.rung(b, scratch).ok()?];
        let [fewer, more] = [rungs[0].min(rungs[1]), rungs[0].max(rungs[1])];
        let bodies = &self.rungs[more].bodies;
        // A smaller robot need not lie within the larger one, so that it need not be free wherever the larger one is.
        let other = if rungs[0] < more { a } else { b };
        if fewer < more && bodies.look(other, scratch) != Validity::Valid {
            return None;
        }
        let shrinks = rungs.map(|rung| self.shrink(rung));
        let free = bodies.judge(a, b, refinement, scratch);
        free.then(|| weight::cost(self.space(), a, b, shrinks, self.shrink(more)))
    }

    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        if self.rung(q, &mut BodyScratch::default()).is_ok() {
            return Vec::new();
        }
        let Rung { scale, bodies } = self.least();
        let mut reasons = bodies.reasons(q, depths);
        // Who asks for depths asks about one configuration; who counts reasons over many is helped by no reason of all of them.
        if depths {
            let text = format!("the robot is free at no scale: at the least, {scale}, this holds");
            reasons.insert(0, Reason::Other { text });
        }
        reasons
    }

    fn is_obstructed(&self) -> bool {
        self.least().bodies.is_obstructed()
    }

    /// Where the robot itself touches nothing, the configuration is valid, whatever holds of smaller ones.
    fn touching_box(&self) -> Option<[[f64; 3]; 2]> {
        self.rungs[0].bodies.touching_box()
    }

    fn node_values(&self) -> &'static [NodeValue] {
        SCALE
    }

    /// The largest scale at which the robot is free; of a configuration that is not valid the least that there is.
    fn values(&self, q: &[f64], out: &mut Vec<f64>, scratch: &mut Scratch) {
        let rung = self.rung(q, scratch.of_model()).unwrap_or(self.rungs.len() - 1);
        out.push(self.rungs[rung].scale);
    }
}
