//! Problem files.

use crate::failure::raised;
use pyo3::prelude::*;
use roadmill::model::{SceneOptions, ValidityFunction};
use roadmill::problem::Problem;
use roadmill_coordinator::exit::Failure;
use roadmill_coordinator::run::Ledgers;
use std::path::{Path, PathBuf};

/// Reads a problem file as the program does.
pub fn load(file: &Path) -> Result<Problem, Failure> {
    Problem::load_with(file, &SceneOptions::default(), &Ledgers).map_err(Failure::usage)
}

/// Reads a problem file, of whose configurations a function judges too, if one is given. What the function fails with is
/// kept by the function.
pub fn load_with(file: &Path, function: Option<&ValidityFunction>) -> Result<Problem, Failure> {
    let problem = load(file)?;
    match function {
        Some(function) => problem.with_validity_function(function.clone()).map_err(Failure::usage),
        None => Ok(problem),
    }
}

/// Checks a problem file: its digest, what would be built, and the notes about what was chosen where the file leaves a choice.
#[pyfunction]
pub fn check_problem(py: Python<'_>, file: PathBuf) -> PyResult<(String, String, Vec<String>)> {
    let problem = py.detach(|| load(&file)).map_err(raised)?;
    Ok((problem.digest().to_string(), problem.describe(), problem.notes().to_vec()))
}
