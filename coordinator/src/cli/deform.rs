//! The command line of `deform`.

use super::{folder, seconds};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Of `deform`.
#[derive(Debug, Args)]
pub struct DeformArguments {
    /// The run folder
    pub run: PathBuf,
    /// Configuration where the path begins [default: the problem's start]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub start: Option<String>,
    /// Configuration where the path ends [default: the problem's goal]
    #[arg(long, value_name = "CONFIGURATION", allow_hyphen_values = true)]
    pub goal: Option<String>,
    /// How shapes are deformed [default: as the problem says]; of the problem's own method the settings stay
    #[arg(long, value_enum)]
    pub method: Option<DeformBy>,
    /// The highest energy of a shape, a length; inf accepts any [default: the problem's]
    #[arg(long, value_name = "ENERGY", value_parser = energy)]
    pub highest_energy: Option<f64>,
    /// The least distance of shapes from obstacles; with 0 nothing is proved between frames [default: the problem's]
    #[arg(long, value_name = "LENGTH", value_parser = clearance)]
    pub clearance: Option<f64>,
    /// The farthest that a vertex moves from frame to frame [default: the problem's]
    #[arg(long, value_name = "LENGTH", value_parser = step)]
    pub step: Option<f64>,
    /// Deform along this path instead of looking for one: a file that `query` writes, or Parasol's .path
    #[arg(long, value_name = "FILE", conflicts_with_all = ["start", "goal"])]
    pub path: Option<PathBuf>,
    /// Deform this closed mesh along that path, instead of the problem's robot; its coordinates are in the robot's frame
    #[arg(long, value_name = "MESH", requires = "path")]
    pub robot: Option<PathBuf>,
    /// Write the energies along the path as a table, a line per frame; - for standard output
    #[arg(long, value_name = "FILE.csv")]
    pub csv: Option<PathBuf>,
    /// Write the obstacles and the shape of every frame as OBJ files into a folder, new or empty
    #[arg(long, value_name = "FOLDER", value_parser = folder())]
    pub obj: Option<PathBuf>,
    /// Write a page that plays the deformation, for any browser
    #[arg(long, value_name = "FILE.html")]
    pub html: Option<PathBuf>,
    /// Replace files that are there already
    #[arg(long)]
    pub force: bool,
    /// Look no longer than this: seconds, or with a unit (90s, 10m, 2h)
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub max_time: Option<f64>,
}

/// A method of deformation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DeformBy {
    /// A lattice around the robot is deformed, and the robot with it
    BoundingBox,
    /// The robot's own triangles are moved
    Geometric,
}

fn number(text: &str, expected: &str, fits: impl Fn(f64) -> bool) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| fits(*value));
    value.ok_or_else(|| format!("{expected} expected"))
}

fn energy(text: &str) -> Result<f64, String> {
    number(text, "a length of at least 0, or inf,", |value| value >= 0.0)
}

fn clearance(text: &str) -> Result<f64, String> {
    number(text, "a length of at least 0", |value| value.is_finite() && value >= 0.0)
}

fn step(text: &str) -> Result<f64, String> {
    number(text, "a length above 0", |value| value.is_finite() && value > 0.0)
}
