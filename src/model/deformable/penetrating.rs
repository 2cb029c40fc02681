//! Bodies whose robot may overlap obstacles as far as a short motion would free it (§4.2 of the paper).

use super::DEPTH;
use super::weight;
use crate::model::bodies::BodyValidity;
use crate::model::bodies::validity::BodyScratch;
use crate::model::{Cost, Model, NodeValue, Reason, Scratch, Validity};
use crate::seed::{Purpose, Seed};
use crate::space::{Direction, Space};

/// The name of the seed of the vectors.
const SEED: &str = "deformable: vectors of penetration";

/// Bodies among which a configuration within the bounds is valid if the robot is free there, or at the end of one of some vectors
/// of the configuration space that start there.
///
/// *The vectors.* Their directions are uniform, their lengths uniform up to the depth, by the metric of the space. The paper draws
/// them anew for each configuration. Here they are drawn once, by a seed that never changes, and are the same at all
/// configurations: so what is valid is a function of the configuration alone, and the steps of a motion, which lie close
/// together, agree.
///
/// *A configuration's depth* is the length of the shortest of the vectors that leads to where the robot is free; 0 where it is free
/// itself. It is at least the distance to the nearest free configuration.
///
/// *A motion* is valid if it is so at steps no farther apart than the resolution. Nothing is proved of what lies between them. It
/// costs the depths of both ends together.
pub(super) struct PenetratingBodies {
    bodies: BodyValidity,
    /// From the shortest up.
    vectors: Vec<Vector>,
}

/// A vector of the configuration space.
struct Vector {
    direction: Direction,
    /// Its length in the metric of the space.
    length: f64,
}

/// What is known of a configuration.
struct Found {
    /// How deep it is, or why it is not valid.
    depth: Result<f64, Validity>,
    /// How many configurations were looked at.
    looks: usize,
}

impl PenetratingBodies {
    /// Bodies, the length of the longest vector in the metric of the space, and how many vectors are tried.
    pub fn new(bodies: BodyValidity, depth: f64, vectors: u32) -> PenetratingBodies {
        let stream = &mut Seed::of_calibration(0, SEED).stream(Purpose::Sampling);
        let draw = |_| Vector {
            direction: bodies.space().direction(stream),
            // Above 0, since a vector of length 0 leads nowhere.
            length: depth * (1.0 - stream.unit()),
        };
        let mut vectors: Vec<Vector> = (0..vectors).map(draw).collect();
        vectors.sort_by(|one, other| one.length.total_cmp(&other.length));
        PenetratingBodies { bodies, vectors }
    }

    fn found(&self, q: &[f64], moved: &mut Vec<f64>, scratch: &mut BodyScratch) -> Found {
        match self.bodies.look(q, scratch) {
            Validity::Valid => return Found { depth: Ok(0.0), looks: 1 },
            Validity::OutOfBounds => return Found { depth: Err(Validity::OutOfBounds), looks: 1 },
            Validity::Invalid => {}
        }
        moved.resize(q.len(), 0.0);
        let frees = |Vector { direction, length }: &Vector| {
            self.bodies.space().along(q, direction, *length, moved);
            self.bodies.look(moved, scratch) == Validity::Valid
        };
        match self.vectors.iter().position(frees) {
            Some(index) => Found { depth: Ok(self.vectors[index].length), looks: index + 2 },
            None => Found { depth: Err(Validity::Invalid), looks: self.vectors.len() + 1 },
        }
    }

    /// The length of the longest vector.
    fn longest(&self) -> f64 {
        self.vectors.last().map_or(0.0, |vector| vector.length)
    }

    /// The depth of a configuration of a motion. Everything that is looked at is counted.
    fn depth_on_way(&self, q: &[f64], moved: &mut Vec<f64>, scratch: &mut Scratch) -> Option<f64> {
        let Found { depth, looks } = self.found(q, moved, scratch.of_model());
        (0..looks).for_each(|_| scratch.count_configuration());
        depth.ok()
    }
}

impl Model for PenetratingBodies {
    fn space(&self) -> &Space {
        self.bodies.space()
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        let Found { depth, looks } = self.found(q, &mut Vec::new(), scratch.of_model());
        (0..looks).for_each(|_| scratch.count_configuration());
        depth.map_or_else(|verdict| verdict, |_| Validity::Valid)
    }

    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let (a, b) = weight::in_order(a, b);
        let free = self.bodies.judge(a, b, refinement, scratch.for_motion());
        let moved = &mut Vec::new();
        let ends = [self.depth_on_way(a, moved, scratch)?, self.depth_on_way(b, moved, scratch)?];
        let mut peak = ends[0].max(ends[1]);
        // Where the robot is free all along, it is so at the steps.
        if !(free && peak == 0.0) {
            let steps = self.bodies.steps(a, b, refinement);
            let valid = self.bodies.all_between(a, b, steps, &mut vec![0.0; a.len()], |q| {
                let depth = self.depth_on_way(q, moved, scratch);
                peak = depth.map_or(peak, |depth| peak.max(depth));
                depth.is_some()
            });
            if !valid {
                return None;
            }
        }
        Some(weight::cost(self.space(), a, b, ends, peak))
    }

    fn reasons(&self, q: &[f64], depths: bool) -> Vec<Reason> {
        match self.found(q, &mut Vec::new(), &mut BodyScratch::default()).depth {
            Ok(_) => Vec::new(),
            Err(Validity::OutOfBounds) => self.bodies.reasons(q, depths),
            Err(_) => {
                let mut reasons = self.bodies.reasons(q, depths);
                // As of scaled robots: not where reasons are counted over many configurations.
                if depths {
                    let (count, longest) = (self.vectors.len(), self.longest());
                    let text =
                        format!("no vector frees the robot: {count} of up to {longest} tried");
                    reasons.push(Reason::Other { text });
                }
                reasons
            }
        }
    }

    fn is_obstructed(&self) -> bool {
        self.bodies.is_obstructed()
    }

    /// Where the robot touches nothing, the configuration is valid.
    fn touching_box(&self) -> Option<[[f64; 3]; 2]> {
        self.bodies.touching_box()
    }

    fn node_values(&self) -> &'static [NodeValue] {
        DEPTH
    }

    /// The depth; of a configuration that is not valid that of the longest vector.
    fn values(&self, q: &[f64], out: &mut Vec<f64>, scratch: &mut Scratch) {
        let found = self.found(q, &mut Vec::new(), scratch.of_model());
        out.push(found.depth.unwrap_or(self.longest()));
    }
}
