//! Local planners: how two nearby configurations are joined by a motion.
//!
//! A planner names the configurations by which the motion goes; between them it follows
//! [`Space::interpolate`](crate::space::Space::interpolate). The motion is free when those
//! configurations and every stretch between them are valid.

mod rotate_at;
mod straight_line;

use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{Cost, Scratch};
use crate::roadmap::{Configs, EdgeCost};
use bincode::{Decode, Encode};
use rotate_at::RotateAt;
use serde::{Deserialize, Serialize};
use std::fmt;
use straight_line::StraightLine;

/// A way of joining two configurations.
pub trait LocalPlanner {
    /// Appends to `out` the configurations strictly between `a` and `b` at which the motion turns.
    fn turns(&self, cx: &Context, a: &[f64], b: &[f64], out: &mut Configs);
}

/// The local planners. An edge records which one succeeded, by its tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Planner {
    /// Straight in the configuration space: tag 0.
    StraightLine,
    /// Translate, turn on the way, translate: tags 1 to 101.
    RotateAt {
        /// Where it turns, in hundredths of the way from the first end to the second.
        percent: u8,
    },
}

impl Planner {
    /// The number that stands for the planner on edges and in files.
    pub fn tag(self) -> u8 {
        match self {
            Planner::StraightLine => 0,
            Planner::RotateAt { percent } => 1 + percent,
        }
    }

    /// The planner that a tag stands for.
    pub fn from_tag(tag: u8) -> Option<Planner> {
        match tag {
            0 => Some(Planner::StraightLine),
            1..=101 => Some(Planner::RotateAt { percent: tag - 1 }),
            _ => None,
        }
    }

    fn turns(self, cx: &Context, a: &[f64], b: &[f64], out: &mut Configs) {
        match self {
            Planner::StraightLine => StraightLine.turns(cx, a, b, out),
            Planner::RotateAt { percent } => {
                RotateAt { s: f64::from(percent) / 100.0 }.turns(cx, a, b, out);
            }
        }
    }

    /// The planner's whole motion from `a` to `b`: both ends and the turns between them.
    pub fn motion(self, cx: &Context, a: &[f64], b: &[f64]) -> Configs {
        let mut motion = Configs::new(a.len());
        motion.push(a);
        self.turns(cx, a, b, &mut motion);
        motion.push(b);
        motion
    }
}

/// The name that exported files use: `straight-line`, `rotate-at-50`.
impl fmt::Display for Planner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Planner::StraightLine => f.write_str("straight-line"),
            Planner::RotateAt { percent } => write!(f, "rotate-at-{percent}"),
        }
    }
}

/// What is wrong with a list of planners to be tried.
pub fn complaint(planners: &[Planner]) -> Option<Complaint> {
    if planners.is_empty() {
        return Some(("planners", "[]".to_owned(), "at least one local planner"));
    }
    let percents = planners.iter().filter_map(|planner| match planner {
        Planner::RotateAt { percent } => Some(*percent),
        Planner::StraightLine => None,
    });
    let wrong = percents.filter(|percent| *percent > 100).max()?;
    Some(("percent", wrong.to_string(), "0 to 100"))
}

/// The first of `planners` whose motion from `a` to `b`, both valid, is valid, and what the motion costs. Checks `refinement` times finer than the problem's resolution.
pub fn connect(
    cx: &Context,
    planners: &[Planner],
    (a, b): (&[f64], &[f64]),
    refinement: u32,
    scratch: &mut Scratch,
) -> Option<(Planner, EdgeCost)> {
    planners.iter().find_map(|planner| {
        if *planner == Planner::StraightLine {
            // It has no turns, so that nothing needs to be written down.
            let cost = cx.model.motion(a, b, refinement, scratch)?;
            return Some((*planner, EdgeCost::of(cost, cx.space.distance(a, b))));
        }
        let motion = planner.motion(cx, a, b);
        let (mut length, mut whole) = (0.0, None);
        for i in 1..motion.len() {
            let (from, to) = (motion.get(i - 1), motion.get(i));
            let turn_valid = i + 1 == motion.len() || cx.model.is_valid(to, scratch);
            let cost = turn_valid.then(|| cx.model.motion(from, to, refinement, scratch))??;
            length += cx.space.distance(from, to);
            whole = match (whole, cost) {
                (None, cost) => Some(cost),
                (Some(Cost::Directed(before)), Cost::Directed(cost)) => {
                    Some(Cost::Directed(before.then(cost)))
                }
                (Some(_), _) => Some(Cost::Metric),
            };
        }
        Some((*planner, EdgeCost::of(whole?, length)))
    })
}

#[cfg(test)]
mod tests;
