//! Collision answers at the rate of an input device: at once, and therefore approximate.
//!
//! Somebody who moves a robot by hand, to show a planner the way ([hints](crate::generator::Hints)), has to feel or see at once that
//! it collides. A force-feedback device wants an answer every millisecond, and an exact one may take longer. So an exact answer is
//! computed beside the motion, for the latest configuration asked for, and until it comes the last one is extrapolated by a
//! *projection rule*. That is the method of O. B. Bayazit, *Solving motion planning problems by iterative relaxation of
//! constraints* (dissertation, Texas A&M University 2003), chapter IV, section B.1, Figures 12 and 13.
//!
//! - [`Projection`] is the rule: it is told exact answers and asked about configurations. It is a pure function of what it was
//!   told and is asked.
//! - [`Follower`] adds a thread that computes exact answers, so that a question never waits for one.
//!
//! **Nothing is guaranteed.** An extrapolated answer may be wrong either way: robots that turn, concave obstacles, and obstacles
//! other than the nearest are not seen, nor are the bounds and the robot's own links. For approximate paths that is
//! good enough, since what collides of them is pushed free. Nothing here enters a roadmap; which answers are exact depends on
//! how fast the machine is, so no result of planning may depend on them.
//!
//! No haptic device was at hand when this was written: recorded motions were replayed at 1 kHz
//! (`docs/hints.md`, "Answers at the rate of a device"), and nobody has felt the forces.
//!
//! ```
//! use roadmill::device_rate::{Basis, Exact, Projection, Rule};
//! use roadmill::{model::Scratch, problem::Problem};
//!
//! // A ball among obstacles, which only translates: a slab lies not far away in the direction of x.
//! let problem = Problem::load("tests/problems/slide.toml".as_ref())?;
//! let model = problem.model().description().prepare();
//! let mut projection = Projection::new(model.space().clone(), Rule::NearestPoint);
//! projection.learn(Exact::at(&*model, &[1.3, 0.0, 0.0], &mut Scratch::new()));
//! let answer = projection.ask(&[2.0, 0.0, 0.0])?;
//! assert!(answer.collides && answer.basis == Basis::Projected);
//! // The force leads back, out of the slab.
//! assert!(answer.force.expect("there is one")[0] < 0.0);
//! // To the side nothing is expected.
//! assert!(!projection.ask(&[1.3, 1.0, 0.0])?.collides);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod exact;
mod follower;
mod projection;

pub use exact::Exact;
pub use follower::Follower;
pub use projection::{Answer, Basis, Projection, Rule};

#[cfg(test)]
mod tests;
