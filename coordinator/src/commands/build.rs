use super::crew::{grow, workers};
use super::load::load;
use crate::cli::BuildArguments;
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::run::SetFiles;
use crate::signals::Signals;
use crate::work::{Run, limit};
use roadmill::problem::{Limits, Problem};
use std::sync::Arc;

/// Grows a roadmap.
pub fn build(arguments: &BuildArguments) -> Result<Code, Failure> {
    let cpu = CpuClock::start();
    let problem = problem(arguments)?;
    let growth = &arguments.growth;
    let workers = workers(&growth.crew)?;
    let imports = SetFiles::open(&arguments.import, &problem)?;
    // Listened to from here on, so that a signal never leaves half a folder unexplained.
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let mut begun = Run::begin(problem).workers(&workers).signals(&signals).import(imports);
    if let Some(out) = &arguments.out {
        begun = begun.folder(out);
    }
    if arguments.force {
        begun = begun.replace();
    }
    if arguments.or_resume {
        begun = begun.or_resume();
    }
    let begun = begun.max_seconds(growth.max_time).max_memory(growth.max_memory);
    grow(begun.clock(cpu), growth.json)
}

/// The problem with what the command line changes of it.
fn problem(arguments: &BuildArguments) -> Result<Problem, Failure> {
    let growth = &arguments.growth;
    let problem = load(&arguments.problem)?;
    let seed = arguments.seed.unwrap_or(problem.seed());
    let own = problem.limits();
    let limits = Limits { seconds: growth.max_time.or(own.seconds), ..own };
    let problem = problem.with_seed(seed).with_limits(limits);
    let problem = problem.map_err(|error| Failure::usage(error.to_string()))?;
    limit(problem, growth.max_nodes, growth.max_sets)
}
