use super::crew::checked;
use super::load::load;
use crate::cli::GenerateArguments;
use crate::exit::{Code, Failure};
use crate::output::{Plain, line, note};
use crate::run::SetsWriter;
use crate::signals::Signals;
use roadmill::img::{Event, Executor, Finished, Job, Outcome, Setup, TICK, Threads};
use roadmill::numbers::{Ordinal, SetNumber, StrategyIndex};
use roadmill::roadmap::Increment;
use roadmill::sampler::GaveUp;
use roadmill_workers::channel::remove_leftovers;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// Sets per thread that may be made before an earlier one is written.
const AHEAD_PER_THREAD: u64 = 16;

/// What making a set came to.
type Made = Result<Increment, GaveUp>;

/// Generates sets apart from a build.
pub fn generate(arguments: &GenerateArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    let seed = arguments.seed.unwrap_or(problem.seed());
    let problem = problem.with_seed(seed);
    let threads = checked("--threads", arguments.threads)?;
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
    remove_leftovers();
    let signals = Signals::listen().map_err(Failure::system)?;
    let out = &arguments.out;
    let mut writer = SetsWriter::begin(out, arguments.force, &problem, label, ordinals.clone())?;
    let executor = Threads::start(Arc::new(Setup::new(problem)), threads)
        .map_err(|error| Failure::system(format!("cannot start the threads: {error}")))?;
    let mut making = Making {
        executor,
        strategy: StrategyIndex(strategy as u32),
        left: ordinals.clone(),
        made: BTreeMap::new(),
    };
    for ordinal in Ordinal::each(ordinals.clone()) {
        let made = making.set(ordinal, threads as u64 * AHEAD_PER_THREAD, &signals)?;
        let made = made.ok_or_else(|| {
            let message = format!("set {label}:{ordinal} cannot be generated");
            Failure::new(Code::WorkersLost, message)
        })?;
        if let Err(gave_up) = &made {
            note(format_args!("set {}:{ordinal}: {gave_up}", Plain(label)));
        }
        writer.set(ordinal, made)?;
    }
    writer.end()?;
    let Range { start, end } = ordinals;
    let count = end.since(*start);
    line(format_args!("{count} sets {}:{start}..{end} in {}", Plain(label), out.display()));
    Ok(Code::Done)
}

/// Sets at work in the order in which they are written. When a signal comes nothing waits for those at work: they end
/// with the process.
struct Making {
    executor: Threads,
    strategy: StrategyIndex,
    /// Not yet handed out.
    left: Range<Ordinal>,
    /// Made, but not yet written.
    made: BTreeMap<Ordinal, Made>,
}

impl Making {
    /// The set of this ordinal, which is the next; `None` if making it panics. Up to `ahead` sets are handed out from
    /// it on.
    fn set(
        &mut self,
        ordinal: Ordinal,
        ahead: u64,
        signals: &Signals,
    ) -> Result<Option<Made>, Failure> {
        let end = Ordinal(ordinal.0.saturating_add(ahead)).min(self.left.end);
        while self.left.start < end {
            let ordinal = self.left.start;
            self.left.start = ordinal.next();
            // The lowest number is the most urgent.
            let number = SetNumber(ordinal.0);
            self.executor.submit(Job::Generate { number, strategy: self.strategy, ordinal });
        }
        loop {
            if signals.came() {
                let message = "a signal came; nothing is written";
                return Err(Failure::new(Code::Interrupted, message));
            }
            if let Some(made) = self.made.remove(&ordinal) {
                return Ok(Some(made));
            }
            match self.executor.next(TICK) {
                Some(Event::Done(Job::Generate { ordinal, .. }, Finished { outcome, .. })) => {
                    let Outcome::Increment(made) = outcome else { return Ok(None) };
                    self.made.insert(ordinal, made);
                }
                None => {}
                Some(_) => return Ok(None),
            }
        }
    }
}
