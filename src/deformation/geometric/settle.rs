//! A region that was moved to where it is free goes back as far as it can, so that it lies against the obstacle as the paper's
//! does, whose triangles are each moved until they are outside.

use super::regions::envelope;
use super::trial::Trial;
use parry3d_f64::math::Vector;

/// How often triangles that still collide are moved on, before the whole region is.
const PASSES: u32 = 3;
/// How often the share of the way is bisected.
const BISECTIONS: u32 = 14;

/// A vertex of a region where it was moved to.
pub(super) struct Moved {
    pub vertex: u32,
    pub place: Vector,
    /// The share of the region's push that the vertex took part in, from 0 to 1.
    pub share: f64,
}

/// Where the region's vertices settle between where they are and their `targets`, at which the region is free.
///
/// Each goes back from its target in a straight line until it meets an obstacle. Then the shares of the way are raised until
/// along the surface they fall by no more than the region's slope, which keeps the surface smooth; and as far as
/// triangles still collide, which may happen between vertices that are free, they and what is around them are moved toward their targets again. All of this
/// but the choice of these triangles depends continuously on the shape and on the targets.
pub(super) fn settle(trial: &mut Trial, targets: &[Vector]) -> Vec<Moved> {
    let region = trial.region;
    let weight = |index: usize| region.vertices[index].1;
    let start = |index: usize| trial.shape[region.vertices[index].0 as usize];
    let mut shares: Vec<f64> = targets
        .iter()
        .enumerate()
        .map(|(index, target)| {
            let way = start(index) - *target;
            let length = way.dot(way).sqrt();
            match trial.obstacles.first_hit(target.to_array(), start(index).to_array()) {
                Some(hit) if length > 0.0 => {
                    weight(index) * (1.0 - hit + trial.reach / length).clamp(0.0, 1.0)
                }
                _ => 0.0,
            }
        })
        .collect();
    envelope(trial.surface, region, &mut shares);

    let starts: Vec<Vector> = (0..targets.len()).map(start).collect();
    let place = |index: usize, share: f64| {
        starts[index] + (targets[index] - starts[index]) * (share / weight(index))
    };
    let raised = |shares: &[f64], by: f64, boost: &[f64]| -> Vec<f64> {
        let raise = |index: usize| (shares[index] + by * boost[index]).min(weight(index));
        (0..shares.len()).map(raise).collect()
    };
    let places = |shares: &[f64]| -> Vec<Vector> {
        shares.iter().enumerate().map(|(index, share)| place(index, *share)).collect()
    };

    let mut boost = vec![0.0; shares.len()];
    for pass in 0..=PASSES {
        let full = raised(&shares, 1.0, &boost);
        let colliding = trial.colliding(places(&full).into_iter());
        if colliding.is_empty() && trial.is_free(places(&full).into_iter()) {
            break;
        }
        if pass == PASSES || colliding.is_empty() {
            boost = (0..shares.len()).map(weight).collect();
            break;
        }
        for corner in trial.surface.corners_of(&colliding) {
            let at = region.vertices.binary_search_by_key(&corner, |(vertex, _)| *vertex);
            if let Ok(index) = at {
                boost[index] = weight(index);
            }
        }
        envelope(trial.surface, region, &mut boost);
    }
    let (mut colliding, mut free) = (0.0, 1.0);
    if boost.iter().any(|boost| *boost > 0.0) {
        for _ in 0..BISECTIONS {
            let middle = (colliding + free) / 2.0;
            let is_free = trial.is_free(places(&raised(&shares, middle, &boost)).into_iter());
            *(if is_free { &mut free } else { &mut colliding }) = middle;
        }
    }
    shares = raised(&shares, free, &boost);
    let moved = |index: usize| Moved {
        vertex: region.vertices[index].0,
        place: place(index, shares[index]),
        share: shares[index],
    };
    (0..shares.len()).filter(|index| shares[*index] > 0.0).map(moved).collect()
}
