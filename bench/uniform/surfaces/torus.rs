//! Figure 4.12: the distribution error on a torus of 1024 triangles.
//!
//! A run is 4000 samples. Every sample counts for the triangle that is nearest to the robot's base. The *distribution error* of a
//! triangle is the difference of its share of the samples and its share of the area; a run's is the mean over the triangles, here
//! divided by PRM's. Independent samples that have the law would have [`floor`]. The figure's numbers are not in the dissertation's
//! text, only that UOBPRM's is the least.
//!
//! Hotelling's test needs fewer shares than runs. It takes the eight pairs of bands around the tube, where the surface is bent in different
//! ways, and the law for a cube: 1 + 2H 3a/4 times the area, with 2H the sum of the principal curvatures and a the edge.
//!
//! Stated before the runs: UOBPRM has the least error, within a fifth of the floor, and is uniform at a level of 1 %; Gaussian comes
//! next; PRM and Bridge test have the largest. UOBPRM has t = 0.01 and l = 1 as the dissertation has it. OBPRM walks in steps of 0.1,
//! the last of them halved twice: its walks begin anywhere in the box, and steps of 0.01 would only make them long.

use super::draws::{self, mean, square};
use super::picture::{Bars, bars};
use super::report::{chance, head, row, stated};
use super::scenes::{EDGE, TORUS, TORUS_PIECES, torus, torus_problem};
use crate::Bench;
use crate::support::plot::COLOURS;
use roadmill::scene::Mesh;
use roadmill::uniformity::{Shares, triangle_areas, triangle_counts};
use std::f64::consts::{FRAC_2_PI, TAU};

const SAMPLES: usize = 4000;
const LEVEL: f64 = 0.01;
/// Bands of the mesh in one group of the test.
const GROUPED: usize = 2;

const CASES: [(&str, &str); 6] = [
    ("PRM", "uniform = {}"),
    ("Gaussian d=0.2", "gaussian = { deviation = 0.2 }"),
    ("Bridge d=3", "bridge = { deviation = 3.0, bounds = true }"),
    ("OBPRM", "obprm = { step = 0.1 }"),
    ("OBPRM outward", "obprm = { step = 0.1, start = \"colliding\" }"),
    ("UOBPRM l=1", "uobprm = { length = 1.0, step = 0.01, adjusted_bounds = true }"),
];

/// The mean distribution error of independent samples that have the law: shares are about normal.
fn floor(shares: &[f64]) -> f64 {
    let spread = |share: &f64| (FRAC_2_PI * share * (1.0 - share) / SAMPLES as f64).sqrt();
    shares.iter().map(spread).sum::<f64>() / shares.len() as f64
}

/// The group of bands that a triangle belongs to.
fn group(triangle: usize) -> usize {
    triangle / (2 * TORUS_PIECES[1] * GROUPED)
}

/// The area of each group for the robot.
fn law(areas: &[f64]) -> Vec<f64> {
    let groups = TORUS_PIECES[0] / GROUPED;
    let mut law = vec![0.0; groups];
    for (triangle, area) in areas.iter().enumerate() {
        let band = (triangle / (2 * TORUS_PIECES[1])) as f64;
        let [far, tube] = TORUS;
        let cosine = libm::cos(TAU * (band + 0.5) / TORUS_PIECES[0] as f64);
        let curvatures = 1.0 / tube + cosine / (far + tube * cosine);
        law[group(triangle)] += area * (1.0 + 0.75 * EDGE * curvatures);
    }
    law
}

pub fn study(bench: &mut Bench) {
    let cx = torus_problem().context();
    let (vertices, triangles) = torus();
    let mesh = Mesh { vertices, triangles };
    let areas = triangle_areas(&mesh);
    let whole: f64 = areas.iter().sum();
    let ideal: Vec<f64> = areas.iter().map(|area| area / whole).collect();
    let (floor, law) = (floor(&ideal), law(&areas));
    println!("{} triangles; floor {floor:.3e}", areas.len());
    head(&[
        "sampler",
        "error",
        "sd",
        "by the floor",
        "by PRM's",
        "p of the law",
        "µs each",
        "asked each",
    ]);
    let (mut errors, mut uniform) = (Vec::new(), None);
    for (name, text) in CASES
        .iter()
        .filter(|(name, _)| *name == "PRM" || bench.wants(name))
        .copied()
        .collect::<Vec<_>>()
    {
        let runs = bench.case(name, |seed| {
            let drawn = draws::run(&cx, text, seed, SAMPLES);
            let drawn = drawn.unwrap_or_else(|error| panic!("{name}: {error}"));
            let counts = triangle_counts(&mesh, &drawn.bases);
            let off = counts
                .iter()
                .zip(&ideal)
                .map(|(count, ideal)| (*count as f64 / SAMPLES as f64 - ideal).abs());
            let error = off.sum::<f64>() / counts.len() as f64;
            let mut grouped = vec![0.0; law.len()];
            counts.iter().enumerate().for_each(|(at, count)| grouped[group(at)] += *count as f64);
            [error, drawn.seconds, drawn.asked].into_iter().chain(grouped).collect()
        });
        let error = mean(&runs, 0);
        let squares: f64 = runs.iter().map(|run| square(run[0] - error)).sum();
        let spread = (squares / (runs.len() as f64 - 1.0).max(1.0)).sqrt();
        let counts: Vec<Vec<usize>> =
            runs.iter().map(|run| run[3..].iter().map(|n| *n as usize).collect()).collect();
        let test = Shares::of(&counts, &law).and_then(|shares| shares.test);
        errors.push((name, error));
        let of_prm = error / errors[0].1;
        if name.starts_with("UOBPRM") {
            uniform = test.map(|test| test.probability >= LEVEL);
        }
        row(&[
            name.to_owned(),
            format!("{error:.3e}"),
            format!("{spread:.1e}"),
            format!("{:.3}", error / floor),
            format!("{of_prm:.3}"),
            chance(test.map(|test| test.probability)),
            format!("{:.1}", mean(&runs, 1) / SAMPLES as f64 * 1e6),
            format!("{:.0}", mean(&runs, 2) / SAMPLES as f64),
        ]);
    }
    println!();
    let of = |name: &str| errors.iter().find(|(known, _)| *known == name).map(|(_, error)| *error);
    let ours = of("UOBPRM l=1");
    let least = errors.iter().map(|(_, error)| *error).fold(f64::INFINITY, f64::min);
    let all = errors.len() == CASES.len();
    stated("UOBPRM has the least error", ours.filter(|_| all).map(|ours| ours <= least));
    stated("UOBPRM is within a fifth of the floor", ours.map(|ours| ours < 1.2 * floor));
    stated("UOBPRM is uniform over the bands", uniform);
    let between = |gaussian: f64| {
        errors.iter().all(|(name, error)| name.starts_with("UOBPRM") || *error >= gaussian)
    };
    stated(
        "Gaussian has the least error after UOBPRM",
        of("Gaussian d=0.2").filter(|_| all).map(between),
    );
    let rest = |worse: f64| errors.iter().filter(|(_, error)| *error > worse).count() <= 1;
    let largest = of("PRM").zip(of("Bridge d=3")).filter(|_| all).map(|(a, b)| rest(a) && rest(b));
    stated("PRM and Bridge test have the two largest errors", largest);
    let colours =
        || errors.iter().zip(COLOURS).map(|((name, error), colour)| (*name, *error, colour));
    let legend: Vec<(&str, &str)> = colours().map(|(name, _, colour)| (name, colour)).collect();
    let prm = errors[0].1;
    let panel = Bars {
        title: "the line is the floor".to_owned(),
        heights: colours().map(|(_, error, colour)| (error / prm, colour)).collect(),
        ideals: vec![floor / prm; errors.len()],
    };
    bench.draw(&bars("Distribution error on the torus, by PRM's", &legend, &[panel]));
}
