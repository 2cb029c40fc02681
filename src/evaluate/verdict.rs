use crate::model::Asked;
use crate::numbers::NodeId;
use crate::query::Answer;
use crate::wire::decode_nested;
use bincode::{Decode, Encode};
use serde::Serialize;

/// An evaluator's verdict on a roadmap.
#[derive(Clone, Debug, PartialEq, Encode)]
pub struct Verdict {
    /// Whether the criterion is met.
    pub satisfied: bool,
    /// The measured value.
    pub value: f64,
    /// The number that the value is compared with.
    pub threshold: f64,
    /// On which side of the threshold the value must be.
    pub bound: Bound,
    /// Further numbers; [`Evaluator::measures`](super::Evaluator::measures) names them.
    pub measures: Vec<f64>,
    /// The answer to the query, with the path; of evaluators that look for a path only.
    pub answer: Option<Answer>,
    /// A minimum cut, the one nearest to where the flow comes from; of the evaluators of flows only.
    pub cut: Option<Vec<CutEdge>>,
    /// The verdicts of the parts of a combined criterion.
    pub parts: Vec<Verdict>,
    /// The validity checks that the evaluation took.
    pub asked: Asked,
}

decode_nested!(Verdict { satisfied, value, threshold, bound, measures, answer, cut, parts, asked });

/// On which side of its threshold a value meets the criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Bound {
    /// The value must be at least the threshold.
    AtLeast,
    /// The value must be at most the threshold.
    AtMost,
}

/// An edge of a cut. Ids that follow those of the roadmap's nodes are the evaluator's own configurations, in their
/// order: first the sources of the flow, then the sinks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Encode, Decode)]
pub struct CutEdge {
    /// The end on the sources' side.
    pub from: NodeId,
    /// The end on the sinks' side.
    pub to: NodeId,
    /// The most that can flow through the edge.
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

    /// The answer to the problem's query, if this verdict or one of its parts, at any depth, has it.
    pub fn answer(&self) -> Option<&Answer> {
        self.answer.as_ref().or_else(|| self.parts.iter().find_map(Verdict::answer))
    }
}
