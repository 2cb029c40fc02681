use crate::model::{Model, Reason, Scratch, Validity};
use crate::space::{FactorKind, Space, stored_form};
use bincode::{Decode, Encode};

/// The most reasons that a message names why a configuration is not valid.
const REASONS: usize = 4;

/// A problem made ready for work: what everything that samples, joins and evaluates shares.
pub struct Context {
    /// The configuration space.
    pub(crate) space: Space,
    /// What is valid, and what motions cost.
    pub(crate) model: Box<dyn Model>,
    /// The base seed of the program's random numbers.
    pub(crate) base_seed: u64,
    /// The query to be solved, if there is one.
    pub(crate) query: Option<Ends>,
    /// Whether a query tries the direct motion between its ends, and its path has no configuration twice in a row.
    pub(crate) tries_direct_motion: bool,
}

impl Context {
    /// The configuration space.
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// What is valid, and what motions cost.
    pub fn model(&self) -> &dyn Model {
        &*self.model
    }

    /// The base seed of the program's random numbers.
    pub fn base_seed(&self) -> u64 {
        self.base_seed
    }

    /// The query to be solved, if there is one: valid configurations in stored form.
    pub fn query(&self) -> Option<&Ends> {
        self.query.as_ref()
    }

    /// Whether a query tries the direct motion between its ends, and its path has no configuration twice in a row. It
    /// does, but where judgements are made again that a program recorded before it did.
    pub fn try_direct_motion(&mut self, tries: bool) {
        self.tries_direct_motion = tries;
    }

    /// Brings a configuration that came from outside into stored form, and checks it.
    ///
    /// # Errors
    /// Says what is wrong with it: the number of values, a value, or that it is not valid.
    pub fn accept(&self, q: &mut [f64]) -> Result<(), String> {
        self.stored(q)?;
        if self.model.validity(q, &mut Scratch::new()) != Validity::Valid {
            let reasons = self.model.reasons(q, true);
            let why: Vec<String> = reasons.iter().take(REASONS).map(Reason::to_string).collect();
            let more = match reasons.len().saturating_sub(REASONS) {
                0 => String::new(),
                more => format!("; and {more} more reasons"),
            };
            let why = why.join("; ");
            return Err(format!("{q:?} found, where {why}{more}; a valid configuration expected"));
        }
        Ok(())
    }

    /// Brings a configuration that came from outside, valid or not, into stored form.
    ///
    /// # Errors
    /// Says what is wrong with it: the number of values, or a value.
    pub(crate) fn stored(&self, q: &mut [f64]) -> Result<(), String> {
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
