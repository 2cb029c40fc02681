//! How long one deformation by the lattice of 13 × 9 × 7 = 819 points takes.

use super::Asked;
use super::experiment::prepared;
use super::rows::median;
use super::scenes::{Ways, scene};
use super::timing::cpu_seconds;
use roadmill::problem::Problem;
use roadmill::scene::Pose;

/// How many places along the axis are looked at, and how often each is timed.
const PLACES: usize = 201;
const REPETITIONS: usize = 5;

/// Deforms the ball at places along the axis of the narrow passage, and prints times and refusals.
pub fn run(asked: &Asked) {
    println!(
        "| method | triangles | free at rest | deformed | refused | ms, median | least | most |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for label in ["bounding-box", "geometric"] {
        if asked.method.as_ref().is_some_and(|only| only != label) {
            continue;
        }
        let method = format!("{{ {label} = {{}} }}");
        let ways = Ways { feasibility: "{ scales = 6 }", method: &method, nodes: 1 };
        let path = scene("narrow").write(&asked.out.join(format!("speed-{label}")), &ways);
        let problem = Problem::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let robot = prepared(&problem);
        let (body, method) = (robot.body(), robot.robot().method);
        let (mut free, mut refused, mut times) = (0, 0, Vec::new());
        for place in 0..PLACES {
            let x = -1.5 + 3.0 * place as f64 / (PLACES - 1) as f64;
            let pose = Pose { translation: [x, 0.0, 0.0], ..Pose::IDENTITY };
            let once = || {
                let begun = cpu_seconds();
                let found = method.deform(&pose);
                (cpu_seconds() - begun, found)
            };
            let (first, found) = once();
            match found {
                Err(_) => refused += 1,
                Ok(shape) if shape.vertices == body.vertices() => free += 1,
                // What takes long is timed once.
                Ok(_) if first > 0.1 => times.push(first),
                Ok(_) => times.push(median((0..REPETITIONS).map(|_| once().0).collect())),
            }
        }
        let least = times.iter().copied().fold(f64::INFINITY, f64::min);
        let most = times.iter().copied().fold(0.0, f64::max);
        println!(
            "| {label} | {} | {free} | {} | {refused} | {:.3} | {:.3} | {:.3} |",
            body.triangles().len(),
            times.len(),
            1e3 * median(times.clone()),
            1e3 * least,
            1e3 * most
        );
    }
}
