use crate::space::Space;
use crate::validity::Validity;
use bincode::{Decode, Encode};

/// A problem made ready for work: what everything that samples, joins and evaluates shares.
pub struct Context {
    /// The configuration space.
    pub space: Space,
    /// What makes configurations and motions valid.
    pub validity: Box<dyn Validity>,
    /// The base seed of the program's random numbers.
    pub base_seed: u64,
    /// The query to be solved, if there is one.
    pub query: Option<Ends>,
}

/// The two ends of a query: valid configurations in stored form.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Ends {
    /// Where the path begins.
    pub start: Vec<f64>,
    /// Where it ends.
    pub goal: Vec<f64>,
}
