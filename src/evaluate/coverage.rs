use super::samples::{self, Samples, share};
use super::{Evaluator, Verdict};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::query::Attachment;
use crate::roadmap::Roadmap;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Enough of the samples can be connected to the roadmap: TR05-007 §3.2, *"It attempts to connect c nodes,
/// either randomly generated or user specified, to the roadmap. It returns success if it can connect at
/// least x% of them"*.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Coverage {
    /// The samples; TR05-007 §4.2 draws 100.
    #[serde(default = "samples::default_samples")]
    pub samples: Samples,
    /// The least percentage; TR05-007 §4.2 asks for 95.
    #[serde(default = "default_percent")]
    pub percent: f64,
    /// How many nearest nodes each sample tries to connect to.
    #[serde(default = "samples::default_neighbors")]
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "samples::default_planners")]
    pub planners: Vec<Planner>,
}

impl Default for Coverage {
    fn default() -> Coverage {
        Coverage {
            samples: samples::default_samples(),
            percent: default_percent(),
            neighbors: samples::default_neighbors(),
            planners: samples::default_planners(),
        }
    }
}

fn default_percent() -> f64 {
    95.0
}

impl Coverage {
    fn how(&self) -> Attachment {
        Attachment { neighbors: self.neighbors, planners: self.planners.clone() }
    }
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
