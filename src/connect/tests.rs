use super::*;
use crate::img::{Setup, build};
use crate::model::Asked;
use crate::numbers::{NodeId, Ordinal};
use crate::problem::Problem;
use std::path::Path;

const NEIGHBORS: u32 = 4;

/// The third set of a round, to be joined to the two before it and a roadmap of four.
fn input() -> (Setup, JoinInput) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/problems/judged.toml");
    let mut problem = Problem::load(&path).unwrap();
    problem.evaluators.clear();
    problem.limits.sets = 4;
    let setup = Setup::new(problem.clone());
    let roadmap = Arc::new(build(&Arc::new(Setup::new(problem))).roadmap);
    let mut increments = Vec::new();
    for ordinal in (2..5).map(Ordinal) {
        let strategy = &setup.problem.strategies[1];
        let increment = strategy.generate(&setup.cx, ordinal, None, &mut Scratch::new()).unwrap();
        increments.push(Arc::new(Built::new(&setup.cx, Arc::new(increment))));
    }
    (setup, JoinInput { roadmap, increments })
}

fn joined(setup: &Setup, input: &JoinInput, way: &dyn Among) -> (Vec<Edge>, Asked) {
    let mut scratch = Scratch::new();
    let edges = way.connect(&setup.cx, input, &mut scratch);
    (edges, scratch.take_asked())
}

/// Everything before the round and in it, with the round's inner edges.
fn whole(input: &JoinInput) -> (Configs, Vec<Edge>) {
    let mut configs = input.roadmap.configs().clone();
    let mut edges: Vec<Edge> = input.roadmap.edges().iter().collect();
    for built in &input.increments {
        let first = configs.len() as u32;
        configs.extend(&built.increment.configs);
        edges.extend(built.increment.edges.iter().map(|edge| edge.shifted(first)));
    }
    (configs, edges)
}

#[test]
fn nearest_nodes_tries_every_new_node_with_the_nearest_of_all_old_ones() {
    let (setup, input) = input();
    let planners = default_planners();
    let way = NearestNodes { neighbors: NEIGHBORS, planners: planners.clone() };
    let (edges, asked) = joined(&setup, &input, &way);
    let (configs, _) = whole(&input);
    let new = configs.len() - input.increments[2].increment.configs.len();
    let mut expected = Vec::new();
    for high in new..configs.len() {
        let q = configs.get(high);
        let mut old: Vec<usize> = (0..new).collect();
        let distance = |node: usize| setup.cx.space.distance(configs.get(node), q);
        old.sort_by(|a, b| distance(*a).total_cmp(&distance(*b)).then(a.cmp(b)));
        for low in &old[..NEIGHBORS as usize] {
            let ends = (configs.get(*low), q);
            let free =
                crate::local::connect(&setup.cx, &planners, ends, 1, &mut Scratch::new()).is_some();
            free.then(|| expected.push((*low as u32, high as u32)));
        }
    }
    assert!(!expected.is_empty() && expected.iter().any(|(low, _)| *low as usize >= new - 16));
    let found: Vec<_> = edges.iter().map(|edge| (edge.low.0, edge.high.0)).collect();
    assert_eq!(found, expected);
    assert_eq!(asked.motions, (configs.len() - new) as u64 * u64::from(NEIGHBORS));
}

#[test]
fn until_joined_joins_what_nearest_nodes_joins_without_a_cycle() {
    let (setup, input) = input();
    let planners = default_planners();
    let all = NearestNodes { neighbors: NEIGHBORS, planners: planners.clone() };
    let few = UntilJoined { neighbors: NEIGHBORS, planners };
    let ((all, all_asked), (few, asked)) =
        (joined(&setup, &input, &all), joined(&setup, &input, &few));
    let (configs, inner) = whole(&input);
    let components = |joins: &[Edge]| {
        let edges = [&inner[..], joins].concat();
        Components::of(&setup.cx.space, &configs, &edges)
    };
    let (apart, by_all, by_few) = (components(&[]), components(&all), components(&few));
    for node in NodeId::each(NodeId(0)..NodeId(configs.len() as u32)) {
        assert_eq!(by_few.of_node(node).name, by_all.of_node(node).name);
    }
    // A forest: every edge joins two components.
    assert!(!few.is_empty());
    assert_eq!(few.len(), apart.count() - by_few.count());
    assert!(asked.motions < all_asked.motions && few.len() < all.len());
}

#[test]
fn nothing_is_joined_to_nothing() {
    let (setup, mut input) = input();
    input.roadmap = Arc::new(Roadmap::new(&setup.cx.space));
    input.increments.truncate(1);
    let planners = default_planners();
    let ways: [&dyn Among; 2] = [
        &NearestNodes { neighbors: 3, planners: planners.clone() },
        &UntilJoined { neighbors: 3, planners },
    ];
    for way in ways {
        assert_eq!(joined(&setup, &input, way), (Vec::new(), Asked::default()));
        let empty = JoinInput { roadmap: input.roadmap.clone(), increments: Vec::new() };
        assert_eq!(joined(&setup, &empty, way).0, []);
    }
}
