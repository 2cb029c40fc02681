//! Sizes of all builds, by evaluator and strategy, beside the paper's means.

use super::environments::{Environment, STRATEGIES};
use super::runs::{EVALUATORS, Measured};
use crate::support::panels::{Look, Panel, Series, svg};
use crate::support::plot::COLOURS;

pub fn draw(environments: &[&Environment], shapes: &[[u32; 2]], runs: &[Measured]) -> String {
    let mut panels = Vec::new();
    for [n, k] in shapes {
        for environment in environments {
            panels.push(panel(environment, [*n, *k], runs));
        }
    }
    svg(&panels)
}

fn panel(environment: &Environment, shape: [u32; 2], runs: &[Measured]) -> Panel {
    let mut series = Vec::new();
    for (strategy, (name, colour)) in STRATEGIES.iter().zip(COLOURS).enumerate() {
        let mut points = Vec::new();
        for measured in runs {
            let run = &measured.run;
            if (&*run.environment, [run.n, run.k], &*run.strategy)
                == (environment.name, shape, *name)
            {
                for (evaluator, noted) in measured.noted.iter().enumerate() {
                    let x = evaluator as f64 + 0.14 * (strategy as f64 - 2.0);
                    points.push([x, (noted.nodes as f64).max(1.0)]);
                }
            }
        }
        series.push(Series { name: (*name).to_owned(), colour, look: Look::Dots, points });
    }
    let paper = environment.paper.iter().enumerate().map(|(at, row)| [at as f64, row[0]]).collect();
    let (name, colour) = ("the paper's mean".to_owned(), COLOURS[5]);
    series.push(Series { name, colour, look: Look::Dashes, points: paper });
    Panel {
        title: format!("{}, n = {}, k = {}", environment.title, shape[0], shape[1]),
        x_label: String::new(),
        y_label: "nodes".to_owned(),
        log_y: true,
        words: EVALUATORS
            .iter()
            .enumerate()
            .map(|(at, word)| (at as f64, (*word).to_owned()))
            .collect(),
        series,
    }
}
