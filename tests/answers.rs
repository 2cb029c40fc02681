//! The paths that builds give out, checked again by code that shares nothing with the library's:
//! own interpolation, own poses, own collision tests, at a twentieth of the resolution.

#[path = "support/judge.rs"]
mod judge;

use judge::Judge;
use roadmill::img::{Grown, Setup, Stop, build_in_threads};
use roadmill::model::Scratch;
use roadmill::problem::Problem;
use roadmill::query;
use roadmill::roadmap::Roadmap;
use std::path::Path;
use std::sync::Arc;

fn load(name: &str) -> Problem {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems").join(name);
    Problem::load(&file).unwrap_or_else(|error| panic!("{error}"))
}

fn build(name: &str) -> (Arc<Setup>, Grown) {
    let setup = Arc::new(Setup::new(load(name)));
    let build = build_in_threads(&setup, 2);
    (setup, build)
}

/// Builds at the file's own settings and checks what comes out.
fn check(name: &str) {
    let (setup, build) = build(name);
    assert_eq!(build.stop, Stop::Satisfied, "{name}");
    let judgement = build.judgement.expect("a round was judged");
    let answer = judgement.verdicts[0].answer.as_ref().expect("the query evaluator answers");
    let path = answer.path.as_ref().expect("a satisfied query has its path");
    let configs: Vec<&[f64]> = path.configs.iter().collect();
    let ends = setup.problem().query().expect("the problem has a query");
    assert_eq!((configs[0], configs[configs.len() - 1]), (&ends.start[..], &ends.goal[..]));

    let judge = Judge::new(setup.problem());
    let length = judge.length(&configs);
    assert!((length - path.length).abs() < 1e-6 * length, "{name}: {length}, not {}", path.length);
    let steps = judge.walk(&configs).unwrap_or_else(|fault| panic!("{name}: {fault}"));
    assert!(steps > 1000, "{name}: only {steps} configurations were looked at");
}

#[test]
fn the_stick_threads_the_walls() {
    check("walls.toml");
}

#[test]
fn the_cart_leaves_the_maze() {
    check("maze.toml");
}

#[test]
fn the_bar_climbs_through_the_maze() {
    check("maze3d.toml");
}

#[test]
fn the_hook_passes_the_slit() {
    check("hook.toml");
}

#[test]
fn the_angle_leaves_the_cage() {
    check("cage.toml");
}

#[test]
fn a_sealed_room_is_never_entered() {
    let (setup, build) = build("sealed.toml");
    assert_eq!(build.stop, Stop::NodeLimit);
    assert!(build.roadmap.configs().len() as u64 >= setup.problem().limits().nodes);
    let judgement = build.judgement.expect("a round was judged");
    assert!(!judgement.satisfied());
    let answer = judgement.verdicts[0].answer.as_ref().expect("the query evaluator answers");
    assert!(!answer.connected && answer.path.is_none());
    // Both ends have company, so it is the wall that keeps them apart.
    assert!(answer.attached.iter().all(|nodes| *nodes > 0), "{:?}", answer.attached);
}

/// Whose ends see each other needs no roadmap, so that its build ends after the first round. Of the problems that ship,
/// and of those whose roadmaps the tests keep, these are all.
#[test]
fn few_problems_have_ends_that_see_each_other() {
    let mut seeing = Vec::new();
    for folder in ["problems", "tests/problems"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        for file in std::fs::read_dir(&folder).expect("the folder is there").flatten() {
            let path = file.path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let problem = Problem::load(&path).unwrap_or_else(|error| panic!("{error}"));
            let Some(ends) = problem.query() else { continue };
            let (cx, none) = (problem.context(), Roadmap::new(&problem.space()));
            let ends = (&ends.start[..], &ends.goal[..]);
            let answer = query::solve(&cx, &none, ends, &problem.attachment(), &mut Scratch::new());
            seeing.extend(answer.path.map(|_| problem.name().to_owned()));
        }
    }
    seeing.sort();
    assert_eq!(seeing, ["ball", "landscape", "muller-brown"]);
}

/// The judge must be able to say no.
#[test]
fn the_straight_way_is_found_out() {
    for name in ["walls.toml", "maze.toml", "maze3d.toml", "hook.toml", "cage.toml"] {
        let problem = load(name);
        let ends = problem.query().cloned().expect("the problem has a query");
        let fault = Judge::new(&problem).walk(&[&ends.start, &ends.goal]).unwrap_err();
        assert!(fault.contains("meets obstacle"), "{name}: {fault}");
    }
    let problem = load("walls.toml");
    let start = problem.query().cloned().expect("the problem has a query").start;
    let mut outside = start.clone();
    outside[2] = 3.9;
    let fault = Judge::new(&problem).walk(&[&start, &outside]).unwrap_err();
    assert!(fault.contains("leaves the bounds"), "{fault}");
}
