//! A program that is not `roadmill` works on runs, with worker processes that are.

use roadmill::Cancel;
use roadmill::problem::Problem;
use roadmill_coordinator::exit::Code;
use roadmill_coordinator::{Run, Selection, Workers};
use std::path::Path;

const ROADMILL: &str = env!("CARGO_BIN_EXE_roadmill");
/// The digest of `judged`, which the library's `same_bits.rs` keeps too.
const JUDGED: &str = "fc618620ce842cfd14f9926dee68f3c1843f38ad90540cf4700bf7e3fd771de7";

fn load(name: &str) -> Problem {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    Problem::load(&file).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_run_is_cancelled_resumed_verified_and_queried() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = Run::at(folder.path().join("judged"));
    let workers = Workers::processes(2, ROADMILL);
    let cancel = Cancel::new();
    let begun = Run::begin(load("tests/problems/judged.toml")).folder(run.folder());
    let cut = begun
        .workers(&workers)
        .cancel(&cancel)
        .progress(|status| {
            if status.progress.rounds > 0 {
                cancel.cancel();
            }
        })
        .grow()
        .expect("it can be begun");
    assert_eq!((cut.run(), cut.rounds()), (&run, 1));
    assert_eq!(cut.outcome(), (Code::Interrupted, "it was cancelled".to_owned()));

    let whole = run.resume().workers(&workers).grow().expect("it can go on");
    assert_eq!(whole.digest().to_string(), JUDGED);
    assert_eq!(whole.summary().expect("something was done").digest, JUDGED);
    // There is nothing left to do; the workers do not matter.
    let again = run.resume().workers(&Workers::threads(1)).grow().expect("it is whole");
    assert!(again.summary().is_none());
    assert_eq!((again.digest(), again.reason()), (whole.digest(), whole.reason()));

    let verified = run.verify(Selection::All).workers(&workers).check().expect("all as recorded");
    assert_eq!(verified.sets, verified.sets_recorded);
    assert_eq!(verified.digest, Some(whole.digest()));
    let recorded = run.read().expect("it is sound");
    assert_eq!((recorded.digest(), recorded.stopped()), (whole.digest(), Some(whole.stopped())));
    assert_eq!(recorded.path(), whole.path());
}

#[test]
fn a_run_answers_queries_and_goes_on_under_other_limits() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = Run::at(folder.path().join("maze"));
    let problem = load("problems/maze.toml");
    let ends = problem.query().cloned().expect("the maze has a query");
    let begun = Run::begin(problem).folder(run.folder()).workers(&Workers::threads(2));
    let built = begun.grow().expect("it can be begun");
    assert_eq!(built.outcome().0, Code::Done);
    let path = built.path().expect("the maze has a way through");

    let recorded = run.read().expect("it is sound");
    let answer = recorded.query(&ends.start, &ends.goal).expect("valid ends");
    assert_eq!(answer.path.as_ref(), Some(path));
    let error = recorded.query(&[], &ends.goal).expect_err("nothing is no configuration");
    assert_eq!(error.end, "start");

    // The criteria are met, so that the new chapter ends where it begins.
    let nodes = recorded.roadmap().configs().len() as u64 + 1000;
    let longer = run.resume().max_nodes(nodes).grow().expect("it can go on");
    assert_eq!((longer.digest(), longer.rounds()), (built.digest(), built.rounds()));
    assert_eq!(longer.problem().limits().nodes, nodes);
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = Run::at(folder.path().join("run"));
    let refused = run.resume().grow().expect_err("there is no run");
    assert_eq!(refused.code, Code::Usage);
    let begun = |workers: &Workers| {
        Run::begin(load("problems/maze.toml")).folder(run.folder()).workers(workers).grow()
    };
    let refused = begun(&Workers::threads(0)).expect_err("nobody works");
    assert_eq!(refused.to_string(), "0 workers found, 1 to 4096 expected");
    let refused = begun(&Workers::processes(1, "/nonexistent")).expect_err("no such program");
    assert_eq!(refused.code, Code::System);
    // Nothing is left of it.
    assert!(!run.folder().exists());

    // A process that is no worker: this test.
    let own = std::env::current_exe().expect("it has a name");
    let ended = begun(&Workers::processes(1, own)).expect("it can be begun");
    assert_eq!(ended.outcome().0, Code::WorkersLost);
}
