use super::crew::{grow, workers};
use crate::cli::ResumeArguments;
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::run::Ledgers;
use crate::signals::Signals;
use crate::work::Run;
use crate::work::relaxing::is_relaxation;
use roadmill::model::SceneOptions;
use roadmill::problem::Problem;
use std::path::Path;
use std::sync::Arc;

/// Reads the problem by which a build goes on.
fn load_changed(file: &Path) -> Result<Problem, Failure> {
    Problem::load_with(file, &SceneOptions::default(), &Ledgers).map_err(Failure::usage)
}

/// Goes on with a build.
pub fn resume(arguments: &ResumeArguments) -> Result<Code, Failure> {
    if is_relaxation(&arguments.run) {
        return super::relax::resume(arguments);
    }
    let cpu = CpuClock::start();
    let growth = &arguments.growth;
    let workers = workers(&growth.crew)?;
    let with = arguments.with.as_deref().map(load_changed).transpose()?;
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let mut resumed = Run::at(&arguments.run).resume().workers(&workers).signals(&signals);
    if let Some(problem) = with {
        resumed = resumed.with(problem);
    }
    if arguments.accept_bits {
        resumed = resumed.accept_bits();
    }
    if let Some(nodes) = growth.max_nodes {
        resumed = resumed.max_nodes(nodes);
    }
    if let Some(sets) = growth.max_sets {
        resumed = resumed.max_sets(sets);
    }
    let resumed = resumed.max_seconds(growth.max_time).max_memory(growth.max_memory);
    grow(resumed.clock(cpu), growth.json)
}
