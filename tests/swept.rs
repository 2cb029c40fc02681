//! Motions of real scenes against the same motions looked at step by step, and of shipped linkages against
//! every pair of their bodies.
//!
//! The real scenes are not part of the repository, see `tests/foreign.rs`.

#[path = "../bench/support/brute.rs"]
#[allow(dead_code, reason = "a bench asks for distances too")]
mod brute;
#[path = "../bench/support/edges.rs"]
mod edges;
#[path = "support/scenes.rs"]
#[allow(dead_code, reason = "only the folder is of interest")]
mod scenes;

use brute::Brute;
use edges::with_edges;
use roadmill::Context;
use roadmill::model::bodies::BodyValidity;
use roadmill::model::bodies::validity::{MotionChecking, TOLERANCE};
use roadmill::model::{Scratch, Validity};
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::seed::{Purpose, Seed};
use scenes::data;
use std::path::Path;

/// How much finer motions are looked at step by step than the resolution asks for.
const FINER: u32 = 16;
/// Looks at the clearance for every step of the resolution.
const LOOKS: u64 = 64;

/// Whether at each of so many equal steps, the ends excepted, something holds.
fn at_steps(
    cx: &Context,
    (a, b): (&[f64], &[f64]),
    steps: u64,
    mut holds: impl FnMut(&[f64]) -> bool,
) -> bool {
    let mut q = a.to_vec();
    (1..steps).all(|i| {
        cx.space().interpolate(a, b, i as f64 / steps as f64, &mut q);
        holds(&q)
    })
}

#[test]
fn real_scenes_are_judged_as_step_by_step() {
    let Some(data) = data() else { return };
    for (scene, count) in [("ompl/cubicles.cfg", 1200), ("parasol/SerialWalls/serial.env", 1200)] {
        let problem = Problem::load(&data.join("scenes").join(scene)).unwrap();
        let [swept, sampled] = [MotionChecking::Swept, MotionChecking::Sampled]
            .map(|edges| with_edges(&problem, edges).context());
        let scratch = &mut Scratch::new();
        let mut stream = Seed::of_set(5, "real scenes", Ordinal(0)).stream(Purpose::Sampling);
        let (mut a, mut b) = (vec![0.0; swept.space().len()], vec![0.0; swept.space().len()]);
        let (mut motions, mut free, mut refused) = (0, 0, 0);
        while motions < count {
            swept.space().sample_uniform(&mut stream, &mut a);
            let far = 40.0 * problem.model().bodies().expect("bodies").resolution() * stream.unit();
            swept.space().step(&a, far, &mut stream, &mut b);
            if !(swept.model().is_valid(&a, scratch) && swept.model().is_valid(&b, scratch)) {
                continue;
            }
            motions += 1;
            let accepted = swept.model().motion(&a, &b, 1, scratch).is_some();
            let mut look = |refinement: u32| {
                let steps =
                    BodyValidity::of(swept.model()).expect("bodies").steps(&a, &b, refinement);
                let free = |q: &[f64]| swept.model().validity(q, scratch) == Validity::Valid;
                at_steps(&swept, (&a, &b), steps, free)
            };
            let (coarse, finer) = (look(1), look(FINER));
            assert!(!accepted || coarse && finer, "{scene}: {a:?} to {b:?} is not free");
            assert_eq!(sampled.model().motion(&a, &b, 1, scratch).is_some(), coarse, "{scene}");
            free += usize::from(finer);
            if finer && !accepted {
                refused += 1;
                // Between two looks nothing moves farther than half of their distance from one of them.
                let steps =
                    BodyValidity::of(swept.model()).expect("bodies").steps(&a, &b, 1) * LOOKS;
                let between =
                    problem.model().bodies().expect("bodies").resolution() / (2 * LOOKS) as f64;
                let near = between
                    + problem.model().bodies().expect("bodies").resolution() / TOLERANCE as f64;
                let away = at_steps(&swept, (&a, &b), steps, |q| {
                    let clearance =
                        swept.model().clearances().expect("bodies").clearance(q, scratch);
                    clearance.is_some_and(|clearance| clearance.distance > near)
                });
                assert!(!away, "{scene}: {a:?} to {b:?} keeps away from everything");
            }
        }
        println!("{scene}: {motions} motions, {free} free, {refused} of them refused");
        assert!(free < motions && refused * 200 <= free, "{scene}: {refused} of {free} refused");
    }
}

/// No tree of ours has a part in what parry says of every pair of bodies.
#[test]
fn linkages_are_judged_as_by_every_pair_of_bodies() {
    let problems = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
    for name in ["stick2.toml", "stick4.toml", "gantry.toml"] {
        let problem = Problem::load(&problems.join(name)).unwrap();
        let [swept, sampled] = [MotionChecking::Swept, MotionChecking::Sampled]
            .map(|edges| with_edges(&problem, edges).context());
        let brute = Brute::new(&problem);
        let scratch = &mut Scratch::new();
        let mut stream = Seed::of_set(5, "linkages", Ordinal(0)).stream(Purpose::Sampling);
        let (mut a, mut b) = (vec![0.0; swept.space().len()], vec![0.0; swept.space().len()]);
        let (mut motions, mut free) = (0, 0);
        while motions < 150 {
            swept.space().sample_uniform(&mut stream, &mut a);
            let far = 60.0 * problem.model().bodies().expect("bodies").resolution() * stream.unit();
            swept.space().step(&a, far, &mut stream, &mut b);
            for q in [&a, &b] {
                assert_eq!(
                    swept.model().is_valid(q, scratch),
                    swept.space().within_bounds(q) && brute.is_free(q)
                );
            }
            if !(swept.model().is_valid(&a, scratch) && swept.model().is_valid(&b, scratch)) {
                continue;
            }
            motions += 1;
            let steps = BodyValidity::of(swept.model()).expect("bodies").steps(&a, &b, 1);
            let coarse = at_steps(&swept, (&a, &b), steps, |q| brute.is_free(q));
            assert_eq!(
                sampled.model().motion(&a, &b, 1, scratch).is_some(),
                coarse,
                "{name}: {a:?}, {b:?}"
            );
            if swept.model().motion(&a, &b, 1, scratch).is_some() {
                free += 1;
                let finer = at_steps(&swept, (&a, &b), 4 * steps, |q| brute.is_free(q));
                assert!(coarse && finer, "{name}: {a:?} to {b:?} is not free");
            }
        }
        println!("{name}: {motions} motions, {free} free");
        assert!(free > 20 && free < motions, "{name}: {free} of {motions}");
    }
}
