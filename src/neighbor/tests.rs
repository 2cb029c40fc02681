use super::embedding::{Embedding, FAN, length};
use super::*;
use crate::lanes::Lanes;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed, Stream};
use crate::shelf::tests::Flaky;
use crate::shelf::{BlockName, Shelf};
use crate::space::{BaseJoint, Configs, Dof, Factor, FactorKind, Space, rigid_space};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Every kind of motion, and a linkage: a free base with sliding, limited and turning joints.
pub(super) fn spaces() -> Vec<Space> {
    let mut spaces = [
        BaseJoint::Fixed,
        BaseJoint::Translation2d,
        BaseJoint::Rigid2d,
        BaseJoint::Translation3d,
        BaseJoint::Rigid3d,
    ]
    .map(|motion| rigid_space(motion, [-1.0, -2.0, 995.0], [1.0, 2.0, 1000.0], 0.7))
    .to_vec();
    let mut kinds = vec![FactorKind::Real { min: -1.0, max: 3.0 }, FactorKind::Rotation];
    kinds.extend([FactorKind::Angle; 7]);
    kinds.extend([
        FactorKind::Rotation,
        FactorKind::Real { min: 0.0, max: 1e-3 },
        FactorKind::Angle,
    ]);
    spaces.push(product(&kinds, |index| if index == 4 { 0.0 } else { 2.0 / (1 + index) as f64 }));
    spaces.push(product(&[FactorKind::Angle; 12], |index| 6.0 - index as f64 / 2.0));
    spaces.push(product(&[FactorKind::Angle, FactorKind::Rotation], |_| 0.0));
    spaces
}

fn product(kinds: &[FactorKind], weight_of: impl Fn(usize) -> f64) -> Space {
    let (mut parts, mut at) = (Vec::new(), 0);
    for (index, kind) in kinds.iter().enumerate() {
        parts.push(Factor { kind: *kind, at, weight: weight_of(index) });
        at += if *kind == FactorKind::Rotation { 4 } else { 1 };
    }
    let dofs = (0..at).map(|index| Dof { name: index.to_string(), unit: "1" }).collect();
    Space::new(parts, dofs, 0)
}

/// What makes neighbours hard: ties on a grid, the same again and again, all but the same,
/// rotations that are opposite as quaternions, the seam of angles.
pub(super) fn draw(space: &Space, stream: &mut Stream, known: &Configs) -> Vec<f64> {
    let mut q = vec![0.0; space.len()];
    space.sample_uniform(stream, &mut q);
    let kind = (stream.unit() * 6.0) as u32;
    let other = (stream.unit() * known.len() as f64) as usize;
    let other = if known.is_empty() { q.clone() } else { known.get(other).to_vec() };
    let stored = |mut q: Vec<f64>, instead: &[f64]| match space.canonicalize(&mut q) {
        Ok(()) => q,
        Err(_) => instead.to_vec(),
    };
    match kind {
        0 => q,
        1 => stored(q.iter().map(|value| value.round()).collect(), &q),
        2 => other,
        3 => {
            let mut near = q.clone();
            let step = [1e-3, 1e-7, 1e-9, 1e-15][(stream.unit() * 4.0) as usize];
            space.interpolate(&other, &q, step, &mut near);
            stored(near, &q)
        }
        4 => {
            // At half a turn the stored side of a quaternion changes.
            let mut near = other.clone();
            for part in space.factors().iter().filter(|part| part.kind == FactorKind::Rotation) {
                near[part.at] = (stream.unit() - 0.5) * 1e-8;
            }
            stored(near, &q)
        }
        _ => {
            for part in space.factors().iter().filter(|part| part.kind == FactorKind::Angle) {
                let side = if stream.unit() < 0.5 { 1.0 } else { -1.0 };
                q[part.at] = side * (std::f64::consts::PI - 1e-7 * stream.unit());
            }
            stored(q.clone(), &q)
        }
    }
}

pub(super) fn configs(space: &Space, stream: &mut Stream, count: usize) -> Configs {
    let mut configs = Configs::new(space.len());
    for _ in 0..count {
        let q = draw(space, stream, &configs);
        configs.push(&q);
    }
    configs
}

/// Ids with one of a few labels; all are eligible, or those with one label.
struct Labelled<'a> {
    configs: &'a Configs,
    label_of: &'a [u32],
    wanted: Option<u32>,
}

impl Searched for Labelled<'_> {
    fn config(&self, id: u32) -> &[f64] {
        self.configs.get(id as usize)
    }
    fn is_eligible(&self, id: u32) -> bool {
        self.label_is_eligible(id) != Some(false)
    }
    fn label_is_eligible(&self, id: u32) -> Option<bool> {
        self.wanted.map(|wanted| self.label_of[id as usize] == wanted)
    }
}

/// A radius around a query, often exactly the distance of a configuration or next to it, and how many are wanted.
fn draw_radius(
    space: &Space,
    stream: &mut Stream,
    configs: &Configs,
    q: &[f64],
) -> (f64, Option<usize>) {
    let other = (stream.unit() * configs.len() as f64) as usize;
    let exact = if configs.is_empty() { 1.0 } else { space.distance(q, configs.get(other)) };
    let radius = match (stream.unit() * 8.0) as u32 {
        0 | 1 => exact,
        2 => exact.next_up(),
        3 => exact.next_down(),
        4 => 0.0,
        5 => f64::INFINITY,
        6 => [-1.0, f64::NEG_INFINITY, f64::NAN][(stream.unit() * 3.0) as usize],
        _ => stream.unit() * stream.unit() * space.diameter(),
    };
    (radius, (stream.unit() < 0.5).then(|| (stream.unit() * stream.unit() * 300.0) as usize))
}

/// The edges of the radius graph by definition.
fn near_pairs(space: &Space, configs: &Configs, radius: f64) -> Vec<(u32, u32)> {
    let count = configs.len() as u32;
    let pairs = (0..count).flat_map(|low| (low + 1..count).map(move |high| (low, high)));
    let distance =
        |id: (u32, u32)| space.distance(configs.get(id.0 as usize), configs.get(id.1 as usize));
    pairs.filter(|pair| distance(*pair) <= radius).collect()
}

/// An index over the first of the configurations, built in steps, and labels that unite meanwhile.
fn index(
    space: &Space,
    configs: &Configs,
    label_of: &mut [u32],
    stream: &mut Stream,
) -> (Index, Vec<u32>) {
    let mut index = Index::new(space);
    let mut steps = Vec::new();
    while stream.unit() < 0.9 {
        let step = (stream.unit() * stream.unit() * configs.len() as f64) as u32 / 2;
        let end = (index.len() + step).min(configs.len() as u32);
        index.extend(end, |id| configs.get(id as usize), |id| label_of[id as usize]);
        steps.push(end);
        let [from, to] = [0, 1].map(|_| (stream.unit() * 5.0) as u32);
        label_of.iter_mut().filter(|label| **label == from).for_each(|label| *label = to);
    }
    (index, steps)
}

/// How many configurations there are, and their labels, from one state to the next.
fn history(stream: &mut Stream, count: usize) -> Vec<(u32, Vec<u32>)> {
    let mut label_of: Vec<u32> = (0..count).map(|_| (stream.unit() * 5.0) as u32).collect();
    let mut states = vec![(0, label_of.clone())];
    let mut end = 0;
    while end < count {
        end = count.min(end + 1 + (stream.unit() * 50.0) as usize);
        if stream.unit() < 0.3 {
            let [from, to] = [0, 1].map(|_| (stream.unit() * 5.0) as u32);
            label_of.iter_mut().filter(|label| **label == from).for_each(|label| *label = to);
        }
        states.push((end as u32, label_of.clone()));
    }
    states
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn indices_that_share_a_shelf_find_what_brute_force_finds(
        ordinal in any::<u64>(),
        often in 0.0f64..0.5,
    ) {
        let mut stream = Seed::of_set(1, "shelf", Ordinal(ordinal)).stream(Purpose::Sampling);
        let space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [3.0; 3], 0.5);
        let configs = configs(&space, &mut stream, 600);
        let states = history(&mut stream, configs.len());
        let shelf: Arc<dyn Shelf> = Arc::new(Flaky::new(often, ordinal));
        let mut indices = [0; 3].map(|state| (state, Index::with_shelf(&space, Some(shelf.clone()))));
        // Each is at a state of its own: what it finds on the shelf may be of a later one.
        while let Some(at) = [0, 1, 2].into_iter().find(|at| indices[*at].0 + 1 < states.len()) {
            let at = if stream.unit() < 0.3 { at } else { (stream.unit() * 3.0) as usize };
            let (state, index) = &mut indices[at];
            *state = (*state + (stream.unit() * 5.0) as usize).min(states.len() - 1);
            let (end, label_of) = &states[*state];
            index.extend(*end, |id| configs.get(id as usize), |id| label_of[id as usize]);
            let wanted = Some((stream.unit() * 5.0) as u32);
            let searched = Labelled { configs: &configs, label_of, wanted };
            let ids = (0..*end).filter(|id| searched.is_eligible(*id));
            let q = configs.get((stream.unit() * configs.len() as f64) as usize);
            let expected = k_nearest(&space, &configs, ids, q, 7);
            prop_assert_eq!(index.k_nearest(&space, &searched, *end, q, 7), expected);
            let (radius, most) = draw_radius(&space, &mut stream, &configs, q);
            let ids = (0..*end).filter(|id| searched.is_eligible(*id));
            let expected = in_radius(&space, &configs, ids, q, radius, most);
            prop_assert_eq!(index.in_radius(&space, &searched, *end, q, radius, most), expected);
        }
    }

    #[test]
    fn the_index_finds_what_brute_force_finds(
        ordinal in any::<u64>(),
        count in 0usize..400,
        k in 0usize..25,
    ) {
        let mut stream = Seed::of_set(1, "index", Ordinal(ordinal)).stream(Purpose::Sampling);
        for space in spaces() {
            let configs = configs(&space, &mut stream, count);
            let ids = 0..configs.len() as u32;
            // Labels by position, so that whole boxes have the same one.
            let mut label_of: Vec<u32> = configs
                .iter()
                .map(|q| if q.first().is_some_and(|x| *x < 0.0) { 0 } else { 1 + (stream.unit() * 4.0) as u32 })
                .collect();
            let (mut index, steps) = index(&space, &configs, &mut label_of, &mut stream);
            for wanted in [None, Some(0), Some(1)] {
                let searched = Labelled { configs: &configs, label_of: &label_of, wanted };
                let some: Vec<u32> =
                    ids.clone().filter(|id| searched.is_eligible(*id)).collect();
                let others = super::tests::configs(&space, &mut stream, 6);
                let mut queries: Vec<&[f64]> = others.iter().collect();
                queries.extend(configs.iter().step_by(61));
                for q in queries {
                    let expected = k_nearest(&space, &configs, some.iter().copied(), q, k);
                    let found = index.k_nearest(&space, &searched, ids.end, q, k);
                    prop_assert_eq!(found, expected, "{:?} {:?}", steps, wanted);

                    let (radius, most) = draw_radius(&space, &mut stream, &configs, q);
                    let expected =
                        in_radius(&space, &configs, some.iter().copied(), q, radius, most);
                    for lanes in Lanes::all() {
                        Arc::make_mut(&mut index.embedding).lanes = lanes;
                        let found = index.in_radius(&space, &searched, ids.end, q, radius, most);
                        prop_assert_eq!(&found, &expected, "{} {:?} {:?}", radius, most, lanes);
                    }
                }
                let first: Vec<u32> = (0..others.len() as u32).collect();
                let first = Subset { all: &others, ids: &first };
                let second = Subset { all: &configs, ids: &some };
                let expected = closest_pairs(&space, first, second, k);
                let found = index.closest_pairs(&space, first, &searched, ids.end, k);
                prop_assert_eq!(found, expected, "{:?} {:?}", steps, wanted);
            }
        }
    }
}

/// The edges of the graph by definition.
fn graph(space: &Space, configs: &Configs, k: usize) -> Vec<(u32, u32)> {
    let count = configs.len() as u32;
    let mut pairs = BTreeSet::new();
    for id in 0..count {
        let others = (0..count).filter(|other| *other != id);
        for near in k_nearest(space, configs, others, configs.get(id as usize), k) {
            pairs.insert((id.min(near.id), id.max(near.id)));
        }
    }
    Vec::from_iter(pairs)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn the_graph_is_the_union_of_the_directed_neighbours(
        ordinal in any::<u64>(),
        count in 0usize..400,
        k in 0usize..25,
    ) {
        let mut stream = Seed::of_set(1, "graph", Ordinal(ordinal)).stream(Purpose::Sampling);
        for space in spaces() {
            let configs = configs(&space, &mut stream, count);
            prop_assert_eq!(k_nearest_graph(&space, &configs, k), graph(&space, &configs, k));
        }
    }

    #[test]
    fn the_radius_graph_has_all_pairs_within_the_radius(
        ordinal in any::<u64>(),
        count in 0usize..300,
    ) {
        let mut stream = Seed::of_set(1, "radius graph", Ordinal(ordinal)).stream(Purpose::Sampling);
        for space in spaces() {
            let configs = configs(&space, &mut stream, count);
            let q = draw(&space, &mut stream, &configs);
            // The radius is a distance between two of the configurations, or one that no pair need have.
            let from = if configs.is_empty() || stream.unit() < 0.3 { &q[..] } else { configs.get(0) };
            let (radius, _) = draw_radius(&space, &mut stream, &configs, from);
            let expected = near_pairs(&space, &configs, radius);
            prop_assert_eq!(radius_graph(&space, &configs, radius), expected, "{}", radius);
        }
    }

    #[test]
    fn points_bound_configurations(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(1, "points", Ordinal(ordinal)).stream(Purpose::Sampling);
        for space in spaces() {
            let configs = configs(&space, &mut stream, 2 * FAN);
            let embedding = Embedding::new(&space);
            let (leaf, points) = leaf(&embedding, &configs);
            let longest = points.iter().map(|point| length(point)).fold(0.0, f64::max);
            let error_bounds = embedding.error_bounds(2.0 * longest);
            for (q, point) in configs.iter().zip(&points) {
                let squares = embedding.squares(point, &leaf);
                for (square, other) in squares.into_iter().zip(configs.iter()) {
                    let distance = space.distance(q, other);
                    prop_assert!(distance * distance <= error_bounds.largest_square(square));
                    prop_assert!(square <= error_bounds.pruning_bound(distance * distance));
                }
            }
        }
    }

    #[test]
    fn all_lanes_measure_the_same_bits(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(1, "lanes", Ordinal(ordinal)).stream(Purpose::Sampling);
        for space in spaces().into_iter().filter(|space| !space.is_empty()) {
            let configs = configs(&space, &mut stream, 3 * FAN);
            let mut embedding = Embedding::new(&space);
            let (leaf, points) = leaf(&embedding, &configs);
            // Any two points are the corners of a box.
            let ends = |index: usize| [points[index].as_slice(), points[index + FAN].as_slice()];
            let side = |index: usize, axis: usize, pick: fn(f32, f32) -> f32| {
                let [a, b] = ends(index);
                pick(a[axis], b[axis])
            };
            let mut sides = Vec::new();
            for axis in 0..embedding.axes() {
                sides.extend((0..FAN).map(|index| side(index, axis, f32::min)));
                sides.extend((0..FAN).map(|index| side(index, axis, f32::max)));
            }
            for point in &points[2 * FAN..] {
                let expected = [embedding.squares(point, &leaf), embedding.box_squares(point, &sides)];
                for limit in expected[0].into_iter().chain([0.0, f32::INFINITY]) {
                    let bits = |squares: &[f32; FAN]| {
                        (0..FAN).filter(|at| squares[*at] <= limit).fold(0, |bits, at| bits | 1 << at)
                    };
                    for lanes in Lanes::all() {
                        embedding.lanes = lanes;
                        let found = [
                            embedding.near_points(point, &leaf, limit),
                            embedding.near_boxes(point, &sides, limit),
                        ];
                        for ((squares, within), expected) in found.iter().zip(&expected) {
                            prop_assert_eq!(squares.map(f32::to_bits), expected.map(f32::to_bits));
                            prop_assert_eq!(*within, bits(expected), "{:?}", lanes);
                        }
                    }
                }
            }
        }
    }
}

/// All points, and the first of them as a leaf.
fn leaf(embedding: &Embedding, configs: &Configs) -> (Vec<f32>, Vec<Vec<f32>>) {
    let point = |q: &[f64]| {
        let mut point = Vec::new();
        embedding.embed(q, &mut point);
        point
    };
    let points: Vec<_> = configs.iter().map(point).collect();
    let axes = (0..embedding.axes()).flat_map(|axis| points[..FAN].iter().map(move |at| at[axis]));
    (axes.collect(), points)
}

/// More than can be told apart by squares: a crowd of equals, and some that nearly are.
#[test]
fn equals_are_told_apart_by_their_ids() {
    for space in spaces() {
        let mut stream = Seed::of_set(1, "equals", Ordinal(0)).stream(Purpose::Sampling);
        let mut q = vec![0.0; space.len()];
        space.sample_uniform(&mut stream, &mut q);
        let mut configs = Configs::new(space.len());
        for i in 0..900 {
            let mut near = q.clone();
            if let Some(value) = near.first_mut().filter(|_| i % 3 == 0) {
                *value += 1e-12 * stream.unit();
            }
            configs.push(&near);
        }
        assert_eq!(k_nearest_graph(&space, &configs, 3), graph(&space, &configs, 3));
        let mut index = Index::new(&space);
        for end in [500, 800] {
            index.extend(end, |id| configs.get(id as usize), |_| 0);
        }
        let searched = Labelled { configs: &configs, label_of: &[], wanted: None };
        let expected = k_nearest(&space, &configs, 0..900, &q, 9);
        assert_eq!(index.k_nearest(&space, &searched, 900, &q, 9), expected);
        // The differences are far below what single precision tells apart.
        for radius in [0.0, 3e-13, 1e-12, f64::INFINITY] {
            for most in [None, Some(9), Some(500)] {
                let expected = in_radius(&space, &configs, 0..900, &q, radius, most);
                assert_eq!(index.in_radius(&space, &searched, 900, &q, radius, most), expected);
            }
            let expected = near_pairs(&space, &configs, radius);
            assert_eq!(radius_graph(&space, &configs, radius), expected, "{radius}");
        }
    }
}

/// What was united by the time of its maker keeps no label apart for who is not as far.
#[test]
fn labels_of_a_later_state_are_not_believed() {
    let space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [3.0; 3], 0.5);
    let mut stream = Seed::of_set(1, "labels", Ordinal(0)).stream(Purpose::Sampling);
    let configs = configs(&space, &mut stream, 96);
    let shelf = Arc::new(Flaky::new(0.0, 0));
    let [mut late, mut early] = [0; 2].map(|_| Index::with_shelf(&space, Some(shelf.clone())));
    let config_of = |id: u32| configs.get(id as usize);
    late.extend(96, config_of, |_| 0);
    let made = shelf.made();
    let label_of: Vec<u32> = (0..64).map(|id| id % 2).collect();
    early.extend(64, config_of, |id| label_of[id as usize]);
    assert_eq!((shelf.made(), early.segment_lengths()), (made, vec![64]), "it is the other's");
    let searched = Labelled { configs: &configs, label_of: &label_of, wanted: Some(1) };
    let odd = || (0..64).filter(|id| id % 2 == 1);
    for q in configs.iter() {
        let expected = k_nearest(&space, &configs, odd(), q, 5);
        assert_eq!(early.k_nearest(&space, &searched, 64, q, 5), expected);
    }
}

#[test]
fn what_one_index_has_built_others_find_and_what_is_superseded_goes() {
    let space = rigid_space(BaseJoint::Rigid3d, [0.0; 3], [3.0; 3], 0.5);
    let mut stream = Seed::of_set(1, "shelf", Ordinal(0)).stream(Purpose::Sampling);
    let configs = configs(&space, &mut stream, 1000);
    let shelf = Arc::new(Flaky::new(0.0, 0));
    let mut indices = [0; 2].map(|_| Index::with_shelf(&space, Some(shelf.clone())));
    for end in (50..=1000).step_by(50) {
        let made = indices.each_mut().map(|index| {
            index.extend(end, |id| configs.get(id as usize), |_| 0);
            shelf.made()
        });
        assert_eq!(made[0], made[1], "only the first makes any");
        let [own, others] = indices.each_ref().map(Index::segment_lengths);
        assert_eq!(own, others);
    }
    // 1000 = 31 times 32 and 8.
    assert_eq!(indices[0].segment_lengths(), [512, 256, 128, 64, 32, 8]);
    let left = [(0, 30), (1, 14), (2, 6), (3, 2), (4, 0)]
        .map(|(level, number)| BlockName::Segment { level, number });
    assert_eq!(shelf.names(), left);
}

#[test]
fn lengths_of_any_size_keep_their_neighbours() {
    for scale in [1e-30, 1e-20, 1e-3, 1e6, 1e18, 1e30, 1e60, 1e150] {
        let space = rigid_space(BaseJoint::Translation3d, [0.0; 3], [scale; 3], 1.0);
        let mut stream = Seed::of_set(1, "lengths", Ordinal(0)).stream(Purpose::Sampling);
        let configs = configs(&space, &mut stream, 300);
        let mut index = Index::new(&space);
        index.extend(300, |id| configs.get(id as usize), |_| 0);
        assert_eq!(k_nearest_graph(&space, &configs, 5), graph(&space, &configs, 5), "{scale}");
        let searched = Labelled { configs: &configs, label_of: &[], wanted: None };
        for q in configs.iter().step_by(7) {
            let expected = k_nearest(&space, &configs, 0..300, q, 10);
            assert_eq!(index.k_nearest(&space, &searched, 300, q, 10), expected, "{scale}");
            let radius = space.distance(q, configs.get(5));
            let expected = in_radius(&space, &configs, 0..300, q, radius, None);
            let found = index.in_radius(&space, &searched, 300, q, radius, None);
            assert_eq!(found, expected, "{scale}");
        }
    }
}

#[test]
fn segments_are_few_and_configurations_rarely_built_in_anew() {
    let space = rigid_space(BaseJoint::Translation2d, [0.0; 3], [1.0; 3], 1.0);
    let mut stream = Seed::of_set(1, "segments", Ordinal(0)).stream(Purpose::Sampling);
    let configs = configs(&space, &mut stream, 20_000);
    let (mut index, mut built) = (Index::new(&space), 0);
    while index.len() < 20_000 {
        let end = (index.len() + 1 + (stream.unit() * 99.0) as u32).min(20_000);
        index.extend(end, |id| configs.get(id as usize), |_| 0);
        let lengths = index.segment_lengths();
        assert!(lengths.windows(2).all(|pair| pair[0] >= 2 * pair[1]), "{lengths:?}");
        assert_eq!(lengths.iter().sum::<u32>(), end);
        built += lengths[lengths.len() - 1];
    }
    assert!(built < 20_000 * 10, "{built}");
}
