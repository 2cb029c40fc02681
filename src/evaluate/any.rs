use super::{Evaluator, EvaluatorKind, Verdict, combined};
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
        if self.0.is_empty() {
            return Some(Complaint::new("any", "[]", "at least one criterion"));
        }
        self.0.iter().find_map(|part| part.method().complaint())
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        self.0.iter_mut().try_for_each(|part| part.method_mut().accept(cx))
    }
}
