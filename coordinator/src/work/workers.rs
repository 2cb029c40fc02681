use crate::agent::{Carriers, Place};
use crate::crew::{CrewError, Executable, LocalCrew};
use crate::dispatch::{AgentOptions, Agents, Dispatcher, Foreman};
use crate::exit::Failure;
use roadmill::img::Setup;
use roadmill::problem::Problem;
use roadmill::roadmap::Outline;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

/// The most worker processes or threads.
pub const WORKERS_MAX: usize = 4096;

/// Who does the jobs of a build. It changes how long the build takes and nothing else.
#[derive(Clone, Debug, PartialEq)]
pub struct Workers {
    pub(super) count: usize,
    pub(super) kind: Kind,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Threads,
    /// Worker processes that run the program at this path; `None` stands for that of this process.
    Processes(Option<PathBuf>),
    Agents(Vec<Place>, AgentOptions),
}

impl Workers {
    /// Threads of this process: no process is started.
    pub fn threads(count: usize) -> Workers {
        Workers { count, kind: Kind::Threads }
    }

    /// Worker processes that run `roadmill`, the path of an executable of the same version as this library.
    pub fn processes(count: usize, roadmill: impl Into<PathBuf>) -> Workers {
        Workers { count, kind: Kind::Processes(Some(roadmill.into())) }
    }

    /// Worker processes that run the program of this process, which has to be `roadmill`.
    pub(crate) fn own_processes(count: usize) -> Workers {
        Workers { count, kind: Kind::Processes(None) }
    }

    /// Agents on other machines, each with workers of its own: see [`crate::agent`].
    pub fn agents(places: Vec<Place>, options: AgentOptions) -> Workers {
        Workers { count: places.len(), kind: Kind::Agents(places, options) }
    }

    /// As many as there are processors that the system lets this process use.
    pub fn available() -> usize {
        std::thread::available_parallelism().map_or(1, usize::from)
    }

    /// Whether the problem can be worked on like this: a validity function is called in this process only.
    pub(super) fn check_for(&self, problem: &Problem) -> Result<(), Failure> {
        match problem.validity_function() {
            Some(function) if self.kind != Kind::Threads => Err(Failure::usage(format!(
                "workers in other processes found; threads expected, since no other process has the validity function `{}`",
                function.identity()
            ))),
            _ => Ok(()),
        }
    }

    pub(super) fn check(&self) -> Result<(), Failure> {
        if (1..=WORKERS_MAX).contains(&self.count) {
            return Ok(());
        }
        Err(Failure::usage(format!("{} workers found, 1 to {WORKERS_MAX} expected", self.count)))
    }
}

/// A thread for every processor.
impl Default for Workers {
    fn default() -> Workers {
        Workers::threads(Workers::available())
    }
}

/// Starts worker processes.
pub(super) fn start(
    setup: &Arc<Setup>,
    count: usize,
    program: Option<&PathBuf>,
) -> Result<Dispatcher<Foreman<LocalCrew>>, CrewError> {
    let executable = program.map_or_else(Executable::own, |path| Executable::at(path))?;
    Dispatcher::start(setup.clone(), LocalCrew::open(executable, count)?)
}

/// Makes agents ready to be started; what they have to be told lies in a file in `folder`.
pub(super) fn start_agents(
    setup: &Arc<Setup>,
    places: &[Place],
    options: &AgentOptions,
    folder: &Path,
) -> Result<Dispatcher<Agents<Carriers>>, CrewError> {
    let outline = Outline::new(setup.context().space());
    // Relays may have kept frames of another process; two that begin in one microsecond have other ids.
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let now = now.map_or(0, |now| now.as_micros() as u64);
    let session = (now << 20) ^ u64::from(std::process::id());
    let fleet = Carriers::new(places.to_vec(), session)
        .map_err(CrewError::system("cannot watch over agents"))?;
    Ok(Dispatcher::of(Agents::new(setup.clone(), options.clone(), fleet, folder)?, outline))
}
