use super::*;
use crate::img::{Setup, build};
use crate::model::Asked;
use crate::numbers::{NodeId, Ordinal};
use crate::problem::Problem;
use std::collections::BTreeSet;
use std::path::Path;

const NEIGHBORS: u32 = 4;

fn seed() -> Seed {
    Seed::of_set(1, "joined", Ordinal(4))
}

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
    (setup, JoinInput { roadmap, increments, seed: seed() })
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
        let empty = JoinInput { increments: Vec::new(), ..input.clone() };
        assert_eq!(joined(&setup, &empty, way).0, []);
    }
}

/// The components of everything before the round and in it, with joining edges.
fn components(setup: &Setup, input: &JoinInput, joins: &[Edge]) -> Components {
    let (configs, inner) = whole(input);
    Components::of(setup.context().space(), &configs, &[&inner[..], joins].concat())
}

fn names(components: &Components) -> Vec<NodeId> {
    let nodes = (0..components.nodes()).map(NodeId);
    nodes.map(|node| components.of_node(node).name).collect()
}

#[test]
fn nodes_and_components_join_what_either_joins() {
    let (setup, input) = input();
    let nodes = NearestNodes { neighbors: NEIGHBORS, ..NearestNodes::default() };
    let pairs = ComponentPairs::default();
    let by = |cycles| NodesAndComponents {
        neighbors: NEIGHBORS,
        cycles,
        ..NodesAndComponents::default()
    };
    let (by_nodes, nodes_asked) = joined(&setup, &input, &nodes);
    let (by_pairs, pairs_asked) = joined(&setup, &input, &pairs);
    let either = [by_nodes, by_pairs].concat();
    let expected = names(&components(&setup, &input, &either));
    let tried_by_either: BTreeSet<(NodeId, NodeId)> =
        either.iter().map(|e| (e.low, e.high)).collect();
    let mut counts = Vec::new();
    for cycles in [0, 1, NEIGHBORS] {
        let (edges, asked) = joined(&setup, &input, &by(cycles));
        assert_eq!(names(&components(&setup, &input, &edges)), expected);
        assert!(asked.motions <= nodes_asked.motions + pairs_asked.motions);
        assert!(edges.iter().all(|edge| tried_by_either.contains(&(edge.low, edge.high))));
        counts.push(edges.len());
    }
    // Without cycles a forest; with all of them every edge that nearest nodes find.
    let (apart, after) = (components(&setup, &input, &[]), components(&setup, &input, &either));
    assert_eq!(counts[0], apart.count() - after.count());
    assert!(counts[0] < counts[1] && counts[1] < counts[2]);
}

/// A small disc in a room of 100 by 10, with the walls that are given by their x.
fn room(walls: &[f64]) -> Setup {
    let mut text = "space = { motion = \"translation-2d\", min = [0.0, 0.0], max = [100.0, 10.0], \
                    bounds = \"reference\" }\n\
                    robot = { bodies = [{ shape = { sphere = { radius = 0.1 } } }] }\n"
        .to_owned();
    for x in walls {
        text += &format!(
            "[[obstacles]]\nshape = {{ box = {{ size = [0.2, 20.0, 1.0] }} }}\nposition = [{x:?}, 5.0, 0.0]\n"
        );
    }
    Setup::new(Problem::parse(Path::new("room.toml"), &text).unwrap())
}

/// Milestones, and edges among them.
type Set<'a> = (&'a [[f64; 2]], &'a [(u32, u32)]);

/// A roadmap of one set, and the sets of the round after it.
fn after(setup: &Setup, roadmap: Set, round: &[Set]) -> JoinInput {
    let space = setup.context().space();
    let increment = |(points, edges): Set| {
        let mut increment = Increment::empty(2);
        points.iter().for_each(|point| increment.configs.push(point));
        increment.edges =
            edges.iter().map(|(a, b)| Edge::metric(NodeId(*a), NodeId(*b), 0, 1.0)).collect();
        increment
    };
    let mut old = Roadmap::new(space);
    old.fold_round(space, [(&increment(roadmap), &[][..])]);
    let built = |set: &Set| Arc::new(Built::new(setup.context(), Arc::new(increment(*set))));
    let increments = round.iter().map(built).collect();
    JoinInput { roadmap: Arc::new(old), increments, seed: seed() }
}

fn ends(edges: &[Edge]) -> Vec<(u32, u32)> {
    edges.iter().map(|edge| (edge.low.0, edge.high.0)).collect()
}

#[test]
fn a_node_whose_nearest_are_behind_a_wall_is_joined_by_components() {
    let setup = room(&[50.0]);
    let behind: Vec<[f64; 2]> = (0..12).map(|i| [49.0, 2.0 + 0.5 * f64::from(i)]).collect();
    let chain: Vec<(u32, u32)> = (0..11).map(|i| (i, i + 1)).collect();
    let points = [&behind[..], &[[90.0, 5.0]]].concat();
    let input = after(&setup, (&points, &chain), &[(&[[51.0, 5.0]], &[])]);
    assert_eq!(joined(&setup, &input, &NearestNodes::default()).0, []);
    let edges = joined(&setup, &input, &NodesAndComponents::default()).0;
    assert_eq!(ends(&edges), [(12, 13)]);
}

#[test]
fn a_component_whose_centre_is_far_away_is_joined_by_its_nodes() {
    let setup = room(&[97.0]);
    // A component with a node at either end, and three of one node each beyond a wall, whose centres are nearer.
    let points = [[1.0, 5.0], [99.0, 5.0], [92.0, 2.0], [92.0, 5.0], [92.0, 8.0]];
    let input = after(&setup, (&points, &[(0, 1)]), &[(&[[98.0, 5.0]], &[])]);
    assert_eq!(joined(&setup, &input, &ComponentPairs::default()).0, []);
    let edges = joined(&setup, &input, &NodesAndComponents::default()).0;
    assert_eq!(ends(&edges), [(1, 5)]);
}

#[test]
fn the_components_of_a_round_take_no_places_of_the_roadmaps() {
    let setup = room(&[]);
    let near: &[[f64; 2]] = &[[48.0, 5.0], [49.0, 5.0], [51.0, 5.0], [52.0, 5.0]];
    let input = after(&setup, (&[[5.0, 5.0]], &[]), &[(near, &[]), (&[[50.0, 5.0]], &[])]);
    let way = ComponentPairs { components: 2, ..ComponentPairs::default() };
    assert_eq!(ends(&joined(&setup, &input, &way).0), [(0, 5), (2, 5), (3, 5)]);
}
