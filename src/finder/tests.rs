//! The laws that every neighbour finder keeps: what it gives is in order, and is what it would be by looking at all.

use super::*;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed};
use crate::space::{BaseJoint, rigid_space};
use proptest::prelude::*;

/// Every finder once.
fn finders(neighbors: u32) -> Vec<FinderKind> {
    let radius = 0.1 * f64::from(neighbors);
    vec![
        FinderKind::KNearest(KNearest { neighbors }),
        FinderKind::Radius(Radius { radius, most: None }),
        FinderKind::Radius(Radius { radius, most: Some(neighbors) }),
    ]
}

proptest! {
    #[test]
    fn finders_give_what_looking_at_all_milestones_gives(
        ordinal in any::<u64>(), count in 1usize..300, neighbors in 1u32..20,
    ) {
        let space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [3.0; 3], 0.5);
        let mut stream = Seed::of_set(1, "finders", Ordinal(ordinal)).stream(Purpose::Sampling);
        let (mut configs, mut q) = (Configs::new(space.len()), vec![0.0; space.len()]);
        for _ in 0..count {
            space.sample_uniform(&mut stream, &mut q);
            configs.push(&q);
        }
        let components = Components::of(&space, &configs, &[]);
        for kind in finders(neighbors) {
            let finder = kind.method();
            let mut pairs = std::collections::BTreeSet::new();
            for (id, q) in configs.iter().enumerate() {
                let near = finder.near(&space, &configs, &components, q);
                let mut sorted = near.clone();
                sorted.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
                prop_assert_eq!(&near, &sorted);
                prop_assert!(near.len() <= finder.most().unwrap_or(count));
                // Nobody that is left out is nearer than the farthest that is given.
                if let (Some(last), Some(most)) = (near.last(), finder.most()) {
                    let nearer = (0..count as u32).filter(|other| {
                        let distance = space.distance(q, configs.get(*other as usize));
                        (distance, *other) <= (last.distance, last.id)
                    });
                    prop_assert_eq!(nearer.count(), near.len());
                    // Within a set a milestone is no neighbour of its own, and takes no other's place.
                    let others = near.iter().filter(|near| near.id as usize != id).take(most);
                    pairs.extend(others.map(|near| (near.id.min(id as u32), near.id.max(id as u32))));
                } else {
                    let others = near.iter().filter(|near| near.id as usize != id);
                    pairs.extend(others.map(|near| (near.id.min(id as u32), near.id.max(id as u32))));
                }
            }
            // With a limit, the search from a milestone's own place gives itself and one neighbour fewer.
            let found = finder.pairs(&space, &configs);
            prop_assert!(found.windows(2).all(|two| two[0] < two[1]));
            prop_assert!(found.iter().all(|(low, high)| low < high));
            prop_assert!(pairs.iter().all(|pair| found.binary_search(pair).is_ok()));
            if finder.most().is_none() {
                prop_assert_eq!(found.len(), pairs.len());
            }
        }
    }
}
