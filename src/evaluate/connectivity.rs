use super::attaching::{attaching, default_neighbors, default_planners};
use super::samples::{self, Samples, share};
use super::{Evaluator, Verdict};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::Attachment;
use crate::roadmap::Roadmap;

attaching! {
    /// Enough of the pairs of samples are connected by the roadmap: TR05-007 §3.2, *"It returns success if x% of
    /// all possible pairs in c are connected to the same connected component"*. A pair is connected when the
    /// sets of components that its two ends reach intersect.
    pub struct Connectivity {
        /// The samples; TR05-007 §4.2 draws 100.
        #[serde(default = "samples::default_samples")]
        pub samples: Samples,
        /// The least percentage; TR05-007 §4.2 asks for 75.
        #[serde(default = "default_percent")]
        pub percent: f64,
    }
}

impl Default for Connectivity {
    fn default() -> Connectivity {
        Connectivity {
            samples: samples::default_samples(),
            percent: default_percent(),
            neighbors: default_neighbors(),
            planners: default_planners(),
        }
    }
}

fn default_percent() -> f64 {
    75.0
}

impl Evaluator for Connectivity {
    fn name(&self) -> &'static str {
        "connectivity"
    }

    fn evaluate(
        &self,
        cx: &Context,
        path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        scratch.take_asked();
        let reached = self.samples.reached(cx, path, roadmap, &self.how(), scratch);
        let mut solved = 0;
        for (index, first) in reached.iter().enumerate() {
            solved += reached[..index].iter().filter(|other| !first.is_disjoint(other)).count();
        }
        let pairs = reached.len() * reached.len().saturating_sub(1) / 2;
        share(solved, pairs, self.percent / 100.0, scratch.take_asked())
    }

    fn attachment(&self) -> Option<Attachment> {
        Some(self.how())
    }

    fn is_within(&self, brackets: u32) -> bool {
        self.samples.is_within(brackets)
    }

    fn complaint(&self) -> Option<Complaint> {
        samples::complaint(&self.samples, self.percent, &self.how())
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        self.samples.accept(cx)
    }
}
