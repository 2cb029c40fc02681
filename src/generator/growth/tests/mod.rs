//! Trees and graphs against plain reimplementations, and what each method says of itself.

use crate::context::Context;
use crate::generator::{
    FoundNeighbors, Generator, GraphNeighbors, Mrrg, NeighborCount, Rrg, Rrt, RrtConnect,
};
use crate::img::{Setup, build};
use crate::math;
use crate::model::Scratch;
use crate::numbers::{NodeId, Ordinal};
use crate::problem::Problem;
use crate::roadmap::{Edge, Increment, Roadmap, SetForm};
use crate::seed::{Purpose, Seed};
use std::collections::BTreeSet;
use std::f64::consts::E;
use std::path::Path;
use std::sync::Arc;

mod local;
mod retraction;
mod settings;
mod sliding;

/// A bar in the plane that turns on its way through two passages.
const PLANE: &str = r#"
[space]
motion = "rigid-2d"
min = [0, 0]
max = [8, 6]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.0, 0.2, 1.0] } } }]
[[obstacles]]
shape = { box = { size = [0.3, 4.5, 1.0] } }
position = [3.0, 2.25, 0.0]
[[obstacles]]
shape = { box = { size = [0.3, 4.5, 1.0] } }
position = [5.0, 3.75, 0.0]
[query]
start = [1.0, 1.0, 0.0]
goal = [7.0, 5.0, 1.5]
"#;

/// A body that turns in space past a wall with a gap.
const SPACE: &str = r#"
[space]
motion = "rigid-3d"
min = [0, 0, 0]
max = [6, 4, 4]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.0, 0.3, 0.2] } } }]
[[obstacles]]
shape = { box = { size = [0.3, 3.0, 4.0] } }
position = [3.0, 1.5, 2.0]
[query]
start = [1, 1, 2, 1, 0, 0, 0]
goal = [5, 1, 2, 0.5, 0.5, 0.5, 0.5]
"#;

fn parse(text: &str) -> Problem {
    Problem::parse(Path::new("growth.toml"), text).unwrap_or_else(|error| panic!("{error}"))
}

/// A build of one strategy, in rounds of one set, without edges among sets that a tree would not have.
fn grown(scene: &str, generator: &str, nodes: u32, sets: u32) -> (Problem, Roadmap) {
    grown_in_rounds(scene, generator, nodes, sets, 1)
}

fn grown_in_rounds(
    scene: &str,
    generator: &str,
    nodes: u32,
    sets: u32,
    in_round: u32,
) -> (Problem, Roadmap) {
    let problem = parse(&format!(
        "{scene}[img]\nsets_per_round = {in_round}\n[limits]\nsets = {sets}\n\
         [[strategies]]\nlabel = \"it\"\nnodes = {nodes}\ngenerator = {generator}\n\
         among = {{ until-joined = {{}} }}\n\
         [[evaluators]]\nall = [{{ query = {{}} }}, {{ not = {{ query = {{}} }} }}]\n"
    ));
    let roadmap = build(&Arc::new(Setup::new(problem.clone()))).roadmap;
    (problem, roadmap)
}

/// The thesis' Algorithms 1 to 5 as they stand there, over one list of nodes: all neighbours by brute force.
struct Plain<'a> {
    cx: &'a Context,
    scratch: Scratch,
    nodes: Vec<Vec<f64>>,
    /// Pairs of nodes, the lower first.
    edges: BTreeSet<(usize, usize)>,
    step: f64,
    goal_bias: f64,
    /// Of RRG and mRRG.
    neighbors: Option<NeighborCount>,
    hop_limit: Option<usize>,
    directions: u32,
    trials: u32,
}

impl Plain<'_> {
    fn new<'a>(cx: &'a Context, step: f64, goal_bias: f64) -> Plain<'a> {
        let nodes = vec![cx.query().expect("a query").start.clone()];
        let (edges, scratch) = (BTreeSet::new(), Scratch::new());
        let (neighbors, directions, trials) = (None, 1, 1);
        let hop_limit = None;
        Plain {
            cx,
            scratch,
            nodes,
            edges,
            step,
            goal_bias,
            neighbors,
            hop_limit,
            directions,
            trials,
        }
    }

    fn by_distance(&self, q: &[f64]) -> Vec<usize> {
        let distance = |node: &usize| self.cx.space().distance(q, &self.nodes[*node]);
        let mut all: Vec<usize> = (0..self.nodes.len()).collect();
        all.sort_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b)));
        all
    }

    fn is_connectable(&mut self, a: &[f64], b: &[f64]) -> bool {
        self.cx.model().is_valid(b, &mut self.scratch)
            && self.cx.model().motion(a, b, 1, &mut self.scratch).is_some()
    }

    fn steer(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let (space, mut q) = (self.cx.space(), to.to_vec());
        let distance = space.distance(from, to);
        if distance > self.step {
            space.interpolate(from, to, self.step / distance, &mut q);
            space.canonicalize(&mut q).expect("it is a configuration");
        }
        q
    }

    fn expand(&mut self, near: usize, toward: &[f64]) -> bool {
        let from = self.nodes[near].clone();
        let q = self.steer(&from, toward);
        if q == from || !self.is_connectable(&from, &q) {
            return false;
        }
        let new = self.nodes.len();
        let mut others = Vec::new();
        if let Some(neighbors) = self.neighbors {
            let count = match neighbors {
                NeighborCount::Fixed(count) => count as usize,
                NeighborCount::Auto => ((2.0 * E * math::ln(new as f64)).floor() as usize).max(1),
            };
            others = self.by_distance(&q);
            if let Some(hops) = self.hop_limit {
                let within = self.within(near, hops);
                others.retain(|node| within.contains(node));
            }
            others.truncate(count);
        }
        self.nodes.push(q.clone());
        self.edges.insert((near, new));
        for other in others {
            let config = self.nodes[other].clone();
            if other != near && self.is_connectable(&config, &q) {
                self.edges.insert((other, new));
            }
        }
        true
    }

    /// SUBGRAPH_WITHIN_HOP_LIMIT of Algorithm 6, by the edges one after another.
    fn within(&self, node: usize, hops: usize) -> BTreeSet<usize> {
        let mut within = BTreeSet::from([node]);
        for _ in 0..hops {
            let reached = self.edges.iter().flat_map(|(a, b)| [(*a, *b), (*b, *a)]);
            let next: Vec<_> =
                reached.filter(|(a, _)| within.contains(a)).map(|(_, b)| b).collect();
            within.extend(next);
        }
        within
    }

    /// An independent angle: by the arc cosine, of coordinates times weights, in a space without rotations.
    fn angle(&self, at: &[f64], a: &[f64], b: &[f64]) -> f64 {
        let space = self.cx.space();
        let vector = |to: &[f64]| -> Vec<f64> {
            let parts = space.factors().iter().map(|factor| {
                let difference = to[factor.at] - at[factor.at];
                factor.weight
                    * match factor.kind {
                        crate::space::FactorKind::Angle => math::wrap_angle(difference),
                        _ => difference,
                    }
            });
            parts.collect()
        };
        let (a, b) = (vector(a), vector(b));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        math::acos(dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt())
    }

    /// Grows by one set of so many nodes, as its seed says.
    fn grow(&mut self, seed: &Seed, mut count: usize) {
        let (mut proposing, mut deciding) =
            (seed.stream(Purpose::Sampling), seed.stream(Purpose::Accepting));
        // The root is a node of the first set.
        count -= usize::from(seed.ordinal() == Ordinal(0));
        let full = self.nodes.len() + count;
        let goal = self.cx.query().expect("a query").goal.clone();
        let space = self.cx.space();
        let mut draw = || {
            let mut q = vec![0.0; space.len()];
            space.sample_uniform(&mut proposing, &mut q);
            q
        };
        while self.nodes.len() < full {
            let is_reached = self.nodes.contains(&goal);
            let toward_goal =
                self.goal_bias > 0.0 && !is_reached && deciding.unit() < self.goal_bias;
            let toward = if toward_goal { goal.clone() } else { draw() };
            let near = self.by_distance(&toward)[0];
            if !self.expand(near, &toward) {
                continue;
            }
            for _ in 1..self.directions {
                if self.nodes.len() == full {
                    break;
                }
                let at = self.nodes[near].clone();
                let adjacent: Vec<usize> = self
                    .edges
                    .iter()
                    .filter(|(a, b)| *a == near || *b == near)
                    .map(|(a, b)| if *a == near { *b } else { *a })
                    .collect();
                let (mut best, mut max_angle) = (Vec::new(), f64::NEG_INFINITY);
                for _ in 0..self.trials {
                    let q = draw();
                    let angles = adjacent.iter().map(|v| self.angle(&at, &self.nodes[*v], &q));
                    let min_angle = angles.fold(f64::INFINITY, f64::min);
                    if max_angle < min_angle {
                        (best, max_angle) = (q, min_angle);
                    }
                }
                self.expand(near, &best);
            }
        }
    }
}

fn pairs<'a>(edges: impl Iterator<Item = &'a Edge>) -> BTreeSet<(usize, usize)> {
    edges.map(|edge| (edge.low.index(), edge.high.index())).collect()
}

/// Node by node and edge by edge, for sets of one and of more nodes.
fn is_that_of_the_thesis(scene: &str, generator: &str, plain: impl Fn(&mut Plain)) {
    for (nodes, sets) in [(1, 90), (30, 3)] {
        let (problem, roadmap) = grown(scene, generator, nodes, sets);
        let cx = problem.context();
        let mut expected = Plain::new(&cx, 0.8, 0.0);
        plain(&mut expected);
        for ordinal in 0..u64::from(sets) {
            let seed = Seed::of_set(problem.seed(), "it", Ordinal(ordinal));
            expected.grow(&seed, nodes as usize);
        }
        let found: Vec<_> = roadmap.configs().iter().map(<[f64]>::to_vec).collect();
        assert_eq!(found, expected.nodes, "{generator}, {nodes} to a set");
        let edges: Vec<Edge> = roadmap.edges().iter().collect();
        assert_eq!(pairs(edges.iter()), expected.edges, "{generator}, {nodes} to a set");
        assert_eq!(edges.len(), expected.edges.len(), "no edge comes twice");
    }
}

#[test]
fn rrt_is_the_tree_of_the_thesis() {
    for scene in [PLANE, SPACE] {
        is_that_of_the_thesis(scene, "{ rrt = { step = 0.8, goal_bias = 0 } }", |_| {});
        let biased = "{ rrt = { step = 0.8, goal_bias = 0.3 } }";
        is_that_of_the_thesis(scene, biased, |plain| plain.goal_bias = 0.3);
    }
}

#[test]
fn rrg_is_the_graph_of_the_thesis() {
    for scene in [PLANE, SPACE] {
        let auto = "{ rrg = { step = 0.8, goal_bias = 0 } }";
        is_that_of_the_thesis(scene, auto, |plain| plain.neighbors = Some(NeighborCount::Auto));
        let few = "{ rrg = { step = 0.8, goal_bias = 0, neighbors = 4 } }";
        is_that_of_the_thesis(scene, few, |p| p.neighbors = Some(NeighborCount::Fixed(4)));
    }
}

#[test]
fn mrrg_is_the_graph_of_the_thesis() {
    let settings = "step = 0.8, goal_bias = 0, neighbors = 3, directions = 4, trials = 5";
    is_that_of_the_thesis(PLANE, &format!("{{ mrrg = {{ {settings} }} }}"), |plain| {
        plain.neighbors = Some(NeighborCount::Fixed(3));
        (plain.directions, plain.trials) = (4, 5);
    });
    let tree = "step = 0.8, goal_bias = 0, neighbors = 0";
    is_that_of_the_thesis(PLANE, &format!("{{ mrrg = {{ {tree} }} }}"), |plain| {
        (plain.directions, plain.trials) = (3, 3);
    });
}

#[test]
fn neighbours_within_a_hop_limit_are_those_of_the_thesis() {
    let settings = |hops: usize| {
        format!(
            "step = 0.8, goal_bias = 0, neighbors = {{ hop_limit = {hops}, \
             finder = {{ brute-force = {{ neighbors = \"auto\" }} }} }}"
        )
    };
    for (scene, hops) in [(PLANE, 1), (PLANE, 3), (SPACE, 2)] {
        let generator = format!("{{ rrg = {{ {} }} }}", settings(hops));
        is_that_of_the_thesis(scene, &generator, |plain| {
            plain.neighbors = Some(NeighborCount::Auto);
            plain.hop_limit = Some(hops);
        });
    }
    let generator = format!("{{ mrrg = {{ {}, directions = 4, trials = 5 }} }}", settings(2));
    is_that_of_the_thesis(PLANE, &generator, |plain| {
        plain.neighbors = Some(NeighborCount::Auto);
        plain.hop_limit = Some(2);
        (plain.directions, plain.trials) = (4, 5);
    });
}

/// Exact finders, and a limit beyond the graph's size, give the graph that the nearest nodes give.
#[test]
fn exact_finders_grow_one_graph() {
    let digest = |generator: &str| grown(SPACE, generator, 40, 4).1.digest();
    let expected = digest("{ rrg = { step = 1.0 } }");
    for neighbors in [
        "\"auto\"",
        "{}",
        "{ finder = { k-nearest = { neighbors = \"auto\" } } }",
        "{ finder = { brute-force = { neighbors = \"auto\" } } }",
        "{ finder = { metric-tree = { neighbors = \"auto\" } } }",
        "{ finder = { approximate = { neighbors = \"auto\", epsilon = 0 } } }",
        "{ hop_limit = 200 }",
    ] {
        let generator = format!("{{ rrg = {{ step = 1.0, neighbors = {neighbors} }} }}");
        assert_eq!(digest(&generator), expected, "{generator}");
    }
    for neighbors in [
        "{ finder = { approximate = { neighbors = \"auto\", epsilon = 2 } } }",
        "{ finder = { randomised = { neighbors = \"auto\" } } }",
        "{ finder = { randomised = {} }, hop_limit = 4 }",
        "{ finder = { radius = { radius = 1.0, most = 5 } } }",
        "{ hop_limit = 1 }",
    ] {
        let generator = format!("{{ rrg = {{ step = 1.0, neighbors = {neighbors} }} }}");
        assert_ne!(digest(&generator), expected, "{generator}");
        assert_eq!(digest(&generator), digest(&generator), "{generator}");
    }
}

/// Without a node to grow from a set begins at a root of its own; neighbours are its milestones only.
#[test]
fn hop_limits_hold_where_a_set_begins_at_no_node() {
    let found = FoundNeighbors { hop_limit: Some(2), ..FoundNeighbors::default() };
    let limited = Rrg { neighbors: GraphNeighbors::Found(found), ..Rrg::default() };
    let (problem, _) = grown(PLANE, "{ rrt = {} }", 2, 1);
    let cx = problem.context();
    let made = make(&cx, &limited, 3, None);
    let all = make(&cx, &Rrg::default(), 3, None);
    assert!(made.root_edges.is_empty() && all.root_edges.is_empty());
    // Edges do not decide where a graph grows, and within two edges there are some.
    assert_eq!(made.configs, all.configs);
    assert!(made.edges.len() > made.configs.len());
}

fn make(cx: &Context, method: &dyn Generator, ordinal: u64, frozen: Option<&Roadmap>) -> Increment {
    let seed = Seed::of_set(1, "it", Ordinal(ordinal));
    let made = method.generate(cx, &seed, 40, frozen, &mut Scratch::new());
    made.unwrap_or_else(|gave_up| panic!("{gave_up:?}"))
}

/// The laws that all generators keep (`src/generator/tests.rs`), of those that need a query.
#[test]
fn sets_have_as_many_valid_milestones_as_they_should_and_valid_edges() {
    for scene in [PLANE, SPACE] {
        let (_, frozen) = grown_in_rounds(scene, "{ rrg = { step = 1.0 } }", 20, 8, 2);
        for generator in ["rrt", "rrg", "mrrg", "rrt-connect"] {
            let (problem, _) = grown(scene, &format!("{{ {generator} = {{}} }}"), 2, 1);
            let cx = problem.context();
            let strategy = problem.strategies[0].generator.method();
            for (ordinal, frozen) in [(0, None), (1, None), (0, Some(&frozen)), (7, Some(&frozen))]
            {
                let made = make(&cx, strategy, ordinal, frozen);
                let scratch = &mut Scratch::new();
                assert_eq!(made.configs.len(), 40, "{generator}");
                assert!(made.configs.iter().all(|q| cx.model.is_valid(q, scratch)), "{generator}");
                let form = SetForm::of(problem.model.description());
                let nodes = frozen.map_or(0, |frozen| frozen.configs().len());
                assert!(made.is_sound(form, nodes as u64), "{generator}");
                assert_eq!(!made.root_edges.is_empty(), frozen.is_some(), "{generator}");
                let new = |node: NodeId| made.configs.get(node.index());
                let old = |node: NodeId| frozen.expect("roots are old").configs().get(node.index());
                let own = made.edges.iter().map(|edge| (new(edge.low), edge));
                let of_roots = made.root_edges.iter().map(|edge| (old(edge.low), edge));
                for (low, edge) in own.chain(of_roots) {
                    assert!(cx.model.motion(low, new(edge.high), 1, scratch).is_some());
                    assert_eq!(edge.weight(), cx.space.distance(low, new(edge.high)));
                }
                // Whatever the scratch was used for.
                let seed = Seed::of_set(1, "it", Ordinal(ordinal));
                scratch.poison(0x7ff0_dead_beef_0001);
                let again = strategy.generate(&cx, &seed, 40, frozen, scratch);
                assert_eq!(again.expect("it is a function").configs, made.configs, "{generator}");
                let other = make(&cx, strategy, ordinal + 2, frozen);
                assert_ne!(other.configs, made.configs, "{generator}");
            }
        }
    }
}

/// Numbers of neighbours have the bytes that they had before there were other finders.
#[test]
fn bytes_of_numbers_of_neighbours_stay() {
    for (neighbors, count) in [
        (GraphNeighbors::Auto, NeighborCount::Auto),
        (GraphNeighbors::Fixed(7), NeighborCount::Fixed(7)),
    ] {
        assert_eq!(crate::wire::encode(&neighbors), crate::wire::encode(&count));
        assert_eq!(neighbors, count.into());
    }
}

/// The thesis' Lemma 1.
#[test]
fn with_one_direction_mrrg_is_rrg_and_without_neighbours_rrt() {
    for scene in [PLANE, SPACE] {
        let (problem, frozen) = grown(scene, "{ rrg = { step = 1.0 } }", 20, 3);
        let cx = problem.context();
        let one = Mrrg { directions: 1, ..Mrrg::default() };
        let tree = Mrrg { neighbors: GraphNeighbors::Fixed(0), ..one.clone() };
        for ordinal in 0..4 {
            for frozen in [None, Some(&frozen)] {
                let of = |method: &dyn Generator| make(&cx, method, ordinal, frozen);
                assert_eq!(of(&one), of(&Rrg::default()));
                assert_eq!(of(&tree), of(&Rrt::default()));
                assert_ne!(of(&Mrrg::default()).configs, of(&one).configs);
            }
        }
    }
}

#[test]
fn a_tree_has_one_edge_less_than_nodes_and_no_edge_is_longer_than_a_step() {
    for generator in [
        "{ rrt = { step = 0.7 } }",
        "{ mrrg = { step = 0.7, neighbors = 0, directions = 5 } }",
        "{ rrt-connect = { step = 0.7 } }",
    ] {
        let (problem, roadmap) = grown(PLANE, generator, 25, 12);
        let (nodes, edges) = (roadmap.configs().len(), roadmap.edges().len());
        let components = roadmap.components().count();
        assert_eq!(nodes, 300);
        assert_eq!(edges, nodes - components, "{generator} has no cycle");
        let is_connect = generator.contains("connect");
        assert!(components == 1 || components == 2 && is_connect, "{generator}");
        let longest = roadmap.edges().iter().map(|edge| edge.weight()).fold(0.0, f64::max);
        // What joins two trees among sets can be longer.
        assert!(longest <= 0.7 + 1e-9 || components == 1 && is_connect, "{generator}: {longest}");
        let ends = problem.query().expect("a query");
        assert!(roadmap.configs().get(0) == ends.start, "{generator}");
    }
}

#[test]
fn the_goal_is_reached_and_comes_once() {
    for generator in ["rrt", "rrg", "mrrg"] {
        let settings = format!("{{ {generator} = {{ step = 0.8, goal_bias = 0.2 }} }}");
        let (problem, roadmap) = grown(PLANE, &settings, 20, 40);
        let goal = &problem.query().expect("a query").goal;
        let there = roadmap.configs().iter().filter(|q| q == goal).count();
        assert_eq!(there, 1, "{generator}");
    }
}

/// The sets of a round do not see one another, and the ends are nodes all the same, once each.
#[test]
fn sets_of_the_first_round_share_the_ends() {
    let generators = [("rrt", false), ("rrg", false), ("mrrg", false), ("rrt-connect", true)];
    for (generator, has_both) in generators {
        for (nodes, sets) in [(1, 40), (10, 16)] {
            let settings = format!("{{ {generator} = {{ step = 0.8 }} }}");
            let (problem, roadmap) = grown_in_rounds(PLANE, &settings, nodes, sets, 4);
            let query = problem.query().expect("a query");
            let count = |end: &Vec<f64>| roadmap.configs().iter().filter(|q| q == end).count();
            assert_eq!(count(&query.start), 1, "{generator}, {nodes}");
            // Others reach the goal, which several sets of a round may do.
            assert!(!has_both || count(&query.goal) == 1, "{generator}, {nodes}");
            let start = roadmap.configs().iter().position(|q| q == query.start);
            let start = NodeId(start.expect("it is there") as u32);
            assert!(roadmap.components().of_node(start).members.len() > 1, "{generator}, {nodes}");
        }
    }
}

#[test]
fn two_trees_meet_and_then_explore() {
    for (scene, step) in [(PLANE, 0.6), (SPACE, 1.0)] {
        let method = RrtConnect { step: Some(step), ..RrtConnect::default() };
        let (problem, _) = grown(scene, "{ rrt = {} }", 2, 1);
        let (cx, seed) = (problem.context(), Seed::of_set(1, "it", Ordinal(0)));
        let made = |count| {
            let made = method.generate(&cx, &seed, count, None, &mut Scratch::new());
            made.unwrap_or_else(|gave_up| panic!("{gave_up:?}"))
        };
        // A larger set begins with the smaller one. Before the trees meet there are two, then there is one.
        let parts: Vec<usize> = (2..200)
            .map(|count| {
                let made = made(count);
                let query = cx.query().expect("a query");
                assert!(made.configs.get(0) == query.start && made.configs.get(1) == query.goal);
                count - made.edges.len()
            })
            .collect();
        let met = parts.iter().position(|parts| *parts == 1).expect("they meet");
        assert!(met > 3, "not at once");
        let (before, after) = parts.split_at(met);
        assert!(before.iter().all(|parts| *parts == 2) && after.iter().all(|parts| *parts == 1));
    }
}

/// A greedy extension in the open leads to the other tree at once.
#[test]
fn trees_in_the_open_meet_by_one_greedy_extension() {
    let open = PLANE.split("[[obstacles]]").next().expect("it begins").to_owned();
    let scene = open + "[query]\nstart = [1, 1, 0]\ngoal = [7, 5, 0.5]\n";
    let (_, roadmap) = grown(&scene, "{ rrt-connect = { step = 0.5 } }", 20, 1);
    assert_eq!(roadmap.components().count(), 1);
    // The two ends, one step from the start, and then a row of nodes from the goal on.
    let edges = pairs(roadmap.edges().iter().collect::<Vec<_>>().iter());
    assert!(edges.contains(&(0, 2)) && edges.contains(&(1, 3)), "{edges:?}");
    assert!((4..14).all(|node| edges.contains(&(node - 1, node))), "{edges:?}");
}

#[test]
fn independent_trees_are_trees_of_their_own() {
    let (problem, _) = grown(PLANE, "{ tree = { step = 0.5 } }", 20, 4);
    let cx = problem.context();
    let generator = problem.strategies[0].generator.method();
    let mut roots = BTreeSet::new();
    for ordinal in 0..6 {
        let made = make(&cx, generator, ordinal, None);
        assert!(made.root_edges.is_empty());
        assert_eq!(made.edges.len(), 39);
        // Every node after the root hangs at one before it.
        let high: Vec<_> = made.edges.iter().map(|edge| edge.high.0).collect();
        assert_eq!(high, (1..40).collect::<Vec<_>>());
        roots.insert(made.configs.get(0)[0].to_bits());
    }
    assert_eq!(roots.len(), 6);
}
