use super::*;
use crate::img::{Grown, Setup, build};
use crate::problem::Problem;
use crate::roadmap::{Configs, Increment};
use std::path::Path as FilePath;
use std::sync::Arc;

/// A point in a room 10 by 10, with whatever else is said; a wall of no width to speak of may be put across it.
fn room(more: &str) -> Arc<Setup> {
    let text = format!(
        "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [10, 10]\nbounds = \"reference\"\n\
         resolution = 0.5\n[robot]\nbodies = [{{ shape = {{ point = {{}} }} }}]\n[query]\n\
         start = [1, 1]\ngoal = [9, 1]\n{more}"
    );
    let problem = Problem::parse(FilePath::new("room.toml"), &text);
    Arc::new(Setup::new(problem.unwrap_or_else(|error| panic!("{error}"))))
}

/// An obstacle across the lower part of the room, this wide.
fn wall(width: f64) -> String {
    format!(
        "[[obstacles]]\nshape = {{ box = {{ size = [{width}, 8, 1] }} }}\n\
         position = [5.26, 4, 0]\n"
    )
}

fn ask_empty(setup: &Setup, ends: (&[f64], &[f64]), planners: &[Planner]) -> Answer {
    let roadmap = Roadmap::new(&setup.cx.space);
    let attachment = Attachment { planners: planners.to_vec(), ..Attachment::default() };
    solve(&setup.cx, &roadmap, ends, &attachment, &mut Scratch::new())
}

fn configs(answer: &Answer) -> Vec<Vec<f64>> {
    let path = answer.path.as_ref().expect("there is a path");
    path.into_iter().map(<[f64]>::to_vec).collect()
}

const STRAIGHT: [Planner; 1] = [Planner::StraightLine];

#[test]
fn ends_that_see_each_other_need_no_roadmap() {
    let setup = room("");
    let answer = ask_empty(&setup, (&[1.0, 1.0], &[4.0, 5.0]), &STRAIGHT);
    assert!(answer.connected && answer.dropped_edges == 0);
    assert_eq!(configs(&answer), [[1.0, 1.0], [4.0, 5.0]]);
    assert_eq!(answer.path.expect("a path").length, 5.0);
    // With a roadmap the path is no other, although its nodes are near.
    let Grown { roadmap, .. } = build(&setup);
    assert!(!roadmap.configs().is_empty());
    let ends: (&[f64], &[f64]) = (&[1.0, 1.0], &[4.0, 5.0]);
    let among_nodes = solve(&setup.cx, &roadmap, ends, &Attachment::default(), &mut Scratch::new());
    assert_eq!(configs(&among_nodes), [[1.0, 1.0], [4.0, 5.0]]);
}

#[test]
fn a_path_from_a_configuration_to_itself_is_that_configuration() {
    let manhattan = Planner::Manhattan(local::Manhattan {});
    let landscape =
        "[landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2]\nenergy = { muller-brown = {} }\n";
    let landscape =
        Problem::parse(FilePath::new("landscape.toml"), landscape).expect("it is sound");
    for setup in [room(""), room(&wall(1.0)), Arc::new(Setup::new(landscape))] {
        for planner in [Planner::StraightLine, manhattan] {
            let answer = ask_empty(&setup, (&[1.0, 1.0], &[1.0, 1.0]), &[planner]);
            assert_eq!(configs(&answer), [[1.0, 1.0]]);
            let path = answer.path.expect("a path");
            assert_eq!(path.length, 0.0);
            assert_eq!(path.lengths(&setup.cx.space), [0.0]);
            let sampled = path.sampled(&setup.cx.space, 3);
            assert!(sampled.len() == 3 && sampled.iter().all(|q| q == [1.0, 1.0]));
            assert_eq!(shorten(&setup.cx, &path, 10, &mut Scratch::new()), path);
        }
    }
}

/// Nothing of an answer through the roadmap depends on whether the direct motion was tried, its counts included.
#[test]
fn ends_that_do_not_see_each_other_are_answered_as_ever() {
    let setup = room(&wall(1.0));
    let Grown { roadmap, .. } = build(&setup);
    let mut before = setup.problem.context();
    before.tries_direct_motion = false;
    let ends: (&[f64], &[f64]) = (&[1.0, 1.0], &[9.0, 1.0]);
    let [now, then] = [&setup.cx, &before].map(|cx| {
        let scratch = &mut Scratch::new();
        let answer = solve(cx, &roadmap, ends, &Attachment::default(), scratch);
        (answer, scratch.take_asked())
    });
    assert_eq!(now, then);
    assert!(now.0.path.is_some() && now.1.motions > 20, "{now:?}");
    let none = ask_empty(&setup, ends, &STRAIGHT);
    assert_eq!((none.attached, none.connected, none.path), ([0, 0], false, None));
}

/// Steps of half a unit pass by the wall, steps twenty times finer do not.
#[test]
fn the_direct_motion_passes_the_check_of_paths_that_are_given_out() {
    let setup = room(&wall(0.05));
    let mut problem = setup.problem.clone();
    problem.model.bodies_mut().expect("it has bodies").edges =
        crate::model::bodies::validity::MotionChecking::Sampled;
    let setup = Setup::new(problem);
    let ends: (&[f64], &[f64]) = (&[1.0, 1.0], &[9.0, 1.0]);
    let scratch = &mut Scratch::new();
    let joined = |refinement, scratch: &mut Scratch| {
        local::connect(&setup.cx, &STRAIGHT, ends, refinement, scratch).is_some()
    };
    assert!(joined(1, scratch) && !joined(PATH_REFINEMENT, scratch), "the wall is thin enough");
    assert_eq!(ask_empty(&setup, ends, &STRAIGHT).path, None);
}

/// The query's own local planners try it, in their order, and a motion with turns is one way among others.
#[test]
fn a_direct_motion_with_turns_is_taken_where_the_roadmap_has_no_shorter_way() {
    let setup = room("");
    let manhattan = Planner::Manhattan(local::Manhattan {});
    let (start, goal) = ([1.0, 1.0], [4.0, 5.0]);
    let answer = ask_empty(&setup, (&start, &goal), &[manhattan]);
    assert_eq!(configs(&answer), [[1.0, 1.0], [4.0, 1.0], [4.0, 5.0]]);
    assert_eq!(answer.path.expect("a path").length, 7.0);
    // A node in the middle of the straight line: two turns instead of one are as long, straight edges are shorter.
    let mut roadmap = Roadmap::new(&setup.cx.space);
    let mut nodes = Configs::new(2);
    [[1.0, 1.5], [4.0, 4.5]].iter().for_each(|q| nodes.push(q));
    let edge =
        Edge::metric(NodeId(0), NodeId(1), 0, setup.cx.space.distance(nodes.get(0), nodes.get(1)));
    let increment = Increment { configs: nodes, edges: vec![edge], ..Increment::empty(2) };
    roadmap.fold_round(&setup.cx.space, [(&increment, &[][..])]);
    let attachment = Attachment { planners: vec![manhattan], ..Attachment::default() };
    let answer = solve(&setup.cx, &roadmap, (&start, &goal), &attachment, &mut Scratch::new());
    let path = answer.path.as_ref().expect("a path");
    assert!(path.length < 6.0 && path.configs.len() > 3, "{path:?}");
    assert_eq!(answer.attached, [2, 2]);
}

/// A direct motion over a mountain is valid but dear; the way around it through the roadmap is cheaper.
#[test]
fn in_a_landscape_the_direct_motion_competes_by_its_cost_and_its_peak() {
    let text = "[landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2]\nenergy = { muller-brown = {} }\n\
        [query]\nstart = [-0.558, 1.442]\ngoal = [0.623, 0.028]\n[img]\nsets_per_round = 1\n\
        [[strategies]]\nlabel = \"u\"\nnodes = 500\nsampler = { uniform = {} }\n\
        [limits]\nsets = 1\n[[evaluators]]\nlowest-barrier = { energy = -1000 }\n";
    let problem = Problem::parse(FilePath::new("landscape.toml"), text).expect("it is sound");
    let setup = Arc::new(Setup::new(problem));
    let query = setup.problem.query.clone().expect("it has a query");
    let ends = (&query.start[..], &query.goal[..]);
    let direct = ask_empty(&setup, ends, &STRAIGHT).path.expect("nothing is forbidden");
    let Grown { roadmap, .. } = build(&setup);
    let (attachment, scratch) = (Attachment::default(), &mut Scratch::new());
    let among = solve(&setup.cx, &roadmap, ends, &attachment, scratch).path.expect("a path");
    assert!(among.length < direct.length && among.configs.len() > 2, "{}", among.length);

    let none = Roadmap::new(&setup.cx.space);
    let (over, answer) = lowest_barrier(&setup.cx, &none, ends, &attachment, scratch);
    assert!(over.is_finite() && answer.connected && configs(&answer).len() == 2);
    let (barrier, answer) = lowest_barrier(&setup.cx, &roadmap, ends, &attachment, scratch);
    assert!(barrier < over && configs(&answer).len() > 2, "{barrier} and {over}");
}

#[test]
fn no_configuration_follows_itself_where_an_end_is_a_node() {
    let setup = room(&wall(1.0));
    let Grown { roadmap, .. } = build(&setup);
    let mut solved = 0;
    for node in 0..roadmap.configs().len().min(40) {
        let ends = (roadmap.configs().get(node), &[9.0, 1.0][..]);
        let scratch = &mut Scratch::new();
        let answer = solve(&setup.cx, &roadmap, ends, &Attachment::default(), scratch);
        let Some(path) = answer.path else { continue };
        solved += 1;
        for i in 1..path.configs.len() {
            assert_ne!(path.configs.get(i - 1), path.configs.get(i), "{path:?}");
        }
    }
    assert!(solved > 20, "only {solved} were solved");
}
