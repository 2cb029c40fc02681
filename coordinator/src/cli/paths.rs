//! The command line of what looks for several paths.

use super::{folder, seconds};
use clap::{Args, ValueEnum};
use roadmill::pathways::DomainAngle;
use roadmill::structure::parse_range;
use std::path::{Path, PathBuf};

/// Which paths are looked for.
#[derive(Debug, Args)]
pub struct SearchArguments {
    /// Configuration where the paths begin [default: the problem's start]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub start: Option<String>,
    /// Configuration where the paths end [default: the problem's goal]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub goal: Option<String>,
    /// How many paths are looked for
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub count: u32,
    /// By what paths are ranked [default: barrier in a model with energies, otherwise cost]
    #[arg(long, value_enum)]
    pub by: Option<RankBy>,
    /// How far apart neighbouring frames are at most, Å of Cα RMSD or in the space's metric [default: 0.5 Å, or a
    /// hundredth of the space's diameter]
    #[arg(long, value_name = "DISTANCE", value_parser = distance)]
    pub spacing: Option<f64>,
    /// How many candidates of dissimilar paths are shortened and compared, at most twice as many in all; of distinct paths in
    /// space, how many are classified [default: 40]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub tries: Option<u32>,
    /// How often a shortcut is tried on each candidate of dissimilar and distinct paths [default: 200]
    #[arg(long, value_name = "N")]
    pub shorten_tries: Option<u32>,
    /// An angle between domains, shown along the paths: the numbers of three ranges of residues, the angle at the second;
    /// may be given several times (NMP=35-55/90-100/115-125). Of a report the first two are the axes of the map
    #[arg(long = "angle", value_name = "NAME=RANGE/RANGE/RANGE", value_parser = angle)]
    pub angles: Vec<DomainAngle>,
}

impl SearchArguments {
    /// What is looked for where nothing is said, with these angles.
    pub fn usual(angles: Vec<DomainAngle>) -> SearchArguments {
        SearchArguments {
            start: None,
            goal: None,
            count: 5,
            by: None,
            spacing: None,
            tries: None,
            shorten_tries: None,
            angles,
        }
    }
}

/// Of `paths`.
#[derive(Debug, Args)]
pub struct PathsArguments {
    /// The run folder; of a relaxation the run of the level that was solved last
    pub run: PathBuf,
    #[command(flatten)]
    pub search: SearchArguments,
    /// Paths each two of which are at least this far apart, Å of Cα RMSD or in the space's metric [default: the best,
    /// however alike; without a distance: 1.5 Å, or a twentieth of the space's diameter]
    #[arg(long, value_name = "DISTANCE", num_args = 0..=1, value_parser = distance)]
    pub dissimilar: Option<Option<f64>>,
    /// Paths that pass the obstacles differently, the shortest of each class: in the plane the shortest there are in the roadmap, in
    /// space those that come up among --tries candidates
    #[arg(long, conflicts_with_all = ["dissimilar", "by"])]
    pub distinct: bool,
    /// Look for paths no longer than this: seconds, or with a unit (90s, 10m, 2h); what was found by then is given
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub max_time: Option<f64>,
    /// A folder for files of the paths, new or empty
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub out: Option<PathBuf>,
    /// What is written there of each path: csv always, the others of molecules
    #[arg(long, value_enum, value_delimiter = ',', default_value = "csv", requires = "out")]
    pub format: Vec<FrameFormat>,
}

/// Of `report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// The run folder; of a relaxation the run of the level that was solved last
    pub run: PathBuf,
    /// The page to be written, for any browser; docs/report.md says what it shows
    #[arg(long, value_name = "FILE.html")]
    pub out: PathBuf,
    #[command(flatten)]
    pub search: SearchArguments,
    /// How far apart each two paths are at least, Å of Cα RMSD or in the space's metric [default: 1.5 Å, or a twentieth of
    /// the space's diameter]
    #[arg(long, value_name = "DISTANCE", value_parser = distance)]
    pub dissimilar: Option<f64>,
    /// Look for paths, or follow pathways of folding, no longer than this: seconds, or with a unit (90s, 10m, 2h); the page then has
    /// what was found by then
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub max_time: Option<f64>,
}

impl ReportArguments {
    /// The page about a run with what is looked for by itself, for at most so many seconds.
    pub fn of(
        run: &Path,
        out: &Path,
        search: SearchArguments,
        max_time: Option<f64>,
    ) -> ReportArguments {
        let (run, out) = (run.to_owned(), out.to_owned());
        ReportArguments { run, out, search, dissimilar: None, max_time }
    }
}

/// By what paths are ranked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RankBy {
    /// The highest energy, then the cost
    Barrier,
    /// The sum of what the motions cost
    Cost,
}

/// A format of the frames of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FrameFormat {
    /// Tables of configurations, and of molecules what is measured frame by frame
    Csv,
    /// A PDB file with a model for every frame
    Pdb,
    /// A trajectory of CHARMM and NAMD
    Dcd,
    /// A trajectory of GROMACS, rounded to 0.001 Å
    Xtc,
    /// A script for PyMOL that shows all paths, with the PDB files that it loads
    Pml,
    /// A script for ChimeraX that shows all paths, with the PDB files that it opens
    Cxc,
}

fn distance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1e-3..=1e12).contains(&value) => Ok(value),
        _ => Err("a distance from 1e-3 to 1e12 expected".to_owned()),
    }
}

pub(super) fn angle(text: &str) -> Result<DomainAngle, String> {
    let range = |text: &str| {
        let (first, last) = parse_range(text)?;
        Some(first.number..=last.number).filter(|range| !range.is_empty())
    };
    let parse = || {
        let (name, ranges) = text.split_once('=')?;
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | ' ');
        let ranges = ranges.split('/').map(range).collect::<Option<Vec<_>>>()?;
        let name = Some(name).filter(|name| !name.is_empty() && name.chars().all(is_plain))?;
        Some(DomainAngle { name: name.to_owned(), ranges: ranges.try_into().ok()? })
    };
    parse().ok_or_else(|| {
        "NAME=FIRST-LAST/FIRST-LAST/FIRST-LAST expected, a plain name and three ranges of residue numbers".to_owned()
    })
}
