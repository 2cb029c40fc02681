use crate::cli::CheckArguments;
use crate::exit::{Code, Failure};
use roadmill::problem::{Companions, Problem};

/// Says what is wrong with a problem, or what it would build.
pub fn check(arguments: &CheckArguments) -> Result<Code, Failure> {
    let companions =
        Companions { robot: arguments.robot.as_deref(), query: arguments.query.as_deref() };
    let problem = Problem::load_with(&arguments.problem, companions).map_err(Failure::usage)?;
    print!("{}", problem.describe());
    Ok(Code::Done)
}
