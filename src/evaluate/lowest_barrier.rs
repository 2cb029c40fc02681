use super::attaching::{attaching, between_ends, default_neighbors, default_planners, ends};
use super::{Evaluator, Verdict, accept_energies};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::lowest_barrier;
use crate::roadmap::Roadmap;

attaching! {
    /// The lowest barrier between the query's ends is low enough: of all ways through the roadmap, and the direct motion, the
    /// one on which the highest energy is least (the minimax path; M. Pollack, *The maximum capacity through a network*, 1960).
    ///
    /// The value is that energy, an upper bound of the true one since every edge's peak is; infinite while the ends are
    /// not connected. The ends are attached as a query's are, and stay attached to the nodes that were once their
    /// nearest: so the value never rises from round to round. The path found is the shortest, by the edges' costs,
    /// among those with that barrier. Defined for models with energies.
    pub struct LowestBarrier {
        /// The highest energy that will do.
        pub energy: f64,
    }
}

impl LowestBarrier {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(energy: f64) -> LowestBarrier {
        LowestBarrier { energy, neighbors: default_neighbors(), planners: default_planners() }
    }
}

impl Evaluator for LowestBarrier {
    fn name(&self) -> &'static str {
        "lowest-barrier"
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        scratch.take_asked();
        let (barrier, answer) = lowest_barrier(cx, roadmap, ends(cx), &self.how(), scratch);
        let asked = scratch.take_asked();
        Verdict { answer: Some(answer), ..Verdict::at_most(self.energy, barrier, asked) }
    }

    between_ends!();

    fn complaint(&self) -> Option<Complaint> {
        if !self.energy.is_finite() {
            return Some(Complaint::new("energy", self.energy, "a finite energy"));
        }
        self.how().complaint()
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        accept_energies(cx, "a lowest barrier")
    }
}
