use super::attaching::{attaching, between_ends, default_neighbors, default_planners, ends};
use super::flow::Attached;
use super::{Evaluator, Verdict, accept_energies};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Roadmap;
use std::collections::BTreeSet;

attaching! {
    /// There are several ways under a barrier: at least `count` paths between the query's ends no two of which have an edge in
    /// common, and none of which goes above an energy.
    ///
    /// The energy is given, or by `above` as so much more than the lowest barrier that the roadmap has. The number of such paths
    /// is a maximum flow where every edge carries 1 (K. Menger, *Zur allgemeinen Kurventheorie*, 1927), the same in both
    /// directions. An edge's peak is an upper bound of the energies on it. The direct motion is no edge of the roadmap and
    /// does not count. Defined for models with energies.
    pub struct DisjointPaths {
        /// How many paths satisfy the criterion.
        #[serde(default = "default_count")]
        pub count: u32,
        /// The highest energy that a path may reach, in the model's unit of energy. Either this or `above` is given.
        pub energy: Option<f64>,
        /// How far above the lowest barrier a path may reach, in the model's unit of energy.
        pub above: Option<f64>,
    }
}

impl DisjointPaths {
    /// The method for so many paths up to an energy.
    pub fn up_to(count: u32, energy: f64) -> DisjointPaths {
        let (neighbors, planners) = (default_neighbors(), default_planners());
        DisjointPaths { count, energy: Some(energy), above: None, neighbors, planners }
    }

    /// The method for so many paths up to so much more than the lowest barrier.
    pub fn above_lowest(count: u32, above: f64) -> DisjointPaths {
        DisjointPaths { energy: None, above: Some(above), ..DisjointPaths::up_to(count, 0.0) }
    }
}

fn default_count() -> u32 {
    2
}

impl Evaluator for DisjointPaths {
    fn name(&self) -> &'static str {
        "disjoint-paths"
    }

    fn measures(&self) -> &'static [&'static str] {
        &["highest energy", "lowest barrier"]
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
        let energy = cx.model.energy(ends(cx).0, scratch).unwrap_or(f64::NEG_INFINITY);
        let (start, goal) = (attached.sources[0], attached.sinks[0]);
        let lowest = attached.graph().lowest_barrier(start, goal, energy, &BTreeSet::new());
        let lowest = lowest.map_or(f64::INFINITY, |(barrier, _)| barrier);
        let highest = self.energy.unwrap_or(lowest + self.above.unwrap_or(0.0));
        let paths =
            attached.disjoint(|edge| edge.cost.directed().is_some_and(|cost| cost.peak <= highest));
        let verdict = Verdict::at_least(f64::from(self.count), paths as f64, scratch.take_asked());
        Verdict { measures: vec![highest, lowest], ..verdict }
    }

    between_ends!();

    fn complaint(&self) -> Option<Complaint> {
        if self.count == 0 {
            return Some(Complaint::new("count", "0", "at least 1"));
        }
        match (self.energy, self.above) {
            (Some(energy), None) if energy.is_finite() => self.how().complaint(),
            (None, Some(above)) if above >= 0.0 && above.is_finite() => self.how().complaint(),
            (Some(energy), None) => Some(Complaint::new("energy", energy, "a finite energy")),
            (None, Some(above)) => {
                Some(Complaint::new("above", above, "a finite energy, not negative"))
            }
            (Some(_), Some(_)) => Some(Complaint::new("energy, above", "both", "one of the two")),
            (None, None) => Some(Complaint::new("energy, above", "neither", "one of the two")),
        }
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        accept_energies(cx, "paths under a barrier")
    }
}
