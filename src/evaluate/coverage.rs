use super::attaching::{attaching, default_neighbors, default_planners};
use super::samples::{self, Samples, share};
use super::{Evaluator, Verdict};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::Attachment;
use crate::roadmap::Roadmap;

attaching! {
    /// Enough of the samples can be connected to the roadmap: TR05-007 §3.2, *"It attempts to connect c nodes,
    /// either randomly generated or user specified, to the roadmap. It returns success if it can connect at
    /// least x% of them"*.
    pub struct Coverage {
        /// The samples; TR05-007 §4.2 draws 100.
        #[serde(default = "samples::default_samples")]
        pub samples: Samples,
        /// The least percentage; TR05-007 §4.2 asks for 95.
        #[serde(default = "default_percent")]
        pub percent: f64,
    }
}

impl Default for Coverage {
    fn default() -> Coverage {
        Coverage {
            samples: samples::default_samples(),
            percent: default_percent(),
            neighbors: default_neighbors(),
            planners: default_planners(),
        }
    }
}

fn default_percent() -> f64 {
    95.0
}

impl Evaluator for Coverage {
    fn name(&self) -> &'static str {
        "coverage"
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
        let covered = reached.iter().filter(|components| !components.is_empty()).count();
        share(covered, reached.len(), self.percent / 100.0, scratch.take_asked())
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
