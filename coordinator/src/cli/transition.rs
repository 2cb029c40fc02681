//! Arguments about the two ends of a protein's transition.

use super::paths::angle;
use super::{Gaps, JobArguments, residues};
use clap::Args;
use roadmill::pathways::DomainAngle;
use roadmill::problem::HOLD;
use roadmill::structure::ResidueNumber;
use std::path::PathBuf;

/// What is taken of a structure.
#[derive(Debug, Args)]
pub struct ChainArguments {
    /// The chain; a sole chain of amino acids answers to any name
    #[arg(long)]
    pub chain: Option<String>,
    /// Only residues from FIRST to LAST, by their numbers in each file
    #[arg(long, value_name = "FIRST-LAST", value_parser = residues, allow_hyphen_values = true)]
    pub residues: Option<(ResidueNumber, ResidueNumber)>,
    /// What is made of gaps in a chain
    #[arg(long, value_enum, default_value_t = Gaps::Error)]
    pub gaps: Gaps,
    /// Another chain of the file, or of the first of two, which stands still; may be given several times
    #[arg(long = "obstacle", value_name = "CHAIN")]
    pub obstacles: Vec<String>,
}

/// What is taken of the structures at both ends, and what is done to them.
#[derive(Debug, Args)]
pub struct EndsArguments {
    #[command(flatten)]
    pub first: ChainArguments,
    /// The chain of the second file [default: as --chain]
    #[arg(long)]
    pub chain_b: Option<String>,
    /// Both ends of a transition are relaxed, each Cα held with so many kT/Å²; 0 leaves the ends as they are
    #[arg(long, value_name = "KT", default_value_t = HOLD, value_parser = hold)]
    pub hold: f64,
}

/// Of `transition`.
#[derive(Debug, Args)]
pub struct TransitionArguments {
    /// A PDB or mmCIF file (docs/structures.md): its bonds, angles and omegas are kept, and it is the start
    pub first: PathBuf,
    /// Another structure of the same residues: the goal is what comes nearest to it
    pub second: PathBuf,
    #[command(flatten)]
    pub ends: EndsArguments,
    /// An angle between domains for the page, as of `report`; may be given several times
    #[arg(long = "angle", value_name = "NAME=RANGE/RANGE/RANGE", value_parser = angle)]
    pub angles: Vec<DomainAngle>,
    #[command(flatten)]
    pub job: JobArguments,
}

fn hold(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|hold| (0.0..=1e6).contains(hold));
    number.ok_or_else(|| "a number from 0 to 1000000 expected".to_owned())
}
