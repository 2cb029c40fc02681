//! The command line.

mod agent;
mod compare;
mod deform;
mod examples;
mod fold;
mod job;
mod ligand;
mod orders;
mod paths;
mod problem;
mod relax;
mod replan;
mod transition;
mod view;

pub use agent::{AgentArguments, AgentsArguments};
pub use compare::CompareArguments;
pub use deform::{DeformArguments, DeformBy};
pub use fold::FoldArguments;
pub use job::JobArguments;
pub use ligand::{
    DockingArguments, Kept, LigandCommand, LigandProblemArguments, Lookup, OwnTerms, PoseFormat,
    PosesArguments, RankArguments, ReceptorArguments, RegionArguments, Samples,
};
pub use orders::{FormationArguments, OrdersArguments};
pub use paths::{FrameFormat, PathsArguments, RankBy, ReportArguments, SearchArguments};
pub use problem::{Bounds, Dh, Origin, ProblemArguments, Solid, Unit, Up};
pub use relax::RelaxArguments;
pub use replan::{KeptComponents, ReplanArguments};
pub use transition::{ChainArguments, EndsArguments, TransitionArguments};
pub use view::ViewArguments;

use crate::files::{FOLDER_EXPECTED, is_standard_output};
use clap::builder::{PathBufValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use roadmill::BITS_VERSION;
use roadmill::export::{Direction, FORMATS, RoadmapFormat};
use roadmill::numbers::Ordinal;
use roadmill::structure::{ResidueNumber, parse_range};
use std::ops::Range;
use std::path::PathBuf;

/// Grows probabilistic roadmaps in many processes, the same bit for bit however many.
#[derive(Debug, Parser)]
#[command(name = "roadmill", version)]
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
    /// Make sets apart from a build, which takes them in by --import
    Generate(GenerateArguments),
    /// Go on with a build that was interrupted, or with a finished one by other criteria
    #[command(allow_negative_numbers = true)]
    Resume(ResumeArguments),
    /// Work for a build on another machine, which speaks to it through standard input and output
    Agent(AgentArguments),
    /// Say how far a build is, from its files alone
    Status(StatusArguments),
    /// Recompute sets from their seeds and compare
    Verify(VerifyArguments),
    /// Find the first set at which two runs differ, and why
    Diff(DiffArguments),
    /// List a build set by set
    Log(LogArguments),
    /// Ask a roadmap for a path
    #[command(allow_negative_numbers = true)]
    Query(QueryArguments),
    /// Find several ways through a roadmap, ranked and compared, and write them for other programs
    #[command(allow_negative_numbers = true)]
    Paths(PathsArguments),
    /// Deform a robot that gives way along a path of its roadmap until it is free of obstacles
    #[command(allow_negative_numbers = true)]
    Deform(DeformArguments),
    /// Say in which order the parts of a protein's native structure form, over all pathways of a run
    Orders(OrdersArguments),
    /// Write a page about a run: its map, several paths in numbers and pictures, structures that move
    #[command(allow_negative_numbers = true)]
    Report(ReportArguments),
    /// Compare strategies on a problem over several seeds: nodes, time, success, and how large a roadmap each needs
    Compare(CompareArguments),
    /// Write a page in which a run can be walked around in, and open it
    View(ViewArguments),
    /// Say what is wrong with a problem, or what it would build
    Check(CheckArguments),
    /// Write a problem, or a scene of another program, as a problem file with its meshes
    Import(ImportArguments),
    /// Write a roadmap in a format that other programs read
    Export(ExportArguments),
    /// Find how a protein gets from one structure to another: makes the problem and grows its roadmap
    #[command(allow_negative_numbers = true)]
    Transition(TransitionArguments),
    /// Find in which order the parts of a protein's native structure form: makes the problem and grows its roadmap
    Fold(FoldArguments),
    /// Go on with a finished roadmap after obstacles have come, moved or gone
    #[command(allow_negative_numbers = true)]
    Replan(ReplanArguments),
    /// Solve a problem that is too hard by way of easier versions of it, made harder again step by step
    #[command(allow_negative_numbers = true)]
    Relax(RelaxArguments),
    /// Look at structures of proteins
    #[command(subcommand)]
    Protein(ProteinCommand),
    /// Find where ligands bind to proteins, and how strongly
    #[command(subcommand)]
    Ligand(LigandCommand),
    /// Print a script by which a shell completes commands, options and values
    Completions(CompletionsArguments),
    /// Print the manual page, or write one for each command
    Man(ManArguments),
    #[command(hide = true)]
    Worker(WorkerArguments),
}

impl Arguments {
    /// The command line as it is parsed, shown and completed: with the examples, and with the version of the bits, by which
    /// two programs are known to give the same roadmaps.
    pub fn whole() -> clap::Command {
        let version = format!("{} (bits version {BITS_VERSION})", env!("CARGO_PKG_VERSION"));
        examples::with_examples(Arguments::command()).version(version)
    }

    /// What the process was called with.
    ///
    /// # Errors
    /// It cannot be understood, or asks for help or the version.
    pub fn of_process() -> Result<Arguments, clap::Error> {
        let matches = Arguments::whole().try_get_matches()?;
        Arguments::from_arg_matches(&matches)
    }
}

/// Of `build`.
#[derive(Debug, Args)]
pub struct BuildArguments {
    #[command(flatten)]
    pub problem: ProblemArguments,
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
    /// Take sets from files that `generate` wrote: paths, or patterns in quotes ('parts/*.sets')
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub import: Vec<String>,
    #[command(flatten)]
    pub growth: GrowthArguments,
}

/// Of `generate`.
#[derive(Debug, Args)]
pub struct GenerateArguments {
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// Base seed, instead of the problem's
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,
    /// Which sets: those of a strategy from one ordinal to before another (uniform:0..64)
    #[arg(long, value_name = "LABEL:FIRST..END", value_parser = sets)]
    pub sets: (String, Range<Ordinal>),
    /// The file to be written
    #[arg(long, value_name = "FILE", value_parser = file())]
    pub out: PathBuf,
    /// Replace the file that --out names
    #[arg(long)]
    pub force: bool,
    /// Threads [default: the cores this process may use]
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
}

/// Of everything that grows a roadmap: who does the work, and how far it goes.
#[derive(Debug, Args)]
pub struct GrowthArguments {
    #[command(flatten)]
    pub crew: CrewArguments,
    /// Stop at the end of the first round with this many nodes
    #[arg(long, value_name = "N")]
    pub max_nodes: Option<u64>,
    /// Stop at the end of the first round with this many sets
    #[arg(long, value_name = "N")]
    pub max_sets: Option<u64>,
    /// Stop after this time, but not before one round is finished: seconds, or with a unit (90s, 10m, 2h)
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub max_time: Option<f64>,
    /// Stop at the end of a round when all processes together hold this much memory: bytes, or with a
    /// unit (500M, 16G)
    #[arg(long, value_name = "SIZE", value_parser = bytes)]
    pub max_memory: Option<u64>,
    /// Progress and summary as JSON, an object per line, on standard output
    #[arg(long)]
    pub json: bool,
}

/// Of everything that does jobs: who does them.
#[derive(Debug, Args)]
pub struct CrewArguments {
    /// Worker processes [default: the cores this process may use]
    #[arg(long, value_name = "N", conflicts_with = "threads")]
    pub workers: Option<usize>,
    /// Do the jobs in N threads of this process instead of worker processes
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub agents: AgentsArguments,
}

/// Of `resume`.
#[derive(Debug, Args)]
pub struct ResumeArguments {
    /// The run folder, or that of a relaxation
    pub run: PathBuf,
    /// Open a chapter: go on by this problem's query, criteria, limits and schedule
    #[arg(long, value_name = "PROBLEM")]
    pub with: Option<PathBuf>,
    /// Open a chapter although the sets so far have other bits than this version's
    #[arg(long)]
    pub accept_bits: bool,
    #[command(flatten)]
    pub growth: GrowthArguments,
}

/// Of `status`.
#[derive(Debug, Args)]
pub struct StatusArguments {
    /// The run folder, or that of a relaxation
    pub run: PathBuf,
    /// Go on until the build has ended
    #[arg(long)]
    pub watch: bool,
    /// As a JSON object per line
    #[arg(long)]
    pub json: bool,
}

/// Of `verify`.
#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// The run folder, or that of a relaxation
    pub run: PathBuf,
    /// Recompute a share of all sets and judgements, at least one set [default: 1%]
    #[arg(long, value_name = "PERCENT", value_parser = share)]
    pub sample: Option<f64>,
    /// Recompute everything
    #[arg(long, conflicts_with = "sample")]
    pub all: bool,
    /// Recompute these sets, named as `log` names them
    #[arg(long = "set", value_name = "LABEL:ORDINAL", conflicts_with_all = ["sample", "all"])]
    pub sets: Vec<String>,
    /// Of a run made by `replan`: the run that it replans [default: where it was, from the run's own folder]
    #[arg(long, value_name = "RUN")]
    pub parent: Option<PathBuf>,
    #[command(flatten)]
    pub crew: CrewArguments,
}

/// Of `diff`.
#[derive(Debug, Args)]
pub struct DiffArguments {
    /// A run folder
    pub left: PathBuf,
    /// Another
    pub right: PathBuf,
}

/// Of `log`.
#[derive(Debug, Args)]
pub struct LogArguments {
    /// The run folder
    pub run: PathBuf,
    /// As a JSON object per line
    #[arg(long)]
    pub json: bool,
}

/// Of `query`.
#[derive(Debug, Args)]
pub struct QueryArguments {
    /// The run folder; of a relaxation the run of the level that was solved last
    pub run: PathBuf,
    /// Configuration where the path begins [default: the problem's start]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub start: Option<String>,
    /// Configuration where the path ends [default: the problem's goal]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub goal: Option<String>,
    /// Where to write the path, - for standard output [default: -]; with --queries a new folder of paths
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// The format of paths
    #[arg(long, value_enum, default_value = "csv")]
    pub format: PathFormat,
    /// Shorten paths: leave needless configurations out, then try shortcuts; the same call gives the same path
    #[arg(long)]
    pub shorten: bool,
    /// How often a shortcut is tried
    #[arg(long, value_name = "N", default_value_t = 200, requires = "shorten")]
    pub shorten_tries: u32,
    /// Not the shortest path but the one that keeps away from obstacles best; what it keeps is printed
    #[arg(long, value_enum, value_name = "BY", conflicts_with_all = ["shorten", "queries"])]
    pub clearest: Option<ClearestBy>,
    /// Many queries: a CSV file with the values of a start and of a goal per line
    #[arg(long, value_name = "FILE", requires = "out", conflicts_with_all = ["start", "goal"])]
    pub queries: Option<PathBuf>,
    /// Also write a page that plays the path, for any browser
    #[arg(long, value_name = "FILE.html", conflicts_with = "queries")]
    pub animate: Option<PathBuf>,
}

/// By what a path keeps away from obstacles best.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum ClearestBy {
    /// The highest least clearance; of several such paths the shortest
    Widest,
    /// The least sum of the edges' lengths, each divided by its mean clearance
    Weighted,
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
pub struct CheckArguments {
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// Say whether this configuration is valid, and every reason if it is not: what collides, how deep, what is out of range
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub at: Option<String>,
    /// Also draw the scene with the robot at that configuration, as SVG; - for standard output
    #[arg(long, value_name = "FILE.svg", requires = "at")]
    pub picture: Option<PathBuf>,
    /// The answer about the configuration as a JSON object
    #[arg(long, requires = "at")]
    pub json: bool,
    /// Say which links touch one another in all, or in none, of so many configurations drawn uniformly, as lines of a problem
    /// file
    #[arg(long, value_name = "N", conflicts_with = "at", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    pub touching: Option<u64>,
}

/// Of `import`.
#[derive(Debug, Args)]
pub struct ImportArguments {
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// The problem file to be written; meshes go beside it into the folder NAME-meshes
    #[arg(long, value_name = "NAME.toml")]
    pub out: PathBuf,
    /// Replace what is there
    #[arg(long)]
    pub force: bool,
}

/// Of `export`.
#[derive(Debug, Args)]
pub struct ExportArguments {
    /// The run folder; of a relaxation the run of the level that was solved last
    pub run: PathBuf,
    /// The format
    #[arg(long, value_parser = formats())]
    pub format: String,
    /// The file to be written, - for standard output; of csv the nodes, the edges go beside it into NAME.edges.csv
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Shorten the path as `query --shorten` does
    #[arg(long)]
    pub shorten: bool,
    /// Of svg in 3D: where the eye is, as degrees about the z axis and above the floor [default: -64,25]
    #[arg(long, value_name = "AZIMUTH,ELEVATION", allow_hyphen_values = true)]
    pub view: Option<Direction>,
}

/// The formats of `export`, each with what it is for.
fn formats() -> PossibleValuesParser {
    let format =
        |format: &&dyn RoadmapFormat| PossibleValue::new(format.name()).help(format.about());
    PossibleValuesParser::new(FORMATS.iter().map(format))
}

/// What to do with structures of proteins.
#[derive(Debug, Subcommand)]
pub enum ProteinCommand {
    /// Say what a structure file holds: models, chains, gaps, alternatives, secondary structure
    Info(ProteinInfoArguments),
    /// Say how two conformations of one protein differ
    Compare(ProteinCompareArguments),
    /// Write a transition between two structures, or what is about one, as a problem file
    Problem(ProteinProblemArguments),
}

/// Of `protein info`.
#[derive(Debug, Args)]
pub struct ProteinInfoArguments {
    /// A PDB or mmCIF file (docs/structures.md)
    pub file: PathBuf,
    /// The model that chains are shown of, by its number in the file [default: the first]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub model: Option<i32>,
    /// Only this chain; a sole chain of amino acids answers to any name
    #[arg(long)]
    pub chain: Option<String>,
    /// As a JSON object
    #[arg(long)]
    pub json: bool,
}

/// Of `protein compare`.
#[derive(Debug, Args)]
pub struct ProteinCompareArguments {
    /// A PDB or mmCIF file (docs/structures.md); its first model is taken
    pub first: PathBuf,
    /// Another, which is moved onto it
    pub second: PathBuf,
    /// The chain; a sole chain of amino acids answers to any name
    #[arg(long)]
    pub chain: Option<String>,
    /// The chain of the second file [default: as --chain]
    #[arg(long)]
    pub chain_b: Option<String>,
    /// Only residues from FIRST to LAST, by their numbers in each file
    #[arg(long, value_name = "FIRST-LAST", value_parser = residues, allow_hyphen_values = true)]
    pub residues: Option<(ResidueNumber, ResidueNumber)>,
    /// How many of the torsions that turn farthest are listed
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub torsions: usize,
    /// As a JSON object
    #[arg(long)]
    pub json: bool,
}

/// Of `protein problem`.
#[derive(Debug, Args)]
pub struct ProteinProblemArguments {
    /// A PDB or mmCIF file (docs/structures.md): its bonds, angles and omegas are kept, and it is the start
    pub first: PathBuf,
    /// Another structure of the same residues: the goal is what comes nearest to it
    pub second: Option<PathBuf>,
    #[command(flatten)]
    pub ends: EndsArguments,
    /// The problem file to be written; structures go beside it into the folder NAME-structures
    #[arg(long, value_name = "NAME.toml")]
    pub out: PathBuf,
    /// Replace what is there
    #[arg(long)]
    pub force: bool,
}

/// What is made of gaps in a chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Gaps {
    /// An error that names the residues at both sides
    Error,
    /// What follows a gap moves as one with what is before it
    Rigid,
}

/// Of `completions`.
#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Of `man`.
#[derive(Debug, Args)]
pub struct ManArguments {
    /// A folder for the pages of all commands; it is made if it is not there, and pages in it are replaced
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub out: Option<PathBuf>,
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

/// A folder: `-`, which stands for standard output elsewhere, is refused, since several files are written.
fn folder() -> impl TypedValueParser<Value = PathBuf> {
    no_standard_output(FOLDER_EXPECTED)
}

/// A file that has its name once it is whole, which standard output cannot be.
fn file() -> impl TypedValueParser<Value = PathBuf> {
    no_standard_output("the name of a regular file expected (./- is a file of that name)")
}

fn no_standard_output(expected: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(move |path| match is_standard_output(&path) {
        true => Err(expected),
        false => Ok(path),
    })
}

fn bytes(text: &str) -> Result<u64, String> {
    let (number, unit) = match text.char_indices().next_back() {
        Some((at, 'K' | 'k')) => (&text[..at], 1u64 << 10),
        Some((at, 'M')) => (&text[..at], 1 << 20),
        Some((at, 'G')) => (&text[..at], 1 << 30),
        Some((at, 'T')) => (&text[..at], 1 << 40),
        _ => (text, 1),
    };
    let bytes = number.trim().parse::<u64>().ok().and_then(|number| number.checked_mul(unit));
    let expected = "a positive number of bytes, or with K, M, G or T behind it, expected";
    bytes.filter(|bytes| *bytes > 0).ok_or_else(|| expected.to_owned())
}

fn sets(text: &str) -> Result<(String, Range<Ordinal>), String> {
    let parse = || {
        let (label, range) = text.rsplit_once(':')?;
        let (first, end) = range.split_once("..")?;
        let range = Ordinal(first.parse().ok()?)..Ordinal(end.parse().ok()?);
        (!range.is_empty()).then(|| (label.to_owned(), range))
    };
    parse().ok_or_else(|| "LABEL:FIRST..END expected, with FIRST below END".to_owned())
}

fn residues(text: &str) -> Result<(ResidueNumber, ResidueNumber), String> {
    parse_range(text).ok_or_else(|| "FIRST-LAST expected, two numbers of residues".to_owned())
}

/// A share in percent, as a fraction.
fn share(text: &str) -> Result<f64, String> {
    match text.strip_suffix('%').unwrap_or(text).trim().parse::<f64>() {
        Ok(percent) if percent > 0.0 && percent <= 100.0 => Ok(percent / 100.0),
        _ => Err("a percentage above 0 and up to 100 expected".to_owned()),
    }
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
