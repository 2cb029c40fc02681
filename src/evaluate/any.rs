use super::{Evaluator, EvaluatorKind, Verdict, accept_parts, combined, complaint_of_parts};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Roadmap;
use crate::wire::decode_nested;
use bincode::Encode;
use serde::{Deserialize, Serialize};

/// At least one of several criteria is met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode)]
#[serde(transparent)]
pub struct Any(pub Vec<EvaluatorKind>);

decode_nested!(Any { 0 });

impl Evaluator for Any {
    fn name(&self) -> &'static str {
        "any"
    }

    fn evaluate(
        &self,
        cx: &Context,
        path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        combined(&self.0, 1, cx, path, roadmap, scratch)
    }

    fn parts(&self) -> &[EvaluatorKind] {
        &self.0
    }

    fn complaint(&self) -> Option<Complaint> {
        complaint_of_parts(self.name(), &self.0)
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        accept_parts(&mut self.0, cx)
    }
}
