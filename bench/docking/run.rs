//! One run: a roadmap is built, and its poses are compared with the known one.

use roadmill::Cancel;
use roadmill::binding::{Asked, Candidates, Exact, candidates};
use roadmill::img::{Setup, build};
use roadmill::ligand::Symmetries;
use roadmill::model::docking::Docking;
use roadmill::model::{ModelKind, ModelSpec, Scratch};
use roadmill::problem::{PoseSearch, Problem, docking as poses_of};
use roadmill::structure::Point;
use std::path::Path;
use std::sync::Arc;

/// What a run came to.
pub struct Run {
    /// CPU seconds, of the build and of the search for poses.
    pub seconds: [f64; 2],
    /// Nodes of the roadmap.
    pub nodes: usize,
    /// The known pose, descended: its energy, and its RMSD to the pose itself.
    pub reference: Pose,
    /// The candidates in rising energy.
    pub poses: Vec<Pose>,
    /// The least RMSD of all milestones and all that became of them.
    pub nearest: f64,
    /// The energies of all poses that were improved, with their RMSDs.
    pub improved: Vec<Pose>,
    /// The rank by the score among the candidates of the one nearest to the known pose, in percent.
    pub rank: f64,
}

/// A pose by numbers.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// kJ/mol, by exact sums.
    pub energy: f64,
    /// To the descended known pose, Å.
    pub rmsd: f64,
    /// The same after the best superposition, Å.
    pub rotated: f64,
}

/// The problem of a text.
pub fn parse(text: &str) -> Problem {
    let problem = Problem::parse(Path::new("complex.toml"), text);
    problem.unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The problem that `roadmill ligand problem` makes of this table `[docking]`, with its own number of nodes unless one is given.
pub fn usual(table: &str, nodes: Option<u64>) -> Problem {
    let ModelSpec::Docking(spec) = parse(table).model().to_spec() else {
        panic!("docking expected")
    };
    let search = PoseSearch { nodes, ..PoseSearch::default() };
    let problem = poses_of("complex", Path::new(""), &spec, &search);
    problem.unwrap_or_else(|error| panic!("{error}\n{table}"))
}

/// Builds a problem with a seed, and compares.
pub fn run(problem: &Problem, seed: u64) -> Run {
    let problem = problem.clone().with_seed(seed);
    let ModelKind::Docking(docking) = problem.model() else { panic!("docking expected") };
    let docking: Docking = docking.clone();
    let begun = cpu();
    let grown = build(&Arc::new(Setup::new(problem)));
    let built = cpu();
    let symmetries = Symmetries::of(docking.ligand()).expect("ligands have few symmetries");
    let exact = Exact::of(&docking, seed);
    let distance = |a: &[Point], b: &[Point]| symmetries.rmsd(a, b);
    let asked = Asked { ways_out: false, ..Asked::default() };
    let found: Candidates = candidates(&exact, &grown.roadmap, &asked, distance, &Cancel::new());
    let done = cpu();

    let given = docking.given();
    let (reference, energy) = exact.improved(&given, &mut Scratch::new());
    let known = exact.positions(&reference);
    let pose = |positions: &[Point], energy: f64| Pose {
        energy,
        rmsd: symmetries.rmsd(positions, &known),
        rotated: symmetries.rmsd_superposed(positions, &known),
    };
    let improved: Vec<Pose> =
        found.improved.iter().map(|of| pose(&of.positions, of.energy)).collect();
    let poses: Vec<Pose> =
        found.candidates.iter().map(|of| pose(&of.positions, of.energy.sum())).collect();
    let of_nodes =
        grown.roadmap.configs().iter().map(|q| symmetries.rmsd(&exact.positions(q), &known));
    let nearest =
        of_nodes.chain(improved.iter().map(|pose| pose.rmsd)).fold(f64::INFINITY, f64::min);
    let best = (0..poses.len()).min_by(|a, b| poses[*a].rmsd.total_cmp(&poses[*b].rmsd));
    let lower = |best: usize| {
        let score = found.candidates[best].score;
        found.candidates.iter().filter(|of| of.score < score).count()
    };
    Run {
        seconds: [built - begun, done - built],
        nodes: grown.roadmap.configs().len(),
        reference: pose(&exact.positions(&given), energy),
        rank: best.map_or(f64::NAN, |best| 100.0 * lower(best) as f64 / poses.len() as f64),
        poses,
        nearest,
        improved,
    }
}

/// CPU seconds of this process.
fn cpu() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
