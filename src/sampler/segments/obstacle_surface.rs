//! The surfaces of C-obstacles.

use super::{Segment, Step, Target};
use crate::context::Context;
use crate::model::Scratch;
use crate::sampler::collides;
use crate::space::Space;
use std::collections::VecDeque;

/// The boundary between free and colliding configurations, crossed where one of two neighbours is free and the other
/// collides (H.-Y. Yeh 2016, Algorithm 6). The free one is the milestone: it is within a step of the surface.
pub(in crate::sampler) struct ObstacleSurface<'a> {
    cx: &'a Context,
    /// Whether a configuration out of bounds is taken as colliding.
    bounds: bool,
    /// Whether the last configuration became a milestone when it was reached, so that it is not one again.
    kept: bool,
}

impl<'a> ObstacleSurface<'a> {
    pub fn new(cx: &'a Context, bounds: bool) -> ObstacleSurface<'a> {
        ObstacleSurface { cx, bounds, kept: false }
    }
}

impl Target for ObstacleSurface<'_> {
    /// Whether the configuration collides; `None` if it is neither free nor colliding.
    type Side = Option<bool>;

    fn begin(&mut self) {
        self.kept = false;
    }

    fn side(&mut self, q: &[f64], scratch: &mut Scratch) -> Option<bool> {
        collides(self.cx.model.validity(q, scratch), self.bounds)
    }

    fn crossings(
        &mut self,
        _segment: &Segment,
        [before, now]: [&Step<Option<bool>>; 2],
        _scratch: &mut Scratch,
        found: &mut VecDeque<Vec<f64>>,
    ) {
        let comes_out = (before.side, now.side) == (Some(true), Some(false));
        match (before.side, now.side) {
            // A free configuration between two that collide is a milestone once, not twice.
            (Some(false), Some(true)) if !self.kept => found.push_back(before.q.clone()),
            _ if comes_out => found.push_back(now.q.clone()),
            _ => {}
        }
        self.kept = comes_out;
    }
}

/// Where segments of a length start that can cross the surface of a C-obstacle: the box in which the base is where the robot may
/// touch an obstacle, longer by the length at either end, but no longer than the bounds would be. Without such a box, or
/// where bounds count as obstacles, it is the bounds, longer by the length at either end.
///
/// With min_O and max_O the ends of the obstacles' box, r the robot's reach from its base and l the length, that is min′ =
/// max(min_O − (l + r), min − l) and max′ = min(max_O + (l + r), max + l) along every axis of the base. Yeh's Algorithm 7 has
/// min and max in the place of min − l and max + l, which never widens the bounds, against its §4.1.1 and Figure 4.3: then
/// fewer segments reach surfaces near the bounds. (Its r is the robot's diameter, which is not enough where the robot's reference
/// point lies outside of the robot.)
pub(in crate::sampler) fn starts_near_obstacles(cx: &Context, length: f64, bounds: bool) -> Space {
    let wide = cx.space.widened(length);
    match cx.model.touching_box().filter(|_| !bounds) {
        Some(touching) => wide.narrowed(touching, length),
        None => wide,
    }
}
