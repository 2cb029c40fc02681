//! A program that is not `roadmill` works on runs, with worker processes that are.

use roadmill::Cancel;
use roadmill::evaluate::{EvaluatorKind, Not, Query};
use roadmill::model::bodies::validity::BoundsMeaning;
use roadmill::model::bodies::{BodiesSpec, BodySpec, RobotSpec, ShapeSpec, SpaceSpec};
use roadmill::problem::{Problem, ProblemBuilder, StrategySpec};
use roadmill::sampler::SamplerKind;
use roadmill::space::BaseJoint;
use roadmill_coordinator::exit::Code;
use roadmill_coordinator::{Run, Selection, Workers};
use std::path::Path;

const ROADMILL: &str = env!("CARGO_BIN_EXE_roadmill");
/// The digest of `judged`, which the library's `same_bits.rs` keeps too.
const JUDGED: &str = "148ea74428efe955e2f3f29c826322052c2015012556b1f3989553efbb0e742a";

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

/// A tetrahedron in memory that turns past another one.
fn from_values() -> ProblemBuilder {
    let tetrahedron = || {
        let vertices = [[0.0; 3], [1.4, 0.0, 0.0], [0.0, 1.4, 0.0], [0.0, 0.0, 1.4]];
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        ShapeSpec::triangles(vertices.to_vec(), triangles.to_vec())
    };
    let space = SpaceSpec::new(BaseJoint::Rigid3d, [0.0; 3], [5.0; 3], BoundsMeaning::Reference);
    let bodies = BodiesSpec::new(space.resolution(0.1), RobotSpec::new().body(tetrahedron()))
        .obstacle(BodySpec::new(tetrahedron()).at([2.0, 2.0, 2.0]));
    let query = EvaluatorKind::Query(Query::default());
    Problem::builder("values", bodies)
        .query([0.5, 0.5, 4.0, 1.0, 0.0, 0.0, 0.0], [4.0, 2.5, 4.0, 0.5, 0.5, -0.5, 0.5])
        .sets_per_round(2)
        .strategy(StrategySpec::sampled("near", SamplerKind::default()).nodes(10))
        // They contradict each other, so that every round is judged up to the limit.
        .evaluators([query.clone(), EvaluatorKind::Not(Not(Box::new(query)))])
        .most_sets(8)
}

#[test]
fn a_problem_of_values_is_run_resumed_and_verified_like_one_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = from_values().build().unwrap_or_else(|error| panic!("{error}"));

    // Written as files, it loads to the same problem.
    let written = problem.to_toml("meshes");
    std::fs::create_dir(folder.path().join("meshes")).expect("a folder");
    for (name, text) in &written.files {
        std::fs::write(folder.path().join("meshes").join(name), text).expect("a mesh");
    }
    let file = folder.path().join("values.toml");
    std::fs::write(&file, &written.text).expect("a problem");
    let loaded = Problem::load(&file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.digest(), problem.digest());

    let workers = Workers::threads(2);
    let run_of_file = Run::at(folder.path().join("of-file"));
    let of_file = Run::begin(loaded.clone()).folder(run_of_file.folder()).workers(&workers);
    let of_file = of_file.grow().expect("it can be begun");

    // Cut after a round, gone on with by the ledger alone, and again by what begins or resumes.
    let run = Run::at(folder.path().join("of-values"));
    let cancel = Cancel::new();
    let cut = Run::begin(problem.clone())
        .folder(run.folder())
        .workers(&workers)
        .cancel(&cancel)
        .progress(|status| {
            if status.progress.rounds > 0 {
                cancel.cancel();
            }
        })
        .grow()
        .expect("it can be begun");
    assert_eq!(cut.outcome().0, Code::Interrupted);
    let whole = run.resume().workers(&workers).grow().expect("it can go on");
    assert_eq!(whole.digest(), of_file.digest());
    let begin = |problem: &Problem| {
        Run::begin(problem.clone()).folder(run.folder()).or_resume().workers(&workers).grow()
    };
    let again = begin(&problem).expect("it is the same problem");
    assert_eq!(again.digest(), whole.digest());
    let same = begin(&loaded).expect("it is the same problem, from a file");
    assert_eq!(same.digest(), whole.digest());
    let other = from_values().seed(2).build().expect("any seed");
    let refused = begin(&other).map(|_| ()).expect_err("another seed").to_string();
    assert!(refused.contains("the seed is 2, 1 expected"), "{refused}");

    let verified = run.verify(Selection::All).workers(&workers).check().expect("all as recorded");
    assert_eq!(verified.digest, Some(whole.digest()));
    let recorded = run.read().expect("it is sound");
    assert_eq!(recorded.problem().digest(), problem.digest());
    assert!(recorded.problem().sources().is_empty());
}
