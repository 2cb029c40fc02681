//! Arguments of `replan`.

use super::{GrowthArguments, folder};
use clap::{Args, ValueEnum};
use roadmill::problem::Replanning;
use std::path::PathBuf;

/// Of `replan`.
#[derive(Debug, Args)]
pub struct ReplanArguments {
    /// The run folder whose roadmap is gone on with; it stays as it is
    pub run: PathBuf,
    /// The problem as it is now: the same robot among other obstacles
    #[arg(long, value_name = "PROBLEM")]
    pub with: PathBuf,
    /// Which connected components of what is left are kept [default: start, or all where the problem has no query]
    #[arg(long, value_enum)]
    pub components: Option<KeptComponents>,
    /// How many dissimilar paths of the old roadmap are tried before anything grows; 0 for none
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub paths: u32,
    /// With how many nearest nodes each is tried again where obstacles went
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=i64::from(Replanning::NEIGHBORS_MAX)))]
    pub neighbors: u32,
    /// Base seed, instead of the problem's
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,
    /// Run folder to be made [default: runs/NAME, or the first free of runs/NAME-2, …]
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub out: Option<PathBuf>,
    /// Replace the run that --out names
    #[arg(long, requires = "out")]
    pub force: bool,
    /// Go on with the run that --out names, if there is one of this problem
    #[arg(long, requires = "out", conflicts_with = "force")]
    pub or_resume: bool,
    #[command(flatten)]
    pub growth: GrowthArguments,
}

/// Which components are kept.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum KeptComponents {
    /// Those that contain the query's start, or a node to which it can be attached
    Start,
    /// All
    All,
}
