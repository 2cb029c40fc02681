use super::margins::{MARGIN, ROTATION_MARGIN};
use crate::space::{Configs, FactorKind, Space};
use std::f64::consts::PI;

/// A pair of configurations far from one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FarPair {
    /// Their distance by [`Space::distance`], in the scene's length unit.
    pub distance: f64,
    /// The lower id.
    pub low: u32,
    /// The higher id.
    pub high: u32,
}

/// The pair of `configs` among `ids` that is farthest apart by [`Space::distance`]; of several such pairs the one
/// with the lowest ids. `None` where there are fewer than two ids.
///
/// This is exactly what comparing all pairs gives, but most are ruled out by two bounds. No configuration is
/// farther from another than the farthest corner of the bounding box of all. Two configurations are at most as
/// far apart as the sum of their distances from `centre`, any configuration of the space.
pub fn farthest_pair(
    space: &Space,
    configs: &Configs,
    ids: &[u32],
    centre: &[f64],
) -> Option<FarPair> {
    let mut best = sweep(space, configs, ids)?;
    let margin = rotation_margin(space);
    let ruled_out = |bound: f64, best: &FarPair| bound * (1.0 + MARGIN) + margin < best.distance;

    let corners = corners(space, configs, ids);
    let mut outer: Vec<(f64, u32)> = Vec::new();
    for id in ids {
        let q = configs.get(*id as usize);
        if !ruled_out(reach(space, q, &corners), &best) {
            outer.push((space.distance(centre, q), *id));
        }
    }
    outer.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (index, (radius, id)) in outer.iter().enumerate() {
        for (other_radius, other) in &outer[..index] {
            // Those that follow are nearer to the centre.
            if ruled_out(radius + other_radius, &best) {
                break;
            }
            offer(space, configs, (*id, *other), &mut best);
        }
    }
    Some(best)
}

/// A far pair to begin with: that of the lowest id and the configuration farthest from it, then of this and
/// the one farthest from it, and so on while the distance grows.
fn sweep(space: &Space, configs: &Configs, ids: &[u32]) -> Option<FarPair> {
    let mut from = *ids.iter().min()?;
    let mut best: Option<FarPair> = None;
    loop {
        let before = best.map_or(-1.0, |pair| pair.distance);
        let mut farthest = FarPair { distance: -1.0, low: 0, high: 0 };
        for id in ids.iter().filter(|id| **id != from) {
            offer(space, configs, (from, *id), &mut farthest);
        }
        if farthest.distance <= before {
            return best;
        }
        best = Some(farthest);
        from = if farthest.low == from { farthest.high } else { farthest.low };
    }
}

/// Replaces the best pair by that of `a` and `b` if these are farther apart.
fn offer(space: &Space, configs: &Configs, (a, b): (u32, u32), best: &mut FarPair) {
    let (low, high) = (a.min(b), a.max(b));
    let ends = (configs.get(low as usize), configs.get(high as usize));
    let Some(distance) = space.distance_unless_below(ends.0, ends.1, best.distance) else { return };
    let farther = distance > best.distance
        || distance == best.distance && (low, high) < (best.low, best.high);
    if farther {
        *best = FarPair { distance, low, high };
    }
}

/// The bounding box: per part of the space the least and the largest of its first values.
fn corners(space: &Space, configs: &Configs, ids: &[u32]) -> Vec<(f64, f64)> {
    let ends = |at: usize| {
        let values = ids.iter().map(|id| configs.get(*id as usize)[at]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
    };
    space.factors().iter().map(|part| ends(part.at)).collect()
}

/// An upper bound on the distance from `q` to any configuration in the bounding box.
fn reach(space: &Space, q: &[f64], corners: &[(f64, f64)]) -> f64 {
    let parts = space.factors().iter().zip(corners);
    let square = parts.map(|(part, (least, largest))| {
        let farthest = match part.kind {
            FactorKind::Real { .. } => (q[part.at] - least).max(largest - q[part.at]),
            FactorKind::Angle | FactorKind::Rotation => PI,
        } * part.weight;
        farthest * farthest
    });
    square.sum::<f64>().sqrt()
}

/// The part of the rounding margin that rotations need.
fn rotation_margin(space: &Space) -> f64 {
    let rotations = space.factors().iter().filter(|part| part.kind == FactorKind::Rotation);
    rotations.map(|part| part.weight * ROTATION_MARGIN).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::neighbor::brute::tests::configs;
    use crate::space::BaseJoint;
    use proptest::prelude::*;

    fn brute(space: &Space, configs: &Configs, ids: &[u32]) -> Option<FarPair> {
        let mut ids = ids.to_vec();
        ids.sort_unstable();
        let mut best: Option<FarPair> = None;
        for (index, high) in ids.iter().enumerate() {
            for low in &ids[..index] {
                let distance =
                    space.distance(configs.get(*low as usize), configs.get(*high as usize));
                let pair = FarPair { distance, low: *low, high: *high };
                let farther = best.is_none_or(|best| {
                    let ids = ((pair.low, pair.high), (best.low, best.high));
                    distance > best.distance || distance == best.distance && ids.0 < ids.1
                });
                if farther {
                    best = Some(pair);
                }
            }
        }
        best
    }

    proptest! {
        /// Half of the configurations stand on a coarse grid, so that ties occur.
        #[test]
        fn the_farthest_pair_is_that_of_all_pairs(
            ordinal in any::<u64>(), share in 1u32..9, pivot in 0usize..80,
        ) {
            let motions =
                [BaseJoint::Translation2d, BaseJoint::Translation3d, BaseJoint::Rigid2d, BaseJoint::Rigid3d];
            for motion in motions {
                let (space, configs) = configs(motion, ordinal);
                // The order of the ids must not matter.
                let ids: Vec<u32> = (0..80).rev().filter(|id| id % 9 <= share).collect();
                let expected = brute(&space, &configs, &ids);
                let centre = configs.get(pivot);
                prop_assert_eq!(farthest_pair(&space, &configs, &ids, centre), expected);
                let grid: Vec<u32> = ids.into_iter().filter(|id| id % 2 == 0).collect();
                let expected = brute(&space, &configs, &grid);
                prop_assert_eq!(farthest_pair(&space, &configs, &grid, centre), expected);
            }
        }
    }

    #[test]
    fn corners_of_a_square_tie_and_the_lowest_ids_win() {
        let (space, _) = configs(BaseJoint::Translation2d, 0);
        let mut square = Configs::new(2);
        for q in [[1.0, 1.0], [0.0, 3.0], [3.0, 0.0], [3.0, 3.0], [0.0, 0.0]] {
            square.push(&q);
        }
        let found = |ids: &[u32]| farthest_pair(&space, &square, ids, square.get(0));
        let pair = found(&[4, 3, 2, 1, 0]).expect("five corners have a farthest pair");
        assert_eq!((pair.low, pair.high), (1, 2));
        assert_eq!(found(&[3]), None);
        assert_eq!(found(&[]), None);
    }

    /// What the bounds are for: of some ten thousand pairs hardly any is looked at.
    #[test]
    fn two_far_ends_rule_everything_else_out() {
        let (space, inner) = configs(BaseJoint::Translation3d, 1);
        let mut all = inner.clone();
        all.push(&[-50.0; 3]);
        all.push(&[50.0; 3]);
        let ids: Vec<u32> = (0..82).collect();
        let best = farthest_pair(&space, &all, &ids, &[0.0; 3]).expect("a pair");
        assert_eq!((best.low, best.high), (80, 81));
        let corners = corners(&space, &all, &ids);
        let outer = inner.iter().filter(|q| reach(&space, q, &corners) >= best.distance);
        assert_eq!(outer.count(), 0);
    }
}
