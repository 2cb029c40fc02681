use super::place::check_place;
use super::solved::run_in;
use super::view::SHORTEN_TRIES;
use crate::cli::ExportArguments;
use crate::exit::{Code, Failure};
use crate::files::{is_standard_output, write_out};
use crate::run::Ledger;
use roadmill::export::{Direction, ExportFile, Exported, FORMATS, svg_from};
use roadmill::model::Scratch;
use roadmill::query::shorten;
use std::fs;

/// Writes a roadmap in a format that other programs read.
pub fn export(arguments: &ExportArguments) -> Result<Code, Failure> {
    check_place("--out", &arguments.out)?;
    if arguments.view.is_some() && arguments.format != "svg" {
        let message = format!("--view: --format {} found, svg expected", arguments.format);
        return Err(Failure::usage(message));
    }
    let Ledger { problem, roadmap, mut path, .. } = Ledger::read(&run_in(&arguments.run)?)?;
    if arguments.shorten {
        path =
            path.map(|path| shorten(&problem.context(), &path, SHORTEN_TRIES, &mut Scratch::new()));
    }
    let format = FORMATS.iter().find(|format| format.name() == arguments.format);
    let format = format.expect("the command line knows the formats");
    let exported = Exported { problem: &problem, roadmap: &roadmap, path: path.as_ref() };
    let files = match arguments.view {
        Some(direction) => seen_from(&exported, direction)?,
        None => {
            let files = format.files(&exported);
            files.map_err(|error| Failure::usage(format!("--format: {error}")))?
        }
    };
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

/// The picture of a scene in 3D from a direction.
fn seen_from(exported: &Exported, direction: Direction) -> Result<Vec<ExportFile>, Failure> {
    let Exported { problem, roadmap, path } = *exported;
    let is_planar = problem.model().description().figure().is_some_and(|figure| figure.is_planar());
    if is_planar {
        let message = format!("--view: {direction} found, but a planar problem is seen from above");
        return Err(Failure::usage(message));
    }
    let picture = svg_from(problem, roadmap, path, direction);
    let picture = picture.ok_or_else(|| Failure::usage("--format: this model cannot be drawn"))?;
    Ok(vec![ExportFile::named(picture)])
}
