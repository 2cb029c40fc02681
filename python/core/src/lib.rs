//! The module `roadmill._core`: what the Python package does without starting the program.
//!
//! It is as small as it can be: a run that was loaded, to be queried and to give its arrays; a build in threads of the
//! process, and the verification of one whose configurations a function in Python judged; and the check of a problem file. What users see is written in Python, in `python/roadmill/`, whose stub
//! `_core.pyi` lists what is here. No function holds Python's lock while it works.

mod failure;
mod growth;
mod problem;
mod run;
mod validity;
mod verification;

use pyo3::prelude::*;

/// The module.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("Failure", module.py().get_type::<failure::Failure>())?;
    module.add("BITS_VERSION", roadmill::BITS_VERSION)?;
    module.add_class::<run::LoadedRun>()?;
    module.add_function(wrap_pyfunction!(growth::grow, module)?)?;
    module.add_function(wrap_pyfunction!(growth::go_on, module)?)?;
    module.add_function(wrap_pyfunction!(verification::verify, module)?)?;
    module.add_function(wrap_pyfunction!(problem::check_problem, module)?)
}
