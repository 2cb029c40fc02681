//! What makes a configuration and a motion of bodies valid.

mod bodies;
mod clearance;
mod contacts;
mod convex;
mod directions;
mod element;
mod frame;
mod freedom;
mod gaps;
mod inside;
mod light;
mod meet;
mod motion;
mod nearest;
mod obb;
mod origin;
mod piece;
mod reasons;
mod scratch;
mod shells;
mod swept;
mod swept_box;
mod touching;
mod tree;
mod triangles;
mod witness;
mod work;

pub use bodies::{BodyValidity, Bounds, BoundsMeaning, MotionChecking};
pub use motion::TOLERANCE;
pub use scratch::BodyScratch;
pub use touching::PairTouches;
pub use work::Work;

pub(crate) use convex::{Convex, nearest};
pub(crate) use directions::separating_axis;
pub(crate) use inside::{Inside, crossing};
pub(crate) use triangles::nearest_points;

#[cfg(test)]
mod gaps_tests;
#[cfg(test)]
mod invariance_tests;
#[cfg(test)]
mod padding_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tree_tests;
#[cfg(test)]
mod witness_tests;
