//! How approximate paths become milestones: what the method [`Hints`](super::Hints) is made of.
//!
//! [`polyline`] samples a path, [`gaps`] finds where a roadmap leaves it broken, [`lay`] makes a stretch of it milestones, [`bridge`] grows the two sides of a gap
//! together, and [`near`] draws configurations near it.

mod bridge;
mod gaps;
mod lay;
mod near;
mod polyline;

pub(super) use bridge::bridge;
pub(super) use gaps::broken;
pub(super) use lay::Layer;
pub(super) use near::draw_near;
pub(super) use polyline::fitted;

#[cfg(test)]
mod tests;
