use super::centre::CentreSum;
use crate::numbers::NodeId;

/// A connected component of a graph over configurations.
#[derive(Clone, Debug)]
pub struct Component {
    /// The node with the smallest id among its nodes, by which it is named.
    pub name: NodeId,
    /// The integers in the ids of its nodes, in no particular order: searches take them as positions among the
    /// configurations.
    pub members: Vec<u32>,
    /// The mean of its nodes, in the sense of the space; up to date after every fold.
    pub centre: Vec<f64>,
    /// What the mean is computed from.
    pub(super) sum: CentreSum,
}
