use super::job::Job;
use super::protein::{announce, problem_of};
use super::report::report_on;
use crate::cli::{ReportArguments, SearchArguments, TransitionArguments};
use crate::exit::{Code, Failure};

/// Makes the problem of a protein's transition between two structures, grows its roadmap, and writes a page about it.
pub fn transition(arguments: &TransitionArguments) -> Result<Code, Failure> {
    let TransitionArguments { first, second, ends, angles, job } = arguments;
    let (is_json, job) = (job.growth.json, Job::begin(job)?);
    let made = problem_of(first, second, ends, &job.file)?;
    let comment = "# Written by `roadmill transition`.\n";
    job.carry_out(
        &made.problem,
        comment,
        || announce(&made, is_json),
        |run, page| {
            let search = SearchArguments::usual(angles.clone());
            report_on(
                run,
                &ReportArguments::of(page.run, page.out, search, page.max_time),
                page.signals,
            )
        },
    )
}
