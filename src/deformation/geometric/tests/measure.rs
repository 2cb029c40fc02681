//! The figures of `docs/deformable-geometric.md`.

use super::shapes::{ball, block, elbow, four_balls, moved, plate_with_hole, round};
use super::{Scene, settings};
use crate::deformation::Deformed;
use crate::scene::{Body, Mesh, Pose};
use rustix::time::{ClockId, clock_gettime};

/// How many steps the robot takes on its way.
const STEPS: u32 = 200;

/// Robots, obstacles, and where the robot's frame is along x, from where to where.
fn scenes() -> Vec<(&'static str, Mesh, Vec<Body>, [f64; 2])> {
    let plates =
        vec![block([4.0, 4.0, 0.2], [0.0, 0.0, 0.9]), block([4.0, 4.0, 0.2], [0.0, 0.0, -0.95])];
    let elbow = elbow(2.0, 0.3, 1.5, 20, 12);
    vec![
        ("ball at a ball", ball(1.0, 3), vec![round(1.0, [0.0; 3])], [2.02, 1.2]),
        ("ball between two plates", ball(1.0, 3), plates, [-2.6, -1.4]),
        ("ball through four balls", ball(0.8, 3), four_balls(), [-1.1, 1.1]),
        (
            "ball at an edge",
            ball(1.0, 3),
            vec![block([1.0, 1.0, 4.0], [0.0, 0.3, 0.0])],
            [-1.5, -0.8],
        ),
        (
            "ball at a thin plate",
            ball(1.0, 3),
            vec![block([0.05, 6.0, 6.0], [0.0; 3])],
            [-1.02, -0.5],
        ),
        ("elbow in a hole", elbow, plate_with_hole(0.5, 6.0, 0.2), [-1.45, -0.1]),
    ]
}

#[test]
#[ignore = "prints figures for the documentation; half a minute with --release"]
fn figures() {
    println!(
        "scene | triangles | deformed | refused | ms median | ms 90 % | ms most | highest energy | least volume | step | median | > 0.02 | farthest"
    );
    for (name, mesh, bodies, [from, to]) in scenes() {
        let scene = Scene::new(mesh, bodies, settings());
        let (mut times, mut steps, mut refused) = (Vec::new(), Vec::new(), 0);
        let (mut energy, mut volume) = (0.0f64, 1.0f64);
        let mut last: Option<(Pose, Deformed)> = None;
        for step in 0..=STEPS {
            let pose = moved(from + (to - from) * f64::from(step) / f64::from(STEPS), 0.0, 0.0);
            let start = cpu_time();
            let found = crate::deformation::Deform::deform(&scene.method, &pose);
            let time = cpu_time() - start;
            let Ok(deformed) = found else {
                (refused, last) = (refused + 1, None);
                continue;
            };
            scene.judge(&pose, &deformed);
            if deformed.energy > 0.0 {
                times.push(time);
            }
            if let Some((before, shape)) = &last {
                steps.push(scene.step((before, shape), (&pose, &deformed)));
            }
            energy = energy.max(deformed.energy);
            volume = volume.min(scene.volume(&deformed));
            last = Some((pose, deformed));
        }
        times.sort_by(f64::total_cmp);
        steps.sort_by(f64::total_cmp);
        let at = |list: &[f64], share: usize| list[(list.len() - 1) * share / 100];
        let jumps = steps.iter().filter(|step| **step > 0.02).count();
        println!(
            "{name} | {} | {} | {refused} | {:.1} | {:.1} | {:.1} | {energy:.1} | {volume:.3} | {:.4} | {:.4} | {jumps} | {:.3}",
            scene.body.triangles().len(),
            times.len(),
            at(&times, 50),
            at(&times, 90),
            at(&times, 100),
            (to - from).abs() / f64::from(STEPS),
            at(&steps, 50),
            at(&steps, 100),
        );
    }
}

/// The CPU time of this thread, in milliseconds.
fn cpu_time() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 * 1e3 + time.tv_nsec as f64 / 1e6
}
