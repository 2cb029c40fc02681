use super::load::load;
use crate::cli::CheckArguments;
use crate::exit::{Code, Failure};
use crate::output::lines;

/// Says what is wrong with a problem, or what it would build.
pub fn check(arguments: &CheckArguments) -> Result<Code, Failure> {
    lines(load(&arguments.problem)?.describe().trim_end());
    Ok(Code::Done)
}
