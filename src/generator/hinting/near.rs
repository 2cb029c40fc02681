use crate::generator::growth::GrowingSet;
use crate::neighbor::{Best, Neighbor};
use crate::sampler::GaveUp;
use crate::seed::{Purpose, Seed};

/// The part of a set's seed from which configurations near hints are drawn.
const NEAR: u64 = 2;
/// After so many draws in vain they are spread twice as far.
const DRAWS: u64 = 100;
/// With how many of the set's milestones each is tried to be joined, the nearest first, and among how many of the latest these are.
const NEIGHBORS: usize = 5;
const LATEST: usize = 500;

/// Fills a set with valid configurations near hints. They are drawn within `spread` of a hint, uniformly by direction and distance; after many draws in vain
/// within twice that, and so on, until the whole space is within it.
///
/// # Errors
/// [`GaveUp`] where too many draws since the last milestone came to nothing.
pub(in crate::generator) fn draw_near(
    set: &mut GrowingSet,
    hints: &[Vec<f64>],
    spread: f64,
    seed: &Seed,
) -> Result<(), GaveUp> {
    let mut stream = seed.part(NEAR).stream(Purpose::Sampling);
    let (cx, diameter) = (set.cx, set.cx.space.diameter());
    let (mut spread, mut tried) = (spread, 0);
    let mut q = vec![0.0; cx.space.len()];
    while !set.is_full() {
        set.attempt()?;
        match hints.get(stream.below(hints.len() as u64) as usize).filter(|_| spread < diameter) {
            Some(hint) => {
                let direction = cx.space.direction(&mut stream);
                cx.space.along(hint, &direction, spread * stream.unit(), &mut q);
            }
            None => cx.space.sample_uniform(&mut stream, &mut q),
        }
        tried += 1;
        if cx.model.is_valid(&q, set.scratch) {
            let place = set.add(&q);
            join_near(set, place);
        } else if tried % DRAWS == 0 {
            spread *= 2.0;
        }
    }
    Ok(())
}

/// Tries to join a new milestone of a set to those near it.
fn join_near(set: &mut GrowingSet, place: u32) {
    let q = set.config(place).to_vec();
    let configs = &set.made.configs;
    let own = configs.len() - 1;
    let mut best: Best<Neighbor> = Best::new(NEIGHBORS);
    for index in own.saturating_sub(LATEST)..own {
        let other = configs.get(index);
        let distance = set.cx.space.distance_unless_above(&q, other, best.bound());
        if let Some(distance) = distance {
            best.offer(Neighbor { distance, id: index as u32 });
        }
    }
    let first = place - own as u32;
    for neighbor in best.into_items() {
        set.join(first + neighbor.id, place);
    }
}
