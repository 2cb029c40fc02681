//! Evaluators: is the roadmap large enough? One file per method (TR05-007 §3.2).
//!
//! An evaluator is a pure function of the problem and the folded roadmap: it remembers nothing
//! from round to round, so that a resumed build judges as an undisturbed one.

mod query;

methods! {
    /// The evaluators, as a problem file names them.
    pub enum EvaluatorKind: dyn Evaluator {
        Query(query::Query),
    }
}

pub use query::Query;

use crate::context::Context;
use crate::methods::{Complaint, methods};
use crate::query::{Answer, Attachment};
use crate::roadmap::Roadmap;
use crate::seed::Seed;
use crate::validity::{Asked, Scratch};
use bincode::{Decode, Encode};

/// A criterion on roadmaps.
pub trait Evaluator {
    /// The criterion's name in progress reports and summaries.
    fn name(&self) -> &'static str;

    /// Judges the roadmap. Randomness, if any, comes from `seed` alone.
    fn evaluate(
        &self,
        cx: &Context,
        seed: &Seed,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict;

    /// Whether the criterion needs the problem to have a query.
    fn needs_query(&self) -> bool {
        false
    }

    /// Of an evaluator that attaches configurations to the roadmap: how it does.
    fn attachment(&self) -> Option<Attachment> {
        None
    }

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        None
    }
}

/// What an evaluator says of a roadmap.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Verdict {
    /// Whether the criterion is met.
    pub satisfied: bool,
    /// The measured value.
    pub value: f64,
    /// The least value that meets the criterion.
    pub threshold: f64,
    /// Of the query evaluator: the answer, with the path.
    pub answer: Option<Answer>,
    /// What the evaluation cost.
    pub asked: Asked,
}
