//! The same problem with other promises of its edges.

use roadmill::model::bodies::validity::MotionChecking;
use roadmill::problem::Problem;

/// The problem with other promises of its edges; one without bodies stays as it is.
pub fn with_edges(problem: &Problem, edges: MotionChecking) -> Problem {
    let builder = problem.to_builder().change_model(|model| {
        model.change_bodies(|bodies| bodies.change_space(|space| space.edges(edges)))
    });
    builder.build().unwrap_or_else(|error| panic!("{}: {error}", problem.name()))
}
