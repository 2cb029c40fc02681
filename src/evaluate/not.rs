use super::{Evaluator, EvaluatorKind, Verdict};
use crate::context::Context;
use crate::model::Scratch;
use crate::roadmap::Roadmap;
use crate::wire::decode_nested;
use bincode::Encode;
use serde::{Deserialize, Serialize};

/// A criterion is not met: to build for as long as something does not hold yet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode)]
#[serde(transparent)]
pub struct Not(pub Box<EvaluatorKind>);

decode_nested!(Not { 0 });

impl Evaluator for Not {
    fn name(&self) -> &'static str {
        "not"
    }

    fn evaluate(
        &self,
        cx: &Context,
        path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        let verdict = self.0.method().evaluate(cx, &format!("{path}/0"), roadmap, scratch);
        let value = f64::from(u8::from(!verdict.satisfied));
        let asked = verdict.asked;
        Verdict { parts: vec![verdict], ..Verdict::at_least(1.0, value, asked) }
    }

    fn parts(&self) -> &[EvaluatorKind] {
        std::slice::from_ref(&*self.0)
    }

    fn is_within(&self, brackets: u32) -> bool {
        // { not = …
        brackets.checked_sub(1).is_some_and(|rest| self.0.method().is_within(rest))
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        self.0.method_mut().accept(cx)
    }
}
