use super::place::check_place;
use crate::cli::ExportArguments;
use crate::exit::{Code, Failure};
use crate::files::{is_standard_output, write_out};
use crate::run::Ledger;
use roadmill::export::{Exported, FORMATS};
use std::fs;

/// Writes a roadmap in a format that other programs read.
pub fn export(arguments: &ExportArguments) -> Result<Code, Failure> {
    check_place("--out", &arguments.out)?;
    let Ledger { problem, roadmap, path, .. } = Ledger::read(&arguments.run)?;
    let format = FORMATS.iter().find(|format| format.name() == arguments.format);
    let format = format.expect("the command line knows the formats");
    let exported = Exported { problem: &problem, roadmap: &roadmap, path: path.as_ref() };
    let files = format.files(&exported);
    let files = files.map_err(|error| Failure::usage(format!("--format: {error}")))?;
    let to_standard_output = is_standard_output(&arguments.out);
    if to_standard_output && files.len() > 1 {
        return Err(Failure::usage(format!(
            "--out: - found, but {} is {} files; the name of a file expected",
            format.name(),
            files.len()
        )));
    }
    let mut written = Vec::new();
    for file in files {
        let out = match file.extension {
            _ if to_standard_output => arguments.out.clone(),
            None => arguments.out.clone(),
            Some(extension) => arguments.out.with_extension(extension),
        };
        let is_new = !to_standard_output && !out.exists();
        if let Err(failure) = write_out(&out, file.contents) {
            // Half of an export is none.
            written.iter().for_each(|path| drop(fs::remove_file(path)));
            return Err(failure);
        }
        if is_new {
            written.push(out);
        }
    }
    Ok(Code::Done)
}
