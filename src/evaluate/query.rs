use super::{Evaluator, Verdict, samples};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::{Attachment, solve};
use crate::roadmap::Roadmap;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The problem's query is solved: TR05-007 §3.2, *"It attempts to connect the start and goal to
/// the roadmap, and returns successful if they are connected to the same connected component."*
///
/// Stricter than the report in one point: the path found must also pass the finer check that
/// every path passes before it is given out ([`crate::query`]), so that a build never ends with
/// a query that it cannot answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Query {
    /// How many nearest nodes start and goal try to connect to.
    #[serde(default = "samples::default_neighbors")]
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "samples::default_planners")]
    pub planners: Vec<Planner>,
}

impl Default for Query {
    fn default() -> Query {
        let Attachment { neighbors, planners } = Attachment::default();
        Query { neighbors, planners }
    }
}

impl Query {
    fn how(&self) -> Attachment {
        Attachment { neighbors: self.neighbors, planners: self.planners.clone() }
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
        let query = cx.query.as_ref().expect("a checked problem has the query");
        let ends = (&query.start[..], &query.goal[..]);
        let attachment = self.how();
        let answer = solve(cx, roadmap, ends, &attachment, scratch);
        let solved = f64::from(u8::from(answer.path.is_some()));
        let asked = scratch.take_asked();
        Verdict { answer: Some(answer), ..Verdict::at_least(1.0, solved, asked) }
    }

    fn needs_query(&self) -> bool {
        true
    }

    fn attachment(&self) -> Option<Attachment> {
        Some(self.how())
    }

    fn complaint(&self) -> Option<Complaint> {
        self.how().complaint()
    }
}
