use super::grow::{Growth, limit, workers};
use super::load::load;
use super::resume::{Change, go_on};
use crate::cli::BuildArguments;
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::run::ledger::LEDGER;
use crate::run::{LedgerWriter, RunFolder, RunLock};
use crate::signals::Signals;
use roadmill::problem::Problem;
use roadmill_workers::channel::private_umask;
use std::path::Path;
use std::sync::Arc;

/// Grows a roadmap.
pub fn build(arguments: &BuildArguments) -> Result<Code, Failure> {
    let cpu = CpuClock::start();
    // Run folders and shared memory are their owner's business.
    private_umask();
    let problem = problem(arguments)?;
    let growth = &arguments.growth;
    let workers = workers(&growth.crew)?;
    // Listened to from here on, so that a signal never leaves half a folder unexplained.
    let signals = Signals::listen().map_err(Failure::system)?;
    let signals = Arc::new(signals);
    let existing = arguments.out.as_deref().filter(|_| arguments.or_resume);
    let has_ledger = |out: &Path| out.join(LEDGER).is_file();
    let folder = match existing {
        None => RunFolder::make(arguments.out.as_deref(), &problem.name, arguments.force)?,
        Some(out) if has_ledger(out) => RunFolder::of(out),
        Some(out) => RunFolder::make_or_take(out)?,
    };
    let lock = match RunLock::take(folder.path(), || signals.came()) {
        Ok(lock) => lock,
        Err(failure) => {
            if existing.is_none() {
                folder.discard();
            }
            return Err(failure);
        }
    };
    // Looked for again now that nobody else can make it.
    if let Some(out) = existing.filter(|out| has_ledger(out)) {
        return go_on(out, lock, Change::None(&problem), growth, workers, signals, cpu);
    }
    let ledger = match LedgerWriter::begin(folder.path(), &problem, lock) {
        Ok(ledger) => ledger,
        Err(failure) => {
            folder.discard();
            return Err(failure);
        }
    };
    if !growth.json {
        let (name, seed) = (&problem.name, problem.seed);
        eprintln!("{name}: seed {seed}, run folder {}", folder.path().display());
        problem.notes.iter().for_each(|note| eprintln!("{name}: {note}"));
    }
    Growth { problem, folder, ledger, past: None, arguments: growth, workers, signals, cpu }.grow()
}

/// The problem with what the command line changes of it.
fn problem(arguments: &BuildArguments) -> Result<Problem, Failure> {
    let mut problem = load(&arguments.problem)?;
    problem.seed = arguments.seed.unwrap_or(problem.seed);
    problem.limits.seconds = arguments.growth.max_time.or(problem.limits.seconds);
    limit(&mut problem, &arguments.growth)?;
    Ok(problem)
}
