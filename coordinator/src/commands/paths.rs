use super::search::Asked;
use super::solved::run_in;
use crate::cli::{FrameFormat, PathsArguments};
use crate::exit::{Code, Failure};
use crate::files::{make_empty, write_whole};
use crate::output::{line, note};
use crate::signals::Signals;
use crate::work::{Run, bounded};
use roadmill::Cancel;
use roadmill::export::{CannotExport, chimerax, dcd, path_csv, pdb, pymol, xtc};
use roadmill::pathways::{FrameTable, Pair, Pathway, Pathways};
use roadmill::query::PATH_REFINEMENT;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Finds several ways through the roadmap of a run, prints what each comes to and how far they are apart, and writes them. A signal or
/// a limit of time ends the search; what was found by then is printed and written all the same.
pub fn paths(arguments: &PathsArguments) -> Result<Code, Failure> {
    let run = Run::at(run_in(&arguments.run)?).read()?;
    match run.stopped() {
        None => note("the build has not ended; its complete rounds are searched"),
        Some(stopped) => note(format_args!("the build ended: {}", stopped.reason)),
    }
    let asked = Asked::of(&run, &arguments.search)?;
    check_formats(&asked, &arguments.format)?;
    if let Some(folder) = &arguments.out {
        make_empty(folder)?;
    }
    // Until here a signal ends the process at once, as nothing is found yet.
    let signals = Signals::listen().map_err(Failure::system)?;
    let begun = Instant::now();
    let search = |cancel: &Cancel| match arguments.distinct {
        true => asked.find_distinct(cancel),
        false => asked.find(arguments.dissimilar, cancel).map(|found| (found, Vec::new())),
    };
    let (found, classes) = bounded(|| signals.came(), arguments.max_time, search)??;
    let seconds = begun.elapsed().as_secs_f64();
    if found.dropped_edges > 0 {
        note(format_args!(
            "{} edges failed the {PATH_REFINEMENT} times finer check and were left out",
            found.dropped_edges
        ));
    }
    if found.pathways.is_empty() {
        let (code, why) = match (signals.came(), found.is_cut, found.connected) {
            (true, ..) => (Code::Interrupted, "a signal came before one was found"),
            (_, _, false) => (
                Code::NoSuccess,
                "nothing joins start and goal: neither the roadmap nor the direct motion",
            ),
            (_, true, _) => (Code::NoSuccess, "the time was up before one was found"),
            _ => (
                Code::NoSuccess,
                "every path between the ends that was tried has an edge that fails the finer check",
            ),
        };
        return Err(Failure::new(code, format!("no path: {why} ({seconds:.3} s)")));
    }
    print(&asked, &found, &classes);
    if let Some(folder) = &arguments.out {
        write(&asked, &found, &classes, arguments, folder)?;
    }
    let (count, wanted) = (found.pathways.len(), arguments.search.count);
    note(format_args!(
        "{count} of {wanted} paths, from {} candidates, in {seconds:.3} s",
        found.tried
    ));
    if signals.came() {
        let message = format!("a signal came; these {count} paths were found by then");
        return Err(Failure::new(Code::Interrupted, message));
    }
    if found.is_cut {
        note("the time was up before the search for paths was over");
    }
    Ok(Code::Done)
}

/// # Errors
/// Exit code 2: a format is asked for that only molecules have, of a model that is none.
fn check_formats(asked: &Asked, formats: &[FrameFormat]) -> Result<(), Failure> {
    let other = formats.iter().find(|format| **format != FrameFormat::Csv);
    match (asked.molecule, other) {
        (None, Some(other)) => {
            let name = format!("{other:?}").to_lowercase();
            let message =
                format!("--format: {name} found; this model is no molecule, csv expected");
            Err(Failure::usage(message))
        }
        _ => Ok(()),
    }
}

/// Prints a line per path, one per class if paths have classes, and one per pair of paths.
fn print(asked: &Asked, found: &Pathways, classes: &[String]) {
    let Asked { energy, cost, length, .. } = asked;
    if found.pathways[0].measured.peak.is_some() {
        line(format_args!(
            "energies in {energy}, above the energy at departure; costs in {cost}; lengths in {length}"
        ));
    } else {
        line(format_args!("costs and lengths in {length}"));
    }
    line("path   barrier      cost   barrier back   cost back    length  frames  nearest");
    for (index, pathway) in found.pathways.iter().enumerate() {
        let Pathway { measured, frames, .. } = pathway;
        let number = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.2}"));
        let nearest = match nearest(found, index) {
            None => "-".to_owned(),
            Some((other, pair)) => format!("{:.2} from {}", pair.frechet.value, other + 1),
        };
        line(format_args!(
            "{:>4}{:>10}{:>10.2}{:>15}{:>12.2}{:>10.2}{:>8}  {nearest}",
            index + 1,
            number(measured.there.barrier),
            measured.there.cost,
            number(measured.back.barrier),
            measured.back.cost,
            frames.length(),
            frames.len(),
        ));
    }
    if !classes.is_empty() {
        line("path  class: obstacles passed");
    }
    for (index, class) in classes.iter().enumerate() {
        line(format_args!("{:>4}  {class}", index + 1));
    }
    if !found.pairs.is_empty() {
        line("pairs    frechet  frames that decide   hausdorff  frames that decide");
    }
    for Pair { first, second, frechet, hausdorff } in &found.pairs {
        let decided = |first: usize, second: usize| format!("{} and {}", first + 1, second + 1);
        line(format_args!(
            "{:<9}{:>7.2}  {:<18}{:>12.2}  {}",
            decided(*first, *second),
            frechet.value,
            decided(frechet.first, frechet.second),
            hausdorff.value,
            decided(hausdorff.first, hausdorff.second),
        ));
    }
}

/// Writes the table, the distances and the paths into a folder.
fn write(
    asked: &Asked,
    found: &Pathways,
    classes: &[String],
    arguments: &PathsArguments,
    folder: &Path,
) -> Result<(), Failure> {
    write_whole(&folder.join("paths.csv"), table(asked, found, classes))?;
    write_whole(&folder.join("matrix.csv"), matrix(asked, found))?;
    let space = asked.run.context().space();
    let is_asked =
        |formats: &[FrameFormat]| arguments.format.iter().any(|format| formats.contains(format));
    for (index, pathway) in found.pathways.iter().enumerate() {
        let file = |end: &str| folder.join(format!("path-{}.{end}", index + 1));
        let frames = || pathway.frames.configs.iter();
        let cannot = |error: CannotExport| Failure::usage(format!("--format: {error}"));
        write_whole(&file("csv"), path_csv(space, &pathway.path))?;
        if let Some(molecule) = asked.molecule {
            let table = FrameTable::of(molecule, &pathway.frames, &arguments.search.angles);
            write_whole(&file("frames.csv"), table.csv())?;
            write_whole(&file("contacts.csv"), table.contacts_csv())?;
            if is_asked(&[FrameFormat::Pdb, FrameFormat::Pml, FrameFormat::Cxc]) {
                write_whole(&file("pdb"), pdb(molecule, frames()).map_err(cannot)?)?;
            }
            if is_asked(&[FrameFormat::Dcd]) {
                write_whole(&file("dcd"), dcd(molecule, frames()).map_err(cannot)?)?;
            }
            if is_asked(&[FrameFormat::Xtc]) {
                write_whole(&file("xtc"), xtc(molecule, frames()).map_err(cannot)?)?;
            }
        }
    }
    let counts: Vec<usize> = found.pathways.iter().map(|pathway| pathway.frames.len()).collect();
    let has_others = asked.molecule.is_some_and(|molecule| molecule.has_chains_that_stand_still());
    if is_asked(&[FrameFormat::Pml]) {
        write_whole(&folder.join("paths.pml"), pymol(&counts, has_others))?;
    }
    if is_asked(&[FrameFormat::Cxc]) {
        write_whole(&folder.join("paths.cxc"), chimerax(&counts, has_others))?;
    }
    Ok(())
}

/// `paths.csv`. Where paths have classes these are the last column.
fn table(asked: &Asked, found: &Pathways, classes: &[String]) -> String {
    let Asked { energy, cost, length, .. } = asked;
    let heading = if classes.is_empty() { "" } else { ",class" };
    let mut csv = format!(
        "path,barrier [{energy}],cost [{cost}],barrier_back [{energy}],cost_back [{cost}],peak [{energy}],\
         length [{length}],configurations,frames,nearest,frechet [{length}]{heading}\n"
    );
    for (index, pathway) in found.pathways.iter().enumerate() {
        let Pathway { path, measured, frames } = pathway;
        let number = |value: Option<f64>| value.map_or(String::new(), |v| v.to_string());
        let nearest = nearest(found, index);
        writeln!(
            csv,
            "{},{},{},{},{},{},{},{},{},{},{}{}",
            index + 1,
            number(measured.there.barrier),
            measured.there.cost,
            number(measured.back.barrier),
            measured.back.cost,
            number(measured.peak),
            frames.length(),
            path.configs.len(),
            frames.len(),
            nearest.map_or(String::new(), |(other, _)| (other + 1).to_string()),
            number(nearest.map(|(_, pair)| pair.frechet.value)),
            classes.get(index).map_or(String::new(), |class| format!(",{class}")),
        )
        .expect("writing to memory cannot fail");
    }
    csv
}

/// `matrix.csv`.
fn matrix(asked: &Asked, found: &Pathways) -> String {
    let length = asked.length;
    let mut csv = format!(
        "first,second,frechet [{length}],frechet_frame_first,frechet_frame_second,\
         hausdorff [{length}],hausdorff_frame_first,hausdorff_frame_second\n"
    );
    for Pair { first, second, frechet, hausdorff } in &found.pairs {
        writeln!(
            csv,
            "{},{},{},{},{},{},{},{}",
            first + 1,
            second + 1,
            frechet.value,
            frechet.first + 1,
            frechet.second + 1,
            hausdorff.value,
            hausdorff.first + 1,
            hausdorff.second + 1,
        )
        .expect("writing to memory cannot fail");
    }
    csv
}

/// The path whose Fréchet distance from a path is the least, the first of several.
fn nearest(found: &Pathways, index: usize) -> Option<(usize, &Pair)> {
    let pairs = found.pairs.iter().filter(|pair| pair.first == index || pair.second == index);
    let nearest = pairs.min_by(|a, b| a.frechet.value.total_cmp(&b.frechet.value))?;
    let other = if nearest.first == index { nearest.second } else { nearest.first };
    Some((other, nearest))
}
