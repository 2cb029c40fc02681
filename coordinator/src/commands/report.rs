use super::bounded::bounded;
use super::place::check_place;
use super::search::Asked;
use crate::cli::ReportArguments;
use crate::exit::{Code, Failure};
use crate::files::write_whole;
use crate::output::note;
use crate::signals::Signals;
use crate::work::{Recorded, Run};
use roadmill::export::{Report, report as page};
use roadmill::model::Scratch;
use roadmill::pathways::Rank;

/// Writes a page about a run, with several dissimilar paths through its roadmap; also where there is no path yet.
///
/// A signal ends it without a page. A limit of time ends the search for paths; the page then says so.
pub fn report(arguments: &ReportArguments) -> Result<Code, Failure> {
    check_place("--out", &arguments.out)?;
    let run = Run::at(&arguments.run).read()?;
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
    let interrupted = || {
        if !signals.came() {
            return Ok(());
        }
        let (run, out) = (arguments.run.display(), arguments.out.display());
        let way = format!("`roadmill report {run} --out {out}` writes it");
        Err(Failure::new(Code::Interrupted, format!("a signal came; there is no page: {way}")))
    };
    let asked = Asked::of(run, &arguments.search)?;
    let distance = arguments.dissimilar.unwrap_or_else(|| asked.usual_distance());
    let found =
        bounded(signals, arguments.max_time, |cancel| asked.find(Some(Some(distance)), cancel))??;
    interrupted()?;
    let end = match run.stopped() {
        None => "it has not ended, or was killed; these are its complete rounds",
        Some(stopped) => &stopped.reason,
    };
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
    let page = page(
        &Report {
            problem: run.problem(),
            cx: run.context(),
            roadmap: run.roadmap(),
            ends: &asked.ends,
            pathways: &found,
            asked: &in_words,
            angles: &arguments.search.angles,
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
    if found.is_cut {
        note(format_args!(
            "{}: the time was up before the search for paths was over",
            arguments.out.display()
        ));
    }
    Ok(Code::Done)
}
