//! Descriptions as files, as values and as bytes.

use super::*;
use crate::model::{ModelKind, Scratch};
use crate::wire;
use proptest::prelude::*;

const TABLES: [&str; 4] = [
    "",
    "feasibility = { scales = [1.0, 0.7, 0.3], centre = [0.1, 0.2, 0.30000000000000004] }\n\
     method = { bounding-box = { lattice = [5, 4, 3], least = [0.3, 0.4, 0.5], greatest = 1.25, shear = 0.1, order = \"queue\", relaxation = 0, interpolation = \"bernstein\" } }\n\
     highest_energy = 0.1\nclearance = 0.0\nstep = 0.013\nlongest_edge = 0.3\n",
    "feasibility = { depth = 0.7 }\nmethod = { geometric = {} }\nhighest_energy = \"none\"\n",
    "feasibility = { depth = 0.1, vectors = 3 }\n\
     method = { geometric = { directions = 0, shortest = 0.5, longest = 2, neighbourhood = 0.21, guide = 0.9, rounds = 7, refuse_self_collisions = false } }\n",
];

/// What is written as files is read as the same description, and so is what is made from it again.
#[test]
fn it_is_written_and_read_again() {
    for lines in TABLES {
        let problem = parse(&with(lines)).unwrap_or_else(|error| panic!("{error}"));
        let written = problem.to_toml("p-files");
        let again =
            parse(&written.text).unwrap_or_else(|error| panic!("{error}\n{}", written.text));
        assert_eq!(again.model(), problem.model(), "{}", written.text);
        assert_eq!(again.digest(), problem.digest());
        assert_eq!(problem.to_builder().build().unwrap().model(), problem.model());
        let bytes = wire::encode(problem.model());
        assert_eq!(wire::decode::<ModelKind>(&bytes).unwrap(), *problem.model());
        let (layout, bytes) = problem.to_bytes();
        assert_eq!(Problem::from_bytes(layout, &bytes).unwrap().model(), problem.model());
    }
}

#[test]
fn what_is_left_out_has_the_stated_defaults() {
    let problem = parse(&with("")).unwrap();
    let Deformable { bodies, feasibility, deformation, longest_edge } =
        problem.model().deformable().unwrap().clone();
    let Feasibility::Scaled { scales, .. } = feasibility else { panic!("scales expected") };
    assert_eq!(scales.len(), 6);
    for (scale, expected) in scales.iter().zip([1.0, 0.9, 0.8, 0.7, 0.6, 0.5]) {
        assert!((scale - expected).abs() < 1e-15, "{scales:?}");
    }
    let expected = DeformationMethod::BoundingBox(BoundingBoxSettings::default());
    assert_eq!(deformation.method, expected);
    assert_eq!(deformation.highest_energy, f64::INFINITY);
    // The robot's padding, which is more than a quarter of the resolution; without a padding that quarter.
    assert!(bodies.resolution / 4.0 < 0.05);
    assert_eq!(deformation.clearance, 0.05);
    let bare = parse(&with("").replace("padding = 0.05", "")).unwrap();
    let bare = bare.model().deformable().unwrap();
    assert_eq!(bare.deformation.clearance, bare.bodies.resolution / 4.0);
    assert_eq!(deformation.step, bodies.resolution);
    // From −0.6 to 1 along x.
    assert!((longest_edge - 1.6 / 16.0).abs() < 1e-15);
    let notes = problem.notes().join("\n");
    for key in ["clearance = ", "step = ", "longest_edge = "] {
        assert!(notes.contains(key), "{notes}");
    }
    let built = Problem::builder("p", DeformableSpec::new(bodies.to_spec())).build().unwrap();
    assert_eq!(built.model().deformable().unwrap().deformation, deformation);
}

/// The table makes the model a deformable robot, and without it the bodies are rigid.
#[test]
fn the_table_chooses_the_model() {
    assert!(parse(BODIES).unwrap().model().bodies().is_some());
    let first = format!("[deformable]\n{BODIES}");
    assert_eq!(parse(&first).unwrap().model(), parse(&with("")).unwrap().model());
    let error = parse("[deformable]\nstep = 1.0\n").unwrap_err();
    assert!(error.contains("missing field `robot`"), "{error}");
    let energies = "[landscape]\nmin = [0, 0]\nmax = [1, 1]\nenergy = { muller-brown = {} }\n";
    let error = parse(&format!("{energies}[deformable]\n")).unwrap_err();
    assert!(error.contains("p.toml:5: unknown field `deformable`"), "{error}");
    let change = |bodies: crate::model::bodies::BodiesSpec| bodies.obstacles([]);
    let spec = parse(&with("")).unwrap().model().to_spec().change_bodies(change);
    let built = Problem::builder("p", spec).build().unwrap();
    assert!(built.model().deformable().unwrap().bodies.obstacles.is_empty());
}

#[test]
fn wrong_tables_are_refused_with_their_lines() {
    let line = BODIES.lines().count() + 2;
    for (lines, expected) in [
        (
            "feasibility = { scales = [0.9, 0.5] }",
            "deformable.feasibility.scales: 0.9 found first; 1, the robot itself, expected first",
        ),
        (
            "feasibility = { scales = [1.0, 0.5, 0.5] }",
            "deformable.feasibility.scales: 0.5 found after 0.5; less than that, at least 0.01, expected",
        ),
        (
            "feasibility = { scales = [1.0, nan] }",
            "deformable.feasibility.scales: NaN found after 1; less than that, at least 0.01, expected",
        ),
        (
            "feasibility = { scales = [] }",
            "deformable.feasibility.scales: none found; 1 to 64 scales expected",
        ),
        (
            "feasibility = { scales = 0 }",
            "deformable.feasibility.scales: none found; 1 to 64 scales expected",
        ),
        (
            "feasibility = { scales = 4000000000 }",
            "deformable.feasibility.scales: more found; 1 to 64 scales expected",
        ),
        (
            "feasibility = { scales = 3, least = 1.5 }",
            "deformable.feasibility.scales: 1.25 found after 1; less than that, at least 0.01, expected",
        ),
        (
            "feasibility = { scales = [1.0], least = 0.5 }",
            "`least` found beside a list of scales; the number of scales expected",
        ),
        ("feasibility = { scales = \"many\" }", "expected the number of scales, or a list of them"),
        (
            "feasibility = { scales = 2, depth = 0.5 }",
            "`scales`, with `least` and `centre` if need be, expected, or `depth`, with `vectors` if need be",
        ),
        (
            "feasibility = { scales = 2, centre = [inf, 0, 0] }",
            "deformable.feasibility.centre: [inf, 0.0, 0.0] found; lengths within ±1e30 expected",
        ),
        (
            "feasibility = { depth = 0.0 }",
            "deformable.feasibility.depth: 0 found; a length above 0, less than the largest distance in the space, ",
        ),
        (
            "feasibility = { depth = 100.0 }",
            "deformable.feasibility.depth: 100 found; a length above 0, less than the largest distance in the space, ",
        ),
        (
            "feasibility = { depth = 0.5, vectors = 0 }",
            "deformable.feasibility.vectors: 0 found; 1 to 10000 expected",
        ),
        (
            "feasibility = { depth = 0.5, vectors = 10001 }",
            "deformable.feasibility.vectors: 10001 found; 1 to 10000 expected",
        ),
        (
            "method = { bounding-box = { lattice = 1 } }",
            "deformable.method.bounding-box.lattice: 1 found; 2 to 200 points along each axis expected",
        ),
        (
            "method = { bounding-box = { lattice = [5, 201, 5] } }",
            "deformable.method.bounding-box.lattice: 201 found; 2 to 200 points along each axis expected",
        ),
        (
            "method = { bounding-box = { lattice = [5, 5] } }",
            "expected a number, or three for x, y and z",
        ),
        (
            "method = { bounding-box = { least = 1.5 } }",
            "deformable.method.bounding-box.least: 1.5 found; a share above 0, at most 1, expected",
        ),
        (
            "method = { bounding-box = { least = [0.5, 0, 0.5] } }",
            "deformable.method.bounding-box.least: 0 found; a share above 0, at most 1, expected",
        ),
        (
            "method = { bounding-box = { greatest = 0.5 } }",
            "deformable.method.bounding-box.greatest: 0.5 found; a share of at least 1, at most 1000000, expected",
        ),
        (
            "method = { bounding-box = { greatest = inf } }",
            "deformable.method.bounding-box.greatest: inf found; a share of at least 1, at most 1000000, expected",
        ),
        (
            "method = { bounding-box = { shear = -1 } }",
            "deformable.method.bounding-box.shear: -1 found; a share of at least 0, at most 1000000, expected",
        ),
        ("method = { bounding-box = { order = \"stack\" } }", "unknown variant `stack`"),
        ("method = { bounding-box = { interpolation = \"cubic\" } }", "unknown variant `cubic`"),
        (
            "method = { bounding-box = { relaxation = 1001 } }",
            "deformable.method.bounding-box.relaxation: 1001 found; at most 1000 sweeps expected",
        ),
        (
            "method = { geometric = { directions = 1001 } }",
            "deformable.method.geometric.directions: 1001 found; at most 1000 expected",
        ),
        (
            "method = { geometric = { shortest = 1.1 } }",
            "deformable.method.geometric.shortest: 1.1 found; a share from 0 to 1 expected",
        ),
        (
            "method = { geometric = { longest = 0.9 } }",
            "deformable.method.geometric.longest: 0.9 found; a share of at least 1, at most 1000000, expected",
        ),
        (
            "method = { geometric = { neighbourhood = -1 } }",
            "deformable.method.geometric.neighbourhood: -1 found; a length of at least 0 expected",
        ),
        (
            "method = { geometric = { guide = 1.0 } }",
            "deformable.method.geometric.guide: 1 found; a scale above 0, below 1, expected",
        ),
        (
            "method = { geometric = { rounds = 0 } }",
            "deformable.method.geometric.rounds: 0 found; 1 to 1000 expected",
        ),
        ("method = { magic = {} }", "unknown variant `magic`"),
        (
            "highest_energy = -1.0",
            "deformable.highest_energy: -1 found; an energy of at least 0, or \"none\", expected",
        ),
        (
            "highest_energy = nan",
            "deformable.highest_energy: NaN found; an energy of at least 0, or \"none\", expected",
        ),
        ("highest_energy = \"much\"", "expected an energy, or \"none\""),
        ("clearance = -0.1", "deformable.clearance: -0.1 found; 0, or a length of at least "),
        ("step = 0.0", "deformable.step: 0 found; a length of at least "),
        (
            "longest_edge = 0.01",
            "deformable.longest_edge: 0.01 found; a length of at least 0.025, a 64th of the longest edge of the robot's bounding box, expected",
        ),
        ("colour = 1", "unknown field `colour`"),
    ] {
        let error = parse(&with(lines)).unwrap_err();
        assert!(error.starts_with(&format!("p.toml:{line}: ")), "{error} for {lines}");
        assert!(error.contains(expected), "{error} for {lines}");
    }
}

#[test]
fn robots_that_cannot_be_deformed_are_refused() {
    let link = "\n[[robot.links]]\nname = \"fore\"\nbodies = [{ shape = { sphere = { radius = 0.1 } } }]\n\
                joint = { kind = { revolute = { axis = [0, 0, 1] } } }\n";
    let error = parse(&(with("") + link)).unwrap_err();
    assert!(error.contains("robot.links: 2 links found beside [deformable]; a robot of one body or several without joints expected"), "{error}");
    let brick = "box = { size = [1.2, 0.6, 0.4] }";
    let open = with("").replace(brick, "mesh = { file = \"open.obj\" }");
    let scratch = tempfile::tempdir().unwrap();
    std::fs::write(
        scratch.path().join("open.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n",
    )
    .unwrap();
    let error = Problem::parse(&scratch.path().join("p.toml"), &open).unwrap_err().to_string();
    assert!(error.contains("p.toml:9: robot.bodies[0].shape: a mesh with 3 open edges found; a closed mesh expected"), "{error}");
    let error = parse(&with("").replace(brick, "point = {}")).unwrap_err();
    assert!(error.contains("p.toml:9: robot.bodies[0].shape: a point found, which has no surface; a shape with an extent expected"), "{error}");
    let edges = with("").replace(
        "bounds = \"body\"",
        "bounds = \"body\"\nedges = { penetrating = { depth = 0.5 } }",
    );
    let error = parse(&edges).unwrap_err();
    assert!(error.contains("p.toml:7: space.edges: penetrating found beside [deformable]; \"swept\" or \"sampled\" expected, and the depth as deformable.feasibility"), "{error}");
}

/// The first thing in which two differ is named.
#[test]
fn differences_are_named() {
    let base = deformable(&with(""));
    let difference = |other: Deformable| base.difference(&ModelKind::Deformable(other));
    assert_eq!(difference(base.clone()), None);
    let mut other = base.clone();
    other.bodies.obstacles.clear();
    assert_eq!(difference(other), Some("an obstacle"));
    assert_eq!(
        difference(Deformable { longest_edge: 1.0, ..base.clone() }),
        Some("the longest edge of the robot's triangles")
    );
    assert_eq!(
        difference(deformable(&with("feasibility = { scales = 2 }"))),
        Some("how the rigid robot may collide")
    );
    assert_eq!(difference(deformable(&with("step = 1.0"))), Some("how the robot is deformed"));
    assert_eq!(base.difference(&ModelKind::Bodies(base.bodies.clone())), Some("the kind of model"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Damaged bytes are an error, or a problem whose model can be made ready and asked.
    #[test]
    fn damaged_bytes_are_an_error_or_a_problem(
        table in 0..TABLES.len(), at in any::<prop::sample::Index>(), bits in 1u8.., more in any::<prop::sample::Index>(), other in any::<u8>(),
    ) {
        let (layout, mut bytes) = parse(&with(TABLES[table])).unwrap().to_bytes();
        let end = bytes.len();
        bytes[at.index(end)] ^= bits;
        bytes[more.index(end)] ^= other;
        if let Ok(problem) = Problem::from_bytes(layout, &bytes) {
            let context = problem.context();
            let (mut q, mut values) = (vec![0.25; context.space.len()], Vec::new());
            let scratch = &mut Scratch::new();
            context.model.validity(&q, scratch);
            q.fill(0.0);
            context.model.validity(&q, scratch);
            context.model.values(&q, &mut values, scratch);
            prop_assert_eq!(values.len(), context.model.node_values().len());
        }
    }
}
