//! Faults that the process tests ask for: a worker that dies, talks rubbish, repeats itself or stops in
//! the middle of a message, at a given set.
//!
//! Workers read them from the environment variable [`VARIABLE`], which is for tests only. A fault
//! takes a worker's answer away; none can change an outcome.

use crate::channel::CHUNK_BYTES;
use crate::error::WorkerError;
use roadmill::img::{Job, Setup};
use roadmill::numbers::Ordinal;
use rustix::process::{Signal, getpid, kill_process};
use std::cell::Cell;
use std::fs::File;
use std::path::PathBuf;

/// Faults separated by commas: `die-at=LABEL:ORDINAL` ends each worker that is to generate that
/// set. The others come about once, and a `FILE`, which must not be there yet, marks that they have; a set
/// with several of them has one after the other.
///
/// `garble-at=LABEL:ORDINAL:FILE` makes the first worker answer with rubbish, `twice-at=…` makes it give
/// its answer again instead of the one to its next job, and `half-at=…` ends it while it sends.
const VARIABLE: &str = "ROADMILL_FAULTS";

/// Bytes that decode as no message.
const RUBBISH: [u8; 24] = [0xff; 24];
/// So long that a worker waits for the coordinator many times while it sends it.
const LONG_BYTES: usize = 64 * CHUNK_BYTES;

enum Effect {
    Die,
    Once(PathBuf, Kind),
}

#[derive(Clone, Copy)]
enum Kind {
    Garble,
    Twice,
    Half,
}

/// What a worker does wrong.
pub enum Slip {
    /// It says this instead of its answer.
    Instead(Vec<u8>),
    /// It gives its answer, and once more after that.
    Twice,
}

struct Fault {
    label: String,
    ordinal: Ordinal,
    effect: Effect,
}

/// The faults of a worker; usually none.
pub struct Faults {
    faults: Vec<Fault>,
    /// Whether the worker ends when it next waits.
    is_ending: Cell<bool>,
}

impl Faults {
    /// No faults.
    pub fn none() -> Faults {
        Faults { faults: Vec::new(), is_ending: Cell::new(false) }
    }

    /// Reads the environment.
    ///
    /// # Errors
    /// When it names faults that there are not: a test would pass without having tested.
    pub fn read() -> Result<Faults, WorkerError> {
        let mut faults = Faults::none();
        let Some(text) = std::env::var_os(VARIABLE) else {
            return Ok(faults);
        };
        let text = text.to_string_lossy();
        let fault =
            |word| parse(word).ok_or_else(|| WorkerError::Faults(VARIABLE, text.to_string()));
        faults.faults = text.split(',').map(fault).collect::<Result<_, _>>()?;
        Ok(faults)
    }

    /// What goes wrong with the answer to `job`: nothing, a slip, or the end of the process.
    pub fn at(&self, job: Job, setup: &Setup) -> Option<Slip> {
        let Job::Generate { strategy, ordinal, .. } = job else {
            return None;
        };
        let label = setup.problem().strategies()[strategy.index()].label();
        let here = |fault: &&Fault| fault.ordinal == ordinal && fault.label == *label;
        // A set may have several faults: one after the other comes about.
        let kind = self.faults.iter().filter(here).find_map(|fault| match &fault.effect {
            Effect::Die => die(),
            Effect::Once(mark, kind) => File::create_new(mark).ok().map(|_| *kind),
        })?;
        Some(match kind {
            Kind::Garble => Slip::Instead(RUBBISH.to_vec()),
            Kind::Twice => Slip::Twice,
            Kind::Half => {
                self.is_ending.set(true);
                Slip::Instead(vec![0xff; LONG_BYTES])
            }
        })
    }

    /// To be called whenever the worker waits for the coordinator.
    pub fn at_wait(&self) {
        if self.is_ending.get() {
            die();
        }
    }
}

fn parse(word: &str) -> Option<Fault> {
    let (name, rest) = word.split_once('=')?;
    let mut parts = rest.splitn(3, ':');
    let label = parts.next()?.to_owned();
    let ordinal = Ordinal(parts.next()?.parse().ok()?);
    let effect = match (name, parts.next()) {
        ("die-at", None) => Effect::Die,
        ("garble-at", Some(mark)) => Effect::Once(mark.into(), Kind::Garble),
        ("twice-at", Some(mark)) => Effect::Once(mark.into(), Kind::Twice),
        ("half-at", Some(mark)) => Effect::Once(mark.into(), Kind::Half),
        _ => return None,
    };
    Some(Fault { label, ordinal, effect })
}

/// Ends the process as the system does when memory is short. (`abort` could leave a core file.)
fn die() -> ! {
    let _ = kill_process(getpid(), Signal::KILL);
    std::process::abort()
}

#[cfg(test)]
mod tests {
    use super::*;
    use roadmill::internal::wire;

    #[test]
    fn rubbish_is_no_message() {
        assert!(wire::decode_borrowed::<crate::message::FromWorker>(&RUBBISH).is_err());
    }

    #[test]
    fn only_known_faults_are_read() {
        assert!(
            parse("die-at=a:3")
                .is_some_and(|fault| fault.label == "a" && fault.ordinal == Ordinal(3))
        );
        for word in ["garble-at=a:3:/x:y", "twice-at=a:3:x", "half-at=a:3:x"] {
            assert!(parse(word).is_some(), "{word}");
        }
        for word in
            ["", "die", "die-at=a", "die-at=a:x", "die-at=a:3:f", "garble-at=a:3", "lie-at=a:3"]
        {
            assert!(parse(word).is_none(), "{word}");
        }
    }
}
