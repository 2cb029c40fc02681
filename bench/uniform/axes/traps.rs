//! The bug trap of Figure 5.14: with which samplers a point gets out, by the width of the opening.

use super::planning::{NODES, SECONDS, SOLVED, build};
use super::scenes::bug_trap;
use super::{METHODS, Method, mean, verdict, verdicts};
use crate::Bench;

/// Widths of the opening as shares of the trap's side: their denominators.
const OPENINGS: [u32; 3] = [20, 50, 100];
/// The most runs of UMAPRM, and of the others at the widest opening. There one whose first run is not solved has no further ones, since
/// each takes all the time that there is; at the other openings the others have one run.
const RUNS: u64 = 10;

/// What the runs of a case came to.
struct Row {
    opening: u32,
    method: Method,
    solved: usize,
    runs: usize,
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
            let solved = runs.iter().filter(|run| run[SOLVED] == 1.0).count();
            println!(
                "| 1/{opening} | {} | {solved} of {} | {:.0} | {:.1} |",
                method.name(),
                runs.len(),
                mean(&runs, NODES),
                mean(&runs, SECONDS)
            );
            rows.push(Row { opening, method, solved, runs: runs.len() });
        }
    }
    verdicts();
    for opening in OPENINGS {
        let of =
            |method: Method| rows.iter().find(|row| row.opening == opening && row.method == method);
        let [Some(umaprm), Some(maprm), Some(prm)] = METHODS.map(of) else { continue };
        let [ours, theirs, prms] =
            [umaprm, maprm, prm].map(|row| format!("{} of {}", row.solved, row.runs));
        verdict(
            &format!("1/{opening}: only UMAPRM leaves the trap"),
            &format!("UMAPRM {ours}, MAPRM {theirs}, PRM {prms}"),
            umaprm.solved == umaprm.runs && maprm.solved == 0 && prm.solved == 0,
        );
    }
}
