use super::build::{bounded_problem, grow_in};
use super::load::load_file;
use super::search::{TRIES, usual_distance, usual_spacing};
use crate::cli::{KeptComponents, ReplanArguments};
use crate::cpu::CpuClock;
use crate::exit::{Code, Failure};
use crate::output::{note, told};
use crate::run::ledger::LEDGER;
use crate::run::{RunFolder, Scan};
use crate::signals::Signals;
use crate::work::{Recorded, Run, bounded};
use roadmill::model::{SceneChange, Scratch};
use roadmill::pathways::{Dissimilar, Pathways, Rank, dissimilar_unshortened};
use roadmill::problem::{Components, OldRun, Problem, Replanned, Replanning};
use roadmill::replan::Revalidation;
use roadmill::{Cancel, Context, Ends};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf, absolute};
use std::sync::Arc;
use std::time::Instant;

/// Where a run goes that is given no folder.
const RUNS: &str = "runs";

/// Goes on with the roadmap of a run after obstacles have come, moved or gone: says which of its paths are valid still and
/// what is left of it, and grows it on.
pub fn replan(arguments: &ReplanArguments) -> Result<Code, Failure> {
    let (cpu, begun) = (CpuClock::start(), Instant::now());
    let ReplanArguments { run, with, seed, out, force, or_resume, growth, .. } = arguments;
    let problem = load_file(with)?;
    let problem = problem.clone().with_seed(seed.unwrap_or(problem.seed()));
    // What cannot be used of the command line is said before anything is looked at.
    let (problem, workers) = bounded_problem(problem, growth)?;
    stays(run, out.as_deref())?;
    if let Some(out) = out {
        RunFolder::check(out, *force, *or_resume)?;
    }
    // A limit of time is one of this whole call: what the search for paths takes of it the growth does not have.
    let max_time = problem.limits().seconds;
    let left = || max_time.map(|whole| (whole - begun.elapsed().as_secs_f64()).max(0.0));
    let old = Run::at(run).read()?;
    match old.stopped() {
        None => note("the build has not ended; its complete rounds are gone on with"),
        Some(stopped) => note(format_args!("the build ended: {}", stopped.reason)),
    }
    let place = place_from(out.as_deref(), run)?;
    let old_run = OldRun {
        problem: old.problem(),
        roadmap: old.roadmap(),
        ledger: old.ledger(),
        place: &place.to_string_lossy(),
    };
    let refuse = |why: String| Failure::usage(format!("{}: {why}", with.display()));
    if let Some(out) = out.as_deref().filter(|_| *or_resume) {
        expect_same(out, &problem, &old_run)?;
    }
    let change = old.problem().model().description().change(problem.model()).map_err(refuse)?;
    let say = |text: String| told(text, growth.json);
    say_change(&change, say);
    // Until here a signal ends the process at once, as nothing is made yet.
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    say_paths(&old, &problem, &change, arguments.paths, (&signals, left()), say)?;
    let revalidated = Instant::now();
    let asked = Replanning {
        components: arguments.components.map(|components| match components {
            KeptComponents::Start => Components::WithStart,
            KeptComponents::All => Components::All,
        }),
        neighbors: arguments.neighbors,
    };
    // A signal ends it; a limit of time does not, since what is left of the roadmap is the one round that is made in any case.
    let look = |cancel: &Cancel| problem.replanned_until(&old_run, &asked, cancel);
    let replanned =
        bounded(|| signals.came(), None, look)?.map_err(|error| refuse(error.to_string()))?;
    let replanned = replanned.ok_or_else(interrupted)?;
    say_survivors(&old, &replanned, revalidated.elapsed().as_secs_f64(), say);
    expect_none_came(&signals)?;
    let growing = Run::begin(replanned.problem).workers(&workers).signals(&signals);
    let growing = growing.max_seconds(left());
    grow_in(growing, (out.as_deref(), *force, *or_resume), growth, cpu)
}

/// Refuses a place for the new run at which the old one is, or that holds it: to replace it would delete what `verify` needs.
fn stays(old: &Path, out: Option<&Path>) -> Result<(), Failure> {
    let place = |path: &Path| fs::canonicalize(path).ok();
    match (place(old), out.and_then(place)) {
        (Some(old), Some(new)) if old.starts_with(&new) => Err(Failure::usage(format!(
            "--out {}: the run that is gone on with is there; another folder expected, since the new run needs the old one",
            new.display()
        ))),
        _ => Ok(()),
    }
}

/// Ends the command once a signal has come. No folder is made yet.
///
/// # Errors
/// Exit code 6: one has come.
fn expect_none_came(signals: &Signals) -> Result<(), Failure> {
    match signals.came() {
        true => Err(interrupted()),
        false => Ok(()),
    }
}

fn interrupted() -> Failure {
    Failure::new(Code::Interrupted, "a signal came; no run is made")
}

/// Refuses to go on with the run in the folder `out`, if there is one, where it can be seen before anything is computed that
/// it is another: it goes on from no run or from another one, or its scene or its seed is another.
///
/// # Errors
/// Exit code 2: it is another; 4: it is damaged.
fn expect_same(out: &Path, problem: &Problem, old: &OldRun) -> Result<(), Failure> {
    if !out.join(LEDGER).is_file() {
        return Ok(());
    }
    let there = Scan::read(out)?.problem()?;
    let difference = match there.survivors() {
        None => Some("it goes on from no other run".to_owned()),
        Some(_) => there
            .scene_difference(problem)
            .or_else(|| there.check_survivors(old).err().map(|why| format!("the old run: {why}"))),
    };
    match difference {
        None => Ok(()),
        Some(why) => Err(Failure::usage(format!(
            "{}: cannot go on: {why}; another --out expected, or --force, which replaces the run",
            out.display()
        ))),
    }
}

/// The run `old` as a path from the folder of the run that is made: from where the one is to where the other is, with links
/// followed. It leads there by whatever links either is reached, and does not change when both are moved together.
///
/// # Errors
/// Exit code 2: the folder in which the program runs has no path.
fn place_from(out: Option<&Path>, old: &Path) -> Result<PathBuf, Failure> {
    // A run without a name for its folder gets one beside others; which, does not matter here.
    let out = out.map_or_else(|| Path::new(RUNS).join("it"), Path::to_owned);
    let place = |path: &Path| {
        place_of(path).map_err(|error| Failure::usage(format!("{}: {error}", path.display())))
    };
    let (from, to) = (place(&out)?, place(old)?);
    let common = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(common).map(|_| Component::ParentDir);
    Ok(up.chain(to.components().skip(common)).collect())
}

/// Where a folder is, or will be once it is made, without links on the way.
fn place_of(path: &Path) -> io::Result<PathBuf> {
    let mut place = PathBuf::new();
    for part in absolute(path)?.components() {
        match part {
            Component::ParentDir => {
                place.pop();
            }
            part => {
                place.push(part);
                // What is not there yet is no link.
                place = fs::canonicalize(&place).unwrap_or(place);
            }
        }
    }
    Ok(place)
}

fn say_change(change: &SceneChange, say: impl Fn(String)) {
    let SceneChange { added, removed, beyond_obstacles } = change;
    let moved = change.moved();
    let (came, went) = (added.len() - moved, removed.len() - moved);
    if change.is_none() {
        say("scene    what it was".to_owned());
    } else {
        let obstacles = if came == 1 { "obstacle" } else { "obstacles" };
        say(format!("scene    {came} {obstacles} came, {moved} moved, {went} went"));
    }
    if let Some(what) = beyond_obstacles {
        say(format!("scene    {what}: not what it was, so everything is checked again"));
    }
}

/// Says which of the dissimilar paths of the old roadmap are valid still. The search for them ends once a signal has come, or so many
/// seconds are over; of the latter it says so, and goes on with the paths that were found by then.
///
/// # Errors
/// Exit code 2: a path would have too many frames; 6: a signal has come.
fn say_paths(
    old: &Recorded,
    problem: &Problem,
    change: &SceneChange,
    count: u32,
    (signals, seconds): (&Signals, Option<f64>),
    say: impl Fn(String),
) -> Result<(), Failure> {
    let Some(ends) = problem.query().filter(|_| count > 0) else { return Ok(()) };
    for (end, q) in [("start", &ends.start), ("goal", &ends.goal)] {
        if let Err(why) = old.context().accept(&mut q.clone()) {
            say(format!("paths    none in the old scene: {end}: {why}"));
            return Ok(());
        }
    }
    let (begun, scratch) = (Instant::now(), &mut Scratch::new());
    let look = |cancel: &Cancel| old_paths(old, problem, ends, count, cancel, scratch);
    let found = bounded(|| signals.came(), seconds, look)??;
    let cx = problem.context();
    let mut revalidation = Revalidation::new(&cx, change);
    let mut valid = Vec::new();
    for (index, pathway) in found.pathways.iter().enumerate() {
        expect_none_came(signals)?;
        let is_valid = revalidation.keeps_path(&pathway.path, scratch);
        if is_valid {
            valid.push(index + 1);
        }
        let word = if is_valid { "valid still" } else { "blocked" };
        say(format!("path {:<3} length {:.6}, {word}", index + 1, pathway.path.length));
    }
    expect_none_came(signals)?;
    if found.is_cut {
        say("paths    the time was up before the search for them was over".to_owned());
    }
    let seconds = begun.elapsed().as_secs_f64();
    say(match (found.pathways.len(), &valid[..]) {
        (0, _) => format!("paths    none in the old roadmap ({seconds:.3} s)"),
        (count, []) => format!("paths    none of {count} is valid still ({seconds:.3} s)"),
        (count, [best, ..]) => format!(
            "paths    {} of {count} valid still, the shortest of them path {best}: nothing has to grow for a way ({seconds:.3} s)",
            valid.len()
        ),
    });
    Ok(())
}

/// The dissimilar paths of the old roadmap, as they go through it: not shortened, so that each of their edges is one of the
/// roadmap's, or attaches an end to it, and what is valid of them is among what is left.
fn old_paths(
    old: &Recorded,
    problem: &Problem,
    ends: &Ends,
    count: u32,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Result<Pathways, Failure> {
    let cx: &Context = old.context();
    let asked = Dissimilar {
        count: count as usize,
        rank: Rank::Cost,
        distance: usual_distance(cx),
        spacing: usual_spacing(cx),
        tries: TRIES.max(count) as usize,
        shortcuts: 0,
    };
    let (roadmap, attachment) = (old.roadmap(), problem.attachment());
    let found = dissimilar_unshortened(cx, roadmap, ends, &attachment, &asked, cancel, scratch);
    found.map_err(|error| Failure::usage(format!("paths: {error}")))
}

fn say_survivors(old: &Recorded, replanned: &Replanned, seconds: f64, say: impl Fn(String)) {
    let Replanned { survived, .. } = replanned;
    let (nodes, edges) = (old.roadmap().configs().len(), old.roadmap().edges().len());
    say(format!(
        "nodes    {} of {nodes} valid still, {} dropped with components without the start",
        survived.valid_nodes, survived.dropped_nodes
    ));
    say(format!(
        "edges    {} of {edges} valid still, {} new ones where obstacles went; {} nodes and edges looked at closely ({seconds:.3} s)",
        survived.valid_edges, survived.new_edges, survived.checked
    ));
}
