//! The shortest push (O. B. Bayazit 2003, chapter IV D 1): the way to the nearest valid configuration, looked for in many directions for the
//! first configuration of a stretch, and in a cone about the way of the one before for every other.

use super::{Pushed, Run, Search};
use crate::space::Direction;

/// In how many directions the nearest valid configuration is looked for the first time; twice as many each time after that.
const DIRECTIONS: u32 = 48;
const MOST_DIRECTIONS: u32 = 768;
/// How many directions a cone has, beside its axis.
const CONE: u32 = 8;
/// The tangent of the cone's half angle the first time; it is wider each time after that.
const WIDTH: f64 = 0.5;
/// At which share of the way of the configuration before the search in a cone begins: one large step.
const HEAD_START: f64 = 0.8;

/// A way out of a collision.
struct Way {
    direction: Direction,
    length: f64,
    q: Vec<f64>,
}

/// Pushes every configuration of a stretch to one valid configuration; one without a way within the reach is left out, and the next is
/// looked for in all directions again.
pub(super) fn push(run: &Run, search: &mut Search) -> Vec<Pushed> {
    let mut found = Vec::new();
    let mut before: Option<Way> = None;
    for (from, q) in run.colliding.iter().enumerate() {
        let guided = before.as_ref().and_then(|before| in_cone(q, before, search));
        before = guided.or_else(|| anywhere(q, search));
        if let Some(Way { q, .. }) = &before {
            found.push(Pushed { from, q: q.clone() });
        }
    }
    found
}

/// The shortest way among many random directions, all of which are looked at a step farther at a time.
fn anywhere(q: &[f64], search: &mut Search) -> Option<Way> {
    let count = DIRECTIONS.saturating_mul(1 << search.effort.min(10)).min(MOST_DIRECTIONS);
    let space = search.cx.space();
    let directions: Vec<Direction> =
        (0..count).map(|_| space.direction(&mut search.stream)).collect();
    shortest(q, directions, 0.0, search)
}

/// The shortest way in a cone about the way of the configuration before, beginning at the length that that one had nearly needed.
fn in_cone(q: &[f64], before: &Way, search: &mut Search) -> Option<Way> {
    let width = WIDTH * f64::from(1 + search.effort.min(7));
    let space = search.cx.space();
    let mut directions = vec![before.direction.clone()];
    for _ in 0..CONE {
        let aside = space.direction(&mut search.stream);
        let share = width * search.stream.unit();
        directions.push(before.direction.bent(&aside, share));
    }
    shortest(q, directions, HEAD_START * before.length, search)
}

/// The first of the directions in which a valid configuration is found, all being looked at beyond `from` a step farther at a time; the last step
/// is halved toward the collision.
fn shortest(q: &[f64], directions: Vec<Direction>, from: f64, search: &mut Search) -> Option<Way> {
    let steps = ((search.reach - from) / search.step).floor().clamp(1.0, f64::from(search.steps()));
    for step in 1..=steps as u32 {
        let long = from + f64::from(step) * search.step;
        // The first large step may have leapt over the nearest valid configuration.
        let short = if step == 1 { 0.0 } else { long - search.step };
        for direction in &directions {
            if let Some(found) = search.at(q, direction, long) {
                let between = [short, long];
                let (length, q) = search.nearest_valid(q, direction, between, found);
                return Some(Way { direction: direction.clone(), length, q });
            }
        }
    }
    None
}
