//! What a sample costs beside OMPL's samplers of valid states over FCL (`bench/peers/samplers.cpp`), around one ball and in the Tunnel.
//!
//! ```text
//! g++ -O3 -march=x86-64 -std=c++17 bench/peers/samplers.cpp -I/usr/include/eigen3 -I/usr/include/ompl-1.5 -lompl -lfcl -lccd -o samplers
//! ROADMILL_SAMPLERS_PEER=$PWD/samplers cargo bench --bench uniform -- cost-ompl
//! ```
//!
//! A run is 1000 samples here and 1000 there, one after the other in one thread each; the ratio of a case is the median of the runs'
//! ratios. Both have solid balls and boxes and the robot's middle in the bounds, and before anything is measured both say of the same
//! 2000 configurations which are valid. The methods differ in what they draw:
//!
//! - OMPL's Gaussian and Bridge move every coordinate by a normal deviate. So that translations have the same mean length, OMPL gets
//!   0.3395 of the deviation here: E|N(0, 1)| · Γ(2) Γ(3) / (Γ(3/2) Γ(7/2)) = 0.542 here, 1.596 there.
//! - OMPL's obstacle-based sampler draws a colliding configuration and a free one, and keeps the last free one on the motion from the
//!   latter to the former, in steps of a hundredth of the space. Here it is OBPRM with walks from colliding configurations, in
//!   steps of 0.1.
//! - There is no UOBPRM there. Ours stands beside OMPL's obstacle-based sampler, which is meant for the same.
//!
//! Stated before the runs: a uniform sample costs less here than there; so do Gaussian and Bridge in the Tunnel; OMPL's obstacle-based
//! sampler costs less than OBPRM around the ball, as its steps are longer.

use super::draws;
use super::report::{head, row, stated};
use super::scenes::{Scene, Solid, one_ball, tunnel};
use crate::Bench;
use crate::support::{median, peer};
use roadmill::Context;
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::seed::{Purpose, Seed};
use std::fmt::Write;
use std::process::Command;

const SAMPLES: usize = 1000;
const CHECKED: usize = 2000;
/// OMPL's deviation of every coordinate, by the deviation of distances here.
const BY_COORDINATE: f64 = 0.3395;

struct Case {
    name: &'static str,
    sampler: &'static str,
    /// OMPL's sampler, and the deviation that it is to have in the place of.
    theirs: (&'static str, f64),
}

const BALL: [Case; 4] = [
    Case { name: "ball uniform", sampler: "uniform = {}", theirs: ("uniform", 0.0) },
    Case {
        name: "ball gaussian d=0.2",
        sampler: "gaussian = { deviation = 0.2 }",
        theirs: ("gaussian", 0.2),
    },
    Case {
        name: "ball obprm t=0.1",
        sampler: "obprm = { step = 0.1, start = \"colliding\" }",
        theirs: ("obstacle", 0.0),
    },
    Case {
        name: "ball uobprm l=1 t=0.1",
        sampler: "uobprm = { length = 1.0, step = 0.1, adjusted_bounds = true }",
        theirs: ("obstacle", 0.0),
    },
];

const TUNNEL: [Case; 5] = [
    Case { name: "tunnel uniform", sampler: "uniform = {}", theirs: ("uniform", 0.0) },
    Case {
        name: "tunnel gaussian d=2",
        sampler: "gaussian = { deviation = 2.0 }",
        theirs: ("gaussian", 2.0),
    },
    Case {
        name: "tunnel bridge d=4",
        sampler: "bridge = { deviation = 4.0 }",
        theirs: ("bridge", 4.0),
    },
    Case {
        name: "tunnel obprm t=0.1",
        sampler: "obprm = { step = 0.1, start = \"colliding\" }",
        theirs: ("obstacle", 0.0),
    },
    Case {
        name: "tunnel uobprm l=2 t=0.2",
        sampler: "uobprm = { length = 2.0, step = 0.2 }",
        theirs: ("obstacle", 0.0),
    },
];

fn text(scene: &Scene) -> String {
    let [x, y, z] = scene.half;
    let mut text = format!("{} {} {} {x} {y} {z} {}\n", -x, -y, -z, scene.edge);
    for solid in &scene.solids {
        match *solid {
            Solid::Ball { at: [x, y, z], radius } => writeln!(text, "sphere {x} {y} {z} {radius}"),
            Solid::Block { at: [x, y, z], size: [a, b, c] } => {
                writeln!(text, "box {x} {y} {z} {a} {b} {c}")
            }
        }
        .expect("writing to memory cannot fail");
    }
    text
}

/// In how many of the same configurations the two differ on what is valid.
fn differ(cx: &Context, program: &str, scene: &str, folder: &std::path::Path) -> usize {
    let mut stream = Seed::of_set(1, "checked", Ordinal(0)).stream(Purpose::Sampling);
    let (mut q, mut scratch) = (vec![0.0; cx.space().len()], Scratch::new());
    let (mut configs, mut ours) = (String::new(), Vec::new());
    for _ in 0..CHECKED {
        cx.space().sample_uniform(&mut stream, &mut q);
        ours.push(f64::from(u8::from(cx.model().is_valid(&q, &mut scratch))));
        let words: Vec<String> = q.iter().map(f64::to_string).collect();
        writeln!(configs, "{}", words.join(" ")).expect("writing to memory cannot fail");
    }
    let path = folder.join("configurations");
    std::fs::write(&path, configs).expect("configurations can be written");
    let theirs = peer::run(program, &["check", scene, &path.to_string_lossy()]);
    assert_eq!(theirs.len(), CHECKED);
    ours.iter().zip(&theirs).filter(|(ours, theirs)| ours != theirs).count()
}

pub fn study(bench: &mut Bench) {
    let Ok(program) = std::env::var("ROADMILL_SAMPLERS_PEER") else {
        println!(
            "skipped: ROADMILL_SAMPLERS_PEER does not name the built bench/peers/samplers.cpp"
        );
        return;
    };
    let ready = Command::new(&program).output().is_ok();
    assert!(ready, "{program} cannot be started");
    let folder = std::env::temp_dir().join(format!("roadmill-samplers-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for scenes");
    head(&[
        "case",
        "ours, µs each",
        "OMPL, µs each",
        "OMPL's by ours",
        "asked each, ours",
        "asked each, OMPL",
    ]);
    let (mut ratios, mut differences) = (Vec::new(), Vec::new());
    for (scene, cases) in [(one_ball(), &BALL[..]), (tunnel(), &TUNNEL[..])] {
        let cx = scene.problem().context();
        let path = folder.join(scene.name);
        std::fs::write(&path, text(&scene)).expect("the scene can be written");
        let path = path.to_string_lossy().into_owned();
        differences.push((scene.name, differ(&cx, &program, &path, &folder)));
        for case in cases {
            if !bench.wants(case.name) {
                continue;
            }
            let runs = bench.case(case.name, |seed| {
                let drawn = draws::run(&cx, case.sampler, seed, SAMPLES);
                let drawn = drawn.unwrap_or_else(|error| panic!("{}: {error}", case.name));
                let (kind, deviation) = case.theirs;
                let words = [
                    (BY_COORDINATE * deviation).to_string(),
                    SAMPLES.to_string(),
                    seed.to_string(),
                ];
                let [deviation, samples, seed] = &words;
                let theirs = peer::run(&program, &["draw", &path, kind, deviation, samples, seed]);
                let each = 1.0 / SAMPLES as f64;
                let micros = [drawn.seconds * 1e6 * each, theirs[0] * 1e6 * each];
                vec![micros[0], micros[1], drawn.asked * each, theirs[1] * each]
            });
            let middle = |of: &dyn Fn(&Vec<f64>) -> f64| {
                median(&mut runs.iter().map(of).collect::<Vec<f64>>())
            };
            let ratio = middle(&|run| run[1] / run[0]);
            row(&[
                case.name.to_owned(),
                format!("{:.2}", middle(&|run| run[0])),
                format!("{:.2}", middle(&|run| run[1])),
                format!("{ratio:.2}"),
                format!("{:.1}", middle(&|run| run[2])),
                format!("{:.1}", middle(&|run| run[3])),
            ]);
            ratios.push((case.name, ratio));
        }
    }
    println!();
    for (scene, count) in differences {
        println!(
            "{scene}: of {CHECKED} configurations {count} are valid here and not there, or the other way round."
        );
    }
    println!();
    let of = |name: &str| ratios.iter().find(|(known, _)| *known == name).map(|(_, ratio)| *ratio);
    for name in ["ball uniform", "tunnel uniform", "tunnel gaussian d=2", "tunnel bridge d=4"] {
        stated(&format!("{name}: less here than there"), of(name).map(|ratio| ratio > 1.0));
    }
    stated(
        "ball obprm t=0.1: less there than here",
        of("ball obprm t=0.1").map(|ratio| ratio < 1.0),
    );
    let _ = std::fs::remove_dir_all(&folder);
}
