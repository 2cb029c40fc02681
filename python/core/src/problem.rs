//! Problem files.

use crate::failure::raised;
use pyo3::prelude::*;
use roadmill::model::SceneOptions;
use roadmill::problem::Problem;
use roadmill_coordinator::exit::Failure;
use roadmill_coordinator::run::Ledgers;
use std::path::{Path, PathBuf};

/// Reads a problem file as the program does.
pub fn load(file: &Path) -> Result<Problem, Failure> {
    Problem::load_with(file, &SceneOptions::default(), &Ledgers).map_err(Failure::usage)
}

/// Checks a problem file: its digest, what would be built, and the notes about what was chosen where the file leaves a choice.
#[pyfunction]
pub fn check_problem(py: Python<'_>, file: PathBuf) -> PyResult<(String, String, Vec<String>)> {
    let problem = py.detach(|| load(&file)).map_err(raised)?;
    Ok((problem.digest().to_string(), problem.describe(), problem.notes().to_vec()))
}
