use super::load::load;
use crate::cli::CheckArguments;
use crate::exit::{Code, Failure};

/// Says what is wrong with a problem, or what it would build.
pub fn check(arguments: &CheckArguments) -> Result<Code, Failure> {
    print!("{}", load(&arguments.problem)?.describe());
    Ok(Code::Done)
}
