//! Run folders: what a build leaves behind.
//!
//! ```text
//! runs/walls/
//!   ledger         the build, round by round; everything else follows from it
//!   summary.json   the summary that the build printed
//!   path.csv       the path of the problem's query, if one was found
//! ```

mod folder;
mod ledger;
mod summary;

pub use folder::RunFolder;
pub use ledger::{Ledger, LedgerWriter, Stopped};
pub use summary::{EvaluatorValue, Summary, Times};
