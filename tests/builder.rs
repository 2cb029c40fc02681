//! Problems made from values: the same as those that files describe, with the same errors.

#[path = "support/values.rs"]
mod values;

use roadmill::Build;
use roadmill::evaluate::{All, Coverage, Drawn, EvaluatorKind, Not, Query, Samples};
use roadmill::model::bodies::validity::{BoundsMeaning, MotionChecking};
use roadmill::model::bodies::{BodiesSpec, BodySpec, RobotSpec, ShapeSpec, SpaceSpec};
use roadmill::model::landscape::{Energy, LandscapeSpec, Term};
use roadmill::problem::{Problem, ProblemBuilder, StrategySpec};
use roadmill::sampler::{Mix, SamplerKind, Share, Uniform};
use roadmill::schedule::Adaptive;
use roadmill::space::BaseJoint;
use values::{
    FACES, TETRAHEDRON, adaptive, arm, ball, cage, expansion, gantry, in_memory, landscape, load,
    meshes, path, planar, plane,
};

#[test]
fn a_built_problem_is_that_of_its_file() {
    for (file, builder) in [
        ("tests/problems/planar.toml", planar()),
        (
            "tests/problems/meshes.toml",
            meshes(|scale| ShapeSpec::Mesh { file: "tetrahedron.obj".into(), scale, weld: 1e-6 }),
        ),
        ("tests/problems/ball.toml", ball()),
        ("tests/problems/arm.toml", arm()),
        ("tests/problems/landscape.toml", landscape()),
        ("tests/problems/adaptive.toml", adaptive()),
        ("tests/problems/expansion.toml", expansion()),
        ("problems/gantry.toml", gantry()),
        ("problems/cage.toml", cage()),
    ] {
        let of_file = load(file);
        let built = builder.build().unwrap_or_else(|error| panic!("{file}: {error}"));
        assert_eq!(built.digest(), of_file.digest(), "{file}");
        // The file names itself among those that were read, and nothing else differs.
        assert_eq!(built.sources(), &of_file.sources()[1..], "{file}");
        assert_eq!(built.describe(), of_file.describe(), "{file}");
        assert_eq!(built.notes(), of_file.notes(), "{file}");
        assert_eq!(built.query(), of_file.query(), "{file}");
        assert_eq!(built.evaluators(), of_file.evaluators(), "{file}");
        assert_eq!(built.limits(), of_file.limits(), "{file}");
    }
}

#[test]
fn a_mesh_in_memory_is_one_of_a_file() {
    let of_file = load("tests/problems/meshes.toml");
    let built = meshes(in_memory).build().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(built.digest(), of_file.digest());
    assert_eq!(built.notes(), of_file.notes());
    assert!(built.sources().is_empty());

    // Vertices given once for each triangle, a face given twice, a flat one, and a vertex of no use.
    let untidy = |scale| {
        let corner = |corner: &u32| TETRAHEDRON[*corner as usize];
        let mut vertices: Vec<[f64; 3]> = FACES.iter().flatten().map(corner).collect();
        vertices.push([9.0; 3]);
        let mut triangles: Vec<[u32; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        triangles.extend([[2, 1, 0], [0, 0, 1]]);
        ShapeSpec::Triangles { vertices, triangles, scale, weld: 1e-6 }
    };
    let folder = tempfile::tempdir().expect("a scratch folder");
    let ShapeSpec::Triangles { vertices, triangles, .. } = untidy(1.0) else { unreachable!() };
    let mut obj = String::new();
    vertices.iter().for_each(|[x, y, z]| obj += &format!("v {x} {y} {z}\n"));
    triangles.iter().for_each(|face| {
        let [a, b, c] = face.map(|corner| corner + 1);
        obj += &format!("f {a} {b} {c}\n");
    });
    std::fs::write(folder.path().join("untidy.obj"), obj).expect("it can be written");
    let of_file = meshes(|scale| ShapeSpec::Mesh { file: "untidy.obj".into(), scale, weld: 1e-6 });
    let of_file = of_file.folder(folder.path()).build().expect("a sound problem");
    let built = meshes(untidy).build().expect("a sound problem");
    assert_eq!(built.digest(), of_file.digest());
    assert_eq!(built.notes(), of_file.notes());
}

#[test]
fn a_problem_makes_its_builder_again() {
    for folder in ["problems", "tests/problems"] {
        for entry in std::fs::read_dir(path(folder)).expect("the folder is there") {
            let file = entry.expect("an entry").path();
            if file.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let problem = Problem::load(&file).unwrap_or_else(|error| panic!("{error}"));
            let again = problem.to_builder().build().unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(again.digest(), problem.digest(), "{}", file.display());
            assert_eq!(again.query(), problem.query(), "{}", file.display());
            assert_eq!(again.evaluators(), problem.evaluators(), "{}", file.display());
            assert_eq!(again.limits(), problem.limits(), "{}", file.display());
            let other = problem.to_builder().seed(problem.seed() + 1).build().expect("any seed");
            assert_ne!(other.digest(), problem.digest());
        }
    }
}

#[test]
fn every_number_survives_to_the_bit() {
    let awkward = [0.1 + 0.2, 1.0 / 3.0, 5e-324, f64::MIN_POSITIVE, -0.0];
    let term =
        Term { height: awkward[0], centre: [awkward[1], -0.0], xx: -1.0, xy: 5e-324, yy: -2.0 };
    let landscape =
        LandscapeSpec::new([-awkward[0], -1.0], [1.0, awkward[1]], Energy::Terms(vec![term]));
    let many = SamplerKind::Uniform(Uniform { attempts: u64::MAX });
    let built = Problem::builder("awkward", landscape.tolerance(awkward[1]))
        .seed(u64::MAX)
        .strategy(StrategySpec::sampled("a \"label\"\n\\", many))
        .build()
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(built.seed(), u64::MAX);
    let written = built.to_toml("files");
    let again = Problem::parse("awkward.toml".as_ref(), &written.text)
        .unwrap_or_else(|error| panic!("{error}\n{}", written.text));
    assert_eq!(again.digest(), built.digest(), "{}", written.text);
    assert_eq!(again.describe(), built.describe());
}

#[test]
fn wrong_values_have_the_error_of_the_file_without_its_line() {
    let text = std::fs::read_to_string(path("tests/problems/planar.toml")).expect("it is there");
    let add = |added: BodySpec| planar().change_model(|m| m.change_bodies(|b| b.obstacle(added)));
    let space = |change: fn(SpaceSpec) -> SpaceSpec| {
        planar().change_model(|m| m.change_bodies(|b| b.change_space(change)))
    };
    let sphere = |radius| BodySpec::new(ShapeSpec::Sphere { radius });
    let first = |change: fn(StrategySpec) -> StrategySpec| {
        let mut index = 0;
        planar().change_strategies(|strategy| {
            index += 1;
            if index == 1 { change(strategy) } else { strategy }
        })
    };
    let obstacle = |text_of: &str| format!("{text}\n[[obstacles]]\n{text_of}\n");
    let with = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    };
    for (text, builder, begins) in [
        (
            obstacle("shape = { sphere = { radius = -1.0 } }"),
            add(sphere(-1.0)),
            "obstacles[3].shape: radius = -1 found",
        ),
        (
            obstacle("shape = { sphere = { radius = nan } }"),
            add(sphere(f64::NAN)),
            "obstacles[3].shape: radius = NaN found",
        ),
        (
            obstacle("shape = { sphere = { radius = 1 } }\nsolid = false"),
            add(sphere(1.0).solid(false)),
            "obstacles[3].solid: false found",
        ),
        (
            obstacle("shape = { sphere = { radius = 1 } }\nposition = [inf, 0, 0]"),
            add(sphere(1.0).at([f64::INFINITY, 0.0, 0.0])),
            "obstacles[3].position: [inf, 0.0, 0.0] found",
        ),
        (
            obstacle(
                "shape = { sphere = { radius = 1 } }\norientation = [1, 0, 0, 0]\nturn = { axis = [0, 0, 1], degrees = 1 }",
            ),
            add(sphere(1.0).orientation([1.0, 0.0, 0.0, 0.0]).turn([0.0, 0.0, 1.0], 1.0)),
            "obstacles[3].turn: given beside orientation",
        ),
        (
            obstacle("shape = { point = {} }"),
            add(ShapeSpec::Point {}.into()),
            "obstacles[3].shape: a point",
        ),
        (
            with("bounds = \"body\"", "bounds = \"body\"\nresolution = 0.0"),
            space(|space| space.resolution(0.0)),
            "space.resolution: 0 found",
        ),
        (
            with("bounds = \"body\"", "bounds = \"body\"\nrotation_length = -1"),
            space(|space| space.rotation_length(-1.0)),
            "space.rotation_length: -1 found",
        ),
        (with("sets = 15", "sets = 0"), planar().most_sets(0), "limits.sets: 0 found"),
        (
            with("sets = 15", "seconds = nan"),
            planar().most_seconds(f64::NAN),
            "limits.seconds: NaN",
        ),
        (
            with("per_round = 3", "per_round = 0"),
            planar().sets_per_round(0),
            "img.sets_per_round: 0",
        ),
        (
            with("[\"few\", \"many\", \"few\"]", "[\"few\", \"none\"]"),
            planar().schedule(["few", "none"]),
            "img.schedule: `none` found",
        ),
        (
            with("[\"few\", \"many\", \"few\"]", "[\"few\"]"),
            planar().schedule(["few"]),
            "img.schedule: the strategy `many` has no place",
        ),
        (
            with("[\"few\", \"many\", \"few\"]", "{ adaptive = { rounds = 0 } }"),
            planar().adaptive(Adaptive { rounds: 0 }),
            "img.schedule: rounds = 0 found",
        ),
        (
            with("label = \"many\"", "label = \"few\""),
            planar().change_strategies(|strategy| strategy.label("few")),
            "strategies[1].label: `few` found twice",
        ),
        (
            with("nodes = 7", "nodes = 0"),
            first(|strategy| strategy.nodes(0)),
            "strategies[0].nodes: 0",
        ),
        (
            with("uniform = {}", "uniform = { attempts = 0 }"),
            first(|s| s.sampler(SamplerKind::Uniform(Uniform { attempts: 0 }))),
            "strategies[0].sampler: attempts = 0",
        ),
        (
            with("start = [1.0, 1.0, 0.0]", "start = [1.0, 1.0]"),
            planar().query([1.0, 1.0], [9.0, 9.0, 1.5]),
            "query.start: 2 values found",
        ),
        (
            with("goal = [9.0, 9.0, 1.5]", "goal = [3.0, 3.0, 1.5]"),
            planar().query([1.0, 1.0, 0.0], [3.0, 3.0, 1.5]),
            "query.goal: ",
        ),
        (with("[space]", "name = \"a b\"\n[space]"), planar().name("a b"), "name: `a b` found"),
        (
            format!("{text}\n[[evaluators]]\ncoverage = {{ percent = 101 }}\n"),
            planar().evaluator(EvaluatorKind::Coverage(Coverage {
                percent: 101.0,
                ..Coverage::default()
            })),
            "evaluators[0]: percent = 101 found",
        ),
    ] {
        let built = builder.build().map(|_| ()).expect_err(begins).to_string();
        assert!(built.starts_with(begins), "{built}");
        let read = Problem::parse("planar.toml".as_ref(), &text).map(|_| ());
        let read = read.expect_err(begins).to_string();
        let (place, message) = read.split_once(": ").expect("a place and a message");
        assert!(place.starts_with("planar.toml:"), "{read}");
        assert_eq!(built, message);
    }
}

/// What is nested without end would overflow the stack of whoever looks at it.
#[test]
fn methods_nest_as_deep_as_a_file_can_say() {
    let not = |depth: usize| {
        let query = EvaluatorKind::Query(Query::default());
        (0..depth).fold(query, |inner, _| EvaluatorKind::Not(Not(Box::new(inner))))
    };
    let all = |depth: usize| {
        let query = EvaluatorKind::Query(Query::default());
        (0..depth).fold(query, |inner, _| EvaluatorKind::All(All(vec![inner])))
    };
    let mix = |depth: usize| {
        let mixed = |inner, _| SamplerKind::Mix(Mix(vec![Share::new(inner)]));
        (0..depth).fold(SamplerKind::default(), mixed)
    };
    let sampled =
        |depth| planar().strategies([StrategySpec::sampled("deep", mix(depth))]).default_schedule();
    let drawn = |depth| {
        let samples = Samples::Drawn(vec![Drawn { sampler: mix(depth), count: 2 }]);
        planar().evaluator(EvaluatorKind::Coverage(Coverage { samples, ..Coverage::default() }))
    };
    let makers: [(&str, &dyn Fn(usize) -> ProblemBuilder); 4] = [
        ("evaluators[0]", &|depth| planar().evaluator(not(depth))),
        ("evaluators[0]", &|depth| planar().evaluator(all(depth))),
        ("strategies[0].sampler", &sampled),
        ("evaluators[0]", &drawn),
    ];
    for (key, maker) in makers {
        let accepted = (0..100).take_while(|depth| maker(*depth).build().is_ok()).count();
        assert!((20..100).contains(&accepted), "{key}: {accepted}");
        let deepest = maker(accepted - 1).build().expect("accepted");
        let written = deepest.to_toml("meshes").text;
        let again = Problem::parse("deep.toml".as_ref(), &written);
        assert_eq!(again.expect("it can be read").digest(), deepest.digest());
        let error = maker(2000).build().map(|_| ()).expect_err("too deep").to_string();
        assert!(error.starts_with(&format!("{key}: methods within methods found")), "{error}");
    }
}

#[test]
fn wrong_meshes_in_memory_name_the_item() {
    let mesh = |vertices: &[[f64; 3]], triangles: &[[u32; 3]], scale| {
        let (vertices, triangles) = (vertices.to_vec(), triangles.to_vec());
        let shape = ShapeSpec::Triangles { vertices, triangles, scale, weld: 1e-6 };
        let added = planar().change_model(|m| m.change_bodies(|b| b.obstacle(shape)));
        added.build().map(|_| ()).expect_err("a wrong mesh").to_string()
    };
    let far = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1e30, 0.0]];
    for (vertices, triangles, scale, expected) in [
        (
            &TETRAHEDRON[..],
            &[[0, 1, 4]][..],
            1.0,
            "triangles[0]: corners [0, 1, 4] found; indices below 4",
        ),
        (&[[0.0; 3], [f64::NAN; 3]], &FACES, 1.0, "vertices[1]: [NaN, NaN, NaN] found; finite"),
        (&TETRAHEDRON, &[], 1.0, "no faces found"),
        (&[], &FACES, 1.0, "triangles[0]: corners [0, 2, 1] found; indices below 0"),
        (&TETRAHEDRON, &[[0, 0, 1]], 1.0, "all 1 triangles have zero area"),
        (&TETRAHEDRON, &FACES, 0.0, "scale = 0 found"),
        (&far, &[[0, 1, 2]], 2.0, "coordinates up to 1e30 found"),
    ] {
        let error = mesh(vertices, triangles, scale);
        assert!(error.starts_with(&format!("obstacles[3].shape: {expected}")), "{error}");
    }
    let open = BodySpec::new(ShapeSpec::triangles(TETRAHEDRON.to_vec(), FACES[1..].to_vec()));
    let open = planar().change_model(|m| m.change_bodies(|b| b.obstacle(open.solid(true))));
    let error = open.build().map(|_| ()).expect_err("an open mesh").to_string();
    assert!(
        error.starts_with("obstacles[3].solid: true found, but the mesh is not closed"),
        "{error}"
    );
}

#[test]
fn a_file_that_is_not_there_is_named_as_it_was_looked_for() {
    let robot = RobotSpec::new().body(ShapeSpec::mesh_file("none.obj"));
    let missing = Problem::builder("missing", BodiesSpec::new(plane(1.0), robot));
    let error = missing.clone().build().map(|_| ()).expect_err("no such file").to_string();
    assert!(error.starts_with("robot.bodies[0].shape: none.obj: cannot read the mesh"), "{error}");
    let error = missing.folder("else").build().map(|_| ()).expect_err("no such file").to_string();
    assert!(error.starts_with("robot.bodies[0].shape: else/none.obj: cannot"), "{error}");
}

#[test]
fn a_built_problem_is_planned_for_like_that_of_its_file() {
    let of_file = Build::new(load("tests/problems/meshes.toml")).run().expect("it runs");
    let built = meshes(in_memory).build().expect("a sound problem");
    let built = Build::new(built).run().expect("it runs");
    assert_eq!(built.digest(), of_file.digest());
    let sampled = meshes(in_memory)
        .change_model(|m| m.change_bodies(|b| b.change_space(|s| s.edges(MotionChecking::Sampled))))
        .build()
        .expect("a sound problem");
    assert_ne!(sampled.digest(), built.problem().digest());
}

#[test]
fn the_example_of_the_documentation_is_that_of_its_file() {
    let page = std::fs::read_to_string(path("docs/problems.md")).expect("it ships");
    let (_, rest) = page.split_once("```toml\n").expect("an example");
    let (example, _) = rest.split_once("```").expect("its end");
    let of_file = Problem::parse("cart.toml".as_ref(), example).unwrap_or_else(|e| panic!("{e}"));

    let space = SpaceSpec::new(BaseJoint::Rigid2d, [0.0, 0.0], [6.0, 4.0], BoundsMeaning::Body);
    let robot = RobotSpec::new().body(ShapeSpec::Box { size: [1.0, 0.4, 0.4] });
    let wall = BodySpec::new(ShapeSpec::Box { size: [0.2, 2.5, 1.0] }).at([3.0, 1.25, 0.0]);
    let problem = Problem::builder("cart", BodiesSpec::new(space, robot).obstacle(wall))
        .query([1.0, 1.0, 0.0], [5.0, 1.0, 1.57])
        .build()
        .expect("a sound problem");
    assert_eq!(problem.digest(), of_file.digest());
    assert_eq!(problem.describe(), of_file.describe());
}
