//! What makes a configuration and a motion valid.

mod bodies;
mod clearance;
mod directions;
mod element;
mod frame;
mod inside;
mod light;
mod meet;
mod motion;
mod nearest;
mod obb;
mod piece;
mod scratch;
mod swept;
mod tree;
mod triangles;
mod work;

pub use bodies::{BodyValidity, Bounds, BoundsMeaning, Edges};
pub use clearance::Clearance;
pub use motion::TOLERANCE;
pub use scratch::{Asked, Scratch};
pub use work::Work;

/// The verdict on a configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// In bounds, and the robot touches nothing.
    Free,
    /// Not in bounds; whether the robot would touch anything is not known.
    OutOfBounds,
    /// In bounds, but the robot touches an obstacle or itself.
    Colliding,
}

/// Decides which configurations and motions are valid.
///
/// Verdicts are pure functions of their arguments: what a [`Scratch`] remembers may change how
/// fast a verdict comes, never the verdict.
pub trait Validity: Send + Sync {
    /// The verdict on the robot at `q`. Bounds are checked first.
    fn state(&self, q: &[f64], scratch: &mut Scratch) -> State;

    /// Whether the robot at `q` is in bounds and touches nothing.
    fn valid(&self, q: &[f64], scratch: &mut Scratch) -> bool {
        self.state(q, scratch) == State::Free
    }

    /// Whether the motion from `a` to `b` along [`Space::interpolate`](crate::space::Space), whose
    /// ends are valid, is valid; [`Edges`] says in which of two senses. The problem's resolution is
    /// divided by `refinement`.
    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> bool;

    /// Whether any configuration in bounds could collide: there are obstacles, or links that must not
    /// touch one another.
    fn obstructed(&self) -> bool;

    /// Number of equal steps into which that motion is cut so that no robot point moves farther than
    /// the problem's resolution divided by `refinement` in one of them.
    fn steps(&self, a: &[f64], b: &[f64], refinement: u32) -> u64;

    /// The distance from the robot at `q` to the nearest obstacle, and where; `None` if there are no obstacles.
    fn clearance(&self, q: &[f64], scratch: &mut Scratch) -> Option<Clearance>;
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod tree_tests;
