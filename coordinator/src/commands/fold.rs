use super::job::Job;
use super::orders::{OwnFormation, native};
use super::protein::{name_of, spec_of};
use super::report::report_with;
use crate::cli::{FoldArguments, ReportArguments, SearchArguments};
use crate::exit::{Code, Failure};
use roadmill::problem::folding;
use std::path::Path;
use std::time::Instant;

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
            let begun = Instant::now();
            let formation = OwnFormation::of(run, native(run)?, page.signals, page.max_time)?;
            // With --json standard output is for the objects alone.
            if !is_json {
                formation.print(run);
            }
            let left = |whole: f64| (whole - begun.elapsed().as_secs_f64()).max(0.0);
            let (search, max_time) = (SearchArguments::usual(Vec::new()), page.max_time.map(left));
            let arguments = ReportArguments::of(page.run, page.out, search, max_time);
            report_with(run, &arguments, page.signals, Some(formation))
        },
    )
}
