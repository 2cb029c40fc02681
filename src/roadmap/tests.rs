use super::*;
use crate::img::{Setup, build};
use crate::neighbor::{Best, NearPair, Subset, closest_pairs, in_radius, k_nearest};
use crate::numbers::{NodeId, Ordinal};
use crate::problem::Problem;
use crate::seed::{Purpose, Seed, Stream};
use crate::shelf::tests::Flaky;
use crate::shelf::{BlockName, Shelf};
use crate::space::{BaseJoint, rigid_space};
use crate::wire;
use proptest::prelude::*;
use std::path::Path;
use std::sync::Arc;

const GROUPS: u32 = 3;

/// A growing graph: most nodes are tied to an earlier one of their group, so there are a few large
/// components and many of one node; now and then two groups become one.
struct Growth {
    space: Space,
    stream: Stream,
    group_of: Vec<u32>,
    roadmap: Roadmap,
    /// Workers that have what is on one shelf in common.
    workers: [Roadmap; 2],
    outline: Outline,
}

impl Growth {
    fn new(motion: BaseJoint, ordinal: u64) -> Growth {
        Growth::with_shelf(motion, ordinal, Arc::new(Flaky::new(0.2, ordinal)))
    }

    fn with_shelf(motion: BaseJoint, ordinal: u64, shelf: Arc<dyn Shelf>) -> Growth {
        let space = rigid_space(motion, [0.0; 3], [9.0, 9.0, 2.0], 0.5);
        let stream = Seed::of_set(1, "growth", Ordinal(ordinal)).stream(Purpose::Sampling);
        let (roadmap, outline) = (Roadmap::new(&space), Outline::new(&space));
        let workers = [false, true].map(|keeps| Roadmap::of_worker(&space, shelf.clone(), keeps));
        Growth { space, stream, group_of: Vec::new(), roadmap, workers, outline }
    }

    fn below(&mut self, count: usize) -> usize {
        (self.stream.unit() * count as f64) as usize
    }

    /// A configuration, every fourth on a grid so that ties occur.
    fn draw(&mut self) -> Vec<f64> {
        let mut q = vec![0.0; self.space.len()];
        self.space.sample_uniform(&mut self.stream, &mut q);
        if self.stream.unit() < 0.25 {
            let mut round: Vec<f64> = q.iter().map(|value| value.round()).collect();
            if self.space.canonicalize(&mut round).is_ok() {
                return round;
            }
        }
        q
    }

    fn fold_round(&mut self, sets: usize, nodes: usize) {
        let mut round = Vec::new();
        for _ in 0..sets {
            let first = self.group_of.len() as u32;
            let mut configs = Configs::new(self.space.len());
            let (mut edges, mut joins) = (Vec::new(), Vec::new());
            for node in first..first + nodes as u32 {
                configs.push(&self.draw());
                let group = self.below(GROUPS as usize + 2) as u32;
                // Nodes outside the groups stay alone, but for a few that tie a group to another.
                let alone = group >= GROUPS && self.stream.unit() < 0.99;
                for _ in 0..if alone { 0 } else { 20 } {
                    let low = self.below(self.group_of.len()) as u32;
                    let kind = self.group_of.get(low as usize).copied();
                    if kind == Some(group) || (group >= GROUPS && kind == Some(group - GROUPS)) {
                        let edge =
                            |from| Edge::metric(NodeId(low - from), NodeId(node - from), 0, 1.0);
                        if low >= first {
                            edges.push(edge(first));
                        } else {
                            joins.push(edge(0));
                        }
                        if group < GROUPS {
                            break;
                        }
                    }
                }
                self.group_of.push(group);
            }
            round.push((Increment { configs, edges, ..Increment::empty(0) }, joins));
        }
        let sets = || round.iter().map(|(increment, joins)| (increment, &joins[..]));
        self.roadmap.fold_round(&self.space, sets());
        for worker in &mut self.workers {
            worker.fold_round(&self.space, sets());
        }
        self.outline.fold_round(sets());
    }

    /// Compares what is found with what brute force finds.
    fn check(&mut self) {
        let (k, nodes) = (self.below(12), self.roadmap.components().nodes());
        let mut queries = Configs::new(self.space.len());
        for _ in 0..20 {
            queries.push(&self.draw());
        }
        let some = self.below(nodes as usize) as u32;
        for roadmap in [&self.roadmap, &self.workers[0], &self.workers[1]] {
            check(&self.space, roadmap, &queries, some, k);
        }
    }
}

fn check(space: &Space, roadmap: &Roadmap, queries: &Configs, some: u32, k: usize) {
    let nodes = roadmap.components().nodes();
    let (configs, components) = (roadmap.configs(), roadmap.components());
    for q in queries.iter() {
        let expected = k_nearest(space, configs, 0..nodes, q, k);
        assert_eq!(roadmap.k_nearest(space, q, k), expected);

        // A node lies exactly on the sphere.
        let radius = space.distance(q, configs.get(some as usize));
        for (radius, most) in [(radius, None), (radius, Some(k)), (f64::INFINITY, Some(k))] {
            let expected = in_radius(space, configs, 0..nodes, q, radius, most);
            assert_eq!(roadmap.in_radius(space, q, radius, most), expected);
        }

        let mut best = Best::new(k);
        for component in components.iter() {
            let distance = space.distance(q, &component.centre);
            best.offer(Neighbor { distance, id: component.name.0 });
        }
        assert_eq!(components.nearest(space, q, k), best.into_items());
    }
    let largest = components.iter().max_by_key(|component| component.members.len());
    for component in
        [components.of_node(NodeId(some)), components.of_node(NodeId(0)), largest.expect("one")]
    {
        let ids: Vec<u32> = (0..queries.len() as u32).collect();
        let first = Subset { all: queries, ids: &ids };
        let expected: Vec<NearPair> =
            closest_pairs(space, first, Subset { all: configs, ids: &component.members }, k);
        let found = components.closest_pairs(space, first, configs, component, k);
        assert_eq!(found, expected);

        // Some nodes, few nodes, and none.
        for every in [2, 50, u32::MAX] {
            let is_meant = |node: NodeId| (node.0 ^ some).is_multiple_of(every);
            for q in queries.iter() {
                let ids = component.members.iter().copied().filter(|id| is_meant(NodeId(*id)));
                let expected = k_nearest(space, configs, ids, q, 1).into_iter().next();
                let found = components.nearest_member(space, configs, component, q, is_meant);
                assert_eq!(found, expected);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn a_growing_roadmap_finds_what_brute_force_finds(
        ordinal in any::<u64>(),
        asked_from in 0usize..20,
    ) {
        for motion in [BaseJoint::Rigid2d, BaseJoint::Rigid3d] {
            let mut growth = Growth::new(motion, ordinal);
            for round in 0..25 {
                let (sets, nodes) = (1 + growth.below(3), 1 + growth.below(80));
                growth.fold_round(sets, nodes);
                if round >= asked_from {
                    growth.check();
                }
                if round == 20 {
                    growth.roadmap = growth.roadmap.clone();
                }
            }
        }
    }
}

#[test]
fn folding_round_by_round_and_finding_the_components_of_the_whole_agree() {
    let mut growth = Growth::new(BaseJoint::Rigid3d, 0);
    (0..9).for_each(|_| growth.fold_round(2, 40));
    let whole = &growth.roadmap;
    let edges: Vec<Edge> = whole.edges().iter().collect();
    let again = Components::of(&growth.space, whole.configs(), &edges);
    for node in whole.nodes() {
        let (a, b) = (whole.components().of_node(node), again.of_node(node));
        assert_eq!((a.name, a.members.len()), (b.name, b.members.len()));
        let near = growth.space.distance(&a.centre, &b.centre);
        assert!(near < 1e-6, "{near}");
    }
    assert_eq!(whole.components().count(), again.count());
}

#[test]
fn those_who_keep_less_come_to_the_same() {
    let numbers = |tally: &Tally| (tally.sets(), tally.nodes(), tally.edges(), tally.components());
    let mut growth = Growth::new(BaseJoint::Rigid2d, 1);
    for round in 1..9 {
        growth.fold_round(2, 40);
        let whole = growth.roadmap.tally();
        assert_eq!(whole.sets(), 2 * round);
        assert_eq!(whole.nodes(), growth.roadmap.configs().len());
        assert_eq!(whole.edges(), growth.roadmap.edges().len());
        assert_eq!(whole.components(), growth.roadmap.components().count());
        assert_eq!(numbers(growth.outline.tally()), numbers(whole));
        assert_eq!(growth.outline.tally().digest(), whole.digest());
        for worker in &growth.workers {
            assert_eq!(numbers(worker.tally()), numbers(whole));
            assert_eq!(worker.configs(), growth.roadmap.configs());
        }
    }
    assert!(growth.workers[0].edges().is_empty());
    let [ours, theirs] = [&growth.roadmap, &growth.workers[1]].map(Roadmap::edges);
    assert!(ours.iter().eq(theirs.iter()));
    assert!((0..ours.len()).all(|index| ours.get(index) == theirs.get(index)));
    assert_eq!(wire::encode(growth.roadmap.configs()), wire::encode(growth.workers[0].configs()));
    growth.check();
}

#[test]
fn what_is_whole_is_made_by_one_worker_and_found_by_the_other() {
    let shelf = Arc::new(Flaky::new(0.0, 0));
    let mut growth = Growth::with_shelf(BaseJoint::Rigid3d, 2, shelf.clone());
    (0..9).for_each(|_| growth.fold_round(2, 40));
    // Only who searches often builds an index.
    (0..2).for_each(|_| growth.check());
    let edges = growth.roadmap.edges().len();
    let whole = |name: &BlockName| !matches!(name, BlockName::Segment { .. });
    // Blocks of 32 configurations and of 32 edges.
    assert_eq!(shelf.names().into_iter().filter(whole).count(), 720 / 32 + edges / 32);
    // 720 = 512 + 128 + 64 + 16, made by whichever searched first.
    assert_eq!(shelf.made(), 720 / 32 + edges / 32 + 3);
}

#[test]
fn a_roadmap_knows_what_it_was_after_every_round() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/problems/judged.toml");
    let mut problem = Problem::load(&path).unwrap();
    problem.evaluators.clear();
    let space = problem.space();
    problem.limits.sets = 12;
    let long = build(&Arc::new(Setup::new(problem.clone()))).roadmap;
    assert_eq!(long.rounds().len(), 6);
    for (index, extent) in long.rounds().iter().enumerate() {
        problem.limits.sets = extent.sets;
        let short = build(&Arc::new(Setup::new(problem.clone()))).roadmap;
        assert_eq!(short.rounds(), &long.rounds()[..=index]);
        let then = long.components_at(&space, *extent);
        assert_eq!(then.count(), short.components().count());
        for component in then.iter() {
            let other = short.components().of_node(component.name);
            let sorted = |component: &Component| {
                let mut members = component.members.clone();
                members.sort_unstable();
                (component.name, members)
            };
            assert_eq!(sorted(component), sorted(other));
            assert_eq!(component.centre, other.centre);
        }
    }
}
