//! Known answers, and laws of words.

use super::*;
use crate::cancel::Cancel;
use crate::context::Ends;
use crate::numbers::Ordinal;
use crate::pathways::classes::{EdgeCrossings, shortest_of_classes};
use crate::pathways::{Distinct, distinct};
use crate::problem::Problem;
use crate::query::{Attachment, Ways};
use crate::roadmap::{Configs, Edge, Increment, Roadmap, Route};
use crate::seed::{Purpose, Seed, Stream};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::path::Path as FilePath;

fn at(points: &[[f64; 2]]) -> Punctures {
    let pieces = (0..points.len()).map(|obstacle| [obstacle, 0]).collect();
    Punctures::at(points.to_vec(), pieces)
}

/// The word of a path over these points, as text.
fn word(punctures: &Punctures, points: &[[f64; 2]]) -> String {
    punctures.text(&punctures.word(points.iter().copied()))
}

#[test]
fn an_obstacle_is_passed_on_either_side() {
    let one = at(&[[0.0, 0.0]]);
    let [start, goal] = [[-2.0, 0.0], [2.0, 0.0]];
    assert_eq!(word(&one, &[start, [0.0, -1.0], goal]), "-");
    assert_eq!(word(&one, &[start, [0.0, 1.0], goal]), "1");
    assert_eq!(word(&one, &[goal, [0.0, 1.0], start]), "-1");
    // A way there and back is no way.
    assert_eq!(word(&one, &[start, [0.5, 1.0], [-0.5, 1.2], [0.5, 3.0], goal]), "1");
    assert_eq!(word(&one, &[start, [0.5, 1.0], [-0.5, 1.2], [-1.0, -3.0], goal]), "-");
}

#[test]
fn an_obstacle_can_be_gone_around_more_than_once() {
    let one = at(&[[0.0, 0.0]]);
    let around = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];
    let path = |rounds: usize| {
        let mut path = vec![[-2.0, 0.0]];
        (0..rounds).for_each(|_| path.extend(around));
        path.extend([[0.0, -1.0], [2.0, 0.0]]);
        path
    };
    assert_eq!(word(&one, &path(1)), "-1");
    assert_eq!(word(&one, &path(2)), "-1 -1");
    // And back again the other way.
    let mut both = path(2);
    both.pop();
    both.extend(around.iter().rev());
    both.extend(around.iter().rev());
    assert_eq!(word(&one, &both), "-");
}

#[test]
fn two_obstacles_have_four_classes_and_their_loops_do_not_commute() {
    let two = at(&[[-1.0, 0.0], [1.0, 0.5]]);
    let [start, goal] = [[-3.0, 0.0], [3.0, 0.0]];
    let over = |first: f64, second: f64| {
        word(&two, &[start, [-1.0, first], [0.0, 0.2], [1.0, second], goal])
    };
    let words = [over(-2.0, -2.0), over(2.0, -2.0), over(-2.0, 2.0), over(2.0, 2.0)];
    assert_eq!(words, ["-", "1", "2", "1 2"]);
    // Around the first and then the second is not around the second and then the first.
    let around = |x: f64, y: f64| {
        [[0.0, -5.0], [x, y - 0.3], [x + 0.3, y], [x, y + 0.3], [x - 0.3, y], [0.0, -5.0]]
    };
    let (first, second) = (around(-1.0, 0.0), around(1.0, 0.5));
    let [there, back] = [[first, second], [second, first]].map(|loops| word(&two, &loops.concat()));
    assert_eq!((&there[..], &back[..]), ("-1 -2", "-2 -1"));
    // The word of both loops, undone in the wrong order, is the commutator, which no counting of turns tells from nothing.
    let undone = [first, second].map(|mut path| {
        path.reverse();
        path
    });
    let commutator = [first, second, undone[0], undone[1]].concat();
    assert_eq!(word(&two, &commutator), "-1 -2 1 2");
}

#[test]
fn punctures_above_one_another_are_told_apart() {
    let two = at(&[[0.0, 0.0], [0.0, 1.0]]);
    let [start, goal] = [[-2.0, 0.0], [2.0, 0.0]];
    assert_eq!(word(&two, &[start, [0.0, -1.0], goal]), "-");
    assert_eq!(word(&two, &[start, [0.0, 0.5], goal]), "1");
    assert_eq!(word(&two, &[start, [0.0, 2.0], goal]), "1 2");
    assert_eq!(word(&two, &[goal, [0.0, 2.0], start]), "-2 -1");
    // Between them and back above both: around the upper one.
    assert_eq!(word(&two, &[start, [0.0, 0.5], [1.0, 1.0], [0.0, 2.0], start]), "1 -2 -1");
    // Along the rays themselves nothing is crossed twice.
    assert_eq!(word(&two, &[start, [0.0, 3.0], [0.0, 2.0], [0.0, 5.0], goal]), "1 2");
}

fn point(stream: &mut Stream) -> [f64; 2] {
    [0; 2].map(|_| (8.0 * stream.unit()).round() / 2.0 - 2.0)
}

/// Whether a triangle has a puncture in it or on its border.
fn holds(punctures: &Punctures, [a, b, c]: [[f64; 2]; 3]) -> bool {
    let side = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| {
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
    };
    punctures.points().iter().any(|p| {
        let sides = [side(a, b, *p), side(b, c, *p), side(c, a, *p)];
        sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
    })
}

proptest! {
    /// A corner drawn over a triangle without a puncture changes no word: these are the deformations of paths along straight
    /// ways. Points lie on a grid, half a step from punctures, so that much lies above one another.
    #[test]
    fn deformed_paths_have_the_word_that_they_had(ordinal in any::<u64>(), count in 1usize..6) {
        let mut stream = Seed::of_set(1, "deformed", Ordinal(ordinal)).stream(Purpose::Sampling);
        let points: Vec<[f64; 2]> =
            (0..count).map(|_| point(&mut stream).map(|value| value + 0.25)).collect();
        let punctures = at(&points);
        let mut path: Vec<[f64; 2]> = (0..8).map(|_| point(&mut stream)).collect();
        let word = punctures.word(path.iter().copied());
        prop_assert!(word.windows(2).all(|two| two[0] != two[1].reversed()));
        let mut moves = 0;
        for _ in 0..60 {
            let between = 1 + stream.below(path.len() as u64 - 1) as usize;
            let corner = point(&mut stream);
            if !holds(&punctures, [path[between - 1], corner, path[between]]) {
                path.insert(between, corner);
                moves += 1;
            }
            prop_assert_eq!(&punctures.word(path.iter().copied()), &word);
        }
        prop_assert!(moves > 0 || count > 2);
        // There and back is nothing, and words of parts make that of the whole.
        let back: Vec<[f64; 2]> = path.iter().rev().copied().collect();
        prop_assert!(punctures.word(path.iter().chain(&back).copied()).is_empty());
        let mut whole = punctures.word(path[..4].iter().copied());
        append(&mut whole, punctures.word(path[3..].iter().copied()));
        prop_assert_eq!(whole, word);
    }

    /// For one puncture the word is the number of turns, which angles give.
    #[test]
    fn the_word_about_one_point_counts_turns(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(1, "turns", Ordinal(ordinal)).stream(Purpose::Sampling);
        let punctures = at(&[[0.25, 0.25]]);
        let mut path: Vec<[f64; 2]> = (0..12).map(|_| point(&mut stream)).collect();
        path.push(path[0]);
        let angle = |[x, y]: [f64; 2]| crate::math::atan2(y - 0.25, x - 0.25);
        let turned: f64 =
            path.windows(2).map(|two| crate::math::wrap_angle(angle(two[1]) - angle(two[0]))).sum();
        let on_line = path.windows(2).any(|two| {
            holds(&punctures, [two[0], two[1], two[1]])
        });
        prop_assume!(!on_line);
        let word = punctures.word(path.iter().copied());
        let sum: i64 = word.iter().map(|crossing| if crossing.rightwards { -1 } else { 1 }).sum();
        prop_assert_eq!(sum, (turned / crate::math::TURN).round() as i64);
        prop_assert_eq!(word.len() as i64, sum.abs());
    }
}

fn scene(motion: &str, robot: &str, obstacles: &str, ends: [&str; 2]) -> Problem {
    let corner =
        if motion.ends_with("2d") { ["[0, 0]", "[8, 6]"] } else { ["[0, 0, 0]", "[8, 6, 6]"] };
    let text = format!(
        "[space]\nmotion = \"{motion}\"\nmin = {}\nmax = {}\nbounds = \"reference\"\n\
         [robot]\nbodies = [{robot}]\n{obstacles}[query]\nstart = {}\ngoal = {}\n",
        corner[0], corner[1], ends[0], ends[1]
    );
    Problem::parse(FilePath::new("topology.toml"), &text).unwrap_or_else(|error| panic!("{error}"))
}

fn boxes(places: &[[f64; 3]]) -> String {
    let one = |[x, y, z]: &[f64; 3]| {
        format!(
            "[[obstacles]]\nshape = {{ box = {{ size = [1, 1, 1] }} }}\nposition = [{x}, {y}, {z}]\n"
        )
    };
    places.iter().map(one).collect()
}

/// A grid of nodes, each joined with those beside it if that is valid.
fn grid(problem: &Problem, columns: u32, rows: u32) -> Roadmap {
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let mut increment = Increment::empty(2);
    let place = |column: u32, row: u32| {
        [
            0.4 + 7.2 * f64::from(column) / f64::from(columns - 1),
            0.4 + 5.2 * f64::from(row) / f64::from(rows - 1),
        ]
    };
    let mut configs = Configs::new(2);
    (0..columns * rows).for_each(|node| configs.push(&place(node % columns, node / columns)));
    let is_valid =
        |node: u32, scratch: &mut Scratch| cx.model().is_valid(configs.get(node as usize), scratch);
    for high in 0..columns * rows {
        let beside = [(high % columns > 0).then(|| high - 1), high.checked_sub(columns)];
        for low in beside.into_iter().flatten() {
            let (a, b) = (configs.get(low as usize), configs.get(high as usize));
            if is_valid(low, scratch)
                && is_valid(high, scratch)
                && cx.model().motion(a, b, 1, scratch).is_some()
            {
                let weight = cx.space().distance(a, b);
                let [low, high] = [low, high].map(crate::numbers::NodeId);
                increment.edges.push(Edge::metric(low, high, 0, weight));
            }
        }
    }
    increment.configs = configs;
    let mut roadmap = Roadmap::new(cx.space());
    roadmap.fold_round(cx.space(), [(&increment, &[][..])]);
    roadmap
}

fn asked(count: usize) -> Distinct {
    Distinct { count, spacing: 0.2, tries: 40, shortcuts: 20 }
}

/// All classes up to a length, by walking through the grid in every way.
fn classes_of_all_walks(
    roadmap: &Roadmap,
    punctures: &Punctures,
    [from, to]: [u32; 2],
    longest: f64,
) -> BTreeSet<(u64, String)> {
    let point = |node: u32| {
        let q = roadmap.configs().get(node as usize);
        [q[0], q[1]]
    };
    let edges: Vec<Edge> = roadmap.edges().iter().collect();
    let mut shortest = std::collections::BTreeMap::<(u32, String), f64>::new();
    let mut open = vec![(vec![from], 0.0)];
    while let Some((walk, length)) = open.pop() {
        let here = walk[walk.len() - 1];
        let word = punctures.text(&punctures.word(walk.iter().map(|node| point(*node))));
        let best = shortest.entry((here, word)).or_insert(f64::INFINITY);
        if length >= *best - 1e-9 {
            continue;
        }
        *best = length;
        for edge in &edges {
            let next = match (edge.low.0, edge.high.0) {
                (low, high) if low == here => high,
                (low, high) if high == here => low,
                _ => continue,
            };
            if length + edge.weight() <= longest {
                open.push(([&walk[..], &[next]].concat(), length + edge.weight()));
            }
        }
    }
    let ends = shortest.into_iter().filter(|((node, _), _)| *node == to);
    ends.map(|((_, word), length)| ((length * 1e6).round() as u64, word)).collect()
}

/// The routes of all classes, of which no shorter one is missing.
#[test]
fn the_shortest_route_of_every_class_is_found() {
    let obstacles = boxes(&[[2.4, 3.0, 0.0], [5.6, 3.2, 0.0]]);
    let point = "{ shape = { point = {} } }";
    let problem = scene("translation-2d", point, &obstacles, ["[0.4, 3]", "[7.6, 3]"]);
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let topology = Topology::of(&cx, problem.model().description(), scratch).expect("bodies");
    let punctures = topology.punctures().expect("it is planar");
    assert_eq!(punctures.points(), [[2.4, 3.0], [5.6, 3.2]]);
    let roadmap = grid(&problem, 6, 5);
    // The ends are the nodes in the middle of the first and last column, and attached to nothing else.
    let [start, goal] = [12, 17].map(|node| roadmap.configs().get(node).to_vec());
    let ends = Ends::new(start, goal);
    let attachment = Attachment { neighbors: 1, ..Attachment::default() };
    let configs = [&ends.start[..], &ends.goal];
    let mut ways = Ways::between(&cx, &roadmap, configs, &attachment, scratch);
    let crossings = EdgeCrossings::of(&ways, punctures, |q| topology.point(q));
    let mut shortest = |ways: &mut Ways, cancel: &Cancel| {
        let found = shortest_of_classes(ways, &crossings, 12, cancel, scratch);
        assert!(!found.has_failed);
        found.routes
    };
    let routes = shortest(&mut ways, &Cancel::new());
    assert_eq!(routes.len(), 12);
    assert!(routes.is_sorted_by(|a, b| a.length <= b.length));
    let longest = routes[11].length;
    let text = |route: &Route| {
        let path = ways.path(route);
        punctures.text(&punctures.word(path.configs.iter().map(|q| topology.point(q))))
    };
    let own = routes.iter().filter(|route| route.length < longest - 1e-6);
    let own: BTreeSet<(u64, String)> =
        own.map(|route| ((route.length * 1e6).round() as u64, text(route))).collect();
    let all = classes_of_all_walks(&roadmap, punctures, [12, 17], longest - 1e-6);
    assert_eq!(own, all);
    let first: BTreeSet<String> = routes[..4].iter().map(text).collect();
    assert_eq!(first, ["-", "1", "2", "1 2"].map(str::to_owned).into());
    // An edge that has failed the finer check is not gone along.
    let without = routes[0].edges[1];
    ways.failed.insert(without);
    let others = shortest(&mut ways, &Cancel::new());
    assert!(others.iter().all(|route| !route.edges.contains(&without)));
    assert!(others[0].length >= routes[0].length && others.len() == 12);
    // Nor is anything looked for once the search is cancelled.
    let cancel = Cancel::new();
    cancel.cancel();
    assert!(shortest(&mut ways, &cancel).is_empty());
}

#[test]
fn paths_are_shortened_within_their_class() {
    let obstacles = boxes(&[[2.4, 3.0, 0.0], [5.6, 3.2, 0.0]]);
    let robot = "{ shape = { box = { size = [0.3, 0.3, 0.3] } } }";
    let problem = scene("translation-2d", robot, &obstacles, ["[0.4, 3]", "[7.6, 3]"]);
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let topology = Topology::of(&cx, problem.model().description(), scratch).expect("bodies");
    let (roadmap, ends) = (grid(&problem, 9, 9), cx.query().expect("a query").clone());
    let attachment = Attachment::default();
    let with = |shortcuts: u32, scratch: &mut Scratch| {
        let asked = Distinct { shortcuts, ..asked(4) };
        let cancel = Cancel::new();
        distinct(&cx, &roadmap, &ends, &attachment, &topology, &asked, &cancel, scratch)
            .expect("few frames")
    };
    let [long, short] = [0, 50].map(|shortcuts| with(shortcuts, scratch));
    let classes = |found: &crate::pathways::DistinctPathways| {
        found.classes.iter().cloned().collect::<BTreeSet<_>>()
    };
    assert_eq!((classes(&long).len(), classes(&short)), (4, classes(&long)));
    let sum = |found: &crate::pathways::DistinctPathways| {
        found.pathways.pathways.iter().map(|pathway| pathway.frames.length()).sum::<f64>()
    };
    assert!(sum(&short) < sum(&long) - 0.5, "{} {}", sum(&short), sum(&long));
    for (class, pathway) in short.classes.iter().zip(&short.pathways.pathways) {
        assert_eq!(*class, topology.class(&cx, &pathway.path, &pathway.frames, scratch));
    }
}

/// An obstacle that the reference point can be above, and one outside the bounds, have no puncture; obstacles that overlap have
/// one each, which changes no class.
#[test]
fn punctures_lie_where_the_robot_cannot_be() {
    let point = "{ shape = { point = {} } }";
    let obstacles = boxes(&[[2.0, 3.0, 0.0], [4.0, 3.0, 3.0], [9.0, 3.0, 0.0], [2.4, 3.1, 0.0]]);
    let problem = scene("translation-2d", point, &obstacles, ["[0.4, 3]", "[7.6, 3]"]);
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let topology = Topology::of(&cx, problem.model().description(), scratch).expect("bodies");
    let punctures = topology.punctures().expect("it is planar");
    assert_eq!(punctures.points(), [[2.0, 3.0], [2.4, 3.1]]);
    assert_eq!(punctures.left_out(), 1);
    assert_eq!(word(punctures, &[[0.4, 3.0], [2.0, 5.0], [7.6, 3.0]]), "1 4");
    // Two ways around the two of them that overlap, whatever passes between in the numbers.
    let attachment = Attachment::default();
    let roadmap = grid(&problem, 9, 9);
    let ends = cx.query().expect("a query").clone();
    let cancel = Cancel::new();
    let found = distinct(&cx, &roadmap, &ends, &attachment, &topology, &asked(4), &cancel, scratch);
    let found = found.expect("few frames");
    let texts: BTreeSet<String> = found.classes.iter().map(|class| topology.text(class)).collect();
    assert_eq!(texts, ["-", "1 4", "-4 -1", "1 4 1 4"].map(str::to_owned).into());
}

/// A mesh with no vertex in the plane, and a box whose middle is far above it.
#[test]
fn obstacles_that_stand_aslant_are_passed_on_either_side() {
    let aslant = "[[obstacles]]\nshape = { mesh = { file = \"tests/problems/tetrahedron.obj\" } }\n\
        position = [2.0, 3.0, -0.3]\norientation = [0.9, 0.3, 0.3, 0.1]\n\
        [[obstacles]]\nshape = { box = { size = [1, 1, 4] } }\n\
        position = [6.0, 3.0, 1.2]\norientation = [0.8660254, 0.0, 0.5, 0.0]\n";
    for robot in ["{ shape = { point = {} } }", "{ shape = { sphere = { radius = 0.05 } } }"] {
        let problem = scene("translation-2d", robot, aslant, ["[0.4, 3]", "[7.6, 3]"]);
        let (cx, scratch) = (problem.context(), &mut Scratch::new());
        let topology = Topology::of(&cx, problem.model().description(), scratch).expect("bodies");
        let punctures = topology.punctures().expect("it is planar");
        assert_eq!((punctures.points().len(), punctures.left_out()), (2, 0), "{robot}");
        for [x, y] in punctures.points() {
            assert!(!cx.model().is_valid(&[*x, *y], scratch), "{x} {y}");
        }
        // The tilted box stands in the plane with its lower end.
        let [x, y] = punctures.points()[1];
        assert!((4.0..5.0).contains(&x) && (2.5..3.5).contains(&y), "{x} {y}");
        let over = |first: f64, second: f64| {
            let [one, other] = [0, 1].map(|number| punctures.points()[number][0]);
            word(punctures, &[[0.4, 3.0], [one, first], [3.3, 3.0], [other, second], [7.6, 3.0]])
        };
        let words = [over(1.0, 1.0), over(5.0, 1.0), over(1.0, 5.0), over(5.0, 5.0)];
        assert_eq!(words, ["-", "1", "2", "1 2"]);
    }
}

/// The obstacles nearest along the path, in their order.
#[test]
fn in_space_the_nearest_obstacles_name_the_class() {
    let ball = "{ shape = { sphere = { radius = 0.2 } } }";
    let places = [[4.0, 3.0, 1.0], [4.0, 3.0, 5.0], [6.0, 5.0, 3.0]];
    let problem = scene("translation-3d", ball, &boxes(&places), ["[1, 3, 1]", "[6.5, 3, 1]"]);
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let topology = Topology::of(&cx, problem.model().description(), scratch).expect("bodies");
    assert!(topology.punctures().is_none());
    let class = |points: &[[f64; 3]], scratch: &mut Scratch| {
        let mut configs = Configs::new(3);
        points.iter().for_each(|point| configs.push(point));
        let path = Path { configs, length: 0.0 };
        let frames = Frames::of(&cx, &path, 0.1, scratch).expect("few frames");
        let class = topology.class(&cx, &path, &frames, scratch);
        topology.text(&class)
    };
    let (start, goal) = ([1.0, 3.0, 1.0], [6.5, 3.0, 1.0]);
    assert_eq!(class(&[start, [4.0, 1.0, 1.0], goal], scratch), "1");
    // On either side of the first one the class is the same: it is an approximation.
    assert_eq!(class(&[start, [4.0, 5.0, 1.0], goal], scratch), "1");
    assert_eq!(class(&[start, [4.0, 1.0, 5.0], goal], scratch), "1 2 1");
    // A model without obstacles has no classes.
    let landscape = "[landscape]\nmin = [0, -1]\nmax = [1, 1]\n\
        energy = { terms = [{ height = -100, centre = [0, 0], xx = 0, yy = -0.01 }] }\n";
    let problem = Problem::parse(FilePath::new("l.toml"), landscape).expect("it is sound");
    assert!(Topology::of(&problem.context(), problem.model().description(), scratch).is_none());
}
