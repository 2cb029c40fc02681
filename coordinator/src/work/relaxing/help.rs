//! Paths of a level that is solved, which help with the next one.

use crate::exit::Failure;
use crate::work::interrupt::Interrupt;
use crate::work::{Recorded, bounded};
use roadmill::Cancel;
use roadmill::model::Scratch;
use roadmill::pathways::topology::Topology;
use roadmill::pathways::{Dissimilar, Distinct, Pathways, Rank, dissimilar_unshortened, distinct};
use roadmill::relaxation::Guide;

/// How many candidates are looked at for several paths.
const TRIES: usize = 40;
/// How often a shortcut is tried on each.
const SHORTCUTS: u32 = 50;
/// How far apart paths are at least, and frames at most, as shares of the largest distance in the space.
const DISTANCE_SHARE: f64 = 1.0 / 50.0;
const SPACING_SHARE: f64 = 1.0 / 100.0;

/// A path, configuration by configuration.
type Configurations = Vec<Vec<f64>>;

/// A search through the roadmap of a run for at most so many paths, which a switch ends.
type Search = fn(&Recorded, usize, &Cancel) -> Result<Pathways, Failure>;

/// The paths that a guide asks for of a run that is solved, each from the start to a goal: the path that the run ended with first. They
/// follow from the run's roadmap, so that a search which was ended before it was done, by what `interrupt` stands for or as so many seconds are over,
/// gives none: `None`.
///
/// # Errors
/// Exit code 2: a path has too many frames; 1: the system refuses a thread.
pub(super) fn paths(
    run: &Recorded,
    guide: Guide,
    count: usize,
    (interrupt, seconds): (&Interrupt, Option<f64>),
) -> Result<Option<Vec<Configurations>>, Failure> {
    let own = run.path().map(|path| path.configs.iter().map(<[f64]>::to_vec).collect());
    let mut paths: Vec<Configurations> = own.into_iter().collect();
    let search: Search = match guide {
        Guide::Nothing | Guide::Path(_) => return Ok(Some(paths)),
        Guide::Dissimilar(_) => dissimilar_paths,
        Guide::Distinct(_) => distinct_paths,
    };
    let searched = bounded(
        || interrupt.came(),
        seconds,
        // Looked at last: as long as the switch is not put, nothing of the search is missing.
        |cancel| (search(run, count, cancel), cancel.is_cancelled()),
    );
    let (found, is_cut) = searched?;
    if is_cut {
        return Ok(None);
    }
    for pathway in found?.pathways {
        let path: Configurations = pathway.path.configs.iter().map(<[f64]>::to_vec).collect();
        if paths.len() < count && !paths.contains(&path) {
            paths.push(path);
        }
    }
    Ok(Some(paths))
}

fn dissimilar_paths(run: &Recorded, count: usize, cancel: &Cancel) -> Result<Pathways, Failure> {
    let (cx, attachment) = (run.context(), run.problem().attachment());
    let Some(ends) = run.problem().query() else { return Ok(Pathways::default()) };
    let diameter = cx.space().diameter();
    let asked = Dissimilar {
        count,
        rank: Rank::Cost,
        distance: DISTANCE_SHARE * diameter,
        spacing: SPACING_SHARE * diameter,
        tries: TRIES,
        shortcuts: 0,
    };
    let (roadmap, scratch) = (run.roadmap(), &mut Scratch::new());
    dissimilar_unshortened(cx, roadmap, ends, &attachment, &asked, cancel, scratch)
        .map_err(|error| Failure::usage(format!("dissimilar paths: {error}")))
}

/// None of a model that knows of no obstacles.
fn distinct_paths(run: &Recorded, count: usize, cancel: &Cancel) -> Result<Pathways, Failure> {
    let (cx, attachment, scratch) =
        (run.context(), run.problem().attachment(), &mut Scratch::new());
    let Some(ends) = run.problem().query() else { return Ok(Pathways::default()) };
    let description = run.problem().model().description();
    let Some(topology) = Topology::of(cx, description, scratch) else {
        return Ok(Pathways::default());
    };
    let spacing = SPACING_SHARE * cx.space().diameter();
    let asked = Distinct { count, spacing, tries: TRIES, shortcuts: SHORTCUTS };
    let found = distinct(cx, run.roadmap(), ends, &attachment, &topology, &asked, cancel, scratch);
    let found = found.map_err(|error| Failure::usage(format!("distinct paths: {error}")))?;
    Ok(found.pathways)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::{Run, Workers};
    use roadmill::problem::Problem;

    /// A point in a room with a wall in the middle of it, which can be passed on either side.
    const ROOM: &str = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [10, 10]\nbounds = \"body\"\n\
        [robot]\nbodies = [{ shape = { sphere = { radius = 0.1 } } }]\n\
        [[obstacles]]\nshape = { box = { size = [1, 6, 1] } }\nposition = [5, 5, 0]\n\
        [query]\nstart = [1, 5]\ngoal = [9, 5]\n";

    /// What a search had found by the time at which it was ended never helps.
    #[test]
    fn searches_that_are_ended_find_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let problem = Problem::parse("room.toml".as_ref(), ROOM).unwrap();
        let growth = Run::begin(problem).folder(folder.path().join("run"));
        let run = growth.workers(&Workers::threads(1)).grow().unwrap().run().read().unwrap();
        let free = Interrupt::default();
        let ended = Interrupt::default();
        ended.cancel.cancel();
        for guide in [Guide::Dissimilar(0), Guide::Distinct(0)] {
            let all = paths(&run, guide, 3, (&free, None)).unwrap().unwrap();
            assert!(all.len() > 1, "{guide:?}: {} paths", all.len());
            assert_eq!(paths(&run, guide, 3, (&free, Some(3600.0))).unwrap(), Some(all));
            assert_eq!(paths(&run, guide, 3, (&free, Some(0.0))).unwrap(), None, "{guide:?}");
            assert_eq!(paths(&run, guide, 3, (&ended, None)).unwrap(), None, "{guide:?}");
        }
        // The path of a run is there without a search.
        let own = paths(&run, Guide::Path(0), 3, (&ended, Some(0.0))).unwrap().unwrap();
        assert_eq!(own.len(), 1);
    }
}
