//! Energies per second: by the grid, by exact sums, and by a plain loop over all pairs.

use super::complexes::COMPLEXES;
use super::rows::median;
use roadmill::model::Scratch;
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::seed::{Purpose, Seed};
use roadmill::structure::Point;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// How many configurations are looked at, each several times.
const CONFIGURATIONS: usize = 2000;
/// Of how many repetitions the median is taken.
const REPETITIONS: usize = 7;

/// Prints the table.
pub fn run() {
    println!(
        "| ligand | heavy atoms | torsions | grid, per s | grid with gradient | exact, per s | plain loop, per s | grid : plain |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for complex in COMPLEXES.iter().filter(|of| ["3PTB", "1STP", "4DFR-B"].contains(&of.name)) {
        let with = |more: &str| {
            let text = format!("{}{more}", complex.table(true));
            let problem = Problem::parse(Path::new("complex.toml"), &text);
            problem.unwrap_or_else(|error| panic!("{error}")).context()
        };
        let (grid, exact) = (with(""), with("grid = { lookup = \"exact\" }\n"));
        // Configurations near the protein, as those that are looked at in a build are.
        let mut stream = Seed::of_set(1, "speed", Ordinal(0)).stream(Purpose::Sampling);
        let scratch = &mut Scratch::new();
        let mut configurations = Vec::new();
        let mut q = vec![0.0; grid.space().len()];
        while configurations.len() < CONFIGURATIONS {
            grid.space().sample_uniform(&mut stream, &mut q);
            if grid.model().energy(&q, scratch).is_some_and(|energy| energy < 5000.0) {
                configurations.push(q.clone());
            }
        }
        let per_second = |work: &mut dyn FnMut(&[f64]) -> f64| {
            let once = |_| {
                let begun = Instant::now();
                for q in &configurations {
                    black_box(work(q));
                }
                configurations.len() as f64 / begun.elapsed().as_secs_f64()
            };
            median((0..REPETITIONS).map(once).collect())
        };
        let ligand = grid.model().ligand().expect("it is docking");
        let protein = ligand.protein().to_vec();
        let mut gradient = vec![0.0; grid.space().cube_dimensions()];
        let by_grid = per_second(&mut |q| grid.model().energy(q, scratch).unwrap_or(0.0));
        let scratch = &mut Scratch::new();
        let by_gradient =
            per_second(&mut |q| grid.model().gradient(q, &mut gradient, scratch).unwrap_or(0.0));
        let scratch = &mut Scratch::new();
        let by_exact = per_second(&mut |q| exact.model().energy(q, scratch).unwrap_or(0.0));
        let plain = per_second(&mut |q| plain_loop(&protein, &ligand.positions(q)));
        println!(
            "| {} | {} | {} | {by_grid:.0} | {by_gradient:.0} | {by_exact:.0} | {plain:.0} | {:.0} |",
            complex.name,
            ligand.ligand().heavy_atoms(),
            ligand.pieces().len() - 1,
            by_grid / plain,
        );
    }
}

/// 12-6 terms of one kind over all pairs, as one writes it first.
fn plain_loop(protein: &[Point], ligand: &[Point]) -> f64 {
    let mut energy = 0.0;
    for atom in ligand {
        for other in protein {
            let square = (atom - other).norm_squared().max(0.01);
            let sixth = 4000.0 / (square * square * square);
            energy += 0.6 * (sixth * sixth - 2.0 * sixth);
        }
    }
    energy
}
