//! Work on a run folder: beginning a build, going on with it, checking it, asking it for paths.
//!
//! The commands `build`, `resume`, `verify` and `query` are made of this, and a program of your own can use
//! it as well. Worker processes run an executable `roadmill`, which such a program names:
//!
//! ```no_run
//! use roadmill::problem::Problem;
//! use roadmill_coordinator::{Run, Selection, Workers};
//!
//! let workers = Workers::processes(4, "/usr/local/bin/roadmill");
//! let problem = Problem::load("maze.toml".as_ref())?;
//! let built = Run::begin(problem).folder("runs/maze").workers(&workers).grow()?;
//! println!("{}: {}", built.digest(), built.reason());
//!
//! let run = Run::at("runs/maze");
//! run.resume().workers(&workers).max_nodes(5000).grow()?;
//! run.verify(Selection::Share(0.1)).workers(&workers).check()?;
//! let answer = run.read()?.query(&[0.5, 0.5, 0.0], &[9.5, 5.5, 0.0])?;
//! for q in &answer.path.expect("there is a way") {
//!     println!("{q:?}");
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bounded;
mod change;
pub(crate) mod difference;
mod ended;
mod growth;
mod interrupt;
mod limits;
mod recorded;
pub mod relaxing;
mod replanned;
mod selection;
mod stops;
mod verification;
mod watch;
mod workers;

pub(crate) use bounded::bounded;
pub use ended::Ended;
pub use growth::Growth;
pub(crate) use limits::limit;
pub use recorded::Recorded;
pub use relaxing::Relaxing;
pub use selection::Selection;
pub use verification::{Verification, Verified};
pub use watch::{Begun, Status, Torn, Watch};
pub use workers::{WORKERS_MAX, Workers};

use crate::exit::Failure;
use crate::run::ledger::Ledger;
use roadmill::problem::Problem;
use std::path::{Path, PathBuf};

/// A run folder: see the [module](self).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    folder: PathBuf,
}

impl Run {
    /// The run in this folder. Nothing is looked at yet.
    pub fn at(folder: impl Into<PathBuf>) -> Run {
        Run { folder: folder.into() }
    }

    /// Its folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A new run of this problem.
    pub fn begin<'a>(problem: Problem) -> Growth<'a> {
        Growth::anew(problem)
    }

    /// The same build, from where it stopped or was killed.
    pub fn resume<'a>(&self) -> Growth<'a> {
        Growth::again(&self.folder)
    }

    /// Recomputes sets from their seeds, and judgements from the roadmap, and compares them with what is recorded.
    pub fn verify(&self, selection: Selection) -> Verification {
        Verification::new(&self.folder, selection)
    }

    /// The roadmap of the complete rounds, every record and every round's digest checked. Nothing is locked: the
    /// build may be at work.
    ///
    /// # Errors
    /// Exit code 2 if there is no ledger, 4 if it is damaged or of another format.
    pub fn read(&self) -> Result<Recorded, Failure> {
        Ok(Recorded::new(Ledger::read(&self.folder)?))
    }
}
