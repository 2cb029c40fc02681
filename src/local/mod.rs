//! Local planners: how two nearby configurations are joined by a motion.
//!
//! A planner names the configurations by which the motion goes; between them it follows
//! [`Space::interpolate`](crate::space::Space::interpolate). The motion is free when those
//! configurations and every stretch between them are valid.

mod straight_line;

use crate::context::Context;
use crate::roadmap::Configs;
use crate::validity::Scratch;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// A way of joining two configurations.
pub trait LocalPlanner {
    /// Appends to `out` the configurations strictly between `a` and `b` at which the motion turns.
    fn turns(&self, cx: &Context, a: &[f64], b: &[f64], out: &mut Configs);
}

/// The local planners. An edge records which one succeeded, by its tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Planner {
    /// Straight in the configuration space.
    StraightLine,
}

impl Planner {
    /// Every planner, in the order of their tags.
    pub const ALL: [Planner; 1] = [Planner::StraightLine];

    /// The number that stands for the planner on edges and in files.
    pub fn tag(self) -> u8 {
        match self {
            Planner::StraightLine => 0,
        }
    }

    /// The planner that a tag stands for.
    pub fn from_tag(tag: u8) -> Option<Planner> {
        Planner::ALL.into_iter().find(|planner| planner.tag() == tag)
    }

    fn method(self) -> &'static dyn LocalPlanner {
        match self {
            Planner::StraightLine => &straight_line::StraightLine,
        }
    }

    /// The planner's whole motion from `a` to `b`: both ends and the turns between them.
    pub fn motion(self, cx: &Context, a: &[f64], b: &[f64]) -> Configs {
        let mut motion = Configs::new(a.len());
        motion.push(a);
        self.method().turns(cx, a, b, &mut motion);
        motion.push(b);
        motion
    }
}

/// The first of `planners` whose motion from `a` to `b`, both valid, is free, and the motion's
/// length in the space's metric. Checks `refinement` times finer than the problem's resolution.
pub fn connect(
    cx: &Context,
    planners: &[Planner],
    (a, b): (&[f64], &[f64]),
    refinement: u32,
    scratch: &mut Scratch,
) -> Option<(Planner, f64)> {
    planners.iter().find_map(|planner| {
        let motion = planner.motion(cx, a, b);
        let mut length = 0.0;
        for i in 1..motion.len() {
            let (from, to) = (motion.get(i - 1), motion.get(i));
            let turn_valid = i + 1 == motion.len() || cx.validity.valid(to, scratch);
            if !turn_valid || !cx.validity.motion(from, to, refinement, scratch) {
                return None;
            }
            length += cx.space.distance(from, to);
        }
        Some((*planner, length))
    })
}
