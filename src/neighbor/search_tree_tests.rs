//! K-d trees and metric trees against looking at all, in every kind of space.

use super::search_trees::SearchTrees;
use super::tests::{configs, draw, spaces};
use super::*;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed};
use crate::space::{Configs, Space};
use proptest::prelude::*;

const EPSILONS: [f64; 5] = [0.0, 1e-9, 0.1, 0.5, 3.0];

fn k_d(space: &Space, configs: &Configs, ends: &[u32]) -> SearchTrees<KdTree> {
    let mut trees = SearchTrees::default();
    ends.iter().for_each(|end| trees.extend(space, configs, *end));
    trees
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn trees_find_what_they_promise(
        ordinal in any::<u64>(),
        count in 0u32..900,
        k in 0usize..30,
        share in 1u32..5,
    ) {
        let mut stream = Seed::of_set(1, "trees", Ordinal(ordinal)).stream(Purpose::Sampling);
        for space in spaces() {
            let configs = configs(&space, &mut stream, count as usize);
            let ends = [count / 3, count / 2, count];
            let trees = k_d(&space, &configs, &ends);
            let at_once = k_d(&space, &configs, &[count]);
            let mut metric: SearchTrees<MetricTree> = SearchTrees::default();
            ends.iter().for_each(|end| metric.extend(&space, &configs, *end));
            let is_eligible = |id: u32| id.is_multiple_of(share);
            for _ in 0..4 {
                let q = draw(&space, &mut stream, &configs);
                let ids = (0..count).filter(|id| is_eligible(*id));
                let expected = k_nearest(&space, &configs, ids, &q, k);
                let found = metric.nearest(&space, &configs, count, &is_eligible, &q, k);
                prop_assert_eq!(&found, &expected);
                for epsilon in EPSILONS {
                    let [found, whole] = [&trees, &at_once].map(|trees| {
                        trees.approximately_nearest(&space, &configs, count, &is_eligible, &q, k, epsilon)
                    });
                    // When the trees were built does not matter.
                    prop_assert_eq!(&found, &whole);
                    prop_assert_eq!(found.len(), expected.len());
                    prop_assert!(found.windows(2).all(|two| two[0].rank(&two[1]).is_lt()));
                    for (near, nearest) in found.iter().zip(&expected) {
                        prop_assert!(is_eligible(near.id));
                        let distance = space.distance(&q, configs.get(near.id as usize));
                        prop_assert_eq!(near.distance.to_bits(), distance.to_bits());
                        prop_assert!(near.distance <= (1.0 + epsilon) * nearest.distance);
                    }
                    if epsilon == 0.0 {
                        prop_assert_eq!(&found, &expected);
                    }
                }
            }
        }
    }
}

/// That approximate searches pay: in ten thousand they look at fewer, and find others than the nearest.
#[test]
fn a_larger_epsilon_looks_at_less() {
    let space = &spaces()[4];
    let mut stream = Seed::of_set(1, "fewer", Ordinal(0)).stream(Purpose::Sampling);
    let mut configs = Configs::new(space.len());
    let mut q = vec![0.0; space.len()];
    for _ in 0..10_000 {
        space.sample_uniform(&mut stream, &mut q);
        configs.push(&q);
    }
    let trees = k_d(space, &configs, &[10_000]);
    let mut looked = [0, 0, 0];
    let mut others = 0;
    for _ in 0..20 {
        space.sample_uniform(&mut stream, &mut q);
        let found = [0.0, 0.5, 3.0].map(|epsilon| {
            let asked = std::cell::Cell::new(0);
            let is_eligible = |_| {
                asked.set(asked.get() + 1);
                true
            };
            let found =
                trees.approximately_nearest(space, &configs, 10_000, &is_eligible, &q, 10, epsilon);
            (found, asked.get())
        });
        for (sum, (_, asked)) in looked.iter_mut().zip(&found) {
            *sum += asked;
        }
        others += usize::from(found[2].0 != found[0].0);
    }
    assert!(looked[0] < 20 * 10_000 / 2, "{looked:?}");
    assert!(looked[1] < looked[0] && looked[2] < looked[1], "{looked:?}");
    assert!(others > 0);
}
