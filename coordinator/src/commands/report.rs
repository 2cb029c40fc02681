use super::orders::{OwnFormation, native_of};
use super::place::check_page;
use super::search::Asked;
use super::solved::run_in;
use crate::cli::{ReportArguments, SearchArguments};
use crate::exit::{Code, Failure};
use crate::files::write_whole;
use crate::output::note;
use crate::signals::Signals;
use crate::work::{Recorded, Run, bounded};
use roadmill::export::{Folding, Report, report as page};
use roadmill::folding::examples;
use roadmill::model::Scratch;
use roadmill::pathways::{Pathways, Rank, SPACING};
use roadmill::{Cancel, Ends};
use std::time::Instant;

/// Writes a page about a run, with several dissimilar paths through its roadmap; also where there is no path yet.
///
/// A signal ends it without a page. A limit of time ends the search for paths; the page then says so.
pub fn report(arguments: &ReportArguments) -> Result<Code, Failure> {
    check_page("--out", &arguments.out)?;
    let run = Run::at(run_in(&arguments.run)?).read()?;
    // Until here a signal ends the process at once, as nothing is written yet.
    let signals = Signals::listen().map_err(Failure::system)?;
    report_on(&run, arguments, &signals)
}

/// Writes the page about a run that has been read.
pub(super) fn report_on(
    run: &Recorded,
    arguments: &ReportArguments,
    signals: &Signals,
) -> Result<Code, Failure> {
    report_with(run, arguments, signals, None)
}

/// [`report_on`] with the orders of formation, if they are known already.
pub(super) fn report_with(
    run: &Recorded,
    arguments: &ReportArguments,
    signals: &Signals,
    known: Option<OwnFormation>,
) -> Result<Code, Failure> {
    let interrupted = || {
        if !signals.came() {
            return Ok(());
        }
        let (run, out) = (arguments.run.display(), arguments.out.display());
        let way = format!("`roadmill report {run} --out {out}` writes it");
        Err(Failure::new(Code::Interrupted, format!("a signal came; there is no page: {way}")))
    };
    let shown = shown(run, arguments, signals, known)?;
    interrupted()?;
    let end = match run.stopped() {
        None => "it has not ended, or was killed; these are its complete rounds",
        Some(stopped) => &stopped.reason,
    };
    let (count, found_count) = (arguments.search.count, shown.pathways.pathways.len());
    let page = page(
        &Report {
            problem: run.problem(),
            cx: run.context(),
            roadmap: run.roadmap(),
            ends: &shown.ends,
            pathways: &shown.pathways,
            asked: &shown.asked,
            angles: &arguments.search.angles,
            folding: shown.folding.as_ref().map(|folding| Folding {
                native: &folding.native,
                settings: &folding.settings,
                formation: folding.formation.as_ref(),
            }),
            rounds: run.rounds(),
            program: &run.program(),
            end,
        },
        &mut Scratch::new(),
    );
    interrupted()?;
    write_whole(&arguments.out, &page)?;
    note(format_args!(
        "{}: {found_count} of {count} paths, {:.1} MB",
        arguments.out.display(),
        page.len() as f64 / 1e6
    ));
    if shown.pathways.is_cut {
        note(format_args!(
            "{}: the time was up before the search for paths was over",
            arguments.out.display()
        ));
    }
    Ok(Code::Done)
}

/// What a page shows.
struct Shown {
    ends: Ends,
    pathways: Pathways,
    /// How the paths were looked for, in words.
    asked: String,
    folding: Option<OwnFormation>,
}

/// The paths between the ends that are asked for or that the problem has; of a protein about a native structure, without any
/// ends, its folding.
fn shown(
    run: &Recorded,
    arguments: &ReportArguments,
    signals: &Signals,
    known: Option<OwnFormation>,
) -> Result<Shown, Failure> {
    let SearchArguments { start, goal, .. } = &arguments.search;
    let has_ends = run.problem().query().is_some() || start.is_some() || goal.is_some();
    let Some(native) = native_of(run).filter(|_| !has_ends) else {
        return shown_between(run, arguments, signals);
    };
    check_of_folding(arguments)?;
    let begun = Instant::now();
    let folding = match known {
        Some(folding) => folding,
        None => OwnFormation::of(run, native, signals, arguments.max_time)?,
    };
    let left = |whole: f64| (whole - begun.elapsed().as_secs_f64()).max(0.0);
    shown_of_folding(run, folding, arguments, signals, arguments.max_time.map(left))
}

/// Refuses what only a search for paths between two ends can be told.
///
/// # Errors
/// Exit code 2: names the first of such options that is given.
fn check_of_folding(arguments: &ReportArguments) -> Result<(), Failure> {
    let SearchArguments { by, tries, shorten_tries, .. } = &arguments.search;
    let given = [
        ("--dissimilar", arguments.dissimilar.is_some()),
        ("--by", by.is_some()),
        ("--tries", tries.is_some()),
        ("--shorten-tries", shorten_tries.is_some()),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        None => Ok(()),
        Some((option, _)) => Err(Failure::usage(format!(
            "{option}: of no use to a run about folding, whose page has the cheapest pathway of each order of formation; --start and \
             --goal beside it expected, or a run of a problem with a query"
        ))),
    }
}

fn shown_between(
    run: &Recorded,
    arguments: &ReportArguments,
    signals: &Signals,
) -> Result<Shown, Failure> {
    let asked = Asked::of(run, &arguments.search)?;
    let distance = arguments.dissimilar.unwrap_or_else(|| asked.usual_distance());
    let found = bounded(
        || signals.came(),
        arguments.max_time,
        |cancel| asked.find(Some(Some(distance)), cancel),
    )??;
    let by = match asked.rank {
        Rank::Barrier => "the highest energy on them, then by cost",
        Rank::Cost => "what they cost",
    };
    let (count, found_count) = (arguments.search.count, found.pathways.len());
    let mut in_words = format!(
        "Up to {count} paths from the start to the goal were asked for, each two at least {distance} {} apart by the discrete \
         Fréchet distance, ranked by {by}. {found_count} {} found.",
        asked.length,
        if found_count == 1 { "is" } else { "are" },
    );
    if found.is_cut {
        in_words += " The time for the search was up before its end: with more, others may be found, or better ones.";
    }
    Ok(Shown { ends: asked.ends, pathways: found, asked: in_words, folding: None })
}

fn shown_of_folding(
    run: &Recorded,
    folding: OwnFormation,
    arguments: &ReportArguments,
    signals: &Signals,
    max_time: Option<f64>,
) -> Result<Shown, Failure> {
    let OwnFormation { native, formation, .. } = &folding;
    let (cx, attachment) = (run.context(), run.problem().attachment());
    let spacing = arguments.search.spacing.unwrap_or(SPACING);
    let count = arguments.search.count as usize;
    let asked = (count, spacing);
    let pathways = match formation {
        None => Pathways { is_cut: true, ..Pathways::default() },
        Some(formation) => {
            let of = (native, formation);
            let look = |cancel: &Cancel| {
                let scratch = &mut Scratch::new();
                examples(cx, run.roadmap(), of, &attachment, asked, cancel, scratch)
            };
            let found = bounded(|| signals.came(), max_time, look)?;
            found.map_err(|error| Failure::usage(format!("--spacing: {error}")))?
        }
    };
    let mut in_words = format!(
        "One pathway for each of the {count} most frequent orders of the helices and strands, the one that costs least: from an \
         unstructured conformation, which is another for each, to the native one. {} found. Below, the start, or A, is where the first of them \
         begins in the map and in what is said of the ends, and where each of them begins in what is shown along it.",
        pathways.pathways.len()
    );
    if pathways.is_cut {
        in_words += " The time was up before all of them were looked at.";
    }
    let first = pathways.pathways.first().and_then(|first| first.path.configs.iter().next());
    let ends = Ends::new(first.unwrap_or(&native.q).to_vec(), native.q.clone());
    Ok(Shown { ends, pathways, asked: in_words, folding: Some(folding) })
}
