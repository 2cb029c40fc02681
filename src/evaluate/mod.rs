//! Evaluators: is the roadmap large enough? One file per method (TR05-007 §3.2).
//!
//! An evaluator is a pure function of the problem and the folded roadmap: it remembers nothing
//! from round to round, so that a resumed build judges as an undisturbed one.

mod all;
mod any;
mod connectivity;
mod coverage;
mod not;
mod query;
mod samples;

methods! {
    /// The evaluators, as a problem file names them.
    pub enum EvaluatorKind: dyn Evaluator {
        Query(query::Query),
        Coverage(coverage::Coverage),
        Connectivity(connectivity::Connectivity),
        All(all::All),
        Any(any::Any),
        Not(not::Not),
    }
}

pub use all::All;
pub use any::Any;
pub use connectivity::Connectivity;
pub use coverage::Coverage;
pub use not::Not;
pub use query::Query;
pub use samples::Samples;

use crate::context::Context;
use crate::methods::{Complaint, methods};
use crate::query::{Answer, Attachment};
use crate::roadmap::Roadmap;
use crate::validity::{Asked, Scratch};
use crate::wire::decode_nested;
use bincode::Encode;

/// A criterion on roadmaps.
pub trait Evaluator {
    /// The criterion's name in progress reports and summaries.
    fn name(&self) -> &'static str;

    /// Judges the roadmap. Randomness, if any, comes from the seed that [`Seed::of_evaluator`](crate::seed::Seed::of_evaluator) gives
    /// for `path`, the evaluator's place in the tree of evaluators.
    fn evaluate(
        &self,
        cx: &Context,
        path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict;

    /// The criteria of which it is made.
    fn parts(&self) -> &[EvaluatorKind] {
        &[]
    }

    /// Whether the criterion needs the problem to have a query.
    fn needs_query(&self) -> bool {
        self.parts().iter().any(|part| part.method().needs_query())
    }

    /// Of an evaluator that attaches configurations to the roadmap: how it does.
    fn attachment(&self) -> Option<Attachment> {
        self.parts().iter().find_map(|part| part.method().attachment())
    }

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        self.parts().iter().find_map(|part| part.method().complaint())
    }

    /// Checks what depends on the problem, and brings configurations among the settings into stored
    /// form.
    fn settle(&mut self, _cx: &Context) -> Result<(), String> {
        Ok(())
    }
}

/// What an evaluator says of a roadmap.
#[derive(Clone, Debug, PartialEq, Encode)]
pub struct Verdict {
    /// Whether the criterion is met.
    pub satisfied: bool,
    /// The measured value.
    pub value: f64,
    /// The least value that meets the criterion.
    pub threshold: f64,
    /// Of the query evaluator: the answer, with the path.
    pub answer: Option<Answer>,
    /// Of a criterion made of others: what they say.
    pub parts: Vec<Verdict>,
    /// What the evaluation cost.
    pub asked: Asked,
}

decode_nested!(Verdict { satisfied, value, threshold, answer, parts, asked });

impl Verdict {
    /// The answer to the problem's query, wherever in the tree it was asked.
    pub fn answer(&self) -> Option<&Answer> {
        self.answer.as_ref().or_else(|| self.parts.iter().find_map(Verdict::answer))
    }
}

/// The verdict of a criterion made of `parts`, of which so many must be satisfied.
fn combined(
    parts: &[EvaluatorKind],
    needed: usize,
    cx: &Context,
    path: &str,
    roadmap: &Roadmap,
    scratch: &mut Scratch,
) -> Verdict {
    let mut verdicts = Vec::new();
    let mut asked = Asked::default();
    // Every part is judged every time, so that its values can be followed over the rounds.
    for (index, part) in parts.iter().enumerate() {
        let verdict = part.method().evaluate(cx, &format!("{path}/{index}"), roadmap, scratch);
        asked += verdict.asked;
        verdicts.push(verdict);
    }
    let satisfied = verdicts.iter().filter(|verdict| verdict.satisfied).count();
    Verdict {
        satisfied: satisfied >= needed,
        value: satisfied as f64,
        threshold: needed as f64,
        answer: None,
        parts: verdicts,
        asked,
    }
}

#[cfg(test)]
mod tests;
