//! The uniform sampling framework (H.-Y. Yeh's dissertation, 2016, chapter 3, Algorithm 5): segments of a fixed length are
//! laid uniformly into the configuration space, and where one crosses a *target surface* is a milestone. One file per
//! target: [`obstacle_surface`] is that of UOBPRM, [`medial_axis`] that of UMAPRM. Another one needs a file with a
//! [`Target`].
//!
//! *What is uniform.* The space is a product of intervals, circles and rotation groups, with a metric that weighs each
//! factor. A segment starts at a configuration drawn by the space's measure (lengths on intervals, angles on circles, the Haar
//! measure on rotations), leaves it in a direction drawn uniformly from the unit sphere of the metric's tangent space, and is
//! part of a geodesic. The motion along geodesics preserves the product of these two measures, so that every point of a segment,
//! with its direction, is distributed as the start is. The expected number of crossings with a piece of a surface is
//! therefore proportional to the area of the piece *in the space's metric*, of one dimension less than the space (L. A.
//! Santaló, *Integral geometry and geometric probability*, 1976, §19.1): it depends neither on where the piece lies nor on how it
//! is bent. That holds for points, rigid bodies and linkages alike; only how much a turn counts beside a translation is
//! the metric's to say, by its weights.
//!
//! It holds as far as segments may start in all places from which they reach the surface. Angles and rotations have no
//! bounds; along intervals the space of the starts is wider than the bounds, see [`Segments::starts`].
//!
//! Crossings are independent of one another only if they are of different segments.

pub(super) mod medial_axis;
pub(super) mod obstacle_surface;

use super::{GaveUp, collect, no_length};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::Stream;
use crate::space::{Direction, Space};
use std::collections::VecDeque;

/// The most steps of a segment.
const STEPS_MAX: f64 = 1e6;

/// How segments are laid.
pub(super) struct Segments<'a> {
    /// The configuration space.
    pub space: &'a Space,
    /// Where segments start: the space with other intervals.
    pub starts: Space,
    /// The length of a segment in the space's metric.
    pub length: f64,
    /// Distance of neighbouring configurations on a segment.
    pub step: f64,
    /// The most segments laid for one milestone.
    pub attempts: u64,
}

/// A surface in the configuration space, told by what is found on either side of it.
pub(super) trait Target {
    /// What tells on which side of the surface a configuration is.
    type Side;

    /// Called when a new segment begins.
    fn begin(&mut self) {}

    /// On which side a configuration is.
    fn side(&mut self, q: &[f64], scratch: &mut Scratch) -> Self::Side;

    /// Appends the milestones at which the surface is crossed between two neighbouring configurations of a segment, in the
    /// segment's order.
    fn crossings(
        &mut self,
        segment: &Segment,
        steps: [&Step<Self::Side>; 2],
        scratch: &mut Scratch,
        found: &mut VecDeque<Vec<f64>>,
    );
}

/// A segment: the first part of a geodesic.
pub(super) struct Segment<'a> {
    space: &'a Space,
    start: Vec<f64>,
    direction: Direction,
}

/// A configuration on a segment.
pub(super) struct Step<S> {
    /// Its distance from the start along the segment.
    pub at: f64,
    /// The configuration.
    pub q: Vec<f64>,
    /// On which side of the target it is.
    pub side: S,
}

impl Segment<'_> {
    /// Writes the configuration at a distance from the start.
    pub fn at(&self, length: f64, out: &mut [f64]) {
        self.space.along(&self.start, &self.direction, length, out);
    }
}

impl Segments<'_> {
    /// Fills `out` with `count` milestones on a target surface. A segment may give several; those that are not needed any more are
    /// dropped.
    pub fn sample<T: Target>(
        &self,
        target: &mut T,
        stream: &mut Stream,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut found = VecDeque::new();
        collect(count, self.attempts, out, |q| {
            if found.is_empty() {
                self.lay(target, stream, scratch, &mut found);
            }
            found.pop_front().is_some_and(|milestone: Vec<f64>| {
                q.copy_from_slice(&milestone);
                true
            })
        })
    }

    /// Lays one segment and appends the crossings on it.
    pub fn lay<T: Target>(
        &self,
        target: &mut T,
        stream: &mut Stream,
        scratch: &mut Scratch,
        found: &mut VecDeque<Vec<f64>>,
    ) {
        let mut start = vec![0.0; self.space.len()];
        self.starts.sample_uniform(stream, &mut start);
        let direction = self.space.direction(stream);
        let segment = Segment { space: self.space, start, direction };
        let steps = (self.length / self.step) as u32;
        let mut last: Option<Step<T::Side>> = None;
        target.begin();
        for i in 0..=steps {
            let at = f64::from(i) * self.step;
            let mut q = vec![0.0; self.space.len()];
            segment.at(at, &mut q);
            let side = target.side(&q, scratch);
            let now = Step { at, q, side };
            if let Some(last) = &last {
                target.crossings(&segment, [last, &now], scratch, found);
            }
            last = Some(now);
        }
    }
}

/// What is wrong with the length of segments and their steps.
pub(super) fn complaint(length: f64, step: f64) -> Option<Complaint> {
    let lengths = no_length("length", length).or_else(|| no_length("step", step));
    if lengths.is_some() {
        return lengths;
    }
    let fits = (length / STEPS_MAX..=length).contains(&step);
    (!fits).then(|| Complaint::new("step", step, "a millionth of the length up to the length"))
}
