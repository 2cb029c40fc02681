use super::build::grown;
use super::load::load_file;
use super::protein::{announce, problem_of};
use super::report::report;
use super::written::write_problem;
use crate::cli::{ReportArguments, SearchArguments, TransitionArguments};
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::output::note;
use std::ffi::OsString;
use std::path::PathBuf;

/// Makes the problem of a protein's transition between two structures, grows its roadmap, and writes a page about it.
///
/// The problem is written beside the run folder first, and read from there, so that whatever becomes of the build it can
/// be looked at, changed, and built again. A problem file that is there already is used if it is the same problem.
pub fn transition(arguments: &TransitionArguments) -> Result<Code, Failure> {
    let cpu = CpuClock::start();
    let TransitionArguments { first, second, ends, seed, out, force, or_resume, angles, growth } =
        arguments;
    // Without a slash at the end, as shells complete it.
    let out = &out.components().collect::<PathBuf>();
    if out.file_name().is_none() {
        let message = format!("--out: {} found; the name of a folder expected", out.display());
        return Err(Failure::usage(message));
    }
    let beside = |extension: &str| {
        let mut file = OsString::from(out);
        file.push(extension);
        PathBuf::from(file)
    };
    let (file, page) = (beside(".toml"), beside(".html"));
    if page.try_exists().unwrap_or(true) && !(*force || *or_resume) {
        let message = format!("{}: it is there already; --force replaces it", page.display());
        return Err(Failure::usage(message));
    }
    let made = problem_of(first, second, ends, &file)?;
    let seed = seed.unwrap_or(made.problem.seed());
    let problem = made.problem.clone().with_seed(seed);
    match file.try_exists() {
        Ok(true) if !force => {
            let there = load_file(&file)?;
            if there.digest() != problem.digest() {
                let message = format!(
                    "{}: another problem found; the same, or --force, or another --out expected",
                    file.display()
                );
                return Err(Failure::usage(message));
            }
            note(format_args!("{}: the problem is there already", file.display()));
        }
        _ => {
            if let Some(folder) = out.parent().filter(|folder| !folder.as_os_str().is_empty()) {
                std::fs::create_dir_all(folder).map_err(|error| {
                    Failure::system(format!("{}: cannot be made: {error}", folder.display()))
                })?;
            }
            let comment = "# Written by `roadmill transition`.\n";
            write_problem(&problem, comment, &file, *force)?;
        }
    }
    announce(&made);
    let ended = grown(load_file(&file)?, (Some(out), *force, *or_resume), growth, cpu);
    // Also of a roadmap that a limit has ended: the page says so.
    let code = ended.as_ref().map_or_else(|failure| failure.code, |code| *code);
    if matches!(code, Code::Done | Code::NoSuccess) {
        report(&ReportArguments {
            run: out.clone(),
            out: page,
            search: SearchArguments::usual(angles.clone()),
            dissimilar: None,
        })?;
    }
    ended
}
