//! Limits that are given beside a problem's own.

use crate::exit::Failure;
use roadmill::problem::{Limits, Problem};

/// The problem with other limits, as far as something is said of them.
pub(crate) fn limit(
    problem: Problem,
    max_nodes: Option<u64>,
    max_sets: Option<u64>,
) -> Result<Problem, Failure> {
    let limits = problem.limits();
    limited(problem, limits, max_nodes, max_sets)
}

/// The problem with these limits, or others as far as something is said of them.
pub(super) fn limited(
    problem: Problem,
    mut limits: Limits,
    max_nodes: Option<u64>,
    max_sets: Option<u64>,
) -> Result<Problem, Failure> {
    limits.nodes = max_nodes.unwrap_or(limits.nodes);
    limits.sets = max_sets.unwrap_or(limits.sets);
    match limits.complaint() {
        // The problem's own limits have been checked.
        Some((limit, message)) => Err(Failure::usage(format!("--max-{limit}: {message}"))),
        None => {
            let problem = problem.with_limits(limits);
            let problem = problem.map_err(|error| Failure::usage(error.to_string()))?;
            Ok(if max_nodes.is_some() { problem.with_nodes_given() } else { problem })
        }
    }
}
