//! Commands about ligands at proteins, one file each.

mod descents;
mod model;
mod pose_files;
mod pose_page;
mod pose_table;
mod poses;
mod problem;
mod rank;
mod rank_table;

use crate::cli::LigandCommand;
use crate::exit::{Code, Failure};

/// Does what is to be done with ligands at proteins.
pub fn ligand(command: &LigandCommand) -> Result<Code, Failure> {
    match command {
        LigandCommand::Problem(arguments) => problem::problem(arguments),
        LigandCommand::Poses(arguments) => poses::poses(arguments),
        LigandCommand::Rank(arguments) => rank::rank(arguments),
    }
}
