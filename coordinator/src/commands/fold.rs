use super::job::Job;
use super::orders;
use super::protein::{name_of, spec_of};
use super::report::report_on;
use crate::cli::{FoldArguments, ReportArguments, SearchArguments};
use crate::exit::{Code, Failure};
use roadmill::problem::folding;
use std::path::Path;

/// Makes the problem of a protein's folding, grows its roadmap, says in which order the parts of the structure form, and
/// writes a page about it.
pub fn fold(arguments: &FoldArguments) -> Result<Code, Failure> {
    let FoldArguments { file, chain, job } = arguments;
    let (is_json, job) = (job.growth.json, Job::begin(job)?);
    let problem = folding(&name_of(&job.file), Path::new(""), &spec_of(file, chain));
    let comment = "# Written by `roadmill fold`.\n";
    job.carry_out(
        &problem.map_err(Failure::usage)?,
        comment,
        || (),
        |run, page| {
            // With --json standard output is for the objects alone.
            if !is_json {
                orders::say(run)?;
            }
            let search = SearchArguments::usual(Vec::new());
            report_on(
                run,
                &ReportArguments::of(page.run, page.out, search, page.max_time),
                page.signals,
            )
        },
    )
}
