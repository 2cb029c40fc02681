use super::attaching::{attaching, default_neighbors, default_planners};
use super::flow::{Attached, Capacities, complaint_of_least_weight};
use super::{Evaluator, Verdict};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::Attachment;
use crate::roadmap::Roadmap;

attaching! {
    /// Enough can flow through the roadmap from one configuration, or any of several, to another: TR05-007 §3.2,
    /// *"If a roadmap edge weight, w(e), reflects the likelihood that the protein will move from one
    /// configuration to the next, then we can define edge capacity c(e) as 1/w(e). The evaluator returns
    /// success if the max-flow between the two configurations is above some threshold f."*
    ///
    /// The configurations are attached to their nearest nodes as a query's are. An edge has its capacity in each
    /// direction. Weights below `least_weight` are raised to it, since 1/w has no bound. Capacities are rounded to whole
    /// multiples of 2⁻³² of the largest one, 1/`least_weight`; for the rounded capacities the maximum flow is exact and
    /// equals the minimum cut, which the verdict holds.
    pub struct MaxFlow {
        /// The least flow that satisfies the criterion, in the unit of 1/weight.
        pub flow: f64,
        /// The sources of the flow; an empty list stands for the query's start.
        #[serde(default)]
        pub from: Vec<Vec<f64>>,
        /// The sinks of the flow; an empty list stands for the query's goal.
        #[serde(default)]
        pub to: Vec<Vec<f64>>,
        /// The least weight that an edge counts with; by default a thousandth of the space's diameter.
        pub least_weight: Option<f64>,
    }
}

impl MaxFlow {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(flow: f64) -> MaxFlow {
        MaxFlow {
            flow,
            from: Vec::new(),
            to: Vec::new(),
            least_weight: None,
            neighbors: default_neighbors(),
            planners: default_planners(),
        }
    }
}

const ENDS_MAX: usize = 10_000;

impl MaxFlow {
    fn least_weight(&self, cx: &Context) -> f64 {
        let chosen = self.least_weight.unwrap_or(cx.space.diameter() / 1000.0);
        if chosen > 0.0 { chosen } else { 1.0 }
    }
}

impl Evaluator for MaxFlow {
    fn name(&self) -> &'static str {
        "max-flow"
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        scratch.take_asked();
        let query = cx.query.as_ref();
        let [from, to] =
            [(&self.from, query.map(|ends| &ends.start)), (&self.to, query.map(|ends| &ends.goal))]
                .map(|(listed, asked)| match asked {
                    Some(asked) if listed.is_empty() => std::slice::from_ref(asked),
                    _ => &listed[..],
                });

        let attached = Attached::of(cx, roadmap, [from, to], &self.how(), scratch);
        let flow = attached.flow(Capacities { least: self.least_weight(cx) }, false);
        let asked = scratch.take_asked();
        Verdict { cut: Some(flow.cut), ..Verdict::at_least(self.flow, flow.value, asked) }
    }

    fn needs_query(&self) -> bool {
        self.from.is_empty() || self.to.is_empty()
    }

    fn attachment(&self) -> Option<Attachment> {
        Some(self.how())
    }

    fn complaint(&self) -> Option<Complaint> {
        if !(self.flow > 0.0 && self.flow.is_finite()) {
            return Some(Complaint::new("flow", self.flow, "a positive number"));
        }
        let most = self.from.len().max(self.to.len());
        if most > ENDS_MAX {
            return Some(Complaint::new("from, to", most, "at most 10000 configurations"));
        }
        complaint_of_least_weight(self.least_weight).or_else(|| self.how().complaint())
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        for (key, list) in [("from", &mut self.from), ("to", &mut self.to)] {
            for (index, q) in list.iter_mut().enumerate() {
                cx.accept(q).map_err(|error| format!("{key}[{index}]: {error}"))?;
            }
        }
        Ok(())
    }
}
