use super::load::load;
use super::written::write_problem;
use crate::cli::ImportArguments;
use crate::exit::{Code, Failure};

/// Writes a problem as a problem file, with its other files in a folder beside it.
pub fn import(arguments: &ImportArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    let from = arguments.problem.file.file_name().unwrap_or_default();
    // Quoted, for names may hold line breaks.
    let comment = format!("# Imported from {from:?}.\n");
    write_problem(&problem, &comment, &arguments.out, (arguments.force, false))?;
    Ok(Code::Done)
}
