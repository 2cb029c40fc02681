//! The bug trap of Figure 5.14: with which samplers a point gets out, by the width of the opening.

use super::planning::{NODES, SECONDS, SOLVED, build};
use super::scenes::bug_trap;
use super::{METHODS, Method, mean, verdict, verdicts};
use crate::Bench;
use crate::support::panels::{Look, Panel, Series, svg};

/// Widths of the opening as shares of the trap's side: their denominators.
const OPENINGS: [u32; 3] = [20, 50, 100];
/// The most runs of UMAPRM, and of the others at the widest opening. There one whose first run is not solved has no further ones, since
/// each takes all the time that there is; at the other openings the others have one run.
const RUNS: u64 = 10;

/// What the runs of a case came to.
struct Row {
    opening: u32,
    method: Method,
    runs: Vec<Vec<f64>>,
}

impl Row {
    fn solved(&self) -> usize {
        self.runs.iter().filter(|run| run[SOLVED] == 1.0).count()
    }
}

pub fn run(bench: &mut Bench) {
    let seconds = bench.seconds;
    let asked = bench.runs.min(RUNS);
    println!("| opening | sampler | solved | nodes, mean | CPU s, mean |");
    println!("|{}", " --- |".repeat(5));
    let mut rows = Vec::new();
    for opening in OPENINGS {
        let scene = bug_trap(1.0 / f64::from(opening));
        for method in METHODS {
            let case = format!("1/{opening} {}", method.name());
            if !bench.wants(&case) {
                continue;
            }
            let often = method == Method::Umaprm || opening == OPENINGS[0];
            let most = if often { asked } else { 1 };
            let mut runs = Vec::new();
            for count in [1, most] {
                bench.runs = count;
                runs = bench.case(&case, |seed| build(&scene, method, seed, seconds));
                if runs[0][SOLVED] != 1.0 {
                    break;
                }
            }
            let row = Row { opening, method, runs };
            println!(
                "| 1/{opening} | {} | {} of {} | {:.0} | {:.1} |",
                method.name(),
                row.solved(),
                row.runs.len(),
                mean(&row.runs, NODES),
                mean(&row.runs, SECONDS)
            );
            rows.push(row);
        }
    }
    bench.draw(&svg(&[SECONDS, NODES].map(|number| panel(&rows, number))));
    verdicts();
    for opening in OPENINGS {
        let of =
            |method: Method| rows.iter().find(|row| row.opening == opening && row.method == method);
        let [Some(umaprm), Some(maprm), Some(prm)] = METHODS.map(of) else { continue };
        let [ours, theirs, prms] =
            [umaprm, maprm, prm].map(|row| format!("{} of {}", row.solved(), row.runs.len()));
        verdict(
            &format!("1/{opening}: only UMAPRM leaves the trap"),
            &format!("UMAPRM {ours}, MAPRM {theirs}, PRM {prms}"),
            umaprm.solved() == umaprm.runs.len() && maprm.solved() + prm.solved() == 0,
        );
    }
}

/// A dot for each run that was solved.
fn panel(rows: &[Row], number: usize) -> Panel {
    let (y_label, unit) =
        if number == SECONDS { ("CPU seconds", 1.0) } else { ("thousands of nodes", 1000.0) };
    let series = METHODS.into_iter().enumerate().map(|(beside, method)| {
        let own = rows.iter().filter(|row| row.method == method);
        let points = own.flat_map(|row| {
            let at = OPENINGS.iter().position(|opening| *opening == row.opening);
            let x = at.map_or(0.0, |at| at as f64) + 0.2 * (beside as f64 - 1.0);
            let solved = row.runs.iter().filter(|run| run[SOLVED] == 1.0);
            solved.map(move |run| [x, run[number] / unit])
        });
        Series {
            name: method.name().to_owned(),
            colour: method.colour(),
            look: Look::Dots,
            points: points.collect(),
        }
    });
    let words = OPENINGS.iter().enumerate();
    Panel {
        title: "out of the bug trap".to_owned(),
        x_label: "opening, as a share of the trap's side".to_owned(),
        y_label: y_label.to_owned(),
        log_y: true,
        words: words.map(|(at, opening)| (at as f64, format!("1/{opening}"))).collect(),
        series: series.collect(),
    }
}
