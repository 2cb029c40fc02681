use super::load::load;
use crate::cli::CheckArguments;
use crate::exit::{Code, Failure};
use crate::output::lines;

/// Says what is wrong with a problem, or what it would build.
pub fn check(arguments: &CheckArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    if let Some(samples) = arguments.touching {
        let Some(bodies) = problem.model().bodies() else {
            return Err(Failure::usage("--touching found; a robot of links expected"));
        };
        lines(bodies.may_touch_lines(samples, problem.seed()).trim_end());
        return Ok(Code::Done);
    }
    lines(problem.describe().trim_end());
    Ok(Code::Done)
}
