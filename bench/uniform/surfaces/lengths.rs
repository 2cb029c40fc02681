//! Figures 4.17 to 4.19 and Lemma 2: UOBPRM is Gaussian sampling if segments have one step (t = l), and Gaussian's
//! pairs one length (d = l).
//!
//! The library's Gaussian draws lengths |N(0, d)|, so pairs of one length are drawn here, by [`pairs`]; `Gaussian sigma` is the
//! library's. UOBPRM is taken twice: with segments that start in the bounds widened by l, as the lemma has it, and with
//! `adjusted_bounds`. A run is 1000 samples around one ball (the dissertation has 4000). A trial is a pair or a segment.
//!
//! Stated before the runs. Lemma 2 holds if the numbers of trials per sample and per volume of the starts, (8 + 2l)³ for UOBPRM and 8³
//! for Gaussian, differ by less than 3 % at every length, and the mean shares of free cells by less than 0.01. The dissertation's
//! figures say three more things: times are alike for short lengths, UOBPRM gets faster than Gaussian for long ones, and is uniform for
//! l = d = 2 while Gaussian is not. With t = l none of the last two can follow from anything but the box of the starts: Lemma 2 says
//! that UOBPRM is as little uniform with t = l = 2. So stated here is: with adjusted bounds UOBPRM is *faster at all lengths*, the more
//! so the shorter they are; without, it is slower for long ones; with t = l = 2 both have samples in free cells; and UOBPRM with l = 2
//! and t = 0.1 is uniform.

use super::draws::{self, mean};
use super::picture::{Bars, bars};
use super::report::{chance, head, row, stated};
use super::scenes::one_ball;
use crate::Bench;
use crate::support::cpu_seconds;
use crate::support::plot::COLOURS;
use roadmill::Context;
use roadmill::model::{Scratch, Validity};
use roadmill::numbers::Ordinal;
use roadmill::seed::{Purpose, Seed};
use roadmill::uniformity::{Grid, Shares};

const SAMPLES: usize = 1000;
const LENGTHS: [f64; 6] = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0];
const LEVEL: f64 = 0.01;
/// Lengths of Figure 4.19.
const SHOWN: [f64; 3] = [0.05, 0.1, 2.0];
const MIDDLE: [usize; 4] = [5, 6, 9, 10];

const PAIRS: &str = "Gaussian d";
const DEVIATING: &str = "Gaussian sigma";
const WIDE: &str = "UOBPRM t=l";
const ADJUSTED: &str = "adjusted UOBPRM t=l";
const FINE: &str = "adjusted UOBPRM t=0.1 l";

/// Gaussian sampling with pairs of one length: the free end where the other collides. A run's bases, CPU seconds, and pairs.
fn pairs(cx: &Context, length: f64, run: u64) -> (Vec<[f64; 3]>, f64, f64) {
    let mut stream = Seed::of_set(run, "surfaces", Ordinal(0)).stream(Purpose::Sampling);
    let (mut near, mut far) = (vec![0.0; cx.space().len()], vec![0.0; cx.space().len()]);
    let (mut scratch, mut bases, mut trials) = (Scratch::new(), Vec::new(), 0.0);
    let begun = cpu_seconds();
    while bases.len() < SAMPLES {
        trials += 1.0;
        cx.space().sample_uniform(&mut stream, &mut near);
        cx.space().step(&near, length, &mut stream, &mut far);
        let free = match [&near, &far].map(|q| cx.model().validity(q, &mut scratch)) {
            [Validity::Valid, Validity::Invalid] => &near,
            [Validity::Invalid, Validity::Valid] => &far,
            _ => continue,
        };
        bases.push([free[0], free[1], free[2]]);
    }
    (bases, cpu_seconds() - begun, trials)
}

/// A sampler at a length, as a case: what it is called, and the text of the library's sampler, if it is one.
fn case(kind: &str, length: f64) -> (String, Option<String>) {
    let adjusted = if kind == WIDE { "" } else { ", adjusted_bounds = true" };
    let step = if kind == FINE { 0.1 } else { length };
    let text = match kind {
        PAIRS => None,
        DEVIATING => Some(format!("gaussian = {{ deviation = {length:?} }}")),
        _ => Some(format!("uobprm = {{ length = {length:?}, step = {step:?}{adjusted} }}")),
    };
    (format!("{kind}={length}"), text)
}

/// What a case came to: its runs, and the shares of the cells.
struct Found {
    seconds: f64,
    trials: f64,
    shares: Shares,
}

impl Found {
    /// The share of all cells that the ball does not reach.
    fn free(&self) -> f64 {
        let cells = self.shares.cells.iter().enumerate();
        cells.filter(|(cell, _)| !MIDDLE.contains(cell)).map(|(_, share)| share.mean).sum()
    }

    fn uniform(&self) -> Option<bool> {
        self.shares.test.map(|test| test.probability >= LEVEL)
    }
}

fn found(bench: &mut Bench, cx: &Context, kind: &str, length: f64) -> Option<Found> {
    let (name, text) = case(kind, length);
    if !bench.wants(kind) && !bench.wants(&name) {
        return None;
    }
    let grid = Grid::new([-4.0; 3], [4.0; 3], [4, 4, 1]).expect("a box");
    let runs = bench.case(&name, |seed| {
        let (bases, seconds, trials) = match &text {
            None => pairs(cx, length, seed),
            Some(text) => {
                let drawn = draws::run(cx, text, seed, SAMPLES);
                let drawn = drawn.unwrap_or_else(|error| panic!("{name}: {error}"));
                // Two configurations a trial, but of segments with more steps.
                (drawn.bases, drawn.seconds, 0.5 * drawn.asked)
            }
        };
        let (counts, outside) = grid.counts(&bases);
        assert_eq!(outside, 0, "milestones are within the bounds");
        counts.iter().map(|count| *count as f64).chain([seconds, trials]).collect()
    });
    let counts: Vec<Vec<usize>> =
        runs.iter().map(|run| run[..16].iter().map(|count| *count as usize).collect()).collect();
    let mut expected = [0.0; 16];
    MIDDLE.iter().for_each(|cell| expected[*cell] = 1.0);
    let shares = Shares::of(&counts, &expected).expect("samples");
    let trials = mean(&runs, 17) / SAMPLES as f64;
    Some(Found { seconds: mean(&runs, 16), trials, shares })
}

pub fn study(bench: &mut Bench) {
    let cx = one_ball().problem().context();
    head(&[
        "sampler",
        "l = d",
        "CPU s for 1000",
        "by Gaussian d",
        "trials each",
        "per volume, by Gaussian d",
        "free cells, %",
        "p of the law",
    ]);
    let mut all: Vec<[Option<Found>; 5]> = Vec::new();
    for length in LENGTHS {
        let kinds = [PAIRS, DEVIATING, WIDE, ADJUSTED, FINE];
        let of = kinds.map(|kind| {
            // A step of 0.1 is one step of a segment of 0.1, and longer than one of 0.05.
            if kind == FINE && length < 0.2 { None } else { found(bench, &cx, kind, length) }
        });
        for (kind, found) in kinds.iter().zip(&of) {
            let (Some(found), Some(gaussian)) = (found, &of[0]) else { continue };
            let of_volume = match *kind {
                WIDE => per_volume(found, length) / gaussian.trials,
                PAIRS | DEVIATING => found.trials / gaussian.trials,
                _ => f64::NAN,
            };
            let of_volume =
                if of_volume.is_nan() { "–".to_owned() } else { format!("{of_volume:.3}") };
            let trials =
                if *kind == FINE { "–".to_owned() } else { format!("{:.0}", found.trials) };
            row(&[
                (*kind).to_owned(),
                length.to_string(),
                format!("{:.4}", found.seconds),
                format!("{:.3}", found.seconds / gaussian.seconds),
                trials,
                of_volume,
                format!("{:.2}", 100.0 * found.free()),
                chance(found.shares.test.map(|test| test.probability)),
            ]);
        }
        all.push(of);
    }
    statements(&all);
    let mut panels = Vec::new();
    for (kind, index) in [(PAIRS, 0), (WIDE, 2)] {
        for (at, length) in LENGTHS.iter().enumerate().filter(|(_, length)| SHOWN.contains(length))
        {
            let Some(found) = &all[at][index] else { continue };
            let colour = |cell: usize| COLOURS[usize::from(!MIDDLE.contains(&cell))];
            let heights = found.shares.cells.iter().enumerate();
            panels.push(Bars {
                title: format!("{kind} = {length}"),
                heights: heights.map(|(cell, share)| (share.mean, colour(cell))).collect(),
                ideals: found.shares.cells.iter().map(|share| share.expected).collect(),
            });
        }
    }
    let legend = [("ball", COLOURS[0]), ("free", COLOURS[1])];
    bench.draw(&bars(
        "Share of the samples in each of 16 cells; the lines are uniform",
        &legend,
        &panels,
    ));
}

/// Trials of UOBPRM as if segments started in the bounds.
fn per_volume(found: &Found, length: f64) -> f64 {
    let ratio = 8.0 / (8.0 + 2.0 * length);
    found.trials * ratio * ratio * ratio
}

fn statements(all: &[[Option<Found>; 5]]) {
    println!();
    // What holds of two samplers at every length; `None` if one was not run.
    let each = |a: usize, b: usize, holds: &dyn Fn(&Found, &Found, f64) -> bool| {
        let of = all
            .iter()
            .zip(LENGTHS)
            .map(|(of, length)| Some(holds(of[a].as_ref()?, of[b].as_ref()?, length)));
        of.collect::<Option<Vec<bool>>>().map(|held| held.into_iter().all(|held| held))
    };
    stated(
        "Lemma 2: as many trials per volume of the starts, within 3 %",
        each(0, 2, &|pairs, wide, length| {
            (per_volume(wide, length) / pairs.trials - 1.0).abs() < 0.03
        }),
    );
    stated(
        "Lemma 2: as many samples in free cells, within 0.01",
        each(0, 2, &|pairs, wide, _| (wide.free() - pairs.free()).abs() < 0.01),
    );
    stated(
        "UOBPRM with adjusted bounds is faster than Gaussian at all lengths",
        each(0, 3, &|pairs, adjusted, _| adjusted.seconds < pairs.seconds),
    );
    let ratio = |at: usize| Some(all[at][3].as_ref()?.seconds / all[at][0].as_ref()?.seconds);
    stated(
        "the more so the shorter they are, against the dissertation's Figure 4.18",
        ratio(0).zip(ratio(5)).map(|(short, long)| short < long),
    );
    let last = &all[LENGTHS.len() - 1];
    let slower =
        last[0].as_ref().zip(last[2].as_ref()).map(|(pairs, wide)| wide.seconds > pairs.seconds);
    stated("without adjusted bounds UOBPRM is slower with l = t = 2", slower);
    for (index, kind) in [(0, PAIRS), (2, WIDE)] {
        for at in [0, 1] {
            let says = format!("{kind} = {} is uniform", LENGTHS[at]);
            stated(&says, all[at][index].as_ref().and_then(Found::uniform));
        }
        let says = format!("{kind} = 2 is not uniform");
        stated(&says, last[index].as_ref().and_then(Found::uniform).map(|uniform| !uniform));
    }
    stated("UOBPRM with l = 2 and t = 0.1 is uniform", last[4].as_ref().and_then(Found::uniform));
}
