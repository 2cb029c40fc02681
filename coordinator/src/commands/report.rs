use super::search::Asked;
use crate::cli::ReportArguments;
use crate::exit::{Code, Failure};
use crate::files::write_whole;
use crate::output::note;
use crate::work::Run;
use roadmill::export::{Report, report as page};
use roadmill::model::Scratch;
use roadmill::pathways::Rank;

/// Writes a page about a run, with several dissimilar paths through its roadmap; also where there is no path yet.
pub fn report(arguments: &ReportArguments) -> Result<Code, Failure> {
    let run = Run::at(&arguments.run).read()?;
    let asked = Asked::of(&run, &arguments.search)?;
    let distance = arguments.dissimilar.unwrap_or_else(|| asked.usual_distance());
    let found = asked.find(Some(Some(distance)));
    let end = match run.stopped() {
        None => "it has not ended, or was killed; these are its complete rounds",
        Some(stopped) => &stopped.reason,
    };
    let by = match asked.rank {
        Rank::Barrier => "the highest energy on them, then by cost",
        Rank::Cost => "what they cost",
    };
    let (count, found_count) = (arguments.search.count, found.pathways.len());
    let in_words = format!(
        "Up to {count} paths from the start to the goal were asked for, each two at least {distance} {} apart by the discrete \
         Fréchet distance, ranked by {by}. {found_count} {} found.",
        asked.length,
        if found_count == 1 { "is" } else { "are" },
    );
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
    write_whole(&arguments.out, &page)?;
    note(format_args!(
        "{}: {found_count} of {count} paths, {:.1} MB",
        arguments.out.display(),
        page.len() as f64 / 1e6
    ));
    Ok(Code::Done)
}
