use super::attaching::{attaching, between_ends, default_neighbors, default_planners};
use super::flow::{Attached, Capacities, Flow, complaint_of_least_weight};
use super::{Evaluator, Verdict};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::Roadmap;

attaching! {
    /// The roadmap has alternatives: the maximum flow between the query's ends is several times what its widest single path
    /// carries, from the start to the goal and back.
    ///
    /// Capacities are those of [`MaxFlow`](super::MaxFlow) (TR05-007 §3.2): an edge carries 1/w in a direction that costs w.
    /// A path carries as much as the edge on it that carries least, and the widest path is the one that carries most
    /// (M. Pollack, *The maximum capacity through a network*, 1960). Where one bottleneck is in all ways the ratio is 1;
    /// unlike a flow, the ratio has no unit, so that one threshold suits any problem. The value is the smaller of the two
    /// ratios, 0 while the ends are not connected; the cut is that of its direction. The start has the first id after the
    /// roadmap's nodes, the goal the next.
    pub struct FlowRatio {
        /// The least ratio that satisfies the criterion.
        #[serde(default = "default_ratio")]
        pub ratio: f64,
        /// The least weight that an edge counts with. By default 1 in a model with energies, where the unit of costs is one that
        /// matters: of proteins 1 kT, below which a climb is no obstacle. Otherwise a thousandth of the space's diameter.
        pub least_weight: Option<f64>,
    }
}

impl Default for FlowRatio {
    fn default() -> FlowRatio {
        FlowRatio {
            ratio: default_ratio(),
            least_weight: None,
            neighbors: default_neighbors(),
            planners: default_planners(),
        }
    }
}

fn default_ratio() -> f64 {
    5.0
}

impl FlowRatio {
    fn capacities(&self, cx: &Context, is_directed: bool) -> Capacities {
        let usual = if is_directed { 1.0 } else { cx.space.diameter() / 1000.0 };
        let least = self.least_weight.unwrap_or(usual);
        Capacities { least: if least > 0.0 { least } else { 1.0 } }
    }
}

/// The flow from one node to another, and what the widest path between them carries.
fn ratio(flow: &Flow, widest: u64) -> f64 {
    if widest == 0 { 0.0 } else { flow.whole as f64 / widest as f64 }
}

impl Evaluator for FlowRatio {
    fn name(&self) -> &'static str {
        "flow-ratio"
    }

    fn measures(&self) -> &'static [&'static str] {
        &["flow", "widest", "flow back", "widest back"]
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        scratch.take_asked();
        let attached = Attached::of_query(cx, roadmap, &self.how(), scratch);
        let capacities =
            self.capacities(cx, attached.edges.iter().any(|e| e.cost.directed().is_some()));
        let graph = attached.graph();
        let widest = |from: NodeId, to: NodeId| {
            let weight = graph.least_largest_weight(from, to, capacities.least);
            weight.map_or(0, |weight| capacities.whole(weight))
        };
        let (start, goal) = (attached.sources[0], attached.sinks[0]);
        let [there, back] = [false, true].map(|back| attached.flow(capacities, back));
        let single = [widest(start, goal), widest(goal, start)];
        let ratios = [ratio(&there, single[0]), ratio(&back, single[1])];
        let [one, other] = single.map(|whole| capacities.real(whole));
        let measures = vec![there.value, one, back.value, other];
        let (value, cut) =
            if ratios[1] < ratios[0] { (ratios[1], back.cut) } else { (ratios[0], there.cut) };
        let verdict = Verdict::at_least(self.ratio, value, scratch.take_asked());
        Verdict { measures, cut: Some(cut), ..verdict }
    }

    between_ends!();

    fn complaint(&self) -> Option<Complaint> {
        if !(self.ratio > 0.0 && self.ratio.is_finite()) {
            return Some(Complaint::new("ratio", self.ratio, "a positive number"));
        }
        complaint_of_least_weight(self.least_weight).or_else(|| self.how().complaint())
    }
}
