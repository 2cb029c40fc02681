//! Figures 5.8 and 5.9: 1000 samples between two blocks, seen.

use super::distances::{DRAWN, Drawn, SAMPLES, cells};
use super::mean;
use super::scenes::blocks;
use crate::Bench;
use crate::support::panels::{Look, Panel, Series, svg};
use crate::support::plot::INK;
use roadmill::Context;

/// The line between the blocks. Samples are spread out sideways in their order, or they would cover one another.
pub fn in_the_plane(bench: &mut Bench) {
    let place = |sample: usize, q: &[f64]| [(sample as f64 / SAMPLES as f64 - 0.5) * 0.4, q[1]];
    let of_side = |side: f64| rectangle([side * 0.25, -0.5], [side * 1.25, 0.5]);
    picture(bench, 2, &[of_side(-1.0), of_side(1.0)], place);
}

/// The plane between the blocks, seen along x, with the side of a block that faces the other.
pub fn in_space(bench: &mut Bench) {
    picture(bench, 3, &[rectangle([-0.5, -0.5], [0.5, 0.5])], |_, q| [q[1], q[2]]);
}

fn rectangle([left, low]: [f64; 2], [right, high]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[left, low], [right, low], [right, high], [left, high], [left, low]]
}

/// A panel for each sampler, with the samples of seed 1, and one with the samples in the cells of the axis, the mean over the runs.
fn picture(
    bench: &mut Bench,
    dimensions: usize,
    sides: &[Vec<[f64; 2]>],
    place: fn(usize, &[f64]) -> [f64; 2],
) {
    let cx = blocks(dimensions).problem.context();
    let mut panels: Vec<Panel> =
        DRAWN.into_iter().map(|drawn| samples(&cx, drawn, sides, place)).collect();
    let expected = SAMPLES as f64 / cells(dimensions).len() as f64;
    let mut series = Vec::new();
    println!("| samples | mean number in each cell of the axis, {expected:.1} if uniform |");
    println!("| --- | --- |");
    for drawn in DRAWN {
        let runs = drawn.runs(bench, dimensions);
        let means: Vec<f64> =
            (0..cells(dimensions).len()).map(|cell| mean(&runs, 1 + cell)).collect();
        let words: Vec<String> = means.iter().map(|mean| format!("{mean:.0}")).collect();
        println!("| {} | {} |", drawn.name(), words.join(" "));
        let points = means.iter().enumerate().map(|(cell, mean)| [cell as f64 + 1.0, *mean]);
        let (name, colour) = (drawn.name().to_owned(), drawn.colour());
        series.push(Series { name, colour, look: Look::Line, points: points.collect() });
    }
    // The names of the first panel's series are the picture's legend.
    let others = series.iter().skip(1).map(named);
    panels[0].series.extend(others);
    panels.push(Panel {
        title: format!("mean of {} runs", bench.runs),
        x_label: "cell of the axis".to_owned(),
        y_label: "samples in it".to_owned(),
        log_y: false,
        words: Vec::new(),
        series,
    });
    bench.draw(&svg(&panels));
}

/// A series without points, for the legend.
fn named(series: &Series) -> Series {
    Series {
        name: series.name.clone(),
        colour: series.colour,
        look: series.look,
        points: Vec::new(),
    }
}

fn samples(
    cx: &Context,
    drawn: Drawn,
    sides: &[Vec<[f64; 2]>],
    place: fn(usize, &[f64]) -> [f64; 2],
) -> Panel {
    let configs = drawn.samples(cx, 1);
    let points = configs.iter().enumerate().map(|(sample, q)| place(sample, q)).collect();
    let (name, colour) = (drawn.name().to_owned(), drawn.colour());
    let mut series = vec![Series { name, colour, look: Look::Dots, points }];
    series.extend(sides.iter().map(|side| Series {
        name: String::new(),
        colour: INK,
        look: Look::Line,
        points: side.clone(),
    }));
    Panel {
        title: drawn.name().to_owned(),
        x_label: String::new(),
        y_label: String::new(),
        log_y: false,
        words: Vec::new(),
        series,
    }
}
