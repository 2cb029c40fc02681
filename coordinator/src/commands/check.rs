use super::load::load;
use super::say;
use crate::cli::CheckArguments;
use crate::exit::{Code, Failure};

/// Says what is wrong with a problem, or what it would build.
pub fn check(arguments: &CheckArguments) -> Result<Code, Failure> {
    say(load(&arguments.problem)?.describe().trim_end());
    Ok(Code::Done)
}
