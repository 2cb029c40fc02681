use super::centre::CentreSum;

/// A connected component of a graph over configurations.
#[derive(Clone, Debug)]
pub struct Component {
    /// The smallest id among its nodes, by which it is named.
    pub name: u32,
    /// Its nodes, in no particular order.
    pub members: Vec<u32>,
    /// The mean of its nodes, in the sense of the space; up to date after every fold.
    pub centre: Vec<f64>,
    /// What the mean is computed from.
    pub(super) sum: CentreSum,
}
