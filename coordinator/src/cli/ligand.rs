//! The command line about ligands at proteins.

use super::{CrewArguments, folder, seconds};
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// What to do with ligands at proteins.
#[derive(Debug, Subcommand)]
pub enum LigandCommand {
    /// Write the search for a ligand's poses at a protein as a problem file
    Problem(Box<LigandProblemArguments>),
    /// Say which poses a run has found: ranked, in clusters, with ways out of the protein
    Poses(PosesArguments),
    /// Sample several ligands at one protein and rank them, beside measured affinities if there are any
    Rank(Box<RankArguments>),
}

/// Of `ligand problem`.
#[derive(Debug, Args)]
pub struct LigandProblemArguments {
    /// A PDB or mmCIF file (docs/structures.md) with the protein, which stands still
    pub protein: PathBuf,
    /// The ligand: an SDF, MOL2, PDBQT or PDB file (docs/ligands.md), or the name of a residue of the protein's PDB file, if no file
    /// has this name
    #[arg(long, value_name = "FILE|RESIDUE")]
    pub ligand: String,
    /// The chain of a ligand that is a residue of the protein's file
    #[arg(long)]
    pub chain: Option<String>,
    /// The number of a ligand that is a residue of the protein's file
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub number: Option<i32>,
    /// The name of the ligand in a file of several molecules
    #[arg(long, value_name = "NAME")]
    pub molecule: Option<String>,
    #[command(flatten)]
    pub receptor: ReceptorArguments,
    #[command(flatten)]
    pub model: DockingArguments,
    #[command(flatten)]
    pub region: RegionArguments,
    /// Search in a box about the ligand's given pose: a cube with edges of this length, Å [default: anywhere at the protein; without a
    /// length: 22.5 Å, or the ligand's extent and 10 Å if that is more]
    #[arg(long, value_name = "EDGE", num_args = 0..=1, value_parser = length, conflicts_with = "box_at")]
    pub box_around_ligand: Option<Option<f64>>,
    /// Poses that may be near one, in a file of the same molecule: placed in the shape of the ligand, descended with all torsions
    #[arg(long, value_name = "FILE")]
    pub hints: Option<PathBuf>,
    /// The number of nodes at which the build ends [default: 12000]
    #[arg(long, value_name = "N")]
    pub nodes: Option<u64>,
    /// End the build before, once every exposed residue has a sample and samples lie closely (evaluator exposed-surface)
    #[arg(long)]
    pub until_covered: bool,
    /// Base seed [default: 1]
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,
    /// The problem file to be written; the protein goes beside it into the folder NAME-structures
    #[arg(long, value_name = "NAME.toml")]
    pub out: PathBuf,
    /// Replace what is there
    #[arg(long)]
    pub force: bool,
}

/// What of a structure file is the protein.
#[derive(Debug, Args)]
pub struct ReceptorArguments {
    /// The chains of the protein [default: all]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub chains: Option<Vec<String>>,
    /// The model, by its number in the file [default: the first]
    #[arg(long = "model", value_name = "N", allow_hyphen_values = true)]
    pub structure_model: Option<i32>,
    /// Whether molecules of water are a part of the protein
    #[arg(long, value_enum, default_value_t = Kept::Remove)]
    pub waters: Kept,
    /// Whether single ions of metals are a part of it
    #[arg(long, value_enum, default_value_t = Kept::Keep)]
    pub metals: Kept,
    /// Whether whatever else is no amino acid is a part of it, such as cofactors and buffers
    #[arg(long, value_enum, default_value_t = Kept::Remove)]
    pub others: Kept,
    /// Residues that are a part of it in any case, by their names: a cofactor
    #[arg(long, value_name = "RESIDUE", value_delimiter = ',')]
    pub keep: Vec<String>,
    /// Whether hydrogens of the protein and of the ligand count
    #[arg(long, value_enum, default_value_t = Kept::Remove)]
    pub hydrogens: Kept,
}

/// Whether something stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Kept {
    /// It is left out
    Remove,
    /// It stays
    Keep,
}

/// How the ligand turns, and which energy it has.
#[derive(Debug, Args)]
pub struct DockingArguments {
    /// Take the ligand as rigid, in the shape that it is given with
    #[arg(long)]
    pub rigid: bool,
    /// Take bonds of amides as rigid
    #[arg(long)]
    pub no_amides: bool,
    /// Add Coulomb terms with this factor of a dielectric that grows with the distance (4 is usual) [default: no charges]
    #[arg(long, value_name = "FACTOR")]
    pub dielectric: Option<f64>,
    /// Add hydrophobic terms
    #[arg(long)]
    pub hydrophobic: bool,
    /// Take the 12-6 terms of the Universal Force Field [default: AutoDock 4.1's]
    #[arg(long)]
    pub uff: bool,
    /// How the ligand's own atoms act upon one another
    #[arg(long, value_enum, default_value_t = OwnTerms::Repulsion)]
    pub own: OwnTerms,
    /// The distance from which on atoms do not act upon one another, Å [default: 12]
    #[arg(long, value_name = "LENGTH")]
    pub cutoff: Option<f64>,
    /// How the energy is looked up while the roadmap grows; poses are computed by exact sums in any case
    #[arg(long, value_enum, default_value_t = Lookup::Reciprocal)]
    pub grid: Lookup,
    /// The distance of neighbouring points of the grid, Å [default: 0.375]
    #[arg(long, value_name = "LENGTH")]
    pub spacing: Option<f64>,
    /// The highest energy that is valid, kJ/mol [default: 5000]
    #[arg(long, value_name = "ENERGY", allow_hyphen_values = true)]
    pub highest: Option<f64>,
}

/// How the ligand's own atoms act upon one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OwnTerms {
    /// Not at all: the ligand may pass through itself
    None,
    /// They repel one another
    Repulsion,
    /// By all terms, as in vacuum
    Whole,
}

/// How an energy is looked up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Lookup {
    /// Between the eight points around, linearly in reciprocal roots of repulsion and attraction
    Reciprocal,
    /// These by splines between the 64 points around
    Tricubic,
    /// Between the eight points around, linearly in energies
    Trilinear,
    /// At the nearest point
    Nearest,
    /// No grid: by exact sums
    Exact,
}

/// Where the centre of the ligand's base may be.
#[derive(Debug, Args)]
pub struct RegionArguments {
    /// Search in a box about this place, Å in the frame of the protein's file
    #[arg(long, value_name = "X,Y,Z", value_parser = place, requires = "box_size", allow_hyphen_values = true)]
    pub box_at: Option<[f64; 3]>,
    /// The edges of that box, Å: one, or one along each axis
    #[arg(long, value_name = "A[,B,C]", value_parser = edges, requires = "box_at")]
    pub box_size: Option<[f64; 3]>,
}

/// Of `ligand poses`.
#[derive(Debug, Args)]
pub struct PosesArguments {
    /// The run folder of a docking problem
    pub run: PathBuf,
    /// How many poses
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=9999))]
    pub count: u32,
    /// How many nodes, those of the lowest energies, are descended once more by exact sums
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub improve: u32,
    /// Poses whose heavy atoms are at most this far apart are of one cluster, Å of RMSD
    #[arg(long, value_name = "RMSD", default_value_t = 2.0, value_parser = length)]
    pub radius: f64,
    /// A known pose, in a file of the same molecule, with which poses are compared [default: the pose that the ligand was given with, if
    /// that is in the box]
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,
    /// Write files of the poses: PREFIX.sdf, PREFIX.pdb, PREFIX.csv, and the protein as PREFIX-protein.pdb beside a PDB file
    #[arg(long, value_enum, value_delimiter = ',')]
    pub format: Vec<PoseFormat>,
    /// How the names of these files begin [default: the run folder, with -poses]
    #[arg(long, value_name = "PREFIX")]
    pub out: Option<PathBuf>,
    /// Also write the ways out of the first N poses: PREFIX-way-1.pdb with a model for every place on the way, and its energies as
    /// PREFIX-way-1.csv
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub ways: u32,
    /// Replace files of poses and of ways out that are there already
    #[arg(long)]
    pub force: bool,
    /// Also write a page that shows the poses and their ways out, for any browser
    #[arg(long, value_name = "FILE.html")]
    pub page: Option<PathBuf>,
    /// As a JSON object
    #[arg(long)]
    pub json: bool,
}

/// A format of poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PoseFormat {
    /// A record for every pose, with its numbers as data items
    Sdf,
    /// A PDB file with a model for every pose
    Pdb,
    /// The table
    Csv,
}

/// Of `ligand rank`.
#[derive(Debug, Args)]
pub struct RankArguments {
    /// A PDB or mmCIF file (docs/structures.md) with the protein, which stands still
    pub protein: PathBuf,
    /// A file of ligands (docs/ligands.md), each with a name of its own
    pub ligands: PathBuf,
    #[command(flatten)]
    pub receptor: ReceptorArguments,
    #[command(flatten)]
    pub model: DockingArguments,
    #[command(flatten)]
    pub region: RegionArguments,
    /// Let ligands be anywhere at the protein [default: in one box about all given poses, if these are at the protein]
    #[arg(long, conflicts_with = "box_at")]
    pub blind: bool,
    /// What the samples are
    #[arg(long, value_enum, default_value_t = Samples::Surface)]
    pub strategy: Samples,
    /// The length of a segment of uobprm, Å in the metric of the space
    #[arg(long, value_name = "LENGTH", default_value_t = 10.0, value_parser = length)]
    pub length: f64,
    /// The step along it, Å
    #[arg(long, value_name = "LENGTH", default_value_t = 0.25, value_parser = length)]
    pub step: f64,
    /// Where ligands may be anywhere: samples are enough once every exposed residue has one and their mean distance to the nearest is at most
    /// this many percent of the ligand's diameter
    #[arg(long, value_name = "PERCENT", default_value_t = 25.0, value_parser = length)]
    pub percent: f64,
    /// The most samples of a ligand
    #[arg(long, value_name = "N", default_value_t = 5000)]
    pub nodes: u64,
    /// Measured affinities: a CSV file of lines NAME,VALUE
    #[arg(long, value_name = "FILE")]
    pub measured: Option<PathBuf>,
    /// Larger measured values mean stronger binding, as of pKi [default: smaller ones do, as of Ki, IC50 or a free energy]
    #[arg(long, requires = "measured")]
    pub larger_is_stronger: bool,
    /// Base seed [default: 1]
    #[arg(long, value_name = "SEED")]
    pub seed: Option<u64>,
    /// The folder for a run of each ligand, rank.csv and rank.md, new or empty
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub out: PathBuf,
    /// Replace the runs that are there
    #[arg(long)]
    pub force: bool,
    /// Go on with the runs that are there, if they are of these problems
    #[arg(long, conflicts_with = "force")]
    pub or_resume: bool,
    /// Stop a ligand's build after this time, but not before one round is finished: seconds, or with a unit (90s, 10m, 2h)
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub max_time: Option<f64>,
    #[command(flatten)]
    pub crew: CrewArguments,
    /// As a JSON object
    #[arg(long)]
    pub json: bool,
}

/// What the samples of a ligand are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Samples {
    /// Configurations spread evenly over the surface (uobprm)
    #[value(name = "uobprm")]
    Surface,
    /// Configurations at the surface and in cells of low energy, and the minima below them
    Minima,
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1e-3..=1e4).contains(&value) => Ok(value),
        _ => Err("a number from 0.001 to 10000 expected".to_owned()),
    }
}

fn place(text: &str) -> Result<[f64; 3], String> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|word| word.trim().parse().ok().filter(|x: &f64| x.is_finite()))
        .collect();
    let place = numbers.and_then(|numbers| numbers.try_into().ok());
    place.ok_or_else(|| "X,Y,Z expected, three numbers".to_owned())
}

fn edges(text: &str) -> Result<[f64; 3], String> {
    let edge = |word: &str| length(word.trim()).ok();
    let edges: Option<Vec<f64>> = text.split(',').map(edge).collect();
    match edges.as_deref() {
        Some([edge]) => Ok([*edge; 3]),
        Some([a, b, c]) => Ok([*a, *b, *c]),
        _ => Err("A or A,B,C expected, lengths from 0.001 to 10000".to_owned()),
    }
}
