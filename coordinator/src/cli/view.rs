//! The command line of `view`.

use clap::Args;
use std::path::PathBuf;

/// Of `view`.
#[derive(Debug, Args)]
pub struct ViewArguments {
    /// The run folder; of a relaxation the run of the level that was solved last
    pub run: PathBuf,
    /// The page to be written [default: NAME-view.html in the current folder, NAME being the run folder's name]
    #[arg(long, value_name = "FILE.html")]
    pub out: Option<PathBuf>,
    /// Follow the build: serve the page on this machine until Ctrl-C, and show new rounds as they come
    #[arg(long, conflicts_with = "out")]
    pub live: bool,
    /// Let nodes be coloured by their clearance, the distance of the nearest obstacle, which is found first
    #[arg(long, conflicts_with = "live")]
    pub clearance: bool,
    /// Do not open the page in a browser, which is done where there is a display
    #[arg(long)]
    pub no_open: bool,
}
