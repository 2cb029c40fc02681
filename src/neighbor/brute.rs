//! Searches by brute force, which define what every other search returns.

use super::ball::Ball;
use super::best::{Best, NearPair, Neighbor};
use crate::space::{Configs, Space};

/// The at most `k` of `configs` among `ids` that are nearest to `q` by [`Space::distance`], nearest first, ties by
/// id. The order of `ids` does not matter.
pub fn k_nearest(
    space: &Space,
    configs: &Configs,
    ids: impl Iterator<Item = u32>,
    q: &[f64],
    k: usize,
) -> Vec<Neighbor> {
    let mut best: Best<Neighbor> = Best::new(k);
    for id in ids {
        if let Some(distance) =
            space.distance_unless_above(q, configs.get(id as usize), best.bound())
        {
            best.offer(Neighbor { distance, id });
        }
    }
    best.into_items()
}

/// The configurations within a radius of `q`: all of `configs` among `ids` whose [`Space::distance`] to `q` is at most
/// `radius`, a length in the scene's unit, nearest first, ties by id. With `most`, at most that many, the nearest
/// ones. There are none if the radius is negative or not a number; an infinite radius has all configurations in
/// it. The order of `ids` does not matter.
pub fn in_radius(
    space: &Space,
    configs: &Configs,
    ids: impl Iterator<Item = u32>,
    q: &[f64],
    radius: f64,
    most: Option<usize>,
) -> Vec<Neighbor> {
    let Some(mut ball) = Ball::new(radius, most) else { return Vec::new() };
    for id in ids {
        if let Some(distance) =
            space.distance_unless_above(q, configs.get(id as usize), ball.bound())
        {
            ball.offer(Neighbor { distance, id });
        }
    }
    ball.into_neighbors()
}

/// Some of many configurations.
#[derive(Clone, Copy, Debug)]
pub struct Subset<'a> {
    /// All of them.
    pub all: &'a Configs,
    /// The ids of those that are meant.
    pub ids: &'a [u32],
}

impl<'a> Subset<'a> {
    /// The configurations that are meant, in the order of their ids.
    pub fn configs(self) -> impl Iterator<Item = &'a [f64]> {
        self.ids.iter().map(move |id| self.all.get(*id as usize))
    }
}

/// The at most `count` closest pairs, by [`Space::distance`], of a configuration of `first` and one of `second`, closest
/// first, ties by the first id, then by the second.
pub fn closest_pairs(space: &Space, first: Subset, second: Subset, count: usize) -> Vec<NearPair> {
    let mut best: Best<NearPair> = Best::new(count);
    for (a, q) in first.ids.iter().zip(first.configs()) {
        for (b, p) in second.ids.iter().zip(second.configs()) {
            if let Some(distance) = space.distance_unless_above(q, p, best.bound()) {
                best.offer(NearPair { distance, first: *a, second: *b });
            }
        }
    }
    best.into_items()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::numbers::Ordinal;
    use crate::seed::{Purpose, Seed};
    use crate::space::{BaseJoint, rigid_space};
    use proptest::prelude::*;

    /// Random configurations, half of them on a coarse grid so that ties occur.
    pub(in crate::neighbor) fn configs(motion: BaseJoint, ordinal: u64) -> (Space, Configs) {
        let space = rigid_space(motion, [0.0; 3], [3.0; 3], 0.5);
        let mut stream = Seed::of_set(1, "neighbours", Ordinal(ordinal)).stream(Purpose::Sampling);
        let mut configs = Configs::new(space.len());
        let mut q = vec![0.0; space.len()];
        for i in 0..80 {
            space.sample_uniform(&mut stream, &mut q);
            if i % 2 == 0 {
                q.iter_mut().for_each(|value| *value = value.round());
                if space.canonicalize(&mut q).is_err() {
                    q = configs.get(0).to_vec();
                }
            }
            configs.push(&q);
        }
        (space, configs)
    }

    proptest! {
        #[test]
        fn neighbours_are_the_head_of_the_sorted_list(ordinal in any::<u64>(), k in 0usize..20) {
            for motion in [BaseJoint::Translation2d, BaseJoint::Rigid2d, BaseJoint::Rigid3d] {
                let (space, configs) = configs(motion, ordinal);
                let q = configs.get(7);
                let mut all: Vec<_> = (0..80u32)
                    .map(|id| Neighbor { distance: space.distance(q, configs.get(id as usize)), id })
                    .collect();
                all.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
                all.truncate(k);
                // The order in which candidates come must not matter.
                prop_assert_eq!(&k_nearest(&space, &configs, 0..80, q, k), &all);
                prop_assert_eq!(&k_nearest(&space, &configs, (0..80).rev(), q, k), &all);
            }
        }

        #[test]
        fn what_is_in_a_radius_is_the_near_part_of_the_sorted_list(
            ordinal in any::<u64>(), other in 0usize..80, most in 0usize..80,
        ) {
            for motion in [BaseJoint::Translation2d, BaseJoint::Rigid2d, BaseJoint::Rigid3d] {
                let (space, configs) = configs(motion, ordinal);
                let q = configs.get(7);
                let mut all: Vec<_> = (0..80u32)
                    .map(|id| Neighbor { distance: space.distance(q, configs.get(id as usize)), id })
                    .collect();
                all.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
                let exact = space.distance(q, configs.get(other));
                let radii = [exact, exact.next_up(), exact.next_down(), 0.0, f64::INFINITY, -1.0, f64::NAN];
                for radius in radii {
                    let mut expected = all.clone();
                    expected.retain(|near| near.distance <= radius);
                    let found = in_radius(&space, &configs, 0..80, q, radius, None);
                    prop_assert_eq!(&found, &expected);
                    expected.truncate(most);
                    let found = in_radius(&space, &configs, 0..80, q, radius, Some(most));
                    prop_assert_eq!(&found, &expected);
                    let found = in_radius(&space, &configs, (0..80).rev(), q, radius, Some(most));
                    prop_assert_eq!(&found, &expected);
                }
            }
        }

        #[test]
        fn pairs_are_the_head_of_the_sorted_list(ordinal in any::<u64>(), count in 0usize..30) {
            let (space, configs) = configs(BaseJoint::Rigid3d, ordinal);
            let (first, second): (Vec<u32>, Vec<u32>) = (0..80).partition(|id| id % 3 == 0);
            let mut all = Vec::new();
            for a in &first {
                for b in &second {
                    let distance = space.distance(configs.get(*a as usize), configs.get(*b as usize));
                    all.push(NearPair { distance, first: *a, second: *b });
                }
            }
            all.sort_by(|a, b| {
                a.distance.total_cmp(&b.distance).then((a.first, a.second).cmp(&(b.first, b.second)))
            });
            all.truncate(count);
            let [first, second] = [&first, &second].map(|ids| Subset { all: &configs, ids });
            prop_assert_eq!(closest_pairs(&space, first, second, count), all);
        }
    }
}
