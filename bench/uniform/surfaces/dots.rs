//! Figures 4.6, 4.8 and 4.10: where samples lie, seen along z, of one run with the seed 1.

use super::draws;
use super::picture::{Dots, Outline, dots};
use super::scenes::{Scene, Solid, four_balls, mixture, one_ball};
use crate::Bench;

/// How many of a run's samples are drawn, of 4000: more would cover one another.
const DRAWN: usize = 1500;

const SAMPLERS: [(&str, &str); 6] = [
    ("PRM", "uniform = {}"),
    ("Gaussian d=0.2", "gaussian = { deviation = 0.2 }"),
    ("Bridge d=3", "bridge = { deviation = 3.0, bounds = true }"),
    ("OBPRM", "obprm = { step = STEP }"),
    ("OBPRM outward", "obprm = { step = STEP, start = \"colliding\" }"),
    ("UOBPRM l=1", "uobprm = { length = 1.0, step = STEP, adjusted_bounds = true }"),
];

fn draw(bench: &Bench, scene: &Scene, step: &str, about: &str) {
    let cx = scene.problem().context();
    let outline = |solid: &Solid| match *solid {
        Solid::Ball { at, radius } => Outline::Disc { at: [at[0], at[1]], radius },
        Solid::Block { at, size } => Outline::Square { at: [at[0], at[1]], edge: size[0] },
    };
    let panel = |(name, text): &(&str, &str)| {
        let drawn = draws::run(&cx, &text.replace("STEP", step), 1, DRAWN);
        let drawn = drawn.unwrap_or_else(|error| panic!("{name}: {error}"));
        Dots {
            title: (*name).to_owned(),
            points: drawn.bases.iter().map(|[x, y, _]| [*x, *y]).collect(),
            outlines: scene.solids.iter().map(outline).collect(),
        }
    };
    let asked = SAMPLERS.iter().filter(|(name, _)| bench.wants(name));
    let panels: Vec<Dots> = asked.map(panel).collect();
    for panel in &panels {
        println!("{}: {} samples", panel.title, panel.points.len());
    }
    bench.draw(&dots(about, &panels));
}

pub fn single(bench: &mut Bench) {
    draw(bench, &one_ball(), "0.1", "Samples around one ball, seen along z");
}

pub fn four(bench: &mut Bench) {
    draw(bench, &four_balls(), "0.1", "Samples around four balls, seen along z");
}

pub fn mixed(bench: &mut Bench) {
    draw(bench, &mixture(), "0.025", "Samples around two balls and two cubes, seen along z");
}
