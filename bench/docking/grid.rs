//! How far energies of the grid are from exact sums, on poses to which the grid's own gradient leads.

use super::complexes::COMPLEXES;
use roadmill::binding::Exact;
use roadmill::descent::{Descent, Gradient};
use roadmill::model::{ModelKind, Scratch};
use roadmill::numbers::Ordinal;
use roadmill::roadmap::Configs;
use roadmill::sampler::{ProteinSurface, Sampler};
use roadmill::seed::{Purpose, Seed};

/// Poses per complex.
const POSES: usize = 200;
/// Ways of looking up, each with the distance of points, Å.
const LOOKUPS: [(&str, f64); 4] =
    [("nearest", 0.5), ("trilinear", 0.375), ("reciprocal", 0.375), ("tricubic", 0.375)];

/// Prints the table.
pub fn run() {
    println!("| ligand | lookup | spacing, Å | median error, kJ/mol | 90 % | largest |");
    println!("|---|---|---|---|---|---|");
    for complex in COMPLEXES.iter().filter(|of| ["3PTB", "1STP", "4DFR-B"].contains(&of.name)) {
        for (lookup, spacing) in LOOKUPS {
            let table = complex.table(true);
            let grid = format!("grid = {{ lookup = \"{lookup}\", spacing = {spacing} }}\n");
            let problem = super::run::parse(&format!("{table}{grid}"));
            let ModelKind::Docking(docking) = problem.model() else { panic!("docking expected") };
            let exact = Exact::of(docking, 1);
            let (cx, scratch) = (problem.context(), &mut Scratch::new());
            let seed = Seed::of_set(1, "grid", Ordinal(0));
            let mut drawn = Configs::new(cx.space().len());
            let sampled = ProteinSurface::default().sample(&cx, &seed, POSES, scratch, &mut drawn);
            sampled.expect("there is room at the surface");
            let mut stream = seed.stream(Purpose::Accepting);
            let error = |q: &[f64]| {
                let mut q = q.to_vec();
                let energy = Gradient::default().descend(&cx, &mut stream, &mut q, scratch);
                (energy - exact.energy(&q).sum()).abs()
            };
            let mut errors: Vec<f64> = drawn.iter().map(error).collect();
            errors.sort_by(f64::total_cmp);
            let at = |share: f64| errors[((POSES - 1) as f64 * share) as usize];
            println!(
                "| {} | {lookup} | {spacing} | {:.2} | {:.2} | {:.1} |",
                complex.name,
                at(0.5),
                at(0.9),
                at(1.0)
            );
        }
    }
}
