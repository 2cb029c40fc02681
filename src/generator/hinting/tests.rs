//! What hints promise: valid milestones whatever the path, and a way along a path that nearly is one.

use super::fitted;
use super::polyline::{evenly, resampled};
use crate::generator::{GeneratorKind, HintPath, Hints};
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::problem::{Problem, StrategySpec};
use crate::push::Push;
use crate::roadmap::{Increment, Roadmap, SetForm};
use proptest::prelude::*;
use std::path::Path;

/// A bar that is to pass a slit of 0.5 in a wall, for which it has to lie along the way: the slit is above the straight way. The hint leads straight through
/// the wall, beside the slit.
const SLIT: &str = r#"
[space]
motion = "rigid-2d"
min = [0, 0]
max = [10, 10]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.6, 0.3, 1] } } }]
[[obstacles]]
shape = { box = { size = [1, 5, 1] } }
position = [5, 2.5, 0]
[[obstacles]]
shape = { box = { size = [1, 4.5, 1] } }
position = [5, 7.75, 0]
[query]
start = [1.5, 5, 0]
goal = [8.5, 5, 0]
[img]
sets_per_round = 1
[limits]
nodes = 600
"#;

fn slit(generator: &str) -> Problem {
    let strategy = format!("[[strategies]]\nlabel = \"it\"\nnodes = 40\ngenerator = {generator}\n");
    Problem::parse(Path::new("slit.toml"), &(SLIT.to_owned() + &strategy))
        .unwrap_or_else(|error| panic!("{error}"))
}

fn made(problem: &Problem, ordinal: u64, frozen: Option<&Roadmap>) -> Increment {
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    let made = problem.strategies[0].generate(&cx, Ordinal(ordinal), frozen, scratch);
    made.unwrap_or_else(|gave_up| panic!("{gave_up:?}"))
}

#[test]
fn every_push_leads_a_hint_beside_a_slit_through_it() {
    for push in ["simple", "shortest", "workspace", "retraction", "all"] {
        let problem = slit(&format!(
            "{{ hints = {{ path = [[1.5, 4.9, 0.1], [8.5, 5.0, -0.1]], push = \"{push}\" }} }}"
        ));
        let built = crate::Build::new(problem.clone()).threads(1).run();
        let built = built.unwrap_or_else(|error| panic!("{push}: {error}"));
        let path = built.path().unwrap_or_else(|| panic!("{push}: no way through"));
        assert_eq!(path.configs.get(path.configs.len() - 1), problem.query().unwrap().goal);
    }
}

#[test]
fn valid_hints_are_milestones_in_their_order_joined_along_the_path() {
    let hint = "{ hints = { path = [[1, 1, 0], [1, 9, 0], [3, 9, 0]], step = 0.5 } }";
    let problem = slit(hint);
    let made = made(&problem, 0, None);
    let hints = resampled(
        &problem.space(),
        &[vec![1.0, 1.0, 0.0], vec![1.0, 9.0, 0.0], vec![3.0, 9.0, 0.0]],
        0.5,
    );
    assert_eq!(hints.len(), 21);
    for (index, q) in hints.iter().enumerate() {
        assert_eq!(made.configs.get(index), q);
        if index > 0 {
            let is_joined = |edge: &crate::roadmap::Edge| {
                (edge.low.index(), edge.high.index()) == (index - 1, index)
            };
            assert!(made.edges.iter().any(is_joined), "{index}");
        }
    }
}

#[test]
fn a_path_that_is_whole_or_far_from_anything_valid_leaves_no_set_unfilled() {
    // Whole from the beginning; wholly in the wall; of one configuration.
    for path in ["[[1, 1, 0], [1, 2, 0]]", "[[5, 1, 0], [5, 2, 0]]", "[[5, 1, 0]]"] {
        let problem = slit(&format!("{{ hints = {{ path = {path} }} }}"));
        let mut roadmap = Roadmap::new(&problem.space());
        for ordinal in 0..4 {
            let made = made(&problem, ordinal, Some(&roadmap));
            assert_eq!(made.configs.len(), 40, "{path}");
            roadmap.fold_round(&problem.space(), [(&made, &[][..])]);
        }
    }
}

#[test]
fn a_program_can_give_a_path_and_the_problem_is_written_and_read_as_one_that_names_a_file() {
    let path = HintPath::new(vec![vec![1.5, 4.9, 0.1], vec![8.5, 0.1 + 0.2, -0.1]]);
    let spec = StrategySpec::generated("it", GeneratorKind::Hints(Hints::new(path)));
    let given = slit("{ hints = { path = [[1, 1, 0]] } }").to_builder().strategies(vec![spec]);
    let given = given.default_schedule().build().unwrap_or_else(|error| panic!("{error}"));
    let (layout, bytes) = given.to_bytes();
    assert_eq!(
        Problem::from_bytes(layout, &bytes).expect("they are its bytes").digest(),
        given.digest()
    );

    let folder = tempfile::tempdir().expect("a folder can be made");
    let written = given.to_toml("files");
    std::fs::create_dir(folder.path().join("files")).expect("it can");
    let [(name, text)] = &written.files[..] else { panic!("{:?}", written.files) };
    std::fs::write(folder.path().join("files").join(name), text).expect("it can be written");
    let file = folder.path().join("it.toml");
    std::fs::write(&file, &written.text).expect("it can be written");
    let read = Problem::load(&file).unwrap_or_else(|error| panic!("{error}\n{}", written.text));
    assert_eq!(read.digest(), given.digest());
    assert!(
        read.describe().contains("2 configurations, of which 2 are valid"),
        "{}",
        read.describe()
    );
    assert!(read.sources.iter().any(|source| source.path.ends_with(name)));
}

#[test]
fn a_problem_can_be_given_files_of_hints() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let write = |name: &str, text: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).expect("it can be written");
        file
    };
    let csv =
        write("hint.csv", "x [length],y [length],theta [rad]\n1,1,0\n# here it turns\n2,1,0.5\n");
    let parasol =
        write("hint.path", "VIZMO_PATH_FILE   Path Version 2012\n1\n2\n1 1 0\n0 2 1 0.5\n");
    let plain = slit("{ rrt-connect = {} }");
    let hinted = plain.with_hints(&[csv, parasol]).unwrap_or_else(|error| panic!("{error}"));
    let GeneratorKind::Hints(hints) = hinted.strategies()[1].generator() else { panic!("hints") };
    let read: Vec<_> = hints.all_paths().map(HintPath::configurations).collect();
    assert_eq!(read[0], [vec![1.0, 1.0, 0.0], vec![2.0, 1.0, 0.5]]);
    assert_eq!(read[1], [vec![1.0, 1.0, 0.0], vec![2.0, 1.0, 0.5 * std::f64::consts::PI]]);
    let labels: Vec<usize> = hinted.schedule().iter().map(|index| index.index()).collect();
    assert_eq!(labels, [1, 0]);
    assert_eq!(plain.with_hints(&[]).unwrap().digest(), plain.digest());
    for (name, text, expected) in [
        ("a.csv", "x,y,theta\n1,2\n", "a.csv:2: 2 values found; 3 expected"),
        (
            "b.csv",
            "x,y,angle\n1,2,3\n",
            "b.csv:1: columns x,y,angle found; x [length],y [length],theta [rad] expected",
        ),
        ("c.csv", "1,2,nan\n", "c.csv:1: `nan` found; a finite number expected"),
        ("d.csv", "x,y,theta\n", "d.csv:1: no configuration found"),
        (
            "e.path",
            "VIZMO_PATH_FILE\n1\n2\n1 1 0\n",
            "e.path:4: cut off; 2 configurations, of which 1 were found, expected",
        ),
        ("f.path", "VIZMO_PATH_FILE\n1\n1\n1 1\n", "f.path:4: 2 numbers found; 3 expected"),
        ("g.path", "VIZMO_PATH_FILE\n2\n1\n1 1 0\n", "g.path:2: 2 robots found; 1 expected"),
        (
            "h.path",
            "VIZMO_PATH_FILE\n1\n1\n1 1 0\n1 1 0\n",
            "h.path:5: `1 1 0` found after 1 configurations",
        ),
    ] {
        let error = plain.with_hints(&[write(name, text)]).expect_err(name).to_string();
        assert!(error.contains(expected), "{error}");
    }
    let error = hinted.with_hints(&[write("hint.csv", "1,1,0\n")]).expect_err("there are hints");
    assert!(error.to_string().contains("a strategy `hints` found"), "{error}");
}

#[test]
fn what_is_wrong_with_a_path_is_told() {
    let complain = |generator: &str| {
        let strategy = format!("[[strategies]]\nlabel = \"it\"\ngenerator = {generator}\n");
        let problem = Problem::parse(Path::new("slit.toml"), &(SLIT.to_owned() + &strategy));
        problem.expect_err(generator).to_string()
    };
    for (generator, expected) in [
        ("{ hints = {} }", "path = none found"),
        ("{ hints = { path = [] } }", "no configuration found; at least 1 expected"),
        ("{ hints = { path = [[1, 2]] } }", "path 1: configuration 1: 2 values found, 3"),
        ("{ hints = { path = \"\" } }", "the name of a file expected"),
        ("{ hints = { path = 3 } }", "the name of a file, or an array of configurations"),
        ("{ hints = { path = \"no.csv\" } }", "no.csv: cannot read the approximate path"),
        ("{ hints = { path = [[1, 2, 3]], push = \"hard\" } }", "unknown variant `hard`"),
        ("{ hints = { path = [[1, 2, 3]], reach = -1.0 } }", "reach = -1 found"),
        ("{ hints = { path = [[1, 2, 3]], attempts = 0 } }", "attempts = 0 found"),
    ] {
        let error = complain(generator);
        assert!(error.contains(expected) && error.contains("slit.toml:"), "{generator}: {error}");
    }
}

#[test]
fn paths_are_sampled_as_finely_as_there_is_room() {
    let space = slit("{ hints = { path = [[1, 1, 0]] } }").space();
    let path = [vec![0.0, 0.0, 0.0], vec![4.0, 0.0, 0.0], vec![4.0, 0.0, 0.0], vec![4.0, 1.0, 0.0]];
    assert_eq!(resampled(&space, &path, 1.0).len(), 6);
    assert_eq!(fitted(&space, &path, 0.1, 6).len(), 5);
    assert_eq!(fitted(&space, &path, 0.1, 100).len(), 51);
    assert_eq!(fitted(&space, &path, 0.1, 2), [path[0].clone(), path[3].clone()]);
    assert_eq!(evenly((0..10).collect(), 4), [0, 3, 6, 9]);
    assert_eq!(evenly((0..3).collect(), 1), [0]);
    assert_eq!(evenly((0..3).collect(), 0), [0; 0]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, ..ProptestConfig::default() })]

    /// Whatever the path, the push, the number of milestones and the set: sets are full, valid, sound, joined by valid motions, and functions of the seed.
    #[test]
    fn sets_are_full_valid_and_sound(
        path in prop::collection::vec((0.0..10.0, 0.0..10.0, -3.0..3.0), 1..5),
        push in prop::sample::select(vec!["simple", "shortest", "workspace", "retraction", "all"]),
        nodes in 1u64..60,
        (ordinal, seed) in (0u64..5, 0u64..1000),
    ) {
        let path: Vec<[f64; 3]> = path.into_iter().map(|(x, y, angle)| [x, y, angle]).collect();
        let text = format!("{{ hints = {{ path = {path:?}, push = \"{push}\" }} }}");
        let problem = slit(&text).with_seed(seed);
        let strategies = vec![StrategySpec::from(&problem.strategies[0]).nodes(nodes)];
        let problem = problem.to_builder().strategies(strategies).build().unwrap();
        let mut frozen = Roadmap::new(&problem.space());
        let first = made(&problem, 0, Some(&frozen));
        frozen.fold_round(&problem.space(), [(&first, &[][..])]);
        let set = made(&problem, ordinal, Some(&frozen));
        prop_assert_eq!(set.configs.len() as u64, nodes);
        let (cx, scratch) = (problem.context(), &mut Scratch::new());
        prop_assert!(set.configs.iter().all(|q| cx.model.is_valid(q, scratch)));
        prop_assert!(set.is_sound(SetForm::of(problem.model.description()), nodes));
        for (edges, from) in [(&set.edges, &set.configs), (&set.root_edges, frozen.configs())] {
            for edge in edges {
                let (a, b) = (from.get(edge.low.index()), set.configs.get(edge.high.index()));
                prop_assert!(cx.model.motion(a, b, 1, scratch).is_some());
            }
        }
        prop_assert_eq!(made(&problem, ordinal, Some(&frozen)), set);
    }
}

#[test]
fn the_default_push_is_the_one_that_docs_name() {
    assert_eq!(Push::default(), Push::All);
}
