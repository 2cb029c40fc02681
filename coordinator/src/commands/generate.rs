use super::crew::count;
use super::load::load;
use super::say;
use crate::cli::{CrewArguments, GenerateArguments};
use crate::exit::{Code, Failure};
use crate::run::SetsWriter;
use crate::signals::Signals;
use roadmill::Strategy;
use roadmill::img::Setup;
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::roadmap::Increment;
use roadmill::sampler::GaveUp;
use roadmill_workers::channel::private_umask;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Sets per thread that are held in memory before they are written.
const BATCH_PER_THREAD: u64 = 16;

type Made = (Ordinal, Result<Increment, GaveUp>);

/// Generates sets apart from a build.
pub fn generate(arguments: &GenerateArguments) -> Result<Code, Failure> {
    private_umask();
    let problem = load(&arguments.problem)?;
    let seed = arguments.seed.unwrap_or(problem.seed());
    let problem = problem.with_seed(seed);
    let threads = count(&CrewArguments { workers: None, threads: arguments.threads })?;
    let (label, ordinals) = &arguments.sets;
    let Some(strategy) = problem.strategies().iter().position(|known| known.label() == label)
    else {
        let labels: Vec<_> = problem.strategies().iter().map(|known| known.label()).collect();
        let labels = labels.join(", ");
        return Err(Failure::usage(format!("--sets: `{label}` found, one of {labels} expected")));
    };
    if problem.strategies()[strategy].generator().grows() {
        return Err(Failure::usage(format!(
            "--sets: the sets of `{label}` grow from the roadmap of a build and cannot be made apart"
        )));
    }
    let signals = Signals::listen().map_err(Failure::system)?;
    let out = &arguments.out;
    let mut writer = SetsWriter::begin(out, arguments.force, &problem, label, ordinals.clone())?;
    let setup = Setup::new(problem);
    let batch = BATCH_PER_THREAD * threads as u64;
    let mut left = ordinals.clone();
    while !left.is_empty() {
        let until = left.end.min(Ordinal(left.start.0.saturating_add(batch)));
        let strategy = &setup.problem().strategies()[strategy];
        let made =
            make(&setup, strategy, left.start..until, threads, &signals).ok_or_else(|| {
                Failure::new(Code::WorkersLost, format!("a set of `{label}` cannot be generated"))
            })?;
        if signals.came() {
            return Err(Failure::new(Code::Interrupted, "a signal came; nothing is written"));
        }
        for (ordinal, made) in made {
            if let Err(gave_up) = &made {
                eprintln!("set {label}:{ordinal}: {gave_up}");
            }
            writer.set(ordinal, made)?;
        }
        left.start = until;
    }
    writer.end()?;
    let Range { start, end } = ordinals;
    let count = end.since(*start);
    say(format_args!("{count} sets {label}:{start}..{end} in {}", out.display()));
    Ok(Code::Done)
}

/// These sets in order, or fewer of them once a signal has come; `None` if one panics.
fn make(
    setup: &Setup,
    strategy: &Strategy,
    ordinals: Range<Ordinal>,
    threads: usize,
    signals: &Signals,
) -> Option<Vec<Made>> {
    let ordinals = Mutex::new(Ordinal::each(ordinals));
    // Nothing can go wrong while it is held.
    let next = || ordinals.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work = || {
        let (mut scratch, mut made) = (Scratch::new(), Vec::new());
        while let Some(ordinal) = next().filter(|_| !signals.came()) {
            made.push((ordinal, strategy.generate(setup.context(), ordinal, None, &mut scratch)));
        }
        made
    };
    let parts: thread::Result<Vec<_>> = thread::scope(|scope| {
        let threads: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join()).collect()
    });
    let mut made = parts.ok()?.concat();
    made.sort_unstable_by_key(|(ordinal, _)| *ordinal);
    Some(made)
}
