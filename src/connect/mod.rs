//! Connection: which pairs of milestones are given to the local planners.
//!
//! *Within* a node set and *among* sets are separate choices (TR05-007 §3.1: *"a (possibly
//! different) user specified set of connection strategies"*). One file per method.
//!
//! ```
//! use roadmill::connect::{Nearest, Within};
//! use roadmill::{model::Scratch, numbers::{NodeId, Ordinal}, problem::Problem, roadmap::Configs, seed::Seed};
//!
//! let cx = Problem::load("tests/problems/slide.toml".as_ref())?.context();
//! let mut milestones = Configs::new(cx.space().len());
//! for z in [-3.0, 0.0, 3.0] {
//!     milestones.push(&[-3.0, -3.0, z]);
//! }
//! let (seed, scratch) = (Seed::of_set(1, "by hand", Ordinal(0)), &mut Scratch::new());
//! let edges = Nearest::default().connect(&cx, &seed, &milestones, scratch);
//! assert!(edges.iter().any(|edge| (edge.low, edge.high) == (NodeId(0), NodeId(1))));
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

mod candidates;
mod component_pairs;
mod joined;
mod nearest;
mod nearest_nodes;
mod neighbors;
mod nodes_and_components;
mod until_joined;

methods! {
    /// Connection within a node set, as a problem file names it.
    pub enum WithinKind: dyn Within {
        Nearest(nearest::Nearest),
        Neighbors(neighbors::Neighbors), // new ones at the end, since ledgers know methods by number
    }
}

methods! {
    /// Connection among node sets, as a problem file names it.
    pub enum AmongKind: dyn Among {
        ComponentPairs(component_pairs::ComponentPairs),
        NearestNodes(nearest_nodes::NearestNodes),
        UntilJoined(until_joined::UntilJoined),
        Neighbors(neighbors::Neighbors),
        NodesAndComponents(nodes_and_components::NodesAndComponents), // new ones at the end, since ledgers know methods by number
    }
}

pub use component_pairs::ComponentPairs;
pub use nearest::Nearest;
pub use nearest_nodes::NearestNodes;
pub use neighbors::Neighbors;
pub use nodes_and_components::NodesAndComponents;
pub use until_joined::UntilJoined;

use crate::context::Context;
use crate::local::{self, Planner};
use crate::methods::{Complaint, methods};
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::{Components, Configs, Edge, Increment, Roadmap};
use crate::seed::Seed;
use std::sync::Arc;

/// The report's: the 10 nearest of each milestone.
impl Default for WithinKind {
    fn default() -> WithinKind {
        WithinKind::Nearest(Nearest::default())
    }
}

/// Nearest nodes, and the report's closest pairs of near components where these join nothing.
impl Default for AmongKind {
    fn default() -> AmongKind {
        AmongKind::NodesAndComponents(NodesAndComponents::default())
    }
}

/// Connection of a set's milestones with one another.
pub trait Within {
    /// The edges found among `configs`, in the order in which they were tried.
    fn connect(
        &self,
        cx: &Context,
        seed: &Seed,
        configs: &Configs,
        scratch: &mut Scratch,
    ) -> Vec<Edge>;

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }

    /// Whether the method is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    fn suits(&self, _cx: &Context) -> Result<(), String> {
        Ok(())
    }
}

/// Connection of a new increment with what came before it.
pub trait Among {
    /// The edges found between the last of the input's increments and everything before it, in
    /// the order in which they were tried, numbered as in the roadmap after the round.
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge>;

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }

    /// Whether the method is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    fn suits(&self, _cx: &Context) -> Result<(), String> {
        Ok(())
    }
}

/// An increment with the connected components that its own edges make.
#[derive(Debug)]
pub struct Built {
    /// The increment.
    pub increment: Arc<Increment>,
    /// Its components, numbered from 0 as the increment is.
    pub components: Components,
}

impl Built {
    /// Finds the components of an increment.
    pub fn new(cx: &Context, increment: Arc<Increment>) -> Built {
        let components = Components::of(&cx.space, &increment.configs, &increment.edges);
        Built { increment, components }
    }
}

/// What a join depends on, all of it frozen: the roadmap at the round's start, and the round's
/// increments as built, up to and with the one to be joined.
#[derive(Clone, Debug)]
pub struct JoinInput {
    /// The roadmap at the round's start.
    pub roadmap: Arc<Roadmap>,
    /// The round's increments; the last is the one to be joined.
    pub increments: Vec<Arc<Built>>,
    /// The seed of the set that is to be joined.
    pub seed: Seed,
}

/// Tries pairs of a set's milestones in their order, each from its first, the lower id, to its second; the edges of
/// those that the planners can join.
fn connect_pairs(
    cx: &Context,
    planners: &[Planner],
    configs: &Configs,
    pairs: &[(u32, u32)],
    scratch: &mut Scratch,
) -> Vec<Edge> {
    let node = |id: u32| (NodeId(id), configs.get(id as usize));
    let joined = pairs
        .iter()
        .filter_map(|(low, high)| local::edge(cx, planners, [node(*low), node(*high)], 1, scratch));
    joined.collect()
}

/// The number of neighbours of a connection that names none: as many as in TR05-007 §4.1.
fn default_neighbors() -> u32 {
    10
}

/// The planners of a connection that names none.
fn default_planners() -> Vec<Planner> {
    vec![Planner::StraightLine]
}

/// What is wrong with the number of neighbours and the planners of a connection.
fn complaint(neighbors: u32, planners: &[Planner]) -> Option<Complaint> {
    if neighbors == 0 {
        return Some(Complaint::new("neighbors", "0", "at least 1"));
    }
    local::complaint(planners)
}

#[cfg(test)]
mod tests;
