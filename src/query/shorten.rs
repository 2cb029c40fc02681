use super::PATH_REFINEMENT;
use super::path::{OnPath, Path, on_path};
use crate::cancel::Cancel;
use crate::context::Context;
use crate::model::{Cost, Directed, Scratch};
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use std::collections::{BTreeMap, BTreeSet};

/// Number of window sizes. Tries take turns with windows of the whole path, a half, a quarter, and so on: where a path
/// winds, only places close to each other can be joined by a straight motion.
const SCALES: u32 = 5;

/// The most pairs of a path's configurations between which the straight motion is tried before shortcuts are drawn.
const PAIRS_MAX: usize = 10_000;
/// A place on a leg that is nearer to one of the leg's ends than this fraction of it is that end: what is interpolated
/// there may differ from the end by rounding.
const AT_END: f64 = 1e-9;

/// Shortens a path. First configurations are left out between which the straight motion is free, those farthest apart
/// along the path first: where nothing is in the way, start and goal remain. Then shortcuts are drawn (R. Geraerts,
/// M. H. Overmars, *Creating high-quality paths for motion planning*, IJRR 2007, §3.1): `tries` times two places on
/// the path are drawn by length, the first uniformly, the second uniformly within a window around it, and what lies
/// between them is replaced by the straight motion where that is shorter and free. In a model with energies *shorter*
/// means that it costs less, and the new motions may reach no higher than what they replace.
///
/// The new motions pass the check at a [`PATH_REFINEMENT`]th of the resolution, as do the two halves
/// of legs that are cut. The result has the same ends, has no configuration twice in a row, is never longer (but for
/// rounding), and is the same for the same arguments; the draws come from the problem's base seed.
pub fn shorten(cx: &Context, path: &Path, tries: u32, scratch: &mut Scratch) -> Path {
    shorten_within(cx, path, tries, 1.0, &Cancel::new(), scratch)
}

/// [`shorten`] by shortcuts alone that replace at most `reach` of the path's length each, a fraction: the path stays
/// about where it is. Ends when `cancel` says so, with the path as short as it is by then; its checks are all done.
pub fn shorten_within(
    cx: &Context,
    path: &Path,
    tries: u32,
    reach: f64,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Path {
    let mut stream = Seed::of_evaluator(cx.base_seed, "shorten").stream(Purpose::Connecting);
    let mut short = without_needless(cx, path, reach, cancel, scratch);
    for index in 0..tries {
        // One straight motion is as short as can be.
        if short.configs.len() < 3 || cancel.is_cancelled() {
            break;
        }
        let window = reach / f64::from(1u32 << (index % SCALES));
        let (one, drawn) = (stream.unit(), stream.unit());
        let other = (one + (2.0 * drawn - 1.0) * window).clamp(0.0, 1.0);
        if let Some(shorter) = shortcut(cx, &short, one.min(other), one.max(other), scratch) {
            short = shorter;
        }
    }
    short
}

/// The path without configurations that stand twice in a row, and without those between which the straight motion
/// does as well. Pairs of configurations are tried in the order of how many legs lie between them, most first, and
/// from the start on; at most [`PAIRS_MAX`] of them, and none once `cancel` says so.
fn without_needless(
    cx: &Context,
    path: &Path,
    reach: f64,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Path {
    let mut all = Configs::new(cx.space.len());
    path.configs.iter().for_each(|q| all.push_if_new(q));
    let mut kept: Vec<usize> = (0..all.len()).collect();
    let lengths = Path { configs: all.clone(), length: 0.0 }.lengths(&cx.space);
    let most = reach * lengths[lengths.len() - 1];
    let is_within =
        |first: usize, last: usize| reach >= 1.0 || lengths[last] - lengths[first] <= most;
    let mut tried = BTreeSet::new();
    let mut known = BTreeMap::new();
    let mut legs = kept.len().saturating_sub(1);
    while legs > 1 && !cancel.is_cancelled() {
        let mut first = 0;
        while first + legs < kept.len() && tried.len() < PAIRS_MAX && !cancel.is_cancelled() {
            let between = &kept[first..=first + legs];
            let is_new =
                is_within(between[0], between[legs]) && tried.insert((between[0], between[legs]));
            if is_new && is_needless(cx, &all, between, &mut known, scratch) {
                kept.drain(first + 1..first + legs);
            }
            first += 1;
        }
        // Pairs with more legs between them than these have had their turn.
        legs = (legs - 1).min(kept.len() - 1);
    }
    if kept.len() == path.configs.len() {
        return path.clone();
    }
    let mut configs = Configs::new(cx.space.len());
    // A path that comes back to its start is a point.
    kept.iter().for_each(|index| configs.push_if_new(all.get(*index)));
    with_length(cx, configs, scratch).unwrap_or_else(|| path.clone())
}

/// Whether the straight motion from the first to the last of these configurations of a path does as well as the legs
/// between them: it is free, and in a model with energies it costs no more and reaches no higher. That it is no longer
/// follows from the metric. `known` keeps what legs cost, by the indices of their ends.
fn is_needless(
    cx: &Context,
    all: &Configs,
    between: &[usize],
    known: &mut BTreeMap<(usize, usize), Directed>,
    scratch: &mut Scratch,
) -> bool {
    let (first, last) = (between[0], between[between.len() - 1]);
    let ends = [all.get(first), all.get(last)];
    if cx.model.energy(ends[0], scratch).is_none() {
        return cx.model.motion(ends[0], ends[1], PATH_REFINEMENT, scratch).is_some();
    }
    let at_rest = Directed { forward: 0.0, backward: 0.0, peak: f64::NEG_INFINITY };
    let mut leg = |from: usize, to: usize| {
        if let Some(leg) = known.get(&(from, to)) {
            return Some(*leg);
        }
        let leg = match (all.get(from), all.get(to)) {
            (a, b) if a == b => at_rest,
            (a, b) => match cx.model.motion(a, b, PATH_REFINEMENT, scratch)? {
                Cost::Directed(leg) => leg,
                Cost::Metric => return None,
            },
        };
        known.insert((from, to), leg);
        Some(leg)
    };
    let mut before = at_rest;
    for (from, to) in between.iter().zip(&between[1..]) {
        let Some(leg) = leg(*from, *to) else { return false };
        before = before.then(leg);
    }
    let does_as_well =
        |after: Directed| after.forward <= before.forward && after.peak <= before.peak;
    is_promising(cx, ends, does_as_well, scratch)
        && motion(cx, ends, PATH_REFINEMENT, scratch).is_some_and(does_as_well)
}

/// Whether a motion, looked at as coarsely as edges are, is free and does as is asked. What does not then hardly ever does when
/// it is looked at [`PATH_REFINEMENT`] times finer, which takes as many times longer.
fn is_promising(
    cx: &Context,
    ends: [&[f64]; 2],
    does: impl Fn(Directed) -> bool,
    scratch: &mut Scratch,
) -> bool {
    motion(cx, ends, 1, scratch).is_some_and(does)
}

/// What a motion costs in a model with energies; `None` if it is not valid.
fn motion(
    cx: &Context,
    [a, b]: [&[f64]; 2],
    refinement: u32,
    scratch: &mut Scratch,
) -> Option<Directed> {
    match cx.model.motion(a, b, refinement, scratch)? {
        Cost::Directed(directed) => Some(directed),
        Cost::Metric => None,
    }
}

/// The path along these configurations; `None` if in a model with energies a motion between them is not valid.
fn with_length(cx: &Context, configs: Configs, scratch: &mut Scratch) -> Option<Path> {
    let mut path = Path { configs, length: 0.0 };
    path.length = match cx.model.energy(path.configs.get(0), scratch) {
        Some(_) => climb(cx, path.configs.iter(), PATH_REFINEMENT, scratch)?.0,
        None => path.lengths(&cx.space).last().copied().unwrap_or(0.0),
    };
    Some(path)
}

/// The path with a straight motion between two places, which are given as fractions of its length in ascending order;
/// `None` if that motion is not free or does not make the path shorter.
fn shortcut(cx: &Context, path: &Path, from: f64, to: f64, scratch: &mut Scratch) -> Option<Path> {
    let lengths = path.lengths(&cx.space);
    let whole = lengths[lengths.len() - 1];
    let (first, last) = (on_path(&lengths, from * whole), on_path(&lengths, to * whole));
    // Between two places of one leg the path is straight already.
    if first.leg == last.leg {
        return None;
    }
    let place = |OnPath { leg, t }| {
        let [before, after] = [leg, leg + 1].map(|index| path.configs.get(index));
        if t <= AT_END || t >= 1.0 - AT_END {
            return Some(if t <= AT_END { before } else { after }.to_vec());
        }
        let mut q = vec![0.0; cx.space.len()];
        cx.space.interpolate(before, after, t, &mut q);
        cx.space.canonicalize(&mut q).ok().map(|()| q)
    };
    let (a, b) = (place(first)?, place(last)?);

    let mut configs = Configs::new(cx.space.len());
    (0..=first.leg).for_each(|i| configs.push_if_new(path.configs.get(i)));
    configs.push_if_new(&a);
    configs.push_if_new(&b);
    (last.leg + 1..path.configs.len()).for_each(|i| configs.push_if_new(path.configs.get(i)));
    let ends = (path.configs.get(first.leg), path.configs.get(last.leg + 1));
    if cx.model.energy(&a, scratch).is_some() {
        let valid = cx.model.is_valid(&a, scratch) && cx.model.is_valid(&b, scratch);
        // As coarsely as edges are looked at, first: see `is_promising`.
        let compared = |refinement: u32, scratch: &mut Scratch| {
            let replaced = (first.leg..=last.leg + 1).map(|i| path.configs.get(i));
            let before = climb(cx, replaced, refinement, scratch)?;
            Some((before, climb(cx, [ends.0, &a, &b, ends.1].into_iter(), refinement, scratch)?))
        };
        let ((before, _), (after, _)) = compared(1, scratch)?;
        if after >= before {
            return None;
        }
        let ((before, highest), (after, reached)) = compared(PATH_REFINEMENT, scratch)?;
        if !(valid && after < before && reached <= highest) {
            return None;
        }
        return with_length(cx, configs, scratch);
    }
    let shorter = with_length(cx, configs, scratch)?;
    if shorter.length.partial_cmp(&path.length) != Some(std::cmp::Ordering::Less) {
        return None;
    }

    let mut free =
        |q: &[f64], p: &[f64]| q == p || cx.model.motion(q, p, PATH_REFINEMENT, scratch).is_some();
    let motions = free(&a, &b) && free(ends.0, &a) && free(&b, ends.1);
    (motions && cx.model.is_valid(&a, scratch) && cx.model.is_valid(&b, scratch)).then_some(shorter)
}

/// What the motions along these configurations cost and how high they reach, in a model with energies, looked at so many
/// times finer than the problem asks for; `None` if one of them is not valid.
fn climb<'a>(
    cx: &Context,
    mut along: impl Iterator<Item = &'a [f64]>,
    refinement: u32,
    scratch: &mut Scratch,
) -> Option<(f64, f64)> {
    let (mut cost, mut highest) = (0.0, f64::NEG_INFINITY);
    let mut before = along.next()?;
    for next in along {
        if next != before {
            let Cost::Directed(own) = cx.model.motion(before, next, refinement, scratch)? else {
                return None;
            };
            (cost, highest) = (cost + own.forward, own.peak.max(highest));
        }
        before = next;
    }
    Some((cost, highest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::img::{Setup, build};
    use crate::problem::Problem;
    use std::sync::Arc;

    /// A setup and the path that its build found.
    fn solved(name: &str, text: &str) -> (Arc<Setup>, Path) {
        let problem = Problem::parse(std::path::Path::new(name), text).expect("it is sound");
        let setup = Arc::new(Setup::new(problem));
        let judgement = build(&setup).judgement.expect("a round was judged");
        let answer = judgement.verdicts[0].answer.as_ref().expect("it has a query");
        let path = answer.path.clone().expect("it has a way");
        (setup, path)
    }

    #[test]
    fn shortened_paths_are_valid_shorter_and_the_same_again() {
        for (name, text) in [
            ("maze.toml", include_str!("../../problems/maze.toml")),
            ("walls.toml", include_str!("../../problems/walls.toml")),
        ] {
            let (setup, path) = solved(name, text);
            let (cx, mut scratch) = (&setup.cx, Scratch::new());
            let short = shorten(cx, &path, 200, &mut scratch);
            assert!(
                short.length < 0.95 * path.length,
                "{name}: {} → {}",
                path.length,
                short.length
            );
            assert_eq!(short, shorten(cx, &path, 200, &mut Scratch::new()));
            assert_eq!(short.length, short.lengths(&cx.space)[short.configs.len() - 1]);
            let last = short.configs.len() - 1;
            assert_eq!(short.configs.get(0), path.configs.get(0));
            assert_eq!(short.configs.get(last), path.configs.get(path.configs.len() - 1));
            for i in 0..=last {
                let q = short.configs.get(i);
                let mut stored = q.to_vec();
                assert_eq!(cx.accept(&mut stored), Ok(()));
                if i > 0 {
                    let before = short.configs.get(i - 1);
                    assert!(cx.model.motion(before, q, PATH_REFINEMENT, &mut scratch).is_some());
                }
            }
            let mut length = path.length;
            for tries in [0, 1, 2, 5, 20, 100] {
                let shorter = shorten(cx, &path, tries, &mut scratch);
                assert!(shorter.length <= length);
                length = shorter.length;
            }
            // Without shortcuts only configurations of the path are left out.
            let few = shorten(cx, &path, 0, &mut scratch);
            assert!(few.configs.iter().all(|q| path.configs.iter().any(|known| known == q)));
            assert!(few.configs.len() < path.configs.len(), "{name}");
        }
    }

    #[test]
    fn a_path_is_as_short_as_it_is_once_shortening_is_cancelled() {
        let (setup, path) = solved("maze.toml", include_str!("../../problems/maze.toml"));
        let (cx, scratch, cancel) = (&setup.cx, &mut Scratch::new(), Cancel::new());
        let short = shorten_within(cx, &path, 50, 1.0, &cancel, scratch);
        assert!(short.length < path.length);
        cancel.cancel();
        assert_eq!(shorten_within(cx, &path, u32::MAX, 1.0, &cancel, scratch), path);
    }

    /// A robot that can turn, in a room with nothing in it.
    fn open_room() -> Setup {
        let text = "[space]\nmotion = \"rigid-2d\"\nmin = [0, 0]\nmax = [10, 10]\nbounds = \"body\"\n\
            [robot]\nbodies = [{ shape = { box = { size = [1, 0.4, 0.4] } } }]\n";
        let problem = Problem::parse(std::path::Path::new("room.toml"), text);
        Setup::new(problem.expect("it is sound"))
    }

    fn path_of(cx: &Context, configs: &[[f64; 3]]) -> Path {
        let mut path = Path { configs: Configs::new(3), length: 0.0 };
        configs.iter().for_each(|q| path.configs.push(q));
        path.length = path.lengths(&cx.space)[configs.len() - 1];
        path
    }

    #[test]
    fn in_free_space_start_and_goal_remain() {
        let setup = open_room();
        let (cx, scratch) = (&setup.cx, &mut Scratch::new());
        let (start, goal) = ([1.0, 1.0, 3.0], [9.0, 9.0, -3.0]);
        let ways: [&[[f64; 3]]; 4] = [
            &[start, [2.0, 8.0, 0.5], [7.0, 3.0, -2.0], [9.0, 9.0, -3.000_000_000_000_000_4], goal],
            // Needless ones that lie on the way, and twice the same.
            &[start, [5.0, 5.0, std::f64::consts::PI - 1e-9], goal],
            &[start, start, [5.0, 8.0, 1.0], [5.0, 8.0, 1.0], goal, goal],
            &[start, goal],
        ];
        for way in ways {
            for tries in [0, 1, 200] {
                let short = shorten(cx, &path_of(cx, way), tries, scratch);
                assert_eq!(short, path_of(cx, &[start, goal]), "{way:?}");
            }
        }
        // A way back to where it began is no way at all.
        let there_and_back = path_of(cx, &[start, [5.0, 8.0, 1.0], start]);
        assert_eq!(shorten(cx, &there_and_back, 5, scratch), path_of(cx, &[start]));
    }

    #[test]
    fn no_configuration_follows_itself_however_many_shortcuts_are_drawn() {
        let (setup, path) = solved("maze.toml", include_str!("../../problems/maze.toml"));
        for tries in [10, 100, 2000] {
            let short = shorten(&setup.cx, &path, tries, &mut Scratch::new());
            for i in 1..short.configs.len() {
                let [before, q] = [i - 1, i].map(|i| short.configs.get(i));
                assert!(setup.cx.space.distance(before, q) > 1e-12, "{tries} tries: {short:?}");
            }
        }
    }

    #[test]
    fn in_a_landscape_shorter_means_less_climbing_and_no_higher_pass() {
        let text = "[landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2]\nenergy = { muller-brown = {} }\n\
            highest = 100\ntolerance = 0.1\n[query]\nstart = [-0.558, 1.442]\ngoal = [0.623, 0.028]\n\
            [[strategies]]\nlabel = \"u\"\nnodes = 100\nsampler = { uniform = {} }\n";
        let (setup, path) = solved("landscape.toml", text);
        let (cx, scratch) = (&setup.cx, &mut Scratch::new());
        let short = shorten(cx, &path, 300, scratch);
        let along = |path: &Path| {
            climb(cx, path.configs.iter(), PATH_REFINEMENT, &mut Scratch::new()).unwrap()
        };
        let ((cost, highest), (short_cost, short_highest)) = (along(&path), along(&short));
        assert!(short_cost < cost && short_highest <= highest, "{cost} → {short_cost}");
        assert!(short.length == short_cost && short.length < path.length);
        assert_eq!(short, shorten(cx, &path, 300, scratch));
    }

    #[test]
    fn paths_that_are_straight_or_a_point_stay_as_they_are() {
        let (setup, path) = solved("maze.toml", include_str!("../../problems/maze.toml"));
        for ends in [&[0, 1][..], &[0]] {
            let mut configs = Configs::new(3);
            ends.iter().for_each(|i| configs.push(path.configs.get(*i)));
            let mut straight = Path { configs, length: 0.0 };
            straight.length = straight.lengths(&setup.cx.space)[ends.len() - 1];
            assert_eq!(shorten(&setup.cx, &straight, 50, &mut Scratch::new()), straight);
            assert_eq!(straight.sampled(&setup.cx.space, 9).len(), 9);
        }
    }
}
