use super::segments::medial_axis::MedialAxis;
use super::segments::{self, Segments};
use super::{GaveUp, Sampler, no_length, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Uniform medial axis sampling: milestones spread evenly over the medial axis of the free space (H.-Y. Yeh, J. Denny,
/// A. Lindsey, S. Thomas, N. M. Amato, *UMAPRM: Uniformly sampling the medial axis*, 2014; H.-Y. Yeh's dissertation, 2016, chapter 5).
///
/// Draws segments of a fixed length, their starts and directions uniform, and finds what is nearest at every step:
/// which obstacle, and which convex body, or vertex, edge or triangle of a mesh. Where that changes between two
/// neighbours, other than to a part that continues the surface without a concavity, the interval between them is bisected
/// down to the tolerance, and if the nearest point does jump there, the middle of the last interval becomes a milestone. A
/// segment may give several; those that a set no longer needs are dropped. Segments start within the bounds widened by their
/// length (§5.1.1), or the axis near the bounds would be hit less often. The text widens by the robot's diameter as well, which is not needed
/// where segments are laid in the configuration space.
///
/// *Which medial axis.* Distances are those of the workspace, between the robot's surface and that of the nearest obstacle. For a
/// point, and for any robot that is only translated, that is the distance in the configuration space, and the axis
/// is that of the free space: the two distances of a milestone differ by no more than the tolerance. For robots that
/// turn or have joints it approximates that axis: within the configurations of the same rotation and joint values, and by
/// the body's nearest point, the two distances are equal; links that must not touch one another are not seen. Milestones are
/// always valid.
///
/// Crossings are missed where a segment passes the axis twice within a step, or between the surface of an obstacle and the step
/// beside it, as well as where the two nearest points are nearer to each other than the tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Umaprm {
    /// Length of a segment in the space's metric.
    pub length: f64,
    /// Distance of neighbouring configurations on a segment.
    pub step: f64,
    /// The length to which an interval that crosses the medial axis is bisected.
    pub tolerance: f64,
    /// Whether the sides of the bounds are obstacles, so that milestones also lie between them and others. Ranges of joints are
    /// none.
    #[serde(default)]
    pub bounds: bool,
    /// The most segments laid for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Umaprm {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(length: f64, step: f64, tolerance: f64) -> Umaprm {
        Umaprm { length, step, tolerance, bounds: false, attempts: default_attempts() }
    }
}

fn default_attempts() -> u64 {
    10_000
}

/// The least tolerance, as a share of the step.
const FINEST: f64 = 1e-9;

impl Sampler for Umaprm {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let Umaprm { length, step, tolerance, bounds, attempts } = *self;
        let Some(mut target) = MedialAxis::new(cx, bounds, tolerance) else {
            return if count == 0 { Ok(()) } else { Err(GaveUp { attempts: 0 }) };
        };
        let starts = cx.space.widened(length);
        let segments = Segments { space: &cx.space, starts, length, step, attempts };
        segments.sample(&mut target, &mut seed.stream(Purpose::Sampling), count, scratch, out)
    }

    fn complaint(&self) -> Option<Complaint> {
        let lengths = segments::complaint(self.length, self.step)
            .or_else(|| no_length("tolerance", self.tolerance));
        if lengths.is_some() {
            return lengths;
        }
        if !(self.step * FINEST..=self.step).contains(&self.tolerance) {
            let expected = "a billionth of the step up to the step";
            return Some(Complaint::new("tolerance", self.tolerance, expected));
        }
        zero("attempts", self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        let Some(clearances) = cx.model.clearances() else {
            let expected = "bodies, which know how far obstacles are, expected";
            return Err(format!("a sampler on the medial axis found; {expected}"));
        };
        let mut q = vec![0.0; cx.space.len()];
        cx.space.of_cube(&vec![0.5; cx.space.cube_dimensions()], &mut q);
        match self.bounds || clearances.clearance(&q, &mut Scratch::new()).is_some() {
            true => Ok(()),
            false => Err("a sampler on the medial axis found, but nothing to be far from; \
                          obstacles, or `bounds = true`, expected"
                .to_owned()),
        }
    }
}
