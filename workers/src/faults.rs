//! Faults that the process tests ask for: a worker that dies, or talks rubbish, at a given set.
//!
//! Workers read them from the environment variable [`VARIABLE`], which is for tests only. A fault
//! takes a worker's answer away; none can change an outcome.

use crate::WorkerError;
use roadmill::img::{Job, Setup};
use rustix::process::{Signal, getpid, kill_process};
use std::fs::File;
use std::path::PathBuf;

/// Faults separated by commas: `die-at=LABEL:ORDINAL` ends each worker that is to generate that
/// set; `garble-at=LABEL:ORDINAL:FILE` makes the first one answer with rubbish, and `FILE`, which
/// must not be there yet, marks that it has.
const VARIABLE: &str = "ROADMILL_FAULTS";

/// Bytes that decode as no message.
const RUBBISH: [u8; 24] = [0xff; 24];

enum Effect {
    Die,
    GarbleOnce(PathBuf),
}

struct Fault {
    label: String,
    ordinal: u64,
    effect: Effect,
}

/// The faults of a worker; usually none.
pub struct Faults(Vec<Fault>);

impl Faults {
    /// Reads the environment.
    ///
    /// # Errors
    /// When it names faults that there are not: a test would pass without having tested.
    pub fn read() -> Result<Faults, WorkerError> {
        let Some(text) = std::env::var_os(VARIABLE) else {
            return Ok(Faults(Vec::new()));
        };
        let text = text.to_string_lossy();
        let fault =
            |word| parse(word).ok_or_else(|| WorkerError::Faults(VARIABLE, text.to_string()));
        text.split(',').map(fault).collect::<Result<_, _>>().map(Faults)
    }

    /// What happens instead of `job`: nothing, the end of the process, or an answer without sense.
    pub fn instead_of(&self, job: Job, setup: &Setup) -> Option<Vec<u8>> {
        let Job::Generate { strategy, ordinal, .. } = job else {
            return None;
        };
        let label = &setup.problem.strategies[strategy as usize].label;
        let here = |fault: &&Fault| fault.ordinal == ordinal && fault.label == *label;
        match &self.0.iter().find(here)?.effect {
            Effect::Die => die(),
            Effect::GarbleOnce(mark) => File::create_new(mark).is_ok().then(|| RUBBISH.to_vec()),
        }
    }
}

fn parse(word: &str) -> Option<Fault> {
    let (name, rest) = word.split_once('=')?;
    let mut parts = rest.splitn(3, ':');
    let label = parts.next()?.to_owned();
    let ordinal = parts.next()?.parse().ok()?;
    let effect = match (name, parts.next()) {
        ("die-at", None) => Effect::Die,
        ("garble-at", Some(mark)) => Effect::GarbleOnce(mark.into()),
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
    use roadmill::wire;

    #[test]
    fn rubbish_is_no_message() {
        assert!(wire::decode::<crate::message::FromWorker>(&RUBBISH).is_err());
    }

    #[test]
    fn only_known_faults_are_read() {
        assert!(parse("die-at=a:3").is_some_and(|fault| fault.label == "a" && fault.ordinal == 3));
        assert!(parse("garble-at=a:3:/x:y").is_some());
        for word in
            ["", "die", "die-at=a", "die-at=a:x", "die-at=a:3:f", "garble-at=a:3", "lie-at=a:3"]
        {
            assert!(parse(word).is_none(), "{word}");
        }
    }
}
