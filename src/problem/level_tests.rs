use super::*;
use crate::Build;
use crate::generator::{GeneratorKind, HintPath, Hints, Parent, Reuse};
use crate::model::{ExtraJoint, ExtraJointKind, Relaxation, ScaleRobot};
use crate::relaxation::Settings;
use std::path::Path;

fn bracket() -> Problem {
    Problem::load(Path::new("problems/bracket.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn paths_of(built: &crate::Built) -> Vec<Vec<Vec<f64>>> {
    built.path().iter().map(|path| path.configs.iter().map(<[f64]>::to_vec).collect()).collect()
}

#[test]
fn the_first_level_without_relaxation_is_the_build_of_the_problem() {
    let problem = bracket();
    let first = problem.at_level(1, 1.0, None).expect("a level");
    assert_eq!(first.digest(), problem.digest());
    assert_eq!((first.seed(), first.limits().nodes), (problem.seed(), 3000));
    let second = problem.at_level(2, 1.0, None).expect("a level");
    assert_ne!((second.seed(), second.digest()), (problem.seed(), problem.digest()));
    assert!(second.seed() < 1 << 63);
    let relaxed = problem.at_level(2, 0.5, None).expect("a level");
    assert_eq!(relaxed.scene_difference(&second).as_deref(), Some("the robot is not what it was"));
}

#[test]
fn a_relaxation_is_no_part_of_the_digest_and_is_written_and_built_again() {
    let problem = bracket();
    let settings = problem.relaxation().expect("it has one").clone();
    let kind = Relaxation::ScaleRobot(ScaleRobot { least: 0.2, ..ScaleRobot::default() });
    assert_eq!((settings.kind.as_ref(), settings.nodes), (Some(&kind), 3000));
    let other = Settings { nodes: 7, ..settings.clone() };
    let changed = problem.clone().with_relaxation(other).expect("sound settings");
    assert_eq!(changed.digest(), problem.digest());
    assert_ne!(changed.relaxation_digest(), problem.relaxation_digest());
    let written = Problem::parse(Path::new("it.toml"), &problem.to_toml("files").text);
    let written = written.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(written.relaxation(), Some(&settings));
    assert_eq!(written.relaxation_digest(), problem.relaxation_digest());
    let again = problem.to_builder().build().expect("a sound problem");
    assert_eq!(again.relaxation(), Some(&settings));
    assert!(problem.describe().contains("relaxation       { kind = { scale-robot ="));
    // A table that names no kind has the usual one.
    let text = problem.to_toml("files").text.replace("kind = { scale-robot", "#");
    let usual =
        Problem::parse(Path::new("it.toml"), &text).unwrap_or_else(|error| panic!("{error}"));
    let kind = usual.relaxation().and_then(|settings| settings.kind.clone());
    assert_eq!(kind, Some(Relaxation::ScaleRobot(ScaleRobot::default())));
}

#[test]
fn half_of_the_sets_take_something_over_from_the_level_before() {
    let problem = bracket();
    let easy = problem.at_level(1, 0.0, None).expect("a level");
    let built = Build::new(easy).run().expect("it can be built");
    let paths = paths_of(&built);
    assert_eq!(paths.len(), 1, "the smallest bracket slips through");
    let earlier = EarlierLevel {
        level: 0.0,
        problem: built.problem(),
        roadmap: built.roadmap(),
        place: "level-01",
        paths: &paths,
    };
    let next = problem.at_level(2, 0.25, Some(&earlier)).expect("a level");
    let own = problem.strategies().len();
    let added = &next.strategies()[own..];
    assert!(!added.is_empty());
    let GeneratorKind::Hints(hints) = added[0].generator() else { panic!("{added:?}") };
    let hinted = hints.path.as_ref().map(|path| path.configurations().to_vec());
    assert_eq!((hinted.as_ref(), hints.paths.len()), (paths.first(), 0));
    assert!(hints.step.is_some(), "what is left open is found when the level is made");
    assert!(matches!(added[1].generator(), GeneratorKind::Reuse(_)));
    // They take turns with the problem's own.
    let is_added: Vec<bool> = next.schedule().iter().map(|index| index.index() >= own).collect();
    assert!(is_added.chunks(2).all(|pair| pair == [true, false]), "{is_added:?}");
    for (index, _) in added.iter().enumerate() {
        assert!(next.schedule().iter().any(|known| known.index() == own + index));
    }
    // The same again, and another once the roadmap before is another.
    let again = problem.at_level(2, 0.25, Some(&earlier)).expect("a level");
    assert_eq!(again.to_bytes(), next.to_bytes());
    let (layout, bytes) = next.to_bytes();
    assert_eq!(
        Problem::from_bytes(layout, &bytes).expect("it is read back").digest(),
        next.digest()
    );
    let solved = Build::new(next).run().expect("it can be built");
    assert!(solved.path().is_some());
}

/// A path of a level with an extra joint helps the next level, whose joint has less of its range, and the problem itself, which has none.
#[test]
fn paths_are_carried_over_where_levels_have_another_number_of_values() {
    let problem =
        Problem::load(Path::new("problems/stick2.toml")).unwrap_or_else(|error| panic!("{error}"));
    let bodies = problem.model().bodies().expect("a linkage");
    let link = bodies.robot().links[1].name.clone();
    let kind = ExtraJointKind::Revolute { axis: [0.0, 0.0, 1.0], degrees: [-30.0, 30.0] };
    let kind = Some(Relaxation::ExtraJoint(ExtraJoint { link, kind }));
    let settings = Settings { kind, ..Settings::default() };
    let problem = problem.with_relaxation(settings).expect("sound settings");
    let easy = problem.at_level(1, 0.5, None).expect("a level");
    let own = problem.space().len();
    assert_eq!(easy.space().len(), own + 1);
    let relaxed = problem.relaxed_model(0.5).expect("a model");
    let at = relaxed.extra_value.expect("it has a joint more");
    let ends = easy.query().expect("it has a query");
    let mut bent = ends.start.clone();
    bent[at] = 0.2;
    let paths = vec![vec![ends.start.clone(), bent.clone(), ends.goal.clone()]];
    let built = Build::new(easy.to_builder().most_sets(1).build().expect("sound")).run();
    let built = built.expect("it can be built");
    let earlier = EarlierLevel {
        level: 0.5,
        problem: built.problem(),
        roadmap: built.roadmap(),
        place: "level-01",
        paths: &paths,
    };
    for (level, expected) in [(0.75, Some(0.1)), (1.0, None)] {
        let next = problem.at_level(2, level, Some(&earlier)).expect("a level");
        let hints = next.strategies().iter().find_map(|strategy| match strategy.generator() {
            GeneratorKind::Hints(hints) => hints.path.clone(),
            _ => None,
        });
        let hints = hints.expect("hints").configurations().to_vec();
        let value = expected.map(|_| hints[1][at]);
        assert_eq!(value.map(|value| (value * 1e9).round()), expected.map(|value| value * 1e9));
        let mut kept = hints[1].clone();
        if expected.is_some() {
            kept.remove(at);
        }
        let mut original = bent.clone();
        original.remove(at);
        assert_eq!(kept, original);
        // Roadmaps are taken over only where configurations have the same values.
        let reuses =
            next.strategies().iter().any(|s| matches!(s.generator(), GeneratorKind::Reuse(_)));
        assert_eq!(reuses, expected.is_some());
    }
}

/// A strategy that no relaxed level suits is told with the table that asks for such levels, and a build without it has nothing against it.
#[test]
fn strategies_that_do_not_suit_relaxed_levels_are_told_at_once() {
    let text = include_str!("../../problems/bracket.toml");
    let trees = text.replace("retraction-trees", "contact-trees");
    let depth = "kind = { penetration = { depth = 1.0 } }";
    let kind = "kind = { scale-robot = { least = 0.2 } }";
    let line = 1 + text.lines().position(|line| line == kind).expect("a kind");
    Problem::parse(Path::new("it.toml"), &trees).unwrap_or_else(|error| panic!("{error}"));
    Problem::parse(Path::new("it.toml"), &text.replace(kind, depth)).expect("it has no contacts");
    let refused = Problem::parse(Path::new("it.toml"), &trees.replace(kind, depth));
    let refused = refused.expect_err("bodies that may overlap have no contacts").to_string();
    let said = format!(
        "it.toml:{line}: relaxation.kind: at level 0 strategy `trees`: generator: the push retraction found"
    );
    assert!(refused.starts_with(&said), "{refused}");
    // A program is told, too.
    let problem = Problem::parse(Path::new("it.toml"), &trees).expect("a problem");
    let settings: Settings = toml::from_str(depth).expect("settings");
    let refused = problem.with_relaxation(settings).expect_err("no contacts").to_string();
    assert!(refused.starts_with("relaxation.kind: at level 0 strategy `trees`"), "{refused}");
}

/// Hints are of the problem's own configurations; those of a level with a joint more have one value more.
#[test]
fn hints_of_users_are_lifted_to_levels_with_an_extra_joint_and_roadmaps_are_refused() {
    let problem =
        Problem::load(Path::new("problems/stick2.toml")).unwrap_or_else(|error| panic!("{error}"));
    let ends = problem.query().expect("it has a query").clone();
    let path = vec![ends.start.clone(), ends.goal.clone()];
    let hints = GeneratorKind::Hints(Hints::new(HintPath::new(path.clone())));
    let link = problem.model().bodies().expect("a linkage").robot().links[1].name.clone();
    let kind = ExtraJointKind::Revolute { axis: [0.0, 0.0, 1.0], degrees: [-30.0, 30.0] };
    let kind = Some(Relaxation::ExtraJoint(ExtraJoint { link, kind }));
    let settings = Settings { kind, ..Settings::default() };
    let with = |generator| {
        let builder = problem.to_builder().strategy(StrategySpec::generated("mine", generator));
        builder.schedule(["mine"].into_iter().chain(labels(&problem))).relaxation(settings.clone())
    };
    let hinted = with(hints).build().unwrap_or_else(|error| panic!("{error}"));
    let at = hinted.relaxed_model(0.5).expect("a model").extra_value.expect("a joint more");
    for (level, is_longer) in [(0.5, true), (1.0, false)] {
        let problem = hinted.at_level(2, level, None).expect("a level");
        let strategy = problem.strategies().iter().find(|strategy| strategy.label() == "mine");
        let GeneratorKind::Hints(hints) = strategy.expect("it is there").generator() else {
            panic!("hints")
        };
        let mut found = hints.path.clone().expect("a path").configurations().to_vec();
        if is_longer {
            assert!(found.iter_mut().all(|q| q.remove(at) == 0.0), "{found:?}");
        }
        assert_eq!(found, path);
        assert!(hints.step.is_some());
    }
    // A roadmap of the problem's own configurations cannot be taken over there.
    let built = Build::new(problem.to_builder().most_sets(1).build().expect("sound")).run();
    let roadmap = built.expect("it can be built");
    let parent = Parent::of("old", roadmap.roadmap().digest(), roadmap.roadmap());
    let reuse = GeneratorKind::Reuse(Reuse::new(parent, 0.1));
    let error = with(reuse).build().expect_err("another number of values").to_string();
    let said = "at level 0 strategy `mine`: generator: the roadmap of another run found, with configurations of 8 values; 9 expected";
    assert!(error.contains(said), "{error}");
}

fn labels(problem: &Problem) -> Vec<&str> {
    problem.schedule().iter().map(|index| problem.strategies()[index.index()].label()).collect()
}

#[test]
fn how_far_a_level_is_relaxed_is_told() {
    let settings = bracket().relaxation().expect("it has one").clone();
    let kind = settings.kind.expect("a kind");
    let told: Vec<String> = [0.0, 0.5, 1.0].iter().map(|level| kind.amount_at(*level)).collect();
    assert_eq!(told, ["factor 0.2000", "factor 0.6000", "factor 1.0000"]);
}

#[test]
fn ends_that_are_not_valid_at_a_level_are_told() {
    let text = bracket().to_toml("files").text;
    // The bracket is scaled about a point far from it: made smaller it leaves the bounds.
    let far = text.replace("centre = \"centroid\"", "centre = [500.0, 0.0, 0.0]");
    assert_ne!(far, text);
    let problem =
        Problem::parse(Path::new("it.toml"), &far).unwrap_or_else(|error| panic!("{error}"));
    let Err(NoLevel::InvalidEnds(why)) = problem.at_level(2, 0.5, None) else { panic!("invalid") };
    assert!(why.starts_with("query.start: [12.0, 20.0, 0.0] found, where"), "{why}");
    assert!(problem.at_level(2, 1.0, None).is_ok());
    // A little too near to the bounds, it is moved.
    let near = text.replace("start = [12.0, 20.0, 0.0]", "start = [6.001, 20.0, 0.0]");
    let near = near.replace("centre = \"centroid\"", "centre = [-10.0, 0.0, 0.0]");
    let problem =
        Problem::parse(Path::new("it.toml"), &near).unwrap_or_else(|error| panic!("{error}"));
    let level = problem.at_level(2, 0.9, None).expect("a level");
    let start = &level.query().expect("a query").start;
    let moved = problem.space().distance(start, &problem.query().expect("a query").start);
    assert!(moved > 0.0 && moved <= 0.05 * problem.space().diameter(), "{moved}");
    assert!(level.context().model().is_valid(start, &mut crate::model::Scratch::new()));
    assert!(level.notes().iter().any(|note| note.starts_with("query.start: moved by")));
}

#[test]
fn what_is_wrong_with_a_relaxation_is_named_by_line_and_key() {
    let text = include_str!("../../problems/bracket.toml");
    let line = 1 + text.lines().position(|line| line.starts_with("kind")).expect("a kind");
    for (kind, said) in [
        ("{ scale-robot = { least = 0.0 } }", "relaxation.kind.scale-robot.least: least = 0 found"),
        ("{ scale-robot = { least = 1.0 } }", "least = 1 found; a factor from 0.001 to below 1"),
        (
            "{ scale-robot = { centre = [inf, 0, 0] } }",
            "relaxation.kind.scale-robot.centre: centre",
        ),
        ("{ scale-robot = { least = 0.5, axes = [false, false, false] } }", "at least one true"),
        ("{ scale-robot = { lest = 0.5 } }", "unknown field `lest`"),
        ("{ scale-robot = { centre = \"middle\" } }", "expected \"centroid\" or [x, y, z]"),
        ("{ scale-robot = { axes = \"x\" } }", "expected \"all\" or three of true and false"),
        ("{ penetration = { depth = -1.0 } }", "relaxation.kind.penetration.depth: depth = -1"),
        ("{ penetration = {} }", "missing field `depth`"),
        ("{ scale-obstacles = { factor = 2, obstacles = [2] } }", "numbers from 0 to 1 expected"),
        ("{ scale-obstacles = { factor = 1001 } }", "factor = 1001 found"),
        (
            "{ scale-obstacles = { factor = 1 } }",
            "factor = 1 found; a factor from 0.001 to 1000, other",
        ),
        (
            "{ penetration = { depth = 1e6 } }",
            "relaxation.kind.penetration.depth: 1000000 found; less than the largest distance",
        ),
        (
            "{ thin-robot = { by = 2.0 } }",
            "relaxation.kind.thin-robot.by: 2 found, which leaves nothing",
        ),
        ("{ energy = { highest = 1.0 } }", "relaxation.kind: energy found"),
        (
            "{ extra-joint = { link = \"base\", kind = { prismatic = { axis = [1, 0, 0], range = [0, 1] } } } }",
            "relaxation.kind.extra-joint.link: `base` found",
        ),
        (
            "{ extra-joint = { link = \"a\", kind = { revolute = { axis = [1, 0, 0], degrees = [1, 2] } } } }",
            "relaxation.kind.extra-joint.degrees: degrees = [1.0, 2.0] found",
        ),
        (
            "{ extra-joint = { link = \"a\", kind = { prismatic = { axis = [1, 0, 0], range = [-inf, 0] } } } }",
            "relaxation.kind.extra-joint.range: range = [-inf, 0.0] found",
        ),
        (
            "{ extra-joint = { link = \"a\", kind = { revolute = { axis = [1, 0, 0], degrees = [0, 361] } } } }",
            "an angle from -360 to 0 and a larger one from 0 to 360 expected",
        ),
        ("{ smaller = {} }", "unknown variant `smaller`"),
    ] {
        let changed = text.replace("{ scale-robot = { least = 0.2 } }", kind);
        assert_ne!(changed, text);
        let error = Problem::parse(Path::new("it.toml"), &changed).expect_err(kind).to_string();
        assert!(error.contains(said), "{kind}: {error}");
        assert!(error.starts_with(&format!("it.toml:{line}: ")), "{kind}: {error}");
    }
    let start = text.replace("nodes = 3000", "start = 2.0");
    let error = Problem::parse(Path::new("it.toml"), &start).expect_err("no level").to_string();
    let expected = format!("it.toml:{}: relaxation.start: start = 2 found", line + 1);
    assert!(error.starts_with(&expected), "{error}");
    let landscape = include_str!("../../tests/problems/landscape.toml");
    let error = Problem::parse(Path::new("l.toml"), &format!("{landscape}\n[relaxation]\n"));
    let error = error.expect_err("no usual way").to_string();
    assert!(error.contains("relaxation.kind: none found"), "{error}");
}

/// The model with the highest energy is the landscape, too.
#[test]
fn energies_are_relaxed_up_to_the_highest_that_is_asked_for() {
    let landscape = include_str!("../../problems/muller-brown.toml");
    let landscape = landscape.replace("tolerance = 0.001", "tolerance = 0.001\nhighest = 0.0");
    let problem = Problem::parse(Path::new("l.toml"), &landscape).expect("a problem");
    let crate::model::ModelKind::Landscape(own) = problem.model() else { panic!("a landscape") };
    let own = own.highest().expect("it has a highest energy");
    let asked = |highest: f64| {
        format!("{landscape}\n[relaxation]\nkind = {{ energy = {{ highest = {highest:?} }} }}\n")
    };
    let relaxed = Problem::parse(Path::new("l.toml"), &asked(own + 8.0)).expect("a problem");
    let level = relaxed.at_level(2, 0.25, None).expect("a level");
    let crate::model::ModelKind::Landscape(level) = level.model() else { panic!("a landscape") };
    assert_eq!(level.highest(), Some(own + 6.0));
    for highest in [own - 1.0, own] {
        let error = Problem::parse(Path::new("l.toml"), &asked(highest)).expect_err("not higher");
        assert!(error.to_string().contains("more than the model's own highest"), "{error}");
    }
}
