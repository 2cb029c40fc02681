//! The poses of complexes, in a box and blind.

use super::Asked;
use super::complexes::chosen;
use super::rows::median;
use super::run::{Run, run as build, usual};

/// The columns: what a run is, then a pose of it. Pose 0 is the known one, descended, with its RMSD to what it was; pose −1 has the least
/// RMSD of all milestones and minima.
const HEAD: &str = "complex,mode,seed,pose,energy,rmsd,rmsd_rotated,cpu_s,nodes,rank";

/// A pose is the known one if it is so near, Å: the usual measure of docking.
const NEAR: f64 = 2.0;

/// What `--charges` adds to the table `[docking]`.
const CHARGES: &str = "energy = { dielectric = 4, hydrophobic = true }\n";

/// The rows of each run of a complex in a mode.
type Runs = Vec<Vec<Vec<f64>>>;

fn run_all(asked: &mut Asked) -> Vec<(String, String, Runs)> {
    let mut all = Vec::new();
    for (mode, is_boxed) in [("boxed", true), ("blind", false)] {
        if asked.mode.as_ref().is_some_and(|wanted| wanted != mode) {
            continue;
        }
        for complex in chosen(&asked.complexes) {
            let energy = if asked.charges { CHARGES } else { "" };
            let problem = usual(&format!("{}{energy}", complex.table(is_boxed)), asked.nodes);
            let of_nodes = asked.nodes.map_or(String::new(), |nodes| format!(" {nodes}"));
            let charges = if asked.charges { " charges" } else { "" };
            let mode = format!("{mode}{of_nodes}{charges}");
            let mut runs = Vec::new();
            for seed in asked.seeds.clone() {
                let key = format!("{},{mode},{seed}", complex.name);
                let rows = asked.rows.of(HEAD, &key, || rows_of(&build(&problem, seed)));
                runs.push(rows);
            }
            all.push((complex.name.to_owned(), mode, runs));
        }
    }
    all
}

/// The rows of a run.
fn rows_of(run: &Run) -> Vec<Vec<f64>> {
    let seconds = run.seconds[0] + run.seconds[1];
    let rest = [seconds, run.nodes as f64, run.rank];
    let row = |number: f64, [energy, rmsd, rotated]: [f64; 3]| {
        [&[number, energy, rmsd, rotated][..], &rest].concat()
    };
    let of = |pose: &super::run::Pose| [pose.energy, pose.rmsd, pose.rotated];
    let mut rows = vec![row(0.0, of(&run.reference)), row(-1.0, [0.0, run.nearest, 0.0])];
    let poses = run.poses.iter().enumerate();
    rows.extend(poses.map(|(number, pose)| row(number as f64 + 1.0, of(pose))));
    rows
}

/// Prints the table.
pub fn run(mut asked: Asked) {
    println!(
        "| complex | mode | first ≤ 2 Å | any of 20 ≤ 2 Å | reached | first, Å | best of 20, Å | rotated, Å | energy of the first, kJ/mol | of the known pose | misses | nodes | CPU s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (name, mode, runs) in run_all(&mut asked) {
        let pose = |run: &Vec<Vec<f64>>, number: f64, column: usize| {
            run.iter().find(|row| row[0] == number).map_or(f64::NAN, |row| row[column])
        };
        let candidates = |run: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            run.iter().filter(|row| row[0] > 0.0).cloned().collect()
        };
        let best = |run: &Vec<Vec<f64>>, column: usize| {
            candidates(run).iter().map(|row| row[column]).fold(f64::INFINITY, f64::min)
        };
        let count = |is: &dyn Fn(&Vec<Vec<f64>>) -> bool| runs.iter().filter(|run| is(run)).count();
        let of_all =
            |number: &dyn Fn(&Vec<Vec<f64>>) -> f64| median(runs.iter().map(number).collect());
        // A miss is one of sampling if the known pose is lower than the first, else one of scoring.
        let is_miss = |run: &Vec<Vec<f64>>| pose(run, 1.0, 2) > NEAR;
        let is_sampling =
            |run: &Vec<Vec<f64>>| is_miss(run) && pose(run, 0.0, 1) < pose(run, 1.0, 1);
        let (misses, sampling) = (count(&is_miss), count(&is_sampling));
        println!(
            "| {name} | {mode} | {} of {} | {} | {} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} | {sampling} sampling, {} scoring | {:.0} | {:.1} |",
            count(&|run| pose(run, 1.0, 2) <= NEAR),
            runs.len(),
            count(&|run| best(run, 2) <= NEAR),
            count(&|run| pose(run, -1.0, 2) <= NEAR),
            of_all(&|run| pose(run, 1.0, 2)),
            of_all(&|run| best(run, 2)),
            of_all(&|run| best(run, 3)),
            of_all(&|run| pose(run, 1.0, 1)),
            of_all(&|run| pose(run, 0.0, 1)),
            misses - sampling,
            of_all(&|run| pose(run, 0.0, 5)),
            of_all(&|run| pose(run, 0.0, 4)),
        );
    }
}
