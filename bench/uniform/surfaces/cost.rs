//! Tables 4.4 and 4.5: what 1000 samples cost, in the scene with one ball and in the Tunnel.
//!
//! The dissertation's seconds are of another machine and another collision checker, so what can agree is order and trend: which of two
//! entries takes longer. The last column of a table says of how many of all pairs of entries, both given by the dissertation, ours and
//! the dissertation's times have the same order.
//!
//! UOBPRM has segments of length 1 around the ball and 2 in the Tunnel, so that l/t says the step; `adjusted_bounds` around the ball.
//! Bridge test takes being out of bounds as colliding. What finds no sample in 200 000 attempts is given up, which a run has as −1.

use super::draws::{self, mean};
use super::report::{head, rises, row, stated};
use super::scenes::{Scene, one_ball, tunnel};
use crate::Bench;

const SAMPLES: usize = 1000;

struct Case {
    name: &'static str,
    sampler: String,
    /// Seconds in the dissertation.
    paper: f64,
}

fn case(name: &'static str, sampler: &str, paper: f64) -> Case {
    Case { name, sampler: sampler.to_owned(), paper }
}

fn measured(bench: &mut Bench, scene: &Scene, cases: &[Case]) -> Vec<(&'static str, f64)> {
    let cx = scene.problem().context();
    head(&["sampler", "ours, s per 1000", "µs each", "asked each", "dissertation, s"]);
    let (mut times, mut pairs) = (Vec::new(), Vec::new());
    for case in cases {
        if !bench.wants(case.name) {
            continue;
        }
        let runs =
            bench.case(case.name, |seed| match draws::run(&cx, &case.sampler, seed, SAMPLES) {
                Ok(drawn) => vec![drawn.seconds, drawn.asked],
                Err(_) => vec![-1.0, -1.0],
            });
        let given_up = runs.iter().filter(|run| run[0] < 0.0).count();
        let paper = format!("{:.2}", case.paper);
        if given_up > 0 {
            let says = format!("none in 200 000 attempts ({given_up} of {} runs)", runs.len());
            row(&[case.name, &says, "–", "–", &paper]);
            times.push((case.name, f64::INFINITY));
            continue;
        }
        let (seconds, asked) = (mean(&runs, 0), mean(&runs, 1));
        let each = format!("{:.2}", seconds * 1e6 / SAMPLES as f64);
        let asked = format!("{:.0}", asked / SAMPLES as f64);
        row(&[case.name, &format!("{seconds:.5}"), &each, &asked, &paper]);
        times.push((case.name, seconds));
        pairs.push((seconds, case.paper));
    }
    let mut same = 0;
    let mut all = 0;
    for (i, a) in pairs.iter().enumerate() {
        for b in &pairs[i + 1..] {
            all += 1;
            same += usize::from((a.0 < b.0) == (a.1 < b.1));
        }
    }
    println!("\nSame order as in the dissertation: {same} of {all} pairs of entries.\n");
    times
}

/// The times of the cases whose names begin so, in their order; `None` if one is missing.
fn series(times: &[(&str, f64)], begins: &str, count: usize) -> Option<Vec<f64>> {
    let of = times.iter().filter(|(name, _)| name.starts_with(begins));
    let of: Vec<f64> = of.map(|(_, seconds)| *seconds).collect();
    (of.len() == count).then_some(of)
}

/// What a statement is about: the names of entries, how many there are, and what holds of their times.
fn about(times: &[(&str, f64)], says: &str, begins: &str, count: usize, holds: fn(&[f64]) -> bool) {
    stated(says, series(times, begins, count).map(|times| holds(&times)));
}

fn falls(times: &[f64]) -> bool {
    times.windows(2).all(|pair| pair[0] > pair[1])
}

/// Table 4.4.
pub fn single(bench: &mut Bench) {
    let gaussian = |d: f64| format!("gaussian = {{ deviation = {d:?} }}");
    let bridge =
        |d: f64| format!("bridge = {{ deviation = {d:?}, bounds = true, attempts = 200000 }}");
    let obprm = |t: f64| format!("obprm = {{ step = {t:?} }}");
    let uobprm = |ratio: f64| {
        format!("uobprm = {{ length = 1.0, step = {:?}, adjusted_bounds = true }}", 1.0 / ratio)
    };
    let cases = [
        case("PRM", "uniform = {}", 0.07),
        case("Gaussian d=0.1", &gaussian(0.1), 22.91),
        case("Gaussian d=0.2", &gaussian(0.2), 7.08),
        case("Bridge d=0.1", &bridge(0.1), 128.58),
        case("Bridge d=0.2", &bridge(0.2), 86.73),
        case("OBPRM t=0.025", &obprm(0.025), 19.34),
        case("OBPRM t=0.05", &obprm(0.05), 18.34),
        case("OBPRM t=0.1", &obprm(0.1), 15.34),
        case("OBPRM t=0.2", &obprm(0.2), 6.02),
        case("UOBPRM l/t=2", &uobprm(2.0), 8.70),
        case("UOBPRM l/t=4", &uobprm(4.0), 8.69),
        case("UOBPRM l/t=5", &uobprm(5.0), 9.08),
        case("UOBPRM l/t=10", &uobprm(10.0), 9.88),
        case("UOBPRM l/t=20", &uobprm(20.0), 11.69),
        case("UOBPRM l/t=40", &uobprm(40.0), 16.67),
    ];
    let times = measured(bench, &one_ball(), &cases);
    about(&times, "Gaussian's time falls with d", "Gaussian", 2, falls);
    about(
        &times,
        "Bridge finds nothing with d = 0.1 and 0.2: one convex obstacle, 3 away from the bounds, has no bridge so short, whatever took the dissertation's 129 and 87 s",
        "Bridge",
        2,
        |times| times.iter().all(|seconds| seconds.is_infinite()),
    );
    about(&times, "OBPRM's time falls with t", "OBPRM", 4, falls);
    about(&times, "UOBPRM's time rises with l/t", "UOBPRM", 6, rises);
    about(
        &times,
        "UOBPRM's time with l/t = 40 is less than ten times that with l/t = 2",
        "UOBPRM",
        6,
        |times| times[5] < 10.0 * times[0],
    );
    let prm =
        series(&times, "PRM", 1).map(|prm| times.iter().all(|(_, seconds)| *seconds >= prm[0]));
    stated("PRM takes the least time", prm);
}

/// Table 4.5.
pub fn tunnels(bench: &mut Bench) {
    let gaussian = |d: f64| format!("gaussian = {{ deviation = {d:?} }}");
    let bridge =
        |d: f64| format!("bridge = {{ deviation = {d:?}, bounds = true, attempts = 200000 }}");
    let obprm = |t: f64| format!("obprm = {{ step = {t:?} }}");
    let uobprm = |ratio: f64| format!("uobprm = {{ length = 2.0, step = {:?} }}", 2.0 / ratio);
    let cases = [
        case("PRM", "uniform = {}", 0.39),
        case("Gaussian d=2", &gaussian(2.0), 28.66),
        case("Gaussian d=4", &gaussian(4.0), 44.39),
        case("Gaussian d=8", &gaussian(8.0), 82.41),
        case("Bridge d=2", &bridge(2.0), 85.86),
        case("Bridge d=4", &bridge(4.0), 172.29),
        case("OBPRM t=0.025", &obprm(0.025), 14.54),
        case("OBPRM t=0.05", &obprm(0.05), 13.28),
        case("OBPRM t=0.1", &obprm(0.1), 11.94),
        case("OBPRM t=0.2", &obprm(0.2), 8.74),
        case("UOBPRM l/t=2", &uobprm(2.0), 11.04),
        case("UOBPRM l/t=4", &uobprm(4.0), 13.05),
        case("UOBPRM l/t=5", &uobprm(5.0), 13.64),
        case("UOBPRM l/t=8", &uobprm(8.0), 17.04),
        case("UOBPRM l/t=10", &uobprm(10.0), 18.56),
        case("UOBPRM l/t=20", &uobprm(20.0), 31.04),
        case("UOBPRM l/t=40", &uobprm(40.0), 33.60),
        case("UOBPRM l/t=80", &uobprm(80.0), 62.83),
    ];
    let times = measured(bench, &tunnel(), &cases);
    about(&times, "Gaussian's time rises with d, as in the dissertation", "Gaussian", 3, rises);
    about(&times, "Bridge's time rises with d, as in the dissertation", "Bridge", 2, rises);
    about(&times, "OBPRM's time falls with t", "OBPRM", 4, falls);
    about(&times, "UOBPRM's time rises with l/t", "UOBPRM", 8, rises);
    let prm =
        series(&times, "PRM", 1).map(|prm| times.iter().all(|(_, seconds)| *seconds >= prm[0]));
    stated("PRM takes the least time", prm);
    let bridge = series(&times, "Bridge", 2);
    let most = bridge.map(|of| times.iter().filter(|(_, seconds)| *seconds > of[1]).count() == 0);
    stated("Bridge with d = 4 takes the most time", most);
}
