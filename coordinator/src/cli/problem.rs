//! The problem on the command line, and the options of scenes of other programs.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The problem, and what is to be taken where a scene of another program leaves a choice.
#[derive(Debug, Args)]
pub struct ProblemArguments {
    /// The problem: TOML (docs/problems.md), an OMPL.app .cfg, a Parasol .env or a URDF (docs/foreign.md)
    #[arg(value_name = "PROBLEM")]
    pub file: PathBuf,
    /// The .robot file of a Parasol .env [default: the one beside it]
    #[arg(long, value_name = "FILE")]
    pub robot: Option<PathBuf>,
    /// The .query file of a Parasol .env [default: the one beside it]
    #[arg(long, value_name = "FILE")]
    pub query: Option<PathBuf>,
    /// Whether the insides of a scene's meshes are material; auto: of closed ones [default: auto, of an OMPL.app world no]
    #[arg(long, value_enum)]
    pub solid: Option<Solid>,
    /// What a scene's bounds hold: every robot point, or the reference point [default: as its program does]
    #[arg(long, value_enum)]
    pub bounds: Option<Bounds>,
    /// The origin of a scene's meshes: the mean of the vertices, or as stored [default: as its program does]
    #[arg(long, value_enum)]
    pub origin: Option<Origin>,
    /// Whether an OMPL.app scene's meshes are turned to y up [default: y]
    #[arg(long, value_enum)]
    pub up: Option<Up>,
    /// Whether an OMPL.app scene's meshes are converted to metres [default: metres]
    #[arg(long, value_enum)]
    pub unit: Option<Unit>,
    /// Join vertices of a scene's meshes at most this far apart [default: 1e-6]
    #[arg(long, value_name = "LENGTH", value_parser = length)]
    pub weld: Option<f64>,
    /// Order of Denavit and Hartenberg's numbers in a Parasol robot [default: standard]
    #[arg(long, value_enum)]
    pub dh: Option<Dh>,
    /// The .srdf file beside a URDF: its groups, states and pairs of links that may touch
    #[arg(long, value_name = "FILE")]
    pub srdf: Option<PathBuf>,
    /// The group of the .srdf file whose joints move; all others are locked [default: all joints move]
    #[arg(long, value_name = "NAME")]
    pub group: Option<String>,
    /// An approximate path for the strategy `hints`: CSV as `query` writes it, or a Parasol .path (docs/hints.md); several, those trusted most first
    #[arg(long, value_name = "FILE")]
    pub hint: Vec<PathBuf>,
}

/// Whether insides are material.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Solid {
    /// Those of closed meshes
    Auto,
    /// All; an open mesh is an error
    Yes,
    /// None
    No,
}

/// What the bounds hold.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Bounds {
    /// Every point of the robot
    Body,
    /// The reference point
    Reference,
}

/// The origin of a mesh.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Origin {
    /// The mean of its vertices
    Mean,
    /// The file's own
    Stored,
}

/// Which way is up.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Up {
    /// y, whatever the file says
    Y,
    /// As stored
    Stored,
}

/// The unit of lengths.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Unit {
    /// Metres, by what the file says
    Metres,
    /// As stored
    Stored,
}

/// The order in which Denavit and Hartenberg's numbers act.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Dh {
    /// Rz(theta) Tz(d) Tx(a) Rx(alpha)
    Standard,
    /// Rx(alpha) Tx(a) Rz(theta) Tz(d), as in scenes of Parasol's older libraries
    Modified,
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        // Far beyond any scene, and far above what cells of this size can still number.
        Ok(value) if value == 0.0 || (1e-12..=1e12).contains(&value) => Ok(value),
        _ => Err("0 or a length from 1e-12 to 1e12 expected".to_owned()),
    }
}
