//! Chains of hops alone, by their settings: how often the known pose is reached, at which cost.

use super::Asked;
use super::complexes::chosen;
use super::rows::median;
use super::run::{parse, run as build};

const HEAD: &str = "complex,nodes,hops,kept,kt,step,seed,cpu_s,nearest,lowest,known";

/// Settings of chains: hops of a chain, minima kept of it, kT in kJ/mol, and the largest step, Å. With every one a milestone costs 40 hops.
const SETTINGS: [(u32, u32, f64, f64); 7] = [
    (200, 5, 5.0, 2.0),
    (1000, 25, 5.0, 2.0),
    (80, 2, 5.0, 2.0),
    (40, 1, 5.0, 2.0),
    (200, 5, 2.5, 2.0),
    (200, 5, 15.0, 2.0),
    (200, 5, 5.0, 1.0),
];

/// Prints the table.
pub fn run(mut asked: Asked) {
    println!(
        "| complex | hops | kept | kT, kJ/mol | step, Å | 2 Å reached | lowest as low as the known pose | nearest, Å | CPU s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for complex in chosen(&asked.complexes) {
        for (hops, kept, kt, step) in SETTINGS {
            let nodes = asked.nodes.unwrap_or(2000);
            let text = format!(
                "{}\n[limits]\nnodes = {nodes}\n[[strategies]]\nlabel = \"only\"\nnodes = 50\ngenerator = {{ hopping = {{ hopping = {{ hops = {hops}, kt = {kt:?}, step = {step:?} }}, kept = {kept} }} }}\n",
                complex.table(true),
            );
            let problem = parse(&text);
            let mut runs = Vec::new();
            for seed in asked.seeds.clone() {
                let key = format!("{},{nodes},{hops},{kept},{kt},{step},{seed}", complex.name);
                let rows = asked.rows.of(HEAD, &key, || {
                    let run = build(&problem, seed);
                    let lowest = run.poses.first().map_or(f64::INFINITY, |pose| pose.energy);
                    vec![vec![run.seconds[0], run.nearest, lowest, run.reference.energy]]
                });
                runs.extend(rows);
            }
            let column = |at: usize| median(runs.iter().map(|row| row[at]).collect());
            let count = |is: &dyn Fn(&Vec<f64>) -> bool| runs.iter().filter(|row| is(row)).count();
            println!(
                "| {} | {hops} | {kept} | {kt} | {step} | {} of {} | {} | {:.2} | {:.1} |",
                complex.name,
                count(&|row| row[1] <= 2.0),
                runs.len(),
                count(&|row| row[2] <= row[3] + 1.0),
                column(1),
                column(0),
            );
        }
    }
}
