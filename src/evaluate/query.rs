use super::attaching::{attaching, between_ends};
use super::{Evaluator, Verdict};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::{Attachment, solve_any};
use crate::roadmap::Roadmap;

attaching! {
    /// The problem's query is solved: TR05-007 §3.2, *"It attempts to connect the start and goal to
    /// the roadmap, and returns successful if they are connected to the same connected component."*
    ///
    /// It differs from the report in three points. Of several goals any will do, and of the paths to them the one that costs
    /// least is given out. The path found must also pass the finer check that
    /// every path passes before it is given out ([`crate::query`]), so that a build never ends with
    /// a query that it cannot answer; and start and goal may be joined by the direct motion, too, for
    /// which no roadmap is needed.
    pub struct Query {}
}

impl Default for Query {
    fn default() -> Query {
        let Attachment { neighbors, planners } = Attachment::default();
        Query { neighbors, planners }
    }
}

impl Evaluator for Query {
    fn name(&self) -> &'static str {
        "query"
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        scratch.take_asked();
        let attachment = self.how();
        let ends = cx.query.as_ref().expect("a checked problem has the query");
        let answer = solve_any(cx, roadmap, ends, &attachment, scratch);
        let solved = f64::from(u8::from(answer.path.is_some()));
        let asked = scratch.take_asked();
        Verdict { answer: Some(answer), ..Verdict::at_least(1.0, solved, asked) }
    }

    between_ends!();

    fn knows_several_goals(&self) -> bool {
        true
    }

    fn complaint(&self) -> Option<Complaint> {
        self.how().complaint()
    }
}
