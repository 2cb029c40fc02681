//! Run folders: what a build leaves behind.
//!
//! ```text
//! runs/walls/
//!   ledger           the build, round by round; everything else follows from it
//!   ledger.durable   how much of the ledger is durable
//!   ledger.torn-1    what a killed build left unfinished behind its last round
//!   lock             who works on the run; empty when nobody does
//!   summary.json     the summary that the build printed
//!   path.csv         the path of the problem's query, if one was found
//! ```

mod folder;
pub mod ledger;
mod lock;
mod sets;
mod summary;

pub use folder::{
    MACHINES_JSON, PATH_CSV, RunFolder, SUMMARY_JSON, is_of_run, outside_of_runs, tidy,
};
pub use ledger::{
    LEVEL, Ledger, LedgerWriter, Ledgers, RELAXATION_JSON, Replay, Scan, Stopped, Told, levels_in,
};
pub(crate) use lock::started;
pub use lock::{Holder, LOCK, RunLock};
pub use sets::{SetFiles, SetsWriter};
pub use summary::{CoordinatorCpu, EvaluatorValue, Summary, Times, run_cpu_seconds_in, summary_in};
