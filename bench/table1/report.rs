//! The tables: ours beside the paper's, and by strategy.

use super::choices::Choices;
use super::environments::{Environment, STRATEGIES};
use super::runs::Measured;
use crate::support::noting::Noted;

const TITLES: [&str; 3] = ["Predefined query", "95 % coverage", "75 % connectivity"];
/// A size agrees within so much of the paper's, a percentage within so many points of it.
const SIZE_WITHIN: f64 = 0.25;
const POINTS_WITHIN: f64 = 10.0;

/// Size, percentages connected and solved.
fn row(noted: &Noted) -> [f64; 3] {
    [noted.nodes as f64, 100.0 * noted.connectible, 100.0 * noted.solved]
}

/// Mean, and its standard error.
fn mean(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance =
        values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0);
    (mean, if count > 1.0 { (variance / count).sqrt() } else { f64::INFINITY })
}

/// `=` where ours agrees with the paper's, else whether it is smaller or larger. A size in which capped
/// builds count too is too small: it never agrees from below.
fn mark(column: usize, ours: f64, paper: f64, capped: usize) -> &'static str {
    let within = if column == 0 { SIZE_WITHIN * paper } else { POINTS_WITHIN };
    match () {
        () if ours > paper + within => ">",
        () if ours < paper - within => {
            if column == 0 && capped > 0 {
                "?"
            } else {
                "<"
            }
        }
        () if column == 0 && capped > 0 => "?",
        () => "=",
    }
}

fn of<'a>(
    environment: &'a Environment,
    [n, k]: [u32; 2],
    runs: &'a [Measured],
) -> impl Iterator<Item = &'a Measured> {
    runs.iter().filter(move |measured| {
        let run = &measured.run;
        run.environment == environment.name && [run.n, run.k] == [n, k]
    })
}

pub fn table(environments: &[&Environment], shape: [u32; 2], runs: &[Measured], choices: &Choices) {
    let [n, k] = shape;
    println!("\n### n = {n}, k = {k}\n");
    println!(
        "Means over the builds of all strategies ± standard error, beside the paper's. A build is capped \
         at {} nodes or {} CPU seconds; it counts with what it had then. `=`: a size within {:.0} % of the \
         paper's, a percentage within {POINTS_WITHIN} points; `<`, `>`: ours is smaller, larger; `?`: it is \
         not known, as capped builds would have gone on.\n",
        choices.nodes,
        choices.seconds,
        100.0 * SIZE_WITHIN
    );
    println!(
        "| environment | evaluator | builds | capped | size | paper | | connectible % | paper | | solved % | paper | |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for environment in environments {
        for (evaluator, title) in TITLES.iter().enumerate() {
            let noted: Vec<&Noted> =
                of(environment, shape, runs).map(|measured| &measured.noted[evaluator]).collect();
            let capped = noted.iter().filter(|noted| !noted.satisfied).count();
            print!("| {} | {title} | {} | {capped} |", environment.title, noted.len());
            for column in 0..3 {
                let values: Vec<f64> = noted.iter().map(|noted| row(noted)[column]).collect();
                let ((ours, error), paper) = (mean(&values), environment.paper[evaluator][column]);
                let mark = mark(column, ours, paper, capped);
                print!(" {ours:.1} ± {error:.1} | {paper:.1} | {mark} |");
            }
            println!();
        }
    }
    println!("\nThe same by strategy: size (builds capped), connectible / solved %.\n");
    println!("| environment | evaluator | {} |", STRATEGIES.join(" | "));
    println!("| --- | --- |{}", " --- |".repeat(STRATEGIES.len()));
    for environment in environments {
        for (evaluator, title) in TITLES.iter().enumerate() {
            print!("| {} | {title} |", environment.title);
            for strategy in STRATEGIES {
                let own = of(environment, shape, runs)
                    .filter(|measured| measured.run.strategy == strategy);
                let noted: Vec<&Noted> = own.map(|measured| &measured.noted[evaluator]).collect();
                if noted.is_empty() {
                    let known = choices.sampler(environment, strategy).is_some();
                    print!(" {} |", if known { "not run" } else { "not available" });
                    continue;
                }
                let column =
                    |i: usize| mean(&noted.iter().map(|noted| row(noted)[i]).collect::<Vec<_>>()).0;
                let capped = noted.iter().filter(|noted| !noted.satisfied).count();
                let capped = if capped > 0 { format!(" ({capped})") } else { String::new() };
                print!(" {:.0}{capped}, {:.0} / {:.0} |", column(0), column(1), column(2));
            }
            println!();
        }
    }
}
