//! Arguments of `relax`.

use super::{GrowthArguments, ProblemArguments, folder};
use clap::Args;
use std::path::PathBuf;

/// Of `relax`.
#[derive(Debug, Args)]
pub struct RelaxArguments {
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// Base seed, instead of the problem's
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,
    /// Folder to be made, for the runs of all levels
    #[arg(short, long, value_name = "FOLDER", value_parser = folder())]
    pub out: PathBuf,
    /// Go on with what --out names, if it is of this problem
    #[arg(long)]
    pub or_resume: bool,
    // The limits of nodes and sets are those of one level.
    #[command(flatten)]
    pub growth: GrowthArguments,
}
