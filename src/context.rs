use crate::model::{Model, Scratch, Validity};
use crate::space::{FactorKind, Space, stored_form};
use bincode::{Decode, Encode};

/// A problem made ready for work: what everything that samples, joins and evaluates shares.
pub struct Context {
    /// The configuration space.
    pub space: Space,
    /// What is valid, and what motions cost.
    pub model: Box<dyn Model>,
    /// The base seed of the program's random numbers.
    pub base_seed: u64,
    /// The query to be solved, if there is one.
    pub query: Option<Ends>,
    /// Whether a query tries the direct motion between its ends, and its path has no configuration twice in a row. It
    /// does, but where judgements are made again that a program recorded before it did.
    pub tries_direct_motion: bool,
}

impl Context {
    /// Brings a configuration that came from outside into stored form, and checks it.
    ///
    /// # Errors
    /// Says what is wrong with it: the number of values, a value, or that it is not valid.
    pub fn accept(&self, q: &mut [f64]) -> Result<(), String> {
        let space = &self.space;
        if q.len() != space.len() {
            let names: Vec<_> = space.dofs().iter().map(|dof| dof.name.as_str()).collect();
            let (found, expected) = (q.len(), space.len());
            return Err(format!("{found} values found, {expected} expected: {}", names.join(" ")));
        }
        let given = q.to_vec();
        space.canonicalize(q)?;
        // What has stored form to within rounding stays as it is written, here too.
        for part in space.factors().iter().filter(|part| part.kind == FactorKind::Rotation) {
            let four = part.at..part.at + 4;
            let quaternion = [0, 1, 2, 3].map(|i| given[part.at + i]);
            q[four].copy_from_slice(&stored_form(quaternion).expect("it has a direction"));
        }
        if !space.within_bounds(q) {
            return Err(format!("{q:?} found, a configuration within the bounds expected"));
        }
        if self.model.validity(q, &mut Scratch::new()) != Validity::Valid {
            let (why, expected) = (self.model.invalidity(), "a valid configuration expected");
            return Err(format!("{q:?} found, where {why}; {expected}"));
        }
        Ok(())
    }
}

/// The two ends of a query: valid configurations in stored form.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Ends {
    /// Where the path begins.
    pub start: Vec<f64>,
    /// Where it ends.
    pub goal: Vec<f64>,
}
