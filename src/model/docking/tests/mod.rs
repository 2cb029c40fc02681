//! The description and the model as a whole, with biotin at streptavidin, which ship as `problems/structures/1STP.pdb`.

mod files;
mod model;
mod pieces;
mod placed;
mod policies;

use super::Docking;
use crate::model::ModelKind;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// Biotin in a box about its place in the crystal, by exact sums unless the table says otherwise.
const BIOTIN: &str = r#"
protein = { file = "structures/1STP.pdb" }
ligand = { file = "structures/1STP.pdb", residue = "BTN" }
box = { centre = [11.0, 2.0, -11.0], size = [12.0, 12.0, 12.0] }
"#;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("problems")
}

fn parse(table: &str) -> Result<Problem, String> {
    let text = format!("[docking]\n{table}");
    Problem::parse(&folder().join("p.toml"), &text).map_err(|error| error.to_string())
}

fn problem(table: &str) -> Problem {
    parse(table).unwrap_or_else(|error| panic!("{error}"))
}

fn docking(table: &str) -> Docking {
    docking_of(&problem(table))
}

fn docking_of(problem: &Problem) -> Docking {
    match problem.model() {
        ModelKind::Docking(docking) => docking.clone(),
        other => panic!("{other:?}"),
    }
}

/// Biotin with these lines more.
fn biotin(more: &str) -> String {
    format!("{BIOTIN}{more}")
}
