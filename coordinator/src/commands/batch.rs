//! Many queries from a file.

use super::asker::{Asker, TimedAnswer};
use crate::exit::{Code, Failure};
use crate::files::{make_empty, read_regular_text, write_whole};
use crate::output::note;
use roadmill::problem::configuration;
use std::fmt::Write;
use std::path::Path;

/// Answers every query of a file into a new folder: a path per solved query, named by its index from
/// 0, and `summary.csv` with a line per query.
pub(super) fn batch(asker: &Asker, file: &Path, folder: &Path) -> Result<Code, Failure> {
    let queries = read(asker, file)?;
    make_empty(folder)?;
    let unit = asker.run.problem().model().description().cost_unit();
    let mut summary =
        format!("index,solved,length [{unit}],configurations,dropped_edges,seconds\n");
    let (mut unsolved, mut whole) = (0, 0.0);
    for (index, [start, goal]) in queries.iter().enumerate() {
        let TimedAnswer { answer, seconds } = asker.ask(start, goal);
        whole += seconds;
        let (solved, length, configs) = match &answer.path {
            Some(path) => {
                let name = format!("{index:06}.{}", asker.extension());
                write_whole(&folder.join(name), asker.text(path))?;
                (1, path.length.to_string(), path.configs.len())
            }
            None => (0, String::new(), 0),
        };
        unsolved += 1 - solved;
        let dropped = answer.dropped_edges;
        writeln!(summary, "{index},{solved},{length},{configs},{dropped},{seconds:.6}")
            .map_err(Failure::system)?;
    }
    write_whole(&folder.join("summary.csv"), summary)?;
    let asked = queries.len();
    note(format_args!("{} of {asked} queries solved, in {whole:.3} s", asked - unsolved));
    match unsolved {
        0 => Ok(Code::Done),
        _ => Err(Failure::new(Code::NoSuccess, format!("{unsolved} of {asked} queries unsolved"))),
    }
}

/// The queries of a file: start and goal of each.
fn read(asker: &Asker, file: &Path) -> Result<Vec<[Vec<f64>; 2]>, Failure> {
    let text = read_regular_text(file).map_err(|error| {
        Failure::usage(format!("{}: cannot read the queries: {error}", file.display()))
    })?;
    let dofs = asker.cx().space().len();
    let mut queries = Vec::new();
    let mut header_may_come = true;
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(&text);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        // A line of names may stand above the numbers.
        let is_wide = fields.len() == 2 * dofs;
        let names = is_wide && fields.iter().all(|field| field.parse::<f64>().is_err());
        if std::mem::take(&mut header_may_come) && names {
            continue;
        }
        let wrong = |message: String| {
            Failure::usage(format!("{}:{}: {message}", file.display(), number + 1))
        };
        if fields.len() != 2 * dofs {
            let found = fields.len();
            return Err(wrong(format!(
                "{found} values found, {} expected: those of the start, then of the goal, with commas between",
                2 * dofs
            )));
        }
        if let Some(empty) = fields.iter().position(|field| field.is_empty()) {
            return Err(wrong(format!("nothing found in field {}, a number expected", empty + 1)));
        }
        let end = |name: &str, fields: &[&str]| {
            configuration(asker.cx(), &fields.join(","))
                .map_err(|error| wrong(format!("{name}: {error}")))
        };
        queries.push([end("start", &fields[..dofs])?, end("goal", &fields[dofs..])?]);
    }
    if queries.is_empty() {
        return Err(Failure::usage(format!(
            "{}: no queries found; a line for each expected",
            file.display()
        )));
    }
    Ok(queries)
}
