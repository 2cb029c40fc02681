//! `roadmill::Build`, as a program uses it.

use roadmill::img::{Cut, Stop};
use roadmill::problem::{Limits, Problem};
use roadmill::{Build, Cancel};
use std::path::Path;

/// The digest of `judged`, which `same_bits.rs` keeps too.
const JUDGED: &str = "148ea74428efe955e2f3f29c826322052c2015012556b1f3989553efbb0e742a";

fn load(name: &str) -> Problem {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    Problem::load(&file).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_cancelled_build_has_whole_rounds_and_goes_on_to_the_same_roadmap() {
    for threads in [None, Some(2)] {
        let problem = load("tests/problems/judged.toml");
        let cancel = Cancel::new();
        let mut rounds = 0;
        let build = Build::new(problem).cancel(&cancel).progress(|progress| {
            rounds = progress.rounds;
            if rounds == 1 {
                cancel.cancel();
            }
        });
        let cut = match threads {
            None => build.run(),
            Some(threads) => build.threads(threads).run(),
        };
        let cut = cut.expect("it runs");
        assert_eq!(cut.stop(), &Stop::Cut(Cut::Interrupted));
        assert_eq!(cut.roadmap().rounds().len(), 1);
        assert_eq!(rounds, 1);

        let whole = cut.resume().run().expect("it runs");
        assert_eq!(whole.digest().to_string(), JUDGED);
        assert!(whole.roadmap().rounds().len() > 1);
        // What has ended stays ended, and is not forgotten.
        let again = whole.resume().threads(3).run().expect("it runs");
        assert_eq!((again.digest(), again.stop()), (whole.digest(), whole.stop()));
        assert_eq!(again.path(), whole.path());
    }
}

#[test]
fn a_build_that_is_cancelled_before_it_begins_is_empty() {
    let cancel = Cancel::new();
    cancel.cancel();
    let built = Build::new(load("problems/maze.toml")).cancel(&cancel).run().expect("it runs");
    assert_eq!((built.roadmap().configs().len(), built.path()), (0, None));
    assert_eq!(built.verdicts().count(), 0);
}

#[test]
fn a_build_goes_on_under_other_limits_and_not_with_another_seed() {
    let problem = load("tests/problems/slide.toml");
    let limits = Limits { nodes: 2 * problem.limits().nodes, ..problem.limits() };
    let longer = problem.clone().with_limits(limits).expect("sound limits");
    let short = Build::new(problem.clone()).run().expect("it runs");
    let continued = short.resume_with(&longer).expect("only a limit differs");
    let continued = continued.threads(2).run().expect("it runs");
    let at_once = Build::new(longer).run().expect("it runs");
    assert_eq!(continued.digest(), at_once.digest());

    let seed = problem.seed() + 1;
    let other = problem.with_seed(seed);
    let refused = short.resume_with(&other).map(|_| ()).expect_err("the seed differs");
    assert!(refused.contains("seed"), "{refused}");
}

#[test]
fn paths_and_verdicts_are_at_hand() {
    let built = Build::new(load("problems/maze.toml")).run().expect("it runs");
    assert!(built.is_satisfied());
    let path = built.path().expect("the maze has a way through");
    let ends = built.problem().query().cloned().expect("the maze has a query");
    let configs: Vec<&[f64]> = path.into_iter().collect();
    assert_eq!((configs[0], configs[configs.len() - 1]), (&ends.start[..], &ends.goal[..]));
    assert!(built.verdict("query").expect("it is asked").satisfied);
    assert!(built.verdict("coverage").is_none());

    // The same question again, and the way back.
    let answer = built.query(&ends.start, &ends.goal).expect("valid ends");
    assert_eq!(answer.path.as_ref(), Some(path));
    assert!(built.query(&ends.goal, &ends.start).expect("valid ends").path.is_some());
    let error = built.query(&ends.start, &[0.0]).expect_err("one number is no configuration");
    assert_eq!(error.end, "goal");
    assert!(error.to_string().starts_with("goal: 1 values found"), "{error}");
}

/// A build that reads no clock must end all the same.
#[test]
fn a_problem_with_a_limit_of_time_alone_has_one_of_nodes_here() {
    let text = std::fs::read_to_string("problems/maze.toml").expect("it ships");
    let timed = Problem::parse("maze.toml".as_ref(), &format!("{text}\n[limits]\nseconds = 5\n"));
    let timed = timed.expect("it is sound");
    let open = load("problems/maze.toml");
    assert!(timed.limits().nodes > open.limits().nodes);
    let cancel = Cancel::new();
    cancel.cancel();
    let built = Build::new(timed).cancel(&cancel).run().expect("it runs");
    assert_eq!(built.problem().limits().nodes, open.limits().nodes);
    assert_eq!(built.problem().limits().seconds, Some(5.0));
}
