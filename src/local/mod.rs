//! Local planners: how two nearby configurations are joined by a motion.
//!
//! A planner names the configurations by which the motion goes; between them it follows
//! [`Space::interpolate`](crate::space::Space::interpolate). The motion is free when those
//! configurations and every stretch between them are valid.
//!
//! ```
//! use roadmill::local::{self, Planner};
//! use roadmill::{model::Scratch, problem::Problem};
//!
//! let cx = Problem::load("problems/maze.toml".as_ref())?.context();
//! let (a, b) = ([1.1, 1.0, 0.0], [1.4, 1.0, 0.1]);
//! // The first planner whose motion is valid, and what the motion costs.
//! let joined = local::connect(&cx, &[Planner::StraightLine], (&a, &b), 1, &mut Scratch::new());
//! assert_eq!(joined.map(|(planner, _)| planner), Some(Planner::StraightLine));
//! // Only the motion's ends: a straight line has no turns.
//! assert_eq!(Planner::StraightLine.motion(&cx, &a, &b).len(), 2);
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod manhattan;
mod rotate_at;
mod straight_line;

/// The enum of local planners, with what follows from the list of those that have settings.
macro_rules! planners {
    ($($variant:ident($planner:ty),)+) => {
        /// The local planners, as a problem file names them. An edge records which one succeeded, by its tag.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
        #[serde(rename_all = "kebab-case", deny_unknown_fields)]
        pub enum Planner {
            /// Straight in the configuration space: tag 0.
            StraightLine,
            $(#[allow(missing_docs)] $variant($planner),)+
        }

        impl Planner {
            /// The planner behind its role.
            pub fn method(&self) -> &dyn LocalPlanner {
                match self {
                    Planner::StraightLine => &StraightLine,
                    $(Planner::$variant(planner) => planner,)+
                }
            }

            /// The planner that a tag stands for.
            pub fn from_tag(tag: u8) -> Option<Planner> {
                StraightLine::of_tag(tag).map(|_| Planner::StraightLine)
                    $(.or_else(|| <$planner>::of_tag(tag).map(Planner::$variant)))+
            }
        }
    };
}

planners! {
    RotateAt(rotate_at::RotateAt),
    Manhattan(manhattan::Manhattan), // new ones at the end, since ledgers know planners by number
}

pub use manhattan::Manhattan;
pub use rotate_at::RotateAt;

use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{Cost, Scratch};
use crate::numbers::NodeId;
use crate::roadmap::{Configs, Edge, EdgeCost};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::fmt;
use straight_line::StraightLine;

/// A way of joining two configurations.
pub trait LocalPlanner {
    /// Appends to `out` the configurations strictly between `a` and `b` at which the motion turns.
    fn turns(&self, cx: &Context, a: &[f64], b: &[f64], out: &mut Configs);

    /// The number that stands for the planner on edges and in files. No two planners share one.
    fn tag(&self) -> u8;

    /// The name that exported files use.
    fn name(&self) -> String;

    /// The planner of this kind that a tag stands for.
    fn of_tag(tag: u8) -> Option<Self>
    where
        Self: Sized;

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }
}

impl Planner {
    /// The number that stands for the planner on edges and in files.
    pub fn tag(self) -> u8 {
        self.method().tag()
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

/// The name that exported files use: `straight-line`, `rotate-at-50`.
impl fmt::Display for Planner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.method().name())
    }
}

/// What is wrong with a list of planners to be tried.
pub fn complaint(planners: &[Planner]) -> Option<Complaint> {
    if planners.is_empty() {
        return Some(Complaint::new("planners", "[]", "at least one local planner"));
    }
    planners.iter().find_map(|planner| planner.method().complaint())
}

/// The first of `planners` whose motion from `a` to `b`, both valid, is valid, and what the motion costs. Motions are
/// checked `refinement` times finer than the problem's resolution.
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

/// The edge by which [`connect`] joins two nodes, each given by its id and its configuration. The motion goes from the
/// first, whose id is the lower one, to the second.
pub(crate) fn edge(
    cx: &Context,
    planners: &[Planner],
    [(low, a), (high, b)]: [(NodeId, &[f64]); 2],
    refinement: u32,
    scratch: &mut Scratch,
) -> Option<Edge> {
    let (planner, cost) = connect(cx, planners, (a, b), refinement, scratch)?;
    Some(Edge { low, high, planner: planner.tag(), cost })
}

#[cfg(test)]
mod tests;
