use super::attaching::{attaching, between_ends, default_neighbors, default_planners, ends};
use super::{Evaluator, Verdict, accept_energies};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::lowest_barriers;
use crate::roadmap::{Extent, Roadmap};

attaching! {
    /// More nodes hardly lower the barrier any more: the [lowest barrier](super::LowestBarrier) between the query's ends fell
    /// by at most `energy` while the number of nodes doubled.
    ///
    /// The barrier now is compared with that of the roadmap as it was at the end of the last round at which it had at most
    /// half of the nodes. Both are found in the same way, so that the barrier never rises from the one to the other. The
    /// value is by how much it fell; infinite while the ends are not connected, or were not then. Defined for models
    /// with energies.
    pub struct BarrierTrend {
        /// The largest fall that satisfies the criterion, in the model's unit of energy (kT is 2.479 kJ/mol at 298 K).
        pub energy: f64,
    }
}

impl BarrierTrend {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(energy: f64) -> BarrierTrend {
        BarrierTrend { energy, neighbors: default_neighbors(), planners: default_planners() }
    }
}

/// How far the roadmap went when it had at most half of its nodes.
fn at_half(roadmap: &Roadmap) -> Extent {
    let nodes = roadmap.configs().len();
    let half = roadmap.rounds().iter().rev().find(|extent| extent.nodes <= nodes / 2);
    half.copied().unwrap_or_default()
}

impl Evaluator for BarrierTrend {
    fn name(&self) -> &'static str {
        "barrier-trend"
    }

    fn measures(&self) -> &'static [&'static str] {
        &["barrier", "barrier at half", "nodes at half"]
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        scratch.take_asked();
        let half = at_half(roadmap);
        let [before, now] = lowest_barriers(cx, roadmap, half, ends(cx), &self.how(), scratch);
        let fell = if now.is_finite() && before.is_finite() { before - now } else { f64::INFINITY };
        let measures = vec![now, before, half.nodes as f64];
        Verdict { measures, ..Verdict::at_most(self.energy, fell, scratch.take_asked()) }
    }

    between_ends!();

    fn complaint(&self) -> Option<Complaint> {
        if !(self.energy >= 0.0 && self.energy.is_finite()) {
            return Some(Complaint::new("energy", self.energy, "a finite energy, not negative"));
        }
        self.how().complaint()
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        accept_energies(cx, "a trend of the barrier")
    }
}
