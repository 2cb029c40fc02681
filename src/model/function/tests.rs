use super::*;
use crate::Build;
use crate::build::BuildError;
use crate::model::Scratch;
use crate::model::bodies::BodyValidity;
use crate::problem::{Layout, Problem};
use crate::roadmap::Digest;
use crate::wire;
use proptest::prelude::*;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

const ROOM: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [10.0, 6.0]
bounds = "body"
edges = "sampled"
resolution = 0.1
[robot]
bodies = [{ shape = { sphere = { radius = 0.2 } } }]
[[obstacles]]
shape = { box = { size = [0.2, 4.0, 1.0] } }
position = [5.0, 2.0, 0.0]
[query]
start = [1.0, 1.0]
goal = [9.0, 1.0]
[limits]
nodes = 2000
"#;

fn room() -> Problem {
    Problem::parse(Path::new("room.toml"), ROOM).unwrap()
}

fn judged(identity: &str, function: impl Fn(&[f64]) -> bool + Send + Sync + 'static) -> Problem {
    let function = ValidityFunction::new(identity, function).unwrap();
    room().with_validity_function(function).unwrap()
}

/// Outside of a disc above the obstacle, which leaves a way over it and none under it.
fn outside_of_disc(q: &[f64]) -> bool {
    let [x, y] = [q[0] - 5.0, q[1] - 4.4];
    x * x + y * y > 0.5
}

#[test]
fn milestones_steps_of_edges_and_paths_are_allowed_by_model_and_function() {
    let problem = judged("disc 1", outside_of_disc);
    let built = Build::new(problem.clone()).threads(2).run().unwrap();
    let path = built.path().expect("there is a way");
    let (model, scratch) = (room().context().model, &mut Scratch::new());
    for q in built.roadmap().configs().iter().chain(path) {
        assert!(outside_of_disc(q) && model.is_valid(q, scratch), "{q:?}");
    }
    let configs = built.roadmap().configs();
    let free = BodyValidity::of(&*model).unwrap();
    for edge in built.roadmap().edges().iter() {
        let (a, b) = (configs.get(edge.low.index()), configs.get(edge.high.index()));
        let q = &mut [0.0; 2];
        assert!(free.all_between(a, b, free.steps(a, b, 1), q, outside_of_disc));
        assert!(model.motion(a, b, 1, scratch).is_some());
    }
    // A path is looked at more finely.
    for i in 1..path.configs.len() {
        let (a, b) = (path.configs.get(i - 1), path.configs.get(i));
        let q = &mut [0.0; 2];
        assert!(free.all_between(a, b, free.steps(a, b, 20), q, outside_of_disc));
    }
    // The same whoever builds; another roadmap than without the function.
    assert_eq!(Build::new(problem).run().unwrap().digest(), built.digest());
    assert_ne!(Build::new(room()).run().unwrap().digest(), built.digest());
}

#[test]
fn the_identity_is_in_the_digest_and_the_bytes_and_the_function_is_not() {
    let problem = judged("disc 1", outside_of_disc);
    assert_eq!(judged("disc 1", |_| true).digest(), problem.digest());
    assert_ne!(judged("disc 2", outside_of_disc).digest(), problem.digest());
    assert_ne!(room().digest(), problem.digest());

    let (layout, bytes) = problem.to_bytes();
    assert_eq!(layout, Layout::Third);
    let read = Problem::from_bytes(layout, &bytes).unwrap();
    assert_eq!((&read, read.digest()), (&problem, problem.digest()));
    // Without the function nothing is valid, and it is said why.
    let error = read.context().accept(&mut [1.0, 1.0]).unwrap_err();
    assert!(error.contains("the validity function `disc 1` is not here"), "{error}");
    let error = read.clone().supplied_with(None).unwrap_err();
    assert!(error.contains("judged by the validity function `disc 1` too"), "{error}");
    let other = ValidityFunction::new("disc 2", outside_of_disc).unwrap();
    let error = read.clone().supplied_with(Some(&other)).unwrap_err();
    assert_eq!(error, "the validity function `disc 2` found, `disc 1` expected");
    let error = room().supplied_with(Some(&other)).unwrap_err();
    assert_eq!(error, "the validity function `disc 2` found, none expected");
    let own = ValidityFunction::new("disc 1", outside_of_disc).unwrap();
    let supplied = read.supplied_with(Some(&own)).unwrap();
    assert_eq!(supplied.context().accept(&mut [1.0, 1.0]), Ok(()));
    // A continuation has the same function.
    assert!(problem.scene_difference(&room()).unwrap().contains("no validity function found"));
    assert_eq!(problem.scene_difference(&supplied), None);
}

#[test]
fn without_the_function_nothing_is_built_or_sent() {
    let (layout, bytes) = judged("disc 1", outside_of_disc).to_bytes();
    let read = Problem::from_bytes(layout, &bytes).unwrap();
    let Err(BuildError::Function(failed)) = Build::new(read.clone()).run() else {
        panic!("it was built")
    };
    assert!(failed.message.contains("this function expected"), "{failed}");
    let sent = wire::decode::<Problem>(&wire::encode(&read)).unwrap_err().to_string();
    assert!(sent.contains("cannot be sent"), "{sent}");
    assert_eq!(wire::decode::<Problem>(&wire::encode(&room())).unwrap(), room());
    // Bytes of a problem that could not have been given a function.
    let swept = ROOM.replace("edges = \"sampled\"", "");
    let swept = Problem::parse(Path::new("room.toml"), &swept).unwrap();
    let (layout, bytes) = Problem { function: read.function.clone(), ..swept }.to_bytes();
    assert!(Problem::from_bytes(layout, &bytes).unwrap_err().to_string().contains("swept"));
}

#[test]
fn what_cannot_be_judged_is_refused() {
    for (text, expected) in [
        (ROOM.replace("edges = \"sampled\"", ""), "space.edges: \"swept\" found"),
        (
            "[landscape]\nmin = [0, 0]\nmax = [1, 1]\nenergy = { muller-brown = {} }\nhighest = 100\n".to_owned(),
            "another model than that of bodies found",
        ),
    ] {
        let problem = Problem::parse(Path::new("room.toml"), &text).unwrap();
        let function = ValidityFunction::new("any", |_: &[f64]| true).unwrap();
        let error = problem.with_validity_function(function).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let function = ValidityFunction::new("left", |q: &[f64]| q[0] < 5.0).unwrap();
    let error = room().with_validity_function(function).unwrap_err().to_string();
    assert!(
        error.starts_with(
            "query.goal: [9.0, 1.0] found, where the validity function `left` forbids it"
        ),
        "{error}"
    );
    for identity in ["", "a\nb", &"a".repeat(201)] {
        assert!(ValidityFunction::new(identity, |_: &[f64]| true).is_err(), "{identity:?}");
    }
}

/// Fails once it was asked often enough.
struct Failing(AtomicU64);

impl JudgeConfigurations for Failing {
    fn is_valid(&self, q: &[f64]) -> Result<bool, FunctionFailed> {
        match self.0.fetch_add(1, Ordering::SeqCst) {
            0..500 => Ok(outside_of_disc(q)),
            _ => Err(FunctionFailed {
                message: "out of order".to_owned(),
                cause: Some(Arc::new(7u8)),
            }),
        }
    }
}

#[test]
fn a_function_that_fails_ends_the_build() {
    for threads in [None, Some(1), Some(3)] {
        let function = ValidityFunction::new("failing", Failing(AtomicU64::new(0))).unwrap();
        let problem = room().with_validity_function(function).unwrap();
        let build = Build::new(problem);
        let ended = match threads {
            None => build.run(),
            Some(threads) => build.threads(threads).run(),
        };
        let Err(BuildError::Function(failed)) = ended else { panic!("it went on") };
        assert_eq!(failed.message, "out of order");
        let cause = failed.cause.unwrap();
        assert_eq!(cause.downcast_ref::<u8>(), Some(&7));
    }
}

#[test]
fn a_function_that_contradicts_itself_is_found_out() {
    let turn = AtomicBool::new(true);
    let function =
        move |q: &[f64]| q[0] < 2.0 || q[0] > 8.0 || turn.fetch_xor(true, Ordering::SeqCst);
    let ended = Build::new(judged("fickle", function)).run();
    let Err(BuildError::Function(failed)) = ended else { panic!("it went on") };
    assert!(failed.message.starts_with("the validity function `fickle` said "), "{failed}");
    assert!(failed.message.contains("when it was asked again"), "{failed}");
}

#[test]
fn other_panics_are_none_of_a_function() {
    let quiet = || with_functions(|| -> u8 { resume_unwind(Box::new("a bug")) });
    let panic = catch_unwind(quiet).unwrap_err();
    assert_eq!(panic.downcast_ref::<&str>(), Some(&"a bug"));
    assert_eq!(with_functions(|| 5).unwrap(), 5);
}

#[test]
fn the_function_is_asked_only_about_what_the_model_finds_valid() {
    let asked = Arc::new(Mutex::new(Vec::new()));
    let noted = asked.clone();
    let function = move |q: &[f64]| {
        noted.lock().unwrap().push(q.to_vec());
        true
    };
    Build::new(judged("all", function)).run().unwrap();
    let model = room().context().model;
    let asked = asked.lock().unwrap();
    assert!(asked.len() > 1000);
    assert!(asked.iter().all(|q| model.is_valid(q, &mut Scratch::new())));
}

proptest! {
    #[test]
    fn one_in_so_many_is_asked_again(at in proptest::array::uniform2(0.0..1.0f64)) {
        let again = (0..1000u32).filter(|i| is_asked_again(&[at[0], at[1] + f64::from(*i)])).count();
        prop_assert!((20..120).contains(&again), "{again}");
        prop_assert_eq!(is_asked_again(&at), Digest::of(&[at[0].to_le_bytes(), at[1].to_le_bytes()].concat()).0[0] < 16);
    }
}
