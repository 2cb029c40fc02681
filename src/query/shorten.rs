use super::PATH_REFINEMENT;
use super::path::{OnPath, Path, on_path};
use crate::context::Context;
use crate::model::{Cost, Scratch};
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};

/// Number of window sizes. Tries take turns with windows of the whole path, a half, a quarter, and so on: where a path
/// winds, only places close to each other can be joined by a straight motion.
const SCALES: u32 = 5;

/// Shortens a path by shortcuts (R. Geraerts, M. H. Overmars, *Creating high-quality paths for motion
/// planning*, IJRR 2007, §3.1): `tries` times two places on the path are drawn by length, the first
/// uniformly, the second uniformly within a window around it, and what lies between them is replaced
/// by the straight motion where that is shorter and free. In a model with energies *shorter* means that it costs
/// less, and the new motions may reach no higher than what they replace.
///
/// The new motions pass the check at a [`PATH_REFINEMENT`]th of the resolution, as do the two halves
/// of legs that are cut. The result has the same ends, is never longer, and is the same for the same
/// arguments; the draws come from the problem's base seed.
pub fn shorten(cx: &Context, path: &Path, tries: u32, scratch: &mut Scratch) -> Path {
    let mut stream = Seed::of_evaluator(cx.base_seed, "shorten").stream(Purpose::Connecting);
    let mut short = path.clone();
    for index in 0..tries {
        let window = 1.0 / f64::from(1u32 << (index % SCALES));
        let (one, drawn) = (stream.unit(), stream.unit());
        if short.configs.len() < 2 {
            break;
        }
        let other = (one + (2.0 * drawn - 1.0) * window).clamp(0.0, 1.0);
        if let Some(shorter) = shortcut(cx, &short, one.min(other), one.max(other), scratch) {
            short = shorter;
        }
    }
    short
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
        let mut q = vec![0.0; cx.space.len()];
        cx.space.interpolate(path.configs.get(leg), path.configs.get(leg + 1), t, &mut q);
        cx.space.canonicalize(&mut q).ok().map(|()| q)
    };
    let (a, b) = (place(first)?, place(last)?);

    let mut configs = Configs::new(cx.space.len());
    let mut push = |q: &[f64]| {
        let again = !configs.is_empty() && configs.get(configs.len() - 1) == q;
        if !again {
            configs.push(q);
        }
    };
    (0..=first.leg).for_each(|i| push(path.configs.get(i)));
    push(&a);
    push(&b);
    (last.leg + 1..path.configs.len()).for_each(|i| push(path.configs.get(i)));
    let mut shorter = Path { configs, length: 0.0 };
    let ends = (path.configs.get(first.leg), path.configs.get(last.leg + 1));
    if cx.model.energy(&a, scratch).is_some() {
        let valid = cx.model.is_valid(&a, scratch) && cx.model.is_valid(&b, scratch);
        let replaced = (first.leg..=last.leg + 1).map(|i| path.configs.get(i));
        let (before, highest) = climb(cx, replaced, scratch)?;
        let (after, reached) = climb(cx, [ends.0, &a, &b, ends.1].into_iter(), scratch)?;
        if !(valid && after < before && reached <= highest) {
            return None;
        }
        shorter.length = climb(cx, shorter.configs.iter(), scratch)?.0;
        return Some(shorter);
    }
    shorter.length = shorter.lengths(&cx.space).last().copied().unwrap_or(0.0);
    if shorter.length.partial_cmp(&path.length) != Some(std::cmp::Ordering::Less) {
        return None;
    }

    let mut free = |q: &[f64], p: &[f64]| cx.model.motion(q, p, PATH_REFINEMENT, scratch).is_some();
    let motions = free(&a, &b) && free(ends.0, &a) && free(&b, ends.1);
    (motions && cx.model.is_valid(&a, scratch) && cx.model.is_valid(&b, scratch)).then_some(shorter)
}

/// What the motions along these configurations cost and how high they reach, in a model with energies, looked at
/// [`PATH_REFINEMENT`] times finer than the problem asks for; `None` if one of them is not valid.
fn climb<'a>(
    cx: &Context,
    mut along: impl Iterator<Item = &'a [f64]>,
    scratch: &mut Scratch,
) -> Option<(f64, f64)> {
    let (mut cost, mut highest) = (0.0, f64::NEG_INFINITY);
    let mut before = along.next()?;
    for next in along {
        if next != before {
            let Cost::Directed(own) = cx.model.motion(before, next, PATH_REFINEMENT, scratch)?
            else {
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
            assert_eq!(shorten(cx, &path, 0, &mut scratch), path);
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
        let along = |path: &Path| climb(cx, path.configs.iter(), &mut Scratch::new()).unwrap();
        let ((cost, highest), (short_cost, short_highest)) = (along(&path), along(&short));
        assert!(short_cost < cost && short_highest <= highest, "{cost} → {short_cost}");
        assert!(short.length == short_cost && short.length < path.length);
        assert_eq!(short, shorten(cx, &path, 300, scratch));
    }

    #[test]
    fn paths_that_are_straight_or_a_point_stay_as_they_are() {
        let (setup, path) = solved("maze.toml", include_str!("../../problems/maze.toml"));
        for ends in [[0, 1], [0, 0]] {
            let mut configs = Configs::new(3);
            ends.iter().for_each(|i| configs.push(path.configs.get(*i)));
            let mut straight = Path { configs, length: 0.0 };
            straight.length = straight.lengths(&setup.cx.space)[1];
            assert_eq!(shorten(&setup.cx, &straight, 50, &mut Scratch::new()), straight);
            assert_eq!(straight.sampled(&setup.cx.space, 9).len(), 9);
        }
    }
}
