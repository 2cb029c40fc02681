//! Approximate paths as files: CSV as `roadmill query` writes it, or Parasol's `.path`.

use crate::context::Context;
use crate::digest::SourceFile;
use crate::generator::{CONFIGURATIONS_MAX, HintPath, too_long};
use crate::internal::csv_field::csv_field;
use crate::model::{is_parasol_path, read_parasol_path};
use crate::source::Step::{Index, Key};
use crate::source::{NoText, ProblemError, Source, read_file, text_of};
use crate::space::{Configs, Dof, Space};
use crate::strategy::Strategy;
use std::fmt::Write;
use std::path::Path;

/// Reads the approximate paths that generators go by.
pub(super) fn take_in_hints(
    source: &Source,
    space: &Space,
    strategies: &mut [Strategy],
) -> Result<(), ProblemError> {
    for (index, strategy) in strategies.iter_mut().enumerate() {
        for path in strategy.generator.method_mut().hint_paths_mut() {
            // What is read already stays.
            if path.configurations().is_empty() && !path.file().is_empty() {
                let place = [Key("strategies"), Index(index), Key("generator")];
                let read = read(source, path.file(), space)?
                    .map_err(|message| source.error(&place, message))?;
                *path = path.clone().with(read);
            }
        }
    }
    Ok(())
}

/// Reads a file: `Err` where something is wrong in it, and `Ok(Err(…))` where it cannot be read at all.
fn read(
    source: &Source,
    file: &str,
    space: &Space,
) -> Result<Result<Vec<Vec<f64>>, String>, ProblemError> {
    let path = source.folder.join(file);
    let bytes = match read_file(&path) {
        Ok(bytes) => bytes,
        Err(error) => return Ok(Err(format!("{file}: cannot read the approximate path: {error}"))),
    };
    let configurations = configurations_in(&path, &bytes, space)?;
    source.read(SourceFile::new(file, &bytes));
    Ok(Ok(configurations))
}

/// The configurations in the bytes of a file.
fn configurations_in(
    path: &Path,
    bytes: &[u8],
    space: &Space,
) -> Result<Vec<Vec<f64>>, ProblemError> {
    let text = text_of(bytes).map_err(|NoText { line, found }| {
        ProblemError::line(path, line, format!("{found}; a path, which is text, expected"))
    })?;
    let read = match is_parasol_path(&text) {
        true => read_parasol_path(&text, space),
        false => read_csv(&text, space),
    };
    let configurations = read.map_err(|(line, message)| ProblemError::line(path, line, message))?;
    match configurations.len() > CONFIGURATIONS_MAX {
        true => Err(ProblemError::file(path, too_long())),
        false => Ok(configurations),
    }
}

/// The configurations of a path in a file, CSV as `roadmill query` writes it or Parasol's `.path`, in stored form. Whether they are valid is
/// not asked.
///
/// # Errors
/// The file cannot be read; or the line where something is wrong, what was found there and what is expected.
pub fn read_path(cx: &Context, file: &Path) -> Result<Configs, ProblemError> {
    let bytes = read_file(file)
        .map_err(|error| ProblemError::file(file, format!("cannot read the path: {error}")))?;
    let mut path = Configs::new(cx.space.len());
    let read = configurations_in(file, &bytes, &cx.space)?;
    for (index, mut q) in read.into_iter().enumerate() {
        cx.stored(&mut q).map_err(|message| {
            ProblemError::file(file, format!("configuration {}: {message}", index + 1))
        })?;
        path.push(&q);
    }
    Ok(path)
}

/// The configurations of a table: a column per degree of freedom, in their order, and a line per configuration. The first line may name the columns, with or
/// without units; empty lines and lines that begin with `#` are passed over.
///
/// # Errors
/// The line, what was found there and what is expected.
fn read_csv(text: &str, space: &Space) -> Result<Vec<Vec<f64>>, (usize, String)> {
    let with_units = head(space);
    let names: Vec<String> =
        space.dofs().iter().map(|dof| csv_field(&dof.name).into_owned()).collect();
    let names = names.join(",");
    let mut path = Vec::new();
    let mut head_may_come = true;
    for (index, line) in text.lines().enumerate() {
        let (number, line) = (index + 1, line.trim());
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if std::mem::take(&mut head_may_come) {
            let is_number = |field: &str| field.trim().parse::<f64>().is_ok();
            if line == with_units || line == names {
                continue;
            }
            if !line.split(',').any(is_number) {
                return Err((number, format!("columns {line} found; {with_units} expected")));
            }
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        if fields.len() != space.len() {
            let message = format!("{} values found; {} expected", fields.len(), space.len());
            return Err((number, message));
        }
        let mut q = Vec::with_capacity(fields.len());
        for field in fields {
            let value = field.parse().ok().filter(|value: &f64| value.is_finite());
            q.push(
                value.ok_or_else(|| {
                    (number, format!("`{field}` found; a finite number expected"))
                })?,
            );
        }
        path.push(q);
    }
    if path.is_empty() {
        let last = text.lines().count().max(1);
        return Err((last, "no configuration found; one a line expected".to_owned()));
    }
    Ok(path)
}

/// An approximate path as a table that [`read_csv`] reads, to the last bit.
pub(super) fn csv_of(path: &HintPath, space: &Space) -> String {
    let mut csv = head(space);
    csv.push('\n');
    for q in path.configurations() {
        let values: Vec<String> = q.iter().map(f64::to_string).collect();
        writeln!(csv, "{}", values.join(",")).expect("writing to memory cannot fail");
    }
    csv
}

/// The first line: the degrees of freedom with their units.
fn head(space: &Space) -> String {
    let name = |dof: &Dof| csv_field(&format!("{} [{}]", dof.name, dof.unit)).into_owned();
    let names: Vec<String> = space.dofs().iter().map(name).collect();
    names.join(",")
}
