use super::gaps::Gap;
use crate::generator::growth::{GrowingSet, GrowingTree};
use crate::generator::rrt_connect::reach_for;
use crate::seed::{Purpose, Seed};

/// The part of a set's seed from which the directions of growth are drawn.
const BRIDGES: u64 = 3;
/// After so many extensions in vain they lead to within twice the distance of a hint.
const EXTENSIONS: u64 = 50;
/// How often that happens before a gap is given up.
const WIDER_MAX: u32 = 6;

/// Grows the components on the two sides of every gap toward each other along the path, as [`RrtConnect`](crate::generator::RrtConnect) does: a tree is extended toward a
/// configuration within `spread` of a random hint of the gap, and then the other tree toward what was reached. The
/// gaps are taken in turn, another one first in every set, until the set is full. A gap of which no side is a node of the roadmap is passed over.
pub(in crate::generator) fn bridge(
    set: &mut GrowingSet,
    hints: &[Vec<f64>],
    gaps: &[Gap],
    (spread, first): (f64, usize),
    seed: &Seed,
) {
    for turn in 0..gaps.len() {
        let index = (turn + first) % gaps.len();
        if let [Some(from), Some(to)] = gaps[index].nodes
            && !set.is_full()
        {
            let trees = [GrowingTree::of_node(set, from), GrowingTree::of_node(set, to)];
            let stretch: Vec<Vec<f64>> = gaps[index].of(hints).collect();
            grow(set, trees, &stretch, spread, &seed.part(index as u64));
        }
    }
}

fn grow<'a>(
    set: &mut GrowingSet<'a>,
    [mut one, mut other]: [GrowingTree<'a>; 2],
    hints: &[Vec<f64>],
    spread: f64,
    seed: &Seed,
) {
    let mut stream = seed.part(BRIDGES).stream(Purpose::Sampling);
    let (mut spread, mut vain, mut wider) = (spread, 0, 0);
    let mut toward = vec![0.0; set.cx.space.len()];
    while !set.is_full() && wider <= WIDER_MAX && set.attempt().is_ok() {
        let hint = &hints[stream.below(hints.len() as u64) as usize];
        let direction = set.cx.space.direction(&mut stream);
        set.cx.space.along(hint, &direction, spread * stream.unit(), &mut toward);
        let near = one.nearest(set, &toward);
        match near.and_then(|near| one.extend(set, near, &toward).milestone()) {
            Some(new) => {
                if reach_for(set, &mut other, new) {
                    return;
                }
            }
            None => vain += 1,
        }
        if vain == EXTENSIONS {
            (spread, vain, wider) = (2.0 * spread, 0, wider + 1);
        }
        std::mem::swap(&mut one, &mut other);
    }
}
