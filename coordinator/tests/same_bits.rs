//! The same bits for any number of workers or threads, and beside other runs.

mod support;

use support::Scratch;

struct Case {
    problem: &'static str,
    /// Without criteria a build ends with 0 at its limit.
    code: i32,
    /// Ends of a query to the finished roadmap.
    start: &'static str,
    goal: &'static str,
}

/// A pyramid without normals, textures or triangles of equal size.
const PYRAMID: &str = "\
v -0.8 -0.8 -0.8
v 0.8 -0.8 -0.8
v 0.8 0.8 -0.8
v -0.8 0.8 -0.8
v 0.0 0.1 1.1
f 1 4 3 2
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
";

const RIGID_3D: Case = Case {
    problem: r#"
seed = 3
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [4.0, 3.0, 3.0]
bounds = "body"
[robot]
bodies = [
    { shape = { box = { size = [0.9, 0.2, 0.2] } } },
    { shape = { sphere = { radius = 0.2 } }, position = [0.45, 0.0, 0.0] },
]
[[obstacles]]
shape = { mesh = { file = "pyramid.obj" } }
position = [2.0, 1.5, 1.4]
turn = { axis = [1.0, 2.0, 3.0], degrees = 30.0 }
[img]
sets_per_round = 3
schedule = ["thin", "thick", "thin"]
[[strategies]]
label = "thin"
nodes = 17
sampler = { uniform = {} }
within = { nearest = { neighbors = 5 } }
[[strategies]]
label = "thick"
nodes = 31
sampler = { uniform = {} }
within = { nearest = { neighbors = 8 } }
among = { component-pairs = { components = 2, pairs = 5 } }
[limits]
nodes = 260
"#,
    code: 0,
    start: "0.7 0.5 0.5 1 0 0 0",
    goal: "3.3 2.5 2.5 1 0 0 0",
};

/// With a query that no roadmap can answer: the evaluator runs after every round.
const RIGID_2D: Case = Case {
    problem: r#"
seed = 4
[space]
motion = "rigid-2d"
min = [0.0, 0.0]
max = [10.0, 6.0]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.2, 0.3, 0.3] } } }]
[[obstacles]]
shape = { box = { size = [0.3, 6.0, 1.0] } }
position = [7.0, 3.0, 0.0]
[[obstacles]]
shape = { cylinder = { radius = 0.8, height = 1.0 } }
position = [3.0, 3.0, 0.0]
turn = { axis = [1.0, 0.0, 0.0], degrees = 90.0 }
[query]
start = [1.0, 1.0, 0.0]
goal = [9.0, 5.0, 1.5]
[img]
sets_per_round = 3
schedule = ["b", "a", "b"]
[[strategies]]
label = "a"
nodes = 25
sampler = { uniform = {} }
[[strategies]]
label = "b"
nodes = 10
sampler = { uniform = {} }
within = { nearest = { neighbors = 3 } }
[limits]
nodes = 400
"#,
    code: 3,
    start: "1 1 0",
    goal: "5.5 5.0 1.5",
};

const TRANSLATION_3D: Case = Case {
    problem: r#"
seed = 5
[space]
motion = "translation-3d"
min = [-3.0, -3.0, -3.0]
max = [3.0, 3.0, 3.0]
bounds = "reference"
[robot]
bodies = [{ shape = { capsule = { radius = 0.2, height = 0.8 } } }]
[[obstacles]]
shape = { sphere = { radius = 1.4 } }
[[obstacles]]
shape = { capsule = { radius = 0.5, height = 4.0 } }
position = [1.5, 1.5, 0.0]
[img]
sets_per_round = 3
schedule = ["a", "b", "a", "b", "b"]
[[strategies]]
label = "a"
nodes = 40
sampler = { uniform = {} }
within = { nearest = { neighbors = 2 } }
[[strategies]]
label = "b"
nodes = 21
sampler = { uniform = {} }
within = { nearest = { neighbors = 6 } }
[limits]
nodes = 600
"#,
    code: 0,
    start: "-2.5 -2.5 -2.5",
    goal: "2.5 -2.5 2.5",
};

fn same_bits_however_built(case: &Case) {
    let scratch = Scratch::new();
    scratch.write("pyramid.obj", PYRAMID);
    scratch.write("problem.toml", case.problem);
    let build = |run: &str, option: &str, count: &str| {
        scratch.build(run, &["problem.toml", option, count], case.code)
    };
    let digest = build("alone", "--workers", "1");
    let ledger = scratch.ledger("alone");
    assert!(scratch.summary("alone").sets >= 9, "several rounds");
    for (option, count) in [
        ("--workers", "2"),
        ("--workers", "4"),
        ("--workers", "7"),
        ("--workers", "16"),
        ("--threads", "1"),
        ("--threads", "3"),
    ] {
        let run = &format!("run{option}-{count}");
        assert_eq!(build(run, option, count), digest, "{option} {count}");
        assert!(scratch.ledger(run) == ledger, "{option} {count}: the ledger differs");
    }

    // Side by side, with the same temporary folder.
    let other_seed = ["build", "problem.toml", "--workers", "2", "--out", "other", "--seed", "99"];
    let other = scratch.start(&other_seed);
    let twin = scratch.start(&["build", "problem.toml", "--workers", "3", "--out", "twin"]);
    assert_eq!(build("beside", "--workers", "2"), digest);
    other.finish().assert_code(case.code);
    twin.finish().assert_code(case.code);
    assert_eq!(scratch.summary("twin").digest, digest);
    assert_ne!(scratch.summary("other").digest, digest, "the seed counts");

    let ask = |run: &str| scratch.run(&["query", run, "--start", case.start, "--goal", case.goal]);
    let answer = ask("alone");
    answer.assert_code(0);
    let path: Vec<&str> = answer.stdout.lines().collect();
    assert!(path.len() >= 3, "a heading, start and goal: {path:?}");
    for run in ["run--workers-16", "run--threads-3", "beside"] {
        assert_eq!(ask(run).stdout, answer.stdout, "{run}");
    }
}

/// Worker processes on a problem of the library's own suite, whose digest is golden there.
fn processes_build_what_threads_build(name: &str) {
    // Their limits end them before their criteria are met.
    processes_end_as_threads(name, 3);
}

/// The same of a problem whose build ends with an exit code.
fn processes_end_as_threads(name: &str, code: i32) {
    let scratch = Scratch::new();
    let problems = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/problems");
    let problem = format!("{problems}/{name}.toml");
    let build = |run: &str, option: &str, count: &str| {
        let digest = scratch.build(run, &[&problem, option, count], code);
        (digest, scratch.ledger(run))
    };
    let expected = build("threads", "--threads", "1");
    for workers in ["1", "2", "5"] {
        assert!(build(workers, "--workers", workers) == expected, "{name}: {workers} workers");
    }
}

#[test]
fn same_bits_for_a_linkage() {
    processes_build_what_threads_build("arm");
}

#[test]
fn same_bits_for_rotate_at_gaussian_and_every_evaluator() {
    processes_build_what_threads_build("judged");
}

#[test]
fn same_bits_for_what_is_judged_by_the_roadmaps_history() {
    processes_build_what_threads_build("settled");
}

#[test]
fn same_bits_for_a_schedule_that_adapts() {
    processes_build_what_threads_build("adaptive");
}

#[test]
fn same_bits_for_every_sampler() {
    processes_build_what_threads_build("sampled");
    processes_build_what_threads_build("axis");
}

#[test]
fn same_bits_for_a_point_in_an_energy() {
    processes_build_what_threads_build("landscape");
}

#[test]
fn same_bits_for_sets_that_grow_from_the_roadmap() {
    processes_build_what_threads_build("expansion");
}

#[test]
fn same_bits_for_trees_and_graphs_that_grow_by_steps() {
    processes_build_what_threads_build("growth");
    processes_end_as_threads("directions", 0);
    processes_build_what_threads_build("neighbors");
    processes_build_what_threads_build("retraction");
}

#[test]
fn same_bits_for_deformable_robots() {
    processes_build_what_threads_build("deformable");
    processes_build_what_threads_build("penetrating");
}

#[test]
fn same_bits_for_hints_that_are_pushed_free() {
    processes_build_what_threads_build("hints");
}

#[test]
fn same_bits_for_a_turning_body_and_a_mesh() {
    same_bits_however_built(&RIGID_3D);
}

#[test]
fn same_bits_in_the_plane_with_a_query_after_every_round() {
    same_bits_however_built(&RIGID_2D);
}

#[test]
fn same_bits_for_a_translating_body() {
    same_bits_however_built(&TRANSLATION_3D);
}
