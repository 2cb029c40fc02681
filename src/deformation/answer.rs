use super::{Deformations, DeformedPath, Refusal};
use crate::numbers::NodeId;

/// What a query for a deformed path came to.
#[derive(Clone, Debug, PartialEq)]
pub struct DeformingAnswer {
    /// The path, or why there is none.
    pub path: Result<DeformedPath, NoDeformedPath>,
    /// The sum of the weights of the path's edges; 0 where there is no path.
    pub weight: f64,
    /// Along how many edges the robot was deformed, whether or not they are of the path.
    pub deformed_edges: u64,
    /// The edges that were removed for this query, in the order in which they were tried.
    pub removed: Vec<RemovedEdge>,
    /// How often a least-weight path was looked for.
    pub searches: u64,
    /// What deforming took.
    pub deformations: Deformations,
}

/// An edge along which the robot cannot be deformed.
#[derive(Clone, Debug, PartialEq)]
pub struct RemovedEdge {
    /// Its ends; the start of the query has the number after the roadmap's last node, the goal the next.
    pub ends: [NodeId; 2],
    /// Its weight, in the direction in which it was to be walked.
    pub weight: f64,
    /// Why it cannot be deformed: the first reason that was found.
    pub refusal: Refusal,
}

/// Why a query has no deformed path.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoDeformedPath {
    /// The robot cannot be deformed at the start.
    #[error("the robot cannot be deformed at the start: {0}")]
    Start(Refusal),
    /// The robot cannot be deformed at the goal.
    #[error("the robot cannot be deformed at the goal: {0}")]
    Goal(Refusal),
    /// The rigid robot has no way from the start to the goal, whatever can be deformed.
    #[error("the roadmap of the rigid robot does not join start and goal")]
    Apart,
    /// Every path of the rigid robot has an edge along which the robot cannot be deformed.
    #[error("every path has an edge along which the robot cannot be deformed")]
    Refused,
    /// The query was cancelled.
    #[error("cancelled")]
    Cancelled,
}
