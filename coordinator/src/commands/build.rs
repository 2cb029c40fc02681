use super::crew::{grow, workers};
use super::load::load;
use crate::cli::{BuildArguments, GrowthArguments};
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::run::SetFiles;
use crate::signals::Signals;
use crate::work::{Growth, Run, Workers, limit};
use roadmill::problem::{Limits, Problem};
use std::path::Path;
use std::sync::Arc;

/// Grows a roadmap.
pub fn build(arguments: &BuildArguments) -> Result<Code, Failure> {
    let cpu = CpuClock::start();
    let problem = load(&arguments.problem)?;
    let seed = arguments.seed.unwrap_or(problem.seed());
    let problem = problem.with_seed(seed);
    let growth = &arguments.growth;
    let (problem, workers) = bounded_problem(problem, growth)?;
    let imports = SetFiles::open(&arguments.import, &problem)?;
    // Listened to from here on, so that a signal never leaves half a folder unexplained.
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let begun = Run::begin(problem).workers(&workers).signals(&signals).import(imports);
    let begun = begun.max_seconds(growth.max_time);
    let place = (arguments.out.as_deref(), arguments.force, arguments.or_resume);
    grow_in(begun, place, growth, cpu)
}

/// The problem with the limits that the command line gives, and who does the work.
///
/// # Errors
/// Exit code 2: a limit or the number of workers cannot be used.
pub(super) fn bounded_problem(
    problem: Problem,
    growth: &GrowthArguments,
) -> Result<(Problem, Workers), Failure> {
    let own = problem.limits();
    let limits = Limits { seconds: growth.max_time.or(own.seconds), ..own };
    let problem = problem.with_limits(limits).map_err(|error| Failure::usage(error.to_string()))?;
    let problem = limit(problem, growth.max_nodes, growth.max_sets)?;
    Ok((problem, workers(&growth.crew)?))
}

/// Grows a roadmap in a run folder: where, whether what is there is replaced, and whether the build goes on that is there. How
/// long it may take `begun` knows.
pub(super) fn grow_in(
    mut begun: Growth,
    (out, force, or_resume): (Option<&Path>, bool, bool),
    growth: &GrowthArguments,
    cpu: CpuClock,
) -> Result<Code, Failure> {
    if let Some(out) = out {
        begun = begun.folder(out);
    }
    if force {
        begun = begun.replace();
    }
    if or_resume {
        begun = begun.or_resume();
    }
    grow(begun.max_memory(growth.max_memory).clock(cpu), growth.json)
}
