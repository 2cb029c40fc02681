//! One generator at a time, flexible and rigid: Tables V and VI of Bayazit's thesis on the complexes at hand.

use super::Asked;
use super::complexes::chosen;
use super::rows::median;
use super::run::{parse, run as build};

const HEAD: &str = "complex,generator,seed,rmsd,rmsd_rotated,cpu_s,rank,nodes";

/// The generators, each with the lines of the table `[docking]` that it adds.
const GENERATORS: [(&str, &str, &str); 6] = [
    (
        "geometry",
        "",
        "generator = { minima = { sampler = { protein-surface = {} }, descent = { lowest-neighbor = {} } } }",
    ),
    (
        "energy",
        "",
        "generator = { minima = { sampler = { low-energy-cells = {} }, descent = { lowest-neighbor = {} } } }",
    ),
    (
        "geometry, rigid",
        "rigid = true\n",
        "generator = { minima = { sampler = { protein-surface = {} }, descent = { lowest-neighbor = {} } } }",
    ),
    ("geometry, gradient", "", "generator = { minima = { sampler = { protein-surface = {} } } }"),
    ("energy, gradient", "", "generator = { minima = { sampler = { low-energy-cells = {} } } }"),
    ("uobprm", "", "sampler = { uobprm = { length = 10.0, step = 0.25 } }"),
];

/// Prints the table.
pub fn run(mut asked: Asked) {
    println!(
        "| complex | generator | least RMSD, Å | after rotation, Å | rank, % | nodes | CPU s |"
    );
    println!("|---|---|---|---|---|---|---|");
    for complex in chosen(&asked.complexes) {
        for (name, table, strategy) in GENERATORS {
            let nodes = asked.nodes.unwrap_or(4000);
            let text = format!(
                "{}{table}\n[limits]\nnodes = {nodes}\n[[strategies]]\nlabel = \"only\"\nnodes = 100\n{strategy}\n",
                complex.table(false),
            );
            let problem = parse(&text);
            let mut runs = Vec::new();
            for seed in asked.seeds.clone() {
                let key = format!("{},{},{seed}", complex.name, name.replace(", ", " "));
                let rows = asked.rows.of(HEAD, &key, || {
                    let run = build(&problem, seed);
                    let rotated =
                        run.improved.iter().map(|pose| pose.rotated).fold(f64::INFINITY, f64::min);
                    let (seconds, nodes) = (run.seconds[0], run.nodes as f64);
                    vec![vec![run.nearest, rotated, seconds, run.rank, nodes]]
                });
                runs.extend(rows);
            }
            let column = |at: usize| median(runs.iter().map(|row| row[at]).collect());
            println!(
                "| {} | {name} | {:.2} | {:.2} | {:.0} | {:.0} | {:.1} |",
                complex.name,
                column(0),
                column(1),
                column(3),
                column(4),
                column(2),
            );
        }
    }
}
