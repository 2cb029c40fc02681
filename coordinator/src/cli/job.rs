//! Arguments of the commands that make a problem, grow its roadmap and write a page about it, all in one.

use super::{GrowthArguments, folder};
use clap::Args;
use std::path::PathBuf;

/// Where the run is made, and what becomes of what is there already.
#[derive(Debug, Args)]
pub struct JobArguments {
    /// Base seed [default: 1]
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,
    /// Run folder to be made; the problem goes beside it as FOLDER.toml, and the page about the run as FOLDER.html
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub out: PathBuf,
    /// Replace the problem and the run that are there
    #[arg(long)]
    pub force: bool,
    /// Go on with the run that is there, if it is of this problem
    #[arg(long, conflicts_with = "force")]
    pub or_resume: bool,
    #[command(flatten)]
    pub growth: GrowthArguments,
}
