use super::descents::Descents;
use super::model::docking_of;
use super::pose_files::{named, places, write, write_way};
use super::pose_page::Shown;
use super::pose_table::PoseTable;
use crate::cli::{PoseFormat, PosesArguments};
use crate::commands::place::{check_page, check_place};
use crate::commands::solved::run_in;
use crate::exit::{Code, Failure};
use crate::files::write_whole;
use crate::output::{json, note};
use crate::signals::Signals;
use crate::waiting::waiting;
use crate::work::{Run, bounded};
use roadmill::Cancel;
use roadmill::binding::{Asked, Comparison, Exact, Reference, candidates};
use roadmill::ligand;
use roadmill::model::docking::Docking;
use std::ffi::OsString;
use std::path::PathBuf;

/// Says which poses a run has found, and writes them. A signal ends the search; what was found by then is printed and written all the same.
pub fn poses(arguments: &PosesArguments) -> Result<Code, Failure> {
    let (prefix, formats) = files(arguments);
    let ways = (1..=arguments.ways.min(arguments.count))
        .flat_map(|way| ["pdb", "csv"].map(|end| named(&prefix, &format!("-way-{way}.{end}"))));
    for place in formats.iter().flat_map(|format| places(&prefix, *format)).chain(ways) {
        check_place("--out", &place)?;
        if !arguments.force && place.try_exists().unwrap_or(true) {
            let place = place.display();
            let message = format!("{place}: it is there already; --force replaces it");
            return Err(Failure::usage(message));
        }
    }
    if let Some(page) = &arguments.page {
        check_page("--page", page)?;
    }
    let folder = run_in(&arguments.run)?;
    let run = Run::at(&folder).read()?;
    let docking = docking_of(&run)?;
    match run.stopped() {
        None => note("the build has not ended; its complete rounds are searched"),
        Some(stopped) => note(format_args!("the build ended: {}", stopped.reason)),
    }
    let exact = Exact::of(docking, run.problem().seed());
    let comparison = Comparison::of(docking);
    if !comparison.is_corrected() {
        note("the ligand has more symmetries than can be counted; RMSDs are without them");
    }
    let reference = reference(arguments, docking, &exact)?;
    let asked = Asked {
        count: arguments.count as usize,
        improved: arguments.improve as usize,
        radius: arguments.radius,
        ..Asked::default()
    };
    // Until here a signal ends the process at once, as nothing is found yet.
    let signals = Signals::listen().map_err(Failure::system)?;
    let search = |cancel: &Cancel| {
        let distance = |a: &[_], b: &[_]| comparison.distance(a, b);
        candidates(&exact, run.roadmap(), &asked, distance, cancel)
    };
    let found = waiting("descending nodes", || bounded(|| signals.came(), None, search))?;
    if found.candidates.is_empty() {
        return Err(match signals.came() {
            true => Failure::new(Code::Interrupted, "no pose: a signal came before one was found"),
            false => Failure::new(Code::NoSuccess, "no pose: the run has no nodes yet"),
        });
    }
    let descents = Descents::of(&folder, &exact, run.roadmap())?;
    let known = reference.as_ref().map(|(reference, source)| (reference, source.clone()));
    let table = PoseTable::of(&found, known, &comparison, &descents);
    match arguments.json {
        true => drop(json(&table)),
        false => table.print(docking),
    }
    for format in formats {
        write(format, &prefix, docking, &found, &table)?;
    }
    for (index, pose) in found.candidates.iter().take(arguments.ways as usize).enumerate() {
        match &pose.way_out {
            Some(way) => write_way(&prefix, index + 1, docking, way)?,
            None => note(format_args!("pose {} has no way out in the roadmap", index + 1)),
        }
    }
    if let Some(page) = &arguments.page {
        let reference = reference.as_ref().map(|(reference, _)| reference);
        let (found, comparison, descents, table) = (&found, &comparison, &descents, &table);
        let shown = Shown { run: &run, docking, found, reference, comparison, descents, table };
        write_whole(page, shown.page()?)?;
    }
    if signals.came() {
        let message = "a signal came; these poses are of the nodes that were descended by then";
        return Err(Failure::new(Code::Interrupted, message));
    }
    Ok(Code::Done)
}

/// How the names of files begin, and the formats that are written: all if only the names are given.
fn files(arguments: &PosesArguments) -> (PathBuf, Vec<PoseFormat>) {
    let prefix = arguments.out.clone().unwrap_or_else(|| {
        // Without a slash at the end, as shells complete it.
        let run: PathBuf = arguments.run.components().collect();
        let mut name = OsString::from(run);
        name.push("-poses");
        PathBuf::from(name)
    });
    let formats = match (&arguments.format[..], &arguments.out) {
        ([], Some(_)) => vec![PoseFormat::Sdf, PoseFormat::Pdb, PoseFormat::Csv],
        (given, _) => given.to_vec(),
    };
    (prefix, formats)
}

/// The pose with which others are compared, and where it comes from: that of a file, or else the given one if it is in the box.
///
/// # Errors
/// Exit code 2: the file has another molecule, or a pose outside of the box.
fn reference(
    arguments: &PosesArguments,
    docking: &Docking,
    exact: &Exact,
) -> Result<Option<(Reference, String)>, Failure> {
    let Some(file) = &arguments.reference else {
        let given = docking.positions_at(&docking.given());
        let reference = Reference::of(exact, docking, given);
        return Ok(reference.map(|reference| (reference, "the given pose".to_owned())));
    };
    let name = file.display();
    let refuse = |message: &str| Failure::usage(format!("{name}: {message}"));
    let pose = ligand::read(file).map_err(Failure::usage)?;
    let positions = docking.positions_in(&pose).map_err(|message| refuse(&message))?;
    let reference = Reference::of(exact, docking, positions).ok_or_else(|| {
        refuse(
            "a pose outside of the box of the run found; one with its centre in the box expected",
        )
    })?;
    Ok(Some((reference, name.to_string())))
}
