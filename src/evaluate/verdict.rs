use crate::model::Asked;
use crate::query::Answer;
use crate::wire::decode_nested;
use bincode::{Decode, Encode};
use serde::Serialize;

/// What an evaluator says of a roadmap.
#[derive(Clone, Debug, PartialEq, Encode)]
pub struct Verdict {
    /// Whether the criterion is met.
    pub satisfied: bool,
    /// The measured value.
    pub value: f64,
    /// What it is compared with.
    pub threshold: f64,
    /// How it is compared.
    pub bound: Bound,
    /// Further numbers; [`Evaluator::measures`](super::Evaluator::measures) names them.
    pub measures: Vec<f64>,
    /// Of the query evaluator: the answer, with the path.
    pub answer: Option<Answer>,
    /// Of the max-flow evaluator: a least cut, the one nearest to where the flow begins.
    pub cut: Option<Vec<CutEdge>>,
    /// Of a criterion made of others: what they say.
    pub parts: Vec<Verdict>,
    /// What the evaluation cost.
    pub asked: Asked,
}

decode_nested!(Verdict { satisfied, value, threshold, bound, measures, answer, cut, parts, asked });

/// On which side of its threshold a value meets the criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// The threshold is the least value that does.
    AtLeast,
    /// The threshold is the largest value that does.
    AtMost,
}

/// An edge that a cut severs. Ids beyond the roadmap's name the evaluator's own configurations, in
/// their order: first those where the flow begins, then those where it ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Encode, Decode)]
pub struct CutEdge {
    /// The end on the side where the flow begins.
    pub from: u32,
    /// The other end.
    pub to: u32,
    /// How much flows through it at most.
    pub capacity: f64,
}

impl Verdict {
    /// The verdict on a value that must be at least `threshold`.
    pub fn at_least(threshold: f64, value: f64, asked: Asked) -> Verdict {
        Verdict::new(value >= threshold, Bound::AtLeast, threshold, value, asked)
    }

    /// The verdict on a value that must be at most `threshold`.
    pub fn at_most(threshold: f64, value: f64, asked: Asked) -> Verdict {
        Verdict::new(value <= threshold, Bound::AtMost, threshold, value, asked)
    }

    fn new(satisfied: bool, bound: Bound, threshold: f64, value: f64, asked: Asked) -> Verdict {
        let (measures, parts) = (Vec::new(), Vec::new());
        Verdict {
            satisfied,
            value,
            threshold,
            bound,
            measures,
            answer: None,
            cut: None,
            parts,
            asked,
        }
    }

    /// The answer to the problem's query, wherever in the tree it was asked.
    pub fn answer(&self) -> Option<&Answer> {
        self.answer.as_ref().or_else(|| self.parts.iter().find_map(Verdict::answer))
    }
}
