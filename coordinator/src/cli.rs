//! The command line.

use crate::exit;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Grows probabilistic roadmaps in many processes, the same bit for bit however many.
#[derive(Debug, Parser)]
#[command(name = "roadmill", version, after_help = exit::HELP)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Grow a roadmap until the problem's criteria are met
    #[command(allow_negative_numbers = true)]
    Build(BuildArguments),
    /// Ask a roadmap for a path
    #[command(allow_negative_numbers = true)]
    Query(QueryArguments),
    /// Say what is wrong with a problem, or what it would build
    Check(CheckArguments),
    /// Write a roadmap in a format that other programs read
    Export(ExportArguments),
    #[command(hide = true)]
    Worker(WorkerArguments),
}

/// Of `build`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct BuildArguments {
    /// The problem: TOML (docs/problems.md), an OMPL.app .cfg or a Parasol .env (docs/foreign.md)
    pub problem: PathBuf,
    /// The .robot file of a Parasol .env [default: the one beside it]
    #[arg(long, value_name = "FILE")]
    pub robot: Option<PathBuf>,
    /// The .query file of a Parasol .env [default: the one beside it]
    #[arg(long, value_name = "FILE")]
    pub query: Option<PathBuf>,
    /// Worker processes [default: the cores this process may use]
    #[arg(long, value_name = "N", conflicts_with = "threads")]
    pub workers: Option<usize>,
    /// Do the jobs in N threads of this process instead of worker processes
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// Base seed, instead of the problem's
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,
    /// Run folder to be made [default: runs/NAME, or the first free of runs/NAME-2, …]
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Replace the run that --out names
    #[arg(long, requires = "out")]
    pub force: bool,
    /// Stop at the end of the first round with this many nodes
    #[arg(long, value_name = "N")]
    pub max_nodes: Option<u64>,
    /// Stop at the end of the first round with this many sets
    #[arg(long, value_name = "N")]
    pub max_sets: Option<u64>,
    /// Stop after this time: seconds, or with a unit (90s, 10m, 2h)
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub max_time: Option<f64>,
    /// Progress and summary as JSON, an object per line, on standard output
    #[arg(long)]
    pub json: bool,
}

/// Of `query`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct QueryArguments {
    /// The run folder
    pub run: PathBuf,
    /// Configuration where the path begins [default: the problem's start]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub start: Option<String>,
    /// Configuration where the path ends [default: the problem's goal]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub goal: Option<String>,
    /// Where to write the path [default: standard output]; with --queries a new folder of paths
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// The format of paths
    #[arg(long, value_enum, default_value = "csv")]
    pub format: PathFormat,
    /// Shorten paths by shortcuts; the same call gives the same path
    #[arg(long)]
    pub shorten: bool,
    /// How often a shortcut is tried
    #[arg(long, value_name = "N", default_value_t = 200, requires = "shorten")]
    pub shorten_tries: u32,
    /// Many queries: a CSV file with the values of a start and of a goal per line
    #[arg(long, value_name = "FILE", requires = "out", conflicts_with_all = ["start", "goal"])]
    pub queries: Option<PathBuf>,
    /// Also write a page that plays the path, for any browser
    #[arg(long, value_name = "FILE.html", conflicts_with = "queries")]
    pub animate: Option<PathBuf>,
}

/// A format of paths.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum PathFormat {
    /// A table with a configuration per line
    Csv,
    /// A path of Parasol's planners and of Vizmo
    Path,
}

/// Of `check`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct CheckArguments {
    /// The problem: TOML (docs/problems.md), an OMPL.app .cfg or a Parasol .env (docs/foreign.md)
    pub problem: PathBuf,
    /// The .robot file of a Parasol .env [default: the one beside it]
    #[arg(long, value_name = "FILE")]
    pub robot: Option<PathBuf>,
    /// The .query file of a Parasol .env [default: the one beside it]
    #[arg(long, value_name = "FILE")]
    pub query: Option<PathBuf>,
}

/// Of `export`.
#[derive(Debug, Args)]
#[command(after_help = exit::HELP)]
pub struct ExportArguments {
    /// The run folder
    pub run: PathBuf,
    /// The format
    #[arg(long, value_enum)]
    pub format: Format,
    /// The file to be written; of csv the nodes, the edges go beside it into NAME.edges.csv
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// A format of `export`.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Format {
    /// The graph with typed attributes, for networkx, Gephi, igraph, …
    Graphml,
    /// Two tables, of the nodes and of the edges
    Csv,
    /// NumPy arrays
    Npz,
    /// A roadmap of Parasol's planners and of Vizmo
    Map,
    /// A picture of the scene, the roadmap and the path
    Svg,
}

/// Of the hidden worker command.
#[derive(Debug, Args)]
pub struct WorkerArguments {
    /// The run's folder of the channel.
    #[arg(long)]
    pub channel: PathBuf,
    /// The worker's name.
    #[arg(long)]
    pub worker: u64,
    /// Process id of the coordinator.
    #[arg(long)]
    pub coordinator: u32,
}

fn seconds(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.char_indices().next_back() {
        Some((at, 's')) => (&text[..at], 1.0),
        Some((at, 'm')) => (&text[..at], 60.0),
        Some((at, 'h')) => (&text[..at], 3600.0),
        _ => (text, 1.0),
    };
    match number.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value * unit),
        _ => Err("a positive number of seconds, or with s, m or h behind it, expected".to_owned()),
    }
}
