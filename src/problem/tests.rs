use super::*;
use crate::model::bodies::Bodies;
use crate::model::bodies::validity::MotionChecking;
use crate::numbers::StrategyIndex;
use crate::schedule::Adaptive;

const WALLS: &str = include_str!("../../problems/walls.toml");

fn parse(text: &str) -> Result<Problem, String> {
    Problem::parse(Path::new("walls.toml"), text).map_err(|error| error.to_string())
}

#[test]
fn every_choice_is_noted_and_every_default_is_the_papers() {
    let problem = parse(WALLS).unwrap();
    assert_eq!((problem.name.as_str(), problem.seed), ("walls", DEFAULT_SEED));
    assert_eq!((problem.sets_per_round, problem.strategies[0].nodes), (5, 50));
    // With a query trees grow from both its ends, too; without one there are uniform sets alone.
    assert_eq!(problem.schedule, [0, 1].map(StrategyIndex));
    assert_eq!(problem.adaptive, Some(Adaptive::default()));
    let labels: Vec<_> = problem.strategies.iter().map(|strategy| strategy.label()).collect();
    assert_eq!(labels, ["uniform", "trees"]);
    let (aimless, _) = WALLS.split_once("[query]").expect("walls has a query");
    let aimless = parse(aimless).unwrap();
    assert_eq!((aimless.strategies.len(), aimless.schedule), (1, vec![StrategyIndex(0)]));
    assert_eq!(aimless.adaptive, None);
    let described = problem.describe();
    for expected in
        ["x y z qw qx qy qz", "neighbors = 10", "components = 3, pairs = 10", "12 box", "chosen"]
    {
        assert!(described.contains(expected), "{expected} in\n{described}");
    }
}

#[test]
fn errors_name_file_line_and_key() {
    let line_of = |key: &str| {
        1 + WALLS.lines().position(|line| line.starts_with(key)).expect("walls has the key")
    };
    let replaced = |key: &str, with: &str| {
        let old = WALLS.lines().nth(line_of(key) - 1).unwrap();
        (WALLS.replace(old, with), format!("walls.toml:{}: ", line_of(key)))
    };
    for (key, with, expected) in [
        ("bounds", "bounds = \"bodies\"", "unknown variant `bodies`"),
        ("bounds", "bonds = \"body\"", "unknown field `bonds`"),
        ("max", "max = [8.0, -4.0, 4.0]", "space.max: in y max = -4 found; more than min = 0"),
        ("max", "max = [8.0, nan, 4.0]", "space.max: NaN found"),
        ("min", "min = [0.0, 0.0]", "space.min: 2 values found; 3 expected"),
        ("start", "start = [1.0, 2.0]", "query.start: 2 values found, 7 expected: x y z qw"),
        ("start", "start = [2.0, 3.0, 2.0, 1.0, 0.0, 0.0, 0.0]", "query.start: [2.0, 3.0"),
        ("start", "start = [-2.0, 3.0, 2.0, 1.0, 0.0, 0.0, 0.0]", "x is -2, 0 to 8 expected"),
        ("goal", "goal = [7.0, 2.0, 2.0, 0.0, 0.0, 0.0, 0.0]", "query.goal: the quaternion"),
    ] {
        let (text, place) = replaced(key, with);
        let error = parse(&text).unwrap_err();
        assert!(error.starts_with(&place) && error.contains(expected), "{error}");
    }
}

#[test]
fn errors_in_added_tables_name_the_key() {
    let strategy = "[[strategies]]\nlabel = \"a\"\nsampler = { uniform = {} }\n";
    for (added, expected) in [
        ("[img]\nsets_per_round = 0\n", "img.sets_per_round: 0 found; 1 to"),
        ("[limits]\nnodes = 1_000_000_000_000\n", "limits.nodes: 1000000000000 found; 1 to"),
        ("[limits]\nseconds = -1.0\n", "limits.seconds: -1 found"),
        ("[[strategies]]\nlabel = \"a\"\nsampler = { uniform = { atempts = 3 } }\n", "`atempts`"),
        (
            "[[strategies]]\nlabel = \"a\"\nsampler = \"uniform\"\n",
            "`uniform` alone found; a table with its settings expected, as { uniform = {",
        ),
        ("[[strategies]]\nlabel = \"a\"\nsampler = {}\n", "an empty table found; one with one key"),
        (
            "[[evaluators]]\nquery = {}\ncoverage = { percent = 1 }\n",
            "a table with several keys found; one with one key",
        ),
        (&format!("{strategy}nodes = 0\n"), "strategies[0].nodes: 0 found; 1 to"),
        (&format!("{strategy}{strategy}"), "strategies[1].label: `a` found twice"),
        (
            &format!("{strategy}within = {{ nearest = {{ neighbors = 0 }} }}\n"),
            "strategies[0].within: neighbors = 0 found; at least 1 expected",
        ),
        ("[img]\nschedule = { adaptive = { round = 3 } }\n", "an array of labels, or { adaptive"),
        ("[img]\nschedule = { adaptive = { rounds = 0 } }\n", "img.schedule: rounds = 0 found"),
        (&format!("{strategy}[img]\nschedule = [\"b\"]\n"), "img.schedule: `b` found"),
        (
            "[[obstacles]]\nshape = { mesh = { file = \"none.obj\" } }\n",
            "obstacles[12].shape: none.obj: cannot read the mesh",
        ),
        (
            "[[obstacles]]\nshape = { sphere = { radius = 1e40 } }\n",
            "obstacles[12].shape: radius = 1e40 found; at most 1e30 expected",
        ),
        (
            "[[obstacles]]\nshape = { sphere = { radius = 0.0 } }\n",
            "obstacles[12].shape: radius = 0 found; a positive length expected",
        ),
        (
            "[[obstacles]]\nshape = { sphere = { radius = 0.1 } }\norientation = [0, 0, 0, 0]\n",
            "obstacles[12].orientation: [0.0, 0.0, 0.0, 0.0] found",
        ),
        ("[[obstacles]]\nshape = { point = {} }\n", "obstacles[12].shape: a point cannot be"),
        (
            "[[obstacles]]\nshape = { sphere = { radius = 0.1 } }\nsolid = false\n",
            "obstacles[12].solid: false found; a sphere is always solid",
        ),
        (
            "[[obstacles]]\nshape = { sphere = { radius = 0.1 } }\nsolid = \"maybe\"\n",
            "\"auto\", true or false",
        ),
    ] {
        let error = parse(&format!("{WALLS}\n{added}")).unwrap_err();
        assert!(error.starts_with("walls.toml:") && error.contains(expected), "{error}");
    }
}

#[test]
fn the_digest_covers_what_determines_entries_and_nothing_else() {
    let problem = parse(WALLS).unwrap();
    let digest = problem.digest();
    let changed = |change: fn(&mut Bodies)| {
        let mut problem = problem.clone();
        change(problem.model.bodies_mut().expect("walls is of bodies"));
        problem
    };
    for (changed, same) in [
        (Problem { name: "other".to_owned(), ..problem.clone() }, true),
        (Problem { evaluators: Vec::new(), ..problem.clone() }, true),
        (Problem { seed: 2, ..problem.clone() }, false),
        (changed(|bodies| bodies.resolution = 0.01), false),
        (changed(|bodies| bodies.edges = MotionChecking::Sampled), false),
        (Problem { sets_per_round: 6, ..problem.clone() }, false),
        (changed(|bodies| bodies.obstacles.clear()), false),
    ] {
        assert_eq!(changed.digest() == digest, same);
    }
}

#[test]
fn errors_in_linkages_name_the_link() {
    let linkage = |link: &str| {
        let first = "[[robot.links]]\nname = \"first\"\njoint = { kind = { fixed = {} } }\n";
        format!("{WALLS}\n{first}[[robot.links]]\n{link}\n")
    };
    let revolute = "joint = { kind = { revolute = { axis = [0, 0, 1] } } }";
    for (link, expected) in [
        (format!("name = \"first\"\n{revolute}"), "robot.links[1].name: `first` found"),
        (format!("name = \"a b\"\n{revolute}"), "robot.links[1].name: `a b` found"),
        (
            "name = \"a\"\njoint = { parent = \"a\", kind = { fixed = {} } }".to_owned(),
            "robot.links[1].joint.parent: `a` found; the name of a link before",
        ),
        (
            "name = \"a\"\njoint = { kind = { revolute = { axis = [0, 0, 0] } } }".to_owned(),
            "robot.links[1].joint.kind: axis [0.0, 0.0, 0.0] found",
        ),
        (
            "name = \"a\"\njoint = { kind = { revolute = { axis = [0, 0, 1], degrees = [9, -9] } } }"
                .to_owned(),
            "robot.links[1].joint.kind: 9 to -9 found",
        ),
        (
            "name = \"a\"\njoint = { kind = { prismatic = { axis = [0, 0, 1], range = [0, nan] } } }"
                .to_owned(),
            "robot.links[1].joint.kind: 0 to NaN found",
        ),
        (
            "name = \"a\"\njoint = { kind = { revolute = { axis = [0, 0, 1], degrees = [0, 1], radians = [0, 1] } } }"
                .to_owned(),
            "robot.links[1].joint.kind: degrees and radians found",
        ),
        ("name = \"a\"\njoint = { kind = { screw = {} } }".to_owned(), "unknown variant `screw`"),
        (
            format!("name = \"a\"\n{revolute}\nbodies = [{{ shape = {{ sphere = {{ radius = -1 }} }} }}]"),
            "robot.links[1].bodies[0].shape: radius = -1 found",
        ),
    ] {
        let error = parse(&linkage(&link)).unwrap_err();
        assert!(error.starts_with("walls.toml:") && error.contains(expected), "{error}");
    }
    for (from, to, expected) in [
        ("[robot]", "[robot]\nurdf = \"a.urdf\"", "robot.bodies: given beside urdf"),
        ("bodies = [", "urdf = \"a.urdf\" # [", "robot.urdf: a.urdf: cannot read"),
        ("[robot]", "[robot]\nname = \"a/b\"", "robot.name: `a/b` found"),
    ] {
        let error = parse(&WALLS.replacen(from, to, 1)).unwrap_err();
        assert!(error.starts_with("walls.toml:") && error.contains(expected), "{error}");
    }
    let fixed = WALLS.replace("rigid-3d", "fixed").split("[query]").next().unwrap().to_owned();
    assert!(parse(&fixed).unwrap_err().contains("robot: nothing moves"));
}

#[test]
fn a_problem_that_is_cut_off_is_an_error_or_a_smaller_problem() {
    let ends = (0..WALLS.len()).filter(|end| WALLS.is_char_boundary(*end));
    for end in ends {
        if let Err(error) = parse(&WALLS[..end]) {
            assert!(error.starts_with("walls.toml"), "{error}");
        }
    }
}
