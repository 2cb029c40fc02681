//! What is left of a roadmap in a changed scene, against checks of everything in the whole scene.

#[path = "../bench/support/edges.rs"]
mod edges;

use edges::with_edges;
use roadmill::img::{Grown, Memo, Setup, Simulated, Stop, build, build_in_threads, build_with};
use roadmill::local::{self, Planner};
use roadmill::model::bodies::validity::MotionChecking;
use roadmill::model::{Model, SceneChange, Scratch};
use roadmill::neighbor::k_nearest_graph;
use roadmill::numbers::Ordinal;
use roadmill::pathways::{Dissimilar, Rank, dissimilar_unshortened};
use roadmill::problem::{Components, OldRun, Problem, Replanned, Replanning};
use roadmill::replan::{Revalidation, retried};
use roadmill::roadmap::{Configs, Digest, Edge, Roadmap};
use roadmill::sampler::{Sampler, SamplerKind, Uniform};
use roadmill::seed::Seed;
use roadmill::{Cancel, Context};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

const LEDGER: Digest = Digest([7; 32]);

const STRAIGHT: Planner = Planner::StraightLine;

/// A bar among pillars in the plane, by its pose.
const PLANAR: &str = r#"
[space]
motion = "rigid-2d"
min = [0.0, 0.0]
max = [10.0, 8.0]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.2, 0.2, 0.4] } } }]
"#;

/// A stick with a knob in a room.
const RIGID: &str = r#"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [8.0, 5.0, 5.0]
bounds = "body"
[robot]
bodies = [
    { shape = { box = { size = [1.4, 0.2, 0.3] } } },
    { shape = { sphere = { radius = 0.25 } }, position = [0.6, 0.0, 0.0] },
]
"#;

/// An arm of three links that stands on the ground, one of them sliding.
const ARM: &str = r#"
[space]
motion = "fixed"
min = [-4.0, -4.0, -4.0]
max = [4.0, 4.0, 4.0]
bounds = "body"
[robot]
bodies = [{ shape = { cylinder = { radius = 0.2, height = 0.4 } } }]
[[robot.links]]
name = "upper"
bodies = [{ shape = { capsule = { radius = 0.1, height = 1.0 } }, position = [0.0, 0.0, 0.6] }]
joint = { kind = { revolute = { axis = [1.0, 0.2, 0.0], degrees = [-120.0, 120.0] } }, before = { position = [0.0, 0.0, 0.3] } }
[[robot.links]]
name = "slide"
bodies = [{ shape = { box = { size = [0.15, 0.15, 0.8] } }, position = [0.0, 0.0, 0.4] }]
joint = { kind = { prismatic = { axis = [0.0, 0.0, 1.0], range = [0.0, 0.5] } }, before = { position = [0.0, 0.0, 1.2] } }
[[robot.links]]
name = "hand"
bodies = [{ shape = { box = { size = [0.1, 0.6, 0.1] } }, position = [0.0, 0.2, 0.1] }]
joint = { kind = { revolute = { axis = [0.0, 1.0, 0.0] } }, before = { position = [0.0, 0.0, 0.9] } }
"#;

/// The disc of `problems/growth.toml` in an empty room.
const DISC: &str = r#"
[space]
motion = "translation-2d"
min = [0.0, 0.0]
max = [10.0, 6.0]
bounds = "body"
[robot]
bodies = [{ shape = { cylinder = { radius = 0.2, height = 0.2 } } }]
"#;

/// An obstacle, of the kind and the turn that its index says.
fn obstacle(index: usize, x: f64, y: f64, z: f64) -> String {
    let shapes = [
        "box = { size = [0.8, 0.5, 1.2] }",
        "sphere = { radius = 0.5 }",
        "cylinder = { radius = 0.4, height = 1.5 }",
        "capsule = { radius = 0.3, height = 0.9 }",
        "mesh = { file = \"tests/problems/tetrahedron.obj\" }",
    ];
    let shape = shapes[index % shapes.len()];
    let degrees = 37 * index;
    format!(
        "[[obstacles]]\nshape = {{ {shape} }}\nposition = [{x:?}, {y:?}, {z:?}]\n\
         turn = {{ axis = [1.0, 2.0, 3.0], degrees = {degrees} }}\n"
    )
}

fn problem(text: &str) -> Problem {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scene.toml");
    Problem::parse(&file, text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A scene of a robot, with obstacles at places that a seed draws within a box.
struct Draws {
    robot: &'static str,
    low: [f64; 3],
    high: [f64; 3],
}

const SCENES: [Draws; 3] = [
    Draws { robot: PLANAR, low: [1.0, 1.0, 0.0], high: [9.0, 7.0, 0.0] },
    Draws { robot: RIGID, low: [1.0, 1.0, 1.0], high: [7.0, 4.0, 4.0] },
    Draws { robot: ARM, low: [0.7, -1.5, 0.5], high: [1.8, 1.5, 2.0] },
];

impl Draws {
    /// `count` obstacles; the same seed draws the same ones.
    fn obstacles(&self, seed: u64, count: usize) -> Vec<String> {
        let box_of = "[space]\nmotion = \"translation-3d\"\nmin = [0.0, 0.0, 0.0]\nmax = [1.0, 1.0, 1.0]\n\
                      bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n";
        let cx = problem(box_of).context();
        let shares = sample(&cx, count, seed);
        let places = shares.iter().enumerate();
        let place = |share: &[f64], axis: usize| {
            self.low[axis] + share[axis] * (self.high[axis] - self.low[axis])
        };
        let placed = |(index, share): (usize, &[f64])| {
            obstacle(index, place(share, 0), place(share, 1), place(share, 2))
        };
        places.map(placed).collect()
    }

    fn problem(&self, obstacles: &[String]) -> Problem {
        let rest = "[[strategies]]\nlabel = \"u\"\nnodes = 120\nsampler = { uniform = {} }\n\
                    within = { nearest = { neighbors = 6 } }\n[limits]\nsets = 2\n[img]\nsets_per_round = 2\n";
        problem(&(self.robot.to_owned() + &obstacles.concat() + rest))
    }
}

/// Valid configurations.
fn sample(cx: &Context, count: usize, seed: u64) -> Configs {
    let (seed, mut configs) =
        (Seed::of_set(seed, "replan", Ordinal(0)), Configs::new(cx.space().len()));
    let sampled = Uniform::default().sample(cx, &seed, count, &mut Scratch::new(), &mut configs);
    sampled.unwrap_or_else(|gave_up| panic!("{gave_up:?}"));
    configs
}

fn grown(problem: &Problem) -> Roadmap {
    build(&Arc::new(Setup::new(problem.clone()))).roadmap
}

fn change(before: &Problem, after: &Problem) -> SceneChange {
    let change = before.model().description().change(after.model());
    change.unwrap_or_else(|why| panic!("{why}"))
}

/// What revalidation keeps of a roadmap, and what a check of everything in the whole scene keeps: for each node and edge.
fn compared(
    after: &Problem,
    change: &SceneChange,
    roadmap: &Roadmap,
) -> (Vec<bool>, Vec<bool>, u64) {
    let (cx, scratch) = (after.context(), &mut Scratch::new());
    let mut revalidation = Revalidation::new(&cx, change);
    let (mut kept, mut full) = (Vec::new(), Vec::new());
    for q in roadmap.configs().iter() {
        kept.push(revalidation.keeps_node(q, scratch));
        full.push(cx.model().is_valid(q, scratch));
    }
    let nodes = kept.clone();
    for Edge { low, high, planner, cost } in roadmap.edges().iter() {
        if !(nodes[low.index()] && nodes[high.index()]) {
            continue;
        }
        let ends = (roadmap.configs().get(low.index()), roadmap.configs().get(high.index()));
        let planner = Planner::from_tag(planner).expect("a planner");
        let found = revalidation.keeps_motion(planner, ends, 1, scratch);
        assert!(found.is_none_or(|found| found == cost), "the cost is what it was");
        kept.push(found.is_some());
        full.push(local::connect(&cx, &[planner], ends, 1, scratch).is_some());
    }
    (kept, full, revalidation.checked())
}

#[test]
fn what_is_kept_is_what_a_check_of_everything_keeps() {
    for scene in &SCENES {
        let (mut checked, mut all, mut dropped) = (0, 0, 0);
        for seed in 0..6 {
            let mut obstacles = scene.obstacles(seed, 4);
            let before = scene.problem(&obstacles);
            // One goes, one moves, one comes.
            obstacles.remove(0);
            obstacles[0] = scene.obstacles(seed + 100, 2).remove(1);
            obstacles.extend(scene.obstacles(seed + 200, 5).pop());
            let after = scene.problem(&obstacles);
            for edges in [MotionChecking::Swept, MotionChecking::Sampled] {
                let (before, after) = (with_edges(&before, edges), with_edges(&after, edges));
                let change = change(&before, &after);
                assert_eq!((change.added.len(), change.removed.len()), (2, 2));
                let (kept, full, close) = compared(&after, &change, &grown(&before));
                assert_eq!(kept, full, "seed {seed}, {edges:?}");
                checked += close;
                all += kept.len() as u64;
                dropped += kept.iter().filter(|kept| !**kept).count();
            }
        }
        assert!(dropped > 0, "nothing was dropped in {}", scene.robot);
        assert!(checked < all, "boxes decided nothing in {}", scene.robot);
    }
}

/// Motions of any length and turn, not those of roadmaps alone.
#[test]
fn a_motion_whose_box_meets_nothing_is_free() {
    for scene in &SCENES {
        let empty = scene.problem(&[]).context();
        let (mut met, mut apart, mut blocked) = (0, 0, 0);
        for seed in 0..40 {
            let with = scene.problem(&scene.obstacles(seed, 1 + seed as usize % 3));
            let (cx, scratch) = (with.context(), &mut Scratch::new());
            let bodies = with.model().bodies().expect("bodies").obstacles();
            let among = cx.model().among(bodies).expect("obstacles come and go");
            let configs = sample(&empty, 40, seed);
            for (a, b) in configs.iter().zip(configs.iter().skip(1)) {
                let free = |model: &dyn Model, scratch: &mut Scratch| {
                    model.is_valid(a, scratch)
                        && model.is_valid(b, scratch)
                        && model.motion(a, b, 1, scratch).is_some()
                };
                // Motions that leave the bounds are none of a roadmap.
                if !free(empty.model(), scratch) {
                    continue;
                }
                let may_meet = among.may_meet(a, b, scratch);
                let is_free = free(&*among, scratch);
                assert!(may_meet || is_free, "seed {seed}: {a:?} to {b:?}");
                met += u32::from(may_meet);
                apart += u32::from(!may_meet);
                blocked += u32::from(!is_free);
            }
        }
        assert!(met > 0 && apart > 0 && blocked > 0, "{met} {apart} {blocked}");
    }
}

#[test]
fn where_more_than_obstacles_changes_everything_is_checked_again() {
    let scene = &SCENES[0];
    let before = scene.problem(&scene.obstacles(1, 3));
    let narrower = PLANAR.replace("max = [10.0, 8.0]", "max = [8.0, 8.0]");
    let scene = Draws { robot: Box::leak(narrower.into_boxed_str()), ..SCENES[0] };
    let after = scene.problem(&SCENES[0].obstacles(1, 3));
    let change = change(&before, &after);
    let what = change.beyond_obstacles.as_deref().expect("the bounds have changed");
    assert!(what.contains("the space's bounds"), "{what}");
    let (kept, full, checked) = compared(&after, &change, &grown(&before));
    assert_eq!(kept, full);
    assert_eq!(checked, kept.len() as u64);
    assert!(kept.contains(&false) && kept.contains(&true));
}

#[test]
fn pairs_are_tried_again_where_obstacles_went() {
    for scene in &SCENES {
        let mut found = 0;
        for seed in 0..10 {
            let mut obstacles = scene.obstacles(seed, 5);
            let before = scene.problem(&obstacles);
            let gone = obstacles.remove(seed as usize % 5);
            let after = scene.problem(&obstacles);
            let change = change(&before, &after);
            assert_eq!((change.added.len(), change.removed.len()), (0, 1), "{gone}");
            let (roadmap, cx, old) = (grown(&before), after.context(), before.context());
            let edges: Vec<Edge> = roadmap.edges().iter().collect();
            let (graph, scratch) = ((roadmap.configs(), &edges[..]), &mut Scratch::new());
            let new = retried(&cx, &change, graph, 8, &[STRAIGHT], scratch);
            let pair = |edge: &Edge| (edge.low.0, edge.high.0);
            let known: BTreeSet<_> = edges.iter().map(pair).collect();
            let new: BTreeSet<_> = new.iter().map(pair).collect();
            assert!(known.is_disjoint(&new));
            for (low, high) in k_nearest_graph(cx.space(), roadmap.configs(), 8) {
                let node = |id: u32| roadmap.configs().get(id as usize);
                let free = |cx: &Context, scratch: &mut Scratch| {
                    cx.model().motion(node(low), node(high), 1, scratch).is_some()
                };
                let is_new = new.contains(&(low, high));
                // What is free only now has to be found, and nothing that is not free.
                if free(&cx, scratch) && !free(&old, scratch) {
                    assert!(is_new, "{low} {high}");
                    found += 1;
                }
                assert!(!is_new || free(&cx, scratch), "{low} {high}");
            }
        }
        assert!(found > 0, "nothing was in the way in {}", scene.robot);
    }
}

#[test]
fn equal_obstacles_stay_however_they_are_listed() {
    let scene = &SCENES[1];
    let [a, b, c, d]: [String; 4] = scene.obstacles(3, 4).try_into().expect("four");
    let of = |list: &[&String]| {
        scene.problem(&list.iter().map(|text| (*text).clone()).collect::<Vec<_>>())
    };
    let between = |before: &[&String], after: &[&String]| {
        let change = change(&of(before), &of(after));
        assert_eq!(change.beyond_obstacles, None);
        (change.added.len(), change.removed.len(), change.moved())
    };
    assert_eq!(between(&[&a, &b, &c], &[&c, &a, &b]), (0, 0, 0));
    assert_eq!(between(&[&a, &a, &b], &[&b, &a]), (0, 1, 0));
    assert_eq!(between(&[&a, &b], &[&b, &d, &a]), (1, 0, 0));
    let elsewhere = a.replace("turn = { axis = [1.0, 2.0, 3.0]", "turn = { axis = [1.0, 2.0, 3.5]");
    let elsewhere = elsewhere.replace("degrees = 0", "degrees = 10");
    assert_ne!(elsewhere, a);
    assert_eq!(between(&[&a, &b, &c], &[&b, &elsewhere]), (1, 2, 1));
    assert!(change(&of(&[&a]), &of(&[&a])).is_none());
}

/// The disc of `problems/growth.toml`, before and after; the builds of both end with a path.
fn growth() -> [Problem; 2] {
    ["growth", "growth-moved"].map(|name| {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("problems/{name}.toml"));
        Problem::load(&file).unwrap_or_else(|error| panic!("{error}"))
    })
}

fn replanned(
    before: &Problem,
    roadmap: &Roadmap,
    after: &Problem,
    asked: &Replanning,
) -> Replanned {
    let old = OldRun { problem: before, roadmap, ledger: LEDGER, place: "../old" };
    after.replanned(&old, asked).unwrap_or_else(|error| panic!("{error}"))
}

fn result(build: &Grown) -> (String, Stop, String) {
    let verdicts = format!("{:?}", build.judgement);
    (build.roadmap.digest().to_string(), build.stop.clone(), verdicts)
}

/// The digest that the roadmap of the changed growth problem has always had.
const GOLDEN: &str = "0fbaa3c0dcf49c97c450b467664aeef52f5ec7e1846e4a754107000e6370461c";

#[test]
fn a_replanned_roadmap_has_the_same_bits_whatever_does_the_work() {
    let [before, after] = growth();
    let old = grown(&before);
    let problem = replanned(&before, &old, &after, &Replanning::default()).problem;
    let setup = Arc::new(Setup::new(problem));
    let expected = result(&build(&setup));
    assert_eq!(expected.0, GOLDEN, "bits of a given seed changed: bump BITS_VERSION");
    assert_eq!(expected.1, Stop::Satisfied);
    for threads in [1, 2, 4] {
        assert_eq!(result(&build_in_threads(&setup, threads)), expected, "{threads} threads");
    }
    let mut memo = Memo::new();
    for seed in 0..300 {
        let workers = 1 + seed as usize % 7;
        let simulated = Simulated::new(setup.clone(), workers, seed, &mut memo);
        assert_eq!(result(&build_with(&setup, simulated, seed / 7 % 5)), expected, "{seed}");
    }
    // Jobs really run anew, with rubbish in the scratch memory.
    for seed in 1000..1003 {
        let memo = &mut Memo::new();
        let simulated = Simulated::new(setup.clone(), 5, seed, memo);
        assert_eq!(result(&build_with(&setup, simulated, 9)), expected, "{seed}");
    }
}

#[test]
fn the_survivors_are_the_first_round_and_the_problem_goes_on() {
    let [before, after] = growth();
    let old = grown(&before);
    let Replanned { problem, change, survived } =
        replanned(&before, &old, &after, &Replanning::default());
    assert_eq!((change.added.len(), change.removed.len(), change.moved()), (2, 1, 1));
    let built = build(&Arc::new(Setup::new(problem.clone())));
    let (cx, scratch) = (after.context(), &mut Scratch::new());
    let first = built.roadmap.rounds()[0];
    assert_eq!((first.sets, first.nodes), (1, survived.increment.configs.len()));
    // Nodes keep their order, and a tree from the start begins with it.
    let mut rest = old.configs().iter();
    let kept = built.roadmap.configs().iter().take(first.nodes);
    assert!({ kept }.all(|q| rest.any(|other| other == q)));
    let start = &after.query().expect("a query").start;
    assert_eq!(built.roadmap.configs().get(0), start);
    assert_eq!(built.roadmap.components_at(cx.space(), first).count(), 1);
    // The rest is grown by the problem's own strategy, from the first set on.
    assert!(built.roadmap.sets() > 1);
    assert!(built.roadmap.edges().iter().all(|edge| {
        let node = |id: roadmill::numbers::NodeId| built.roadmap.configs().get(id.index());
        cx.model().motion(node(edge.low), node(edge.high), 1, scratch).is_some()
    }));
    // All components: nothing is dropped but what is not valid.
    let all = Replanning { components: Some(Components::All), ..Replanning::default() };
    let all = replanned(&before, &old, &after, &all).survived;
    assert_eq!((all.dropped_nodes, all.increment.configs.len()), (0, all.valid_nodes));
    assert!(survived.dropped_nodes > 0 && all.valid_nodes < old.configs().len());
    // The bytes are those of the same problem.
    let (layout, bytes) = problem.to_bytes();
    let read = Problem::from_bytes(layout, &bytes).expect("a problem");
    assert_eq!(read, problem);
    assert_eq!(read.digest(), problem.digest());
}

/// A path through the roadmap that is valid still is among the survivors, so that the build ends with the first round.
#[test]
fn an_old_path_that_is_valid_still_needs_no_growth() {
    let [before, _] = growth();
    let many =
        before.clone().with_limits(roadmill::problem::Limits { sets: 60, ..before.limits() });
    let builder = many.expect("sound limits").to_builder().evaluators([]);
    let before = builder.change_strategies(|strategy| {
        let prm = roadmill::connect::WithinKind::default();
        strategy.sampler(SamplerKind::default()).within(prm)
    });
    let before = before.build().expect("a problem");
    let old = grown(&before);
    let cx = before.context();
    let ends = cx.query().expect("a query");
    let asked = Dissimilar {
        count: 4,
        rank: Rank::Cost,
        distance: 0.5,
        spacing: 0.1,
        tries: 20,
        shortcuts: 0,
    };
    let attachment = before.attachment();
    let (never, scratch) = (Cancel::new(), &mut Scratch::new());
    let found = dissimilar_unshortened(&cx, &old, ends, &attachment, &asked, &never, scratch);
    let found = found.expect("coarse enough").pathways;
    assert!(found.len() > 1, "one path alone");
    // A ball on the middle of each path in turn.
    let mut seen = [0, 0];
    for blocked in &found {
        let middle = blocked.path.sampled(cx.space(), 3);
        let (x, y) = (middle.get(1)[0], middle.get(1)[1]);
        let after = growth()[0].to_builder().change_model(|model| {
            model.change_bodies(|bodies| {
                let shape = roadmill::model::bodies::ShapeSpec::Sphere { radius: 0.05 };
                bodies.obstacle(roadmill::model::bodies::BodySpec::new(shape).at([x, y, 0.0]))
            })
        });
        let after = after.build().expect("a problem");
        let new = after.context();
        let change = change(&before, &after);
        let mut revalidation = Revalidation::new(&new, &change);
        let valid =
            found.iter().map(|pathway| revalidation.keeps_path(&pathway.path, &mut Scratch::new()));
        let is_any = { valid }.fold(false, |any, valid| any | valid);
        let problem = replanned(&before, &old, &after, &Replanning::default()).problem;
        let built = build(&Arc::new(Setup::new(problem)));
        seen[usize::from(is_any)] += 1;
        assert!(!is_any || built.roadmap.sets() == 1, "grown for nothing");
        assert_eq!(built.stop, Stop::Satisfied);
    }
    assert!(seen[1] > 0, "{seen:?}");
}

#[test]
fn what_cannot_be_replanned_says_why() {
    let [before, after] = growth();
    let old = grown(&before);
    let refused = |before: &Problem, after: &Problem, asked: Replanning| {
        let old = OldRun { problem: before, roadmap: &old, ledger: LEDGER, place: "../old" };
        let error = after.replanned(&old, &asked).expect_err("it cannot be replanned");
        error.to_string()
    };
    let usual = Replanning::default();
    let wider = after.to_builder().change_model(|_| {
        let text = std::fs::read_to_string("problems/growth-moved.toml").expect("a file");
        problem(&text.replace("radius = 0.2", "radius = 0.1")).model().to_spec()
    });
    let wider = wider.build().expect("a problem");
    assert_eq!(
        refused(&before, &wider, usual),
        "the robot is not what it was; the same robot expected"
    );
    let landscape = Problem::load(Path::new("tests/problems/landscape.toml")).expect("a problem");
    assert!(refused(&landscape, &landscape, usual).contains("no obstacles that come and go"));
    assert_eq!(refused(&before, &landscape, usual), "the kind of model is not what it was");
    let without = problem(DISC);
    let start = Replanning { components: Some(Components::WithStart), ..usual };
    assert!(refused(&before, &without, start).contains("no [query]"));
    let none = Replanning { neighbors: 0, ..usual };
    assert!(refused(&before, &after, none).contains("0 neighbors found"));
    let many = Replanning { neighbors: Replanning::NEIGHBORS_MAX + 1, ..usual };
    assert!(refused(&before, &after, many).contains("1001 neighbors found; 1 to 1000 expected"));
    let block = "[[obstacles]]\nshape = { box = { size = [20.0, 20.0, 20.0] } }\n";
    let (empty, full) = (without, problem(&(DISC.to_owned() + block)));
    let nothing = refused(&empty, &full, usual);
    assert!(nothing.ends_with(
        "0 are valid, and none is kept: there is nothing to go on from, and a build begins anew"
    ));
    let replanned = replanned(&before, &old, &after, &usual).problem;
    assert!(refused(&before, &replanned, usual).contains("`survivors` found"));
    // No problem file can name it.
    let file = "generator = { survivors = {} }";
    let text = std::fs::read_to_string("problems/growth-moved.toml").expect("a file");
    let text = text.replace("generator = { rrt = { step = 0.4 } }", file);
    let error = Problem::parse("it.toml".as_ref(), &text).expect_err("refused").to_string();
    assert!(error.starts_with("it.toml:") && error.contains("roadmill replan"), "{error}");
}

#[test]
fn survivors_are_checked_against_the_old_run() {
    let [before, after] = growth();
    let old = grown(&before);
    let problem = replanned(&before, &old, &after, &Replanning::default()).problem;
    let run = OldRun { problem: &before, roadmap: &old, ledger: LEDGER, place: "elsewhere" };
    assert_eq!(problem.check_survivors(&run), Ok(()));
    let other = OldRun { ledger: Digest([8; 32]), ..run };
    assert!(problem.check_survivors(&other).is_err_and(|why| why.contains("hash")));
    // Another scene, and another roadmap, that pretend to be the run.
    let other = OldRun { problem: &after, ..run };
    assert!(problem.check_survivors(&other).is_err());
    let seeded = grown(&before.clone().with_seed(77));
    let other = OldRun { roadmap: &seeded, ..run };
    assert!(problem.check_survivors(&other).is_err());
}

/// The example of `docs/replanning.md`.
#[test]
fn a_program_replans_in_memory() {
    let [before, problem] = growth();
    let before = roadmill::Build::new(before).run().expect("a build");
    let old = OldRun {
        problem: before.problem(),
        roadmap: before.roadmap(),
        ledger: Digest::of(b"a build in memory"),
        place: "",
    };
    let replanned = problem.replanned(&old, &Replanning::default()).expect("the same robot");
    let cancel = Cancel::new();
    let until = |cancel: &Cancel| problem.replanned_until(&old, &Replanning::default(), cancel);
    let whole = until(&cancel).expect("the same robot").expect("nothing ends it");
    assert_eq!(whole.survived, replanned.survived);
    cancel.cancel();
    assert!(until(&cancel).expect("the same robot").is_none());
    let after = roadmill::Build::new(replanned.problem).run().expect("a build");
    assert!(after.path().is_some_and(|path| path.length > 0.0));
    assert!(after.roadmap().sets() > 1);
}
