use crate::cli::ExportArguments;
use crate::exit::{Code, Failure};
use crate::files::write_whole;
use crate::run::Ledger;
use roadmill::export::{Exported, FORMATS};

/// Writes a roadmap in a format that other programs read.
pub fn export(arguments: &ExportArguments) -> Result<Code, Failure> {
    let Ledger { problem, roadmap, path, .. } = Ledger::read(&arguments.run)?;
    let format = FORMATS.iter().find(|format| format.name() == arguments.format);
    let format = format.expect("the command line knows the formats");
    let exported = Exported { problem: &problem, roadmap: &roadmap, path: path.as_ref() };
    let files = format.files(&exported);
    let out = &arguments.out;
    for file in files.map_err(|error| Failure::usage(format!("--format: {error}")))? {
        match file.extension {
            None => write_whole(out, file.contents)?,
            Some(extension) => write_whole(&out.with_extension(extension), file.contents)?,
        }
    }
    Ok(Code::Done)
}
