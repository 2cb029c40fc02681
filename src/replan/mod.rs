//! Replanning: what of a roadmap is left when the obstacles have changed (S. K. Nath, *Multi-directional rapidly exploring
//! random graph (mRRG) for motion planning*, Texas A&M University 2013, §5.2.2.1).
//!
//! A roadmap of the same robot among the old obstacles is *revalidated*: nodes and edges that the change makes invalid are
//! removed. Only what has changed is looked at ([`Revalidation`]): an edge was valid among the old obstacles, so among the
//! new ones it is valid if none of those that came is in its way, and most edges are passed by at the cost of comparing
//! boxes. Where obstacles went there may be motions that were refused before; these are tried again ([`retried`]).
//!
//! [`Survivors`](crate::generator::Survivors) makes the first set of a new build of this, and
//! [`Problem::replanned`](crate::problem::Problem::replanned) the problem that begins with it.

mod retry;
mod revalidation;

pub use retry::retried;
pub(crate) use retry::retried_until;
pub use revalidation::Revalidation;
