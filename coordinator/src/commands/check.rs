use crate::cli::CheckArguments;
use crate::exit::{Code, Failure};
use roadmill::problem::Problem;

/// Says what is wrong with a problem, or what it would build.
pub fn check(arguments: &CheckArguments) -> Result<Code, Failure> {
    let problem = Problem::load(&arguments.problem).map_err(Failure::usage)?;
    print!("{}", problem.describe());
    Ok(Code::Done)
}
