//! Poses of biotin at streptavidin, from a roadmap in a small box.

use super::{Asked, Exact, candidates};
use crate::cancel::Cancel;
use crate::img::{Grown, Setup, build};
use crate::ligand::Symmetries;
use crate::model::docking::Docking;
use crate::model::{ModelKind, Scratch};
use crate::problem::Problem;
use crate::structure::Point;
use std::path::Path;
use std::sync::{Arc, OnceLock};

const TEXT: &str = r#"
[docking]
protein = { file = "structures/1STP.pdb" }
ligand = { file = "structures/1STP.pdb", residue = "BTN" }
box = { centre = [11.0, 2.0, -14.0], size = [8.0, 8.0, 26.0] }
grid = { spacing = 0.5 }
[limits]
nodes = 150
[img]
sets_per_round = 3
[[strategies]]
label = "hops"
nodes = 20
generator = { hopping = { hopping = { hops = 10 } } }
[[strategies]]
label = "surface"
nodes = 20
generator = { minima = { sampler = { protein-surface = {} } } }
[[strategies]]
label = "uniform"
nodes = 10
sampler = { uniform = {} }
"#;

/// The roadmap, which all tests share.
fn grown() -> &'static (Docking, Grown) {
    static GROWN: OnceLock<(Docking, Grown)> = OnceLock::new();
    GROWN.get_or_init(|| {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/p.toml");
        let problem = Problem::parse(&file, TEXT).unwrap_or_else(|error| panic!("{error}"));
        let ModelKind::Docking(docking) = problem.model() else { panic!("docking expected") };
        (docking.clone(), build(&Arc::new(Setup::new(problem))))
    })
}

/// What is found is in order, apart, told by exact sums, and the same every time.
#[test]
fn candidates_are_low_and_apart() {
    let (docking, grown) = grown();
    let exact = Exact::of(docking, 1);
    let symmetries = Symmetries::of(docking.ligand()).unwrap();
    let distance = |a: &[Point], b: &[Point]| symmetries.rmsd(a, b);
    let asked = Asked { count: 8, improved: 60, ..Asked::default() };
    let find = || candidates(&exact, &grown.roadmap, &asked, distance, &Cancel::new());
    let found = find();
    assert_eq!(found, find());
    assert_eq!((found.candidates.len(), found.improved.len()), (8, 60));
    let energies: Vec<f64> = found.candidates.iter().map(|of| of.energy.sum()).collect();
    assert!(energies.is_sorted(), "{energies:?}");
    for (number, of) in found.candidates.iter().enumerate() {
        assert!((exact.energy(&of.q).sum() - of.energy.sum()).abs() < 1e-9);
        // The score is the mean of energies near a minimum: above it.
        assert!(of.score > of.energy.sum(), "{} at {}", of.score, of.energy.sum());
        let others = &found.candidates[number + 1..];
        assert!(
            others.iter().all(|other| distance(&of.positions, &other.positions) > asked.radius)
        );
    }
    let members: usize = found.clusters.iter().map(|cluster| cluster.members.len()).sum();
    assert_eq!(members, found.improved.len());
    // What was improved is no higher than its milestone, but for what the grid is off.
    for of in &found.improved {
        let before = exact.energy(grown.roadmap.configs().get(of.node.index())).sum();
        assert!(of.energy <= before + 1e-9, "{} from {before}", of.energy);
    }
}

/// A way out begins at the pose, ends where no atom of the protein is near, moves no atom by more than the step, and tells the energies along it.
#[test]
fn ways_lead_out() {
    let (docking, grown) = grown();
    let exact = Exact::of(docking, 1);
    let distance =
        |a: &[Point], b: &[Point]| a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let asked = Asked { count: 20, improved: 60, ..Asked::default() };
    let found = candidates(&exact, &grown.roadmap, &asked, distance, &Cancel::new());
    let ways: Vec<_> =
        found.candidates.iter().filter_map(|of| Some((of, of.way_out.as_ref()?))).collect();
    assert!(!ways.is_empty(), "none of {} poses has a way out", found.candidates.len());
    let protein = exact.context().model().ligand().unwrap().protein().to_vec();
    for (of, way) in ways {
        assert_eq!(way.configurations[0], of.q);
        assert_eq!(way.configurations.len(), way.energies.len());
        let positions: Vec<Vec<Point>> =
            way.configurations.iter().map(|q| exact.positions(q)).collect();
        for two in positions.windows(2) {
            assert!(distance(&two[0], &two[1]) <= 0.25 + 1e-9);
        }
        let end = positions.last().unwrap();
        assert!(end.iter().all(|a| protein.iter().all(|b| (a - b).norm() >= 6.0)));
        for (q, energy) in way.configurations.iter().zip(&way.energies) {
            assert!((exact.energy(q).sum() - energy).abs() < 1e-9);
        }
        assert!(way.barrier() >= of.energy.sum() && way.depth() >= 0.0);
    }
}

/// Every other milestone of `minima` is a minimum below the one before it; those of `hopping` are minima, apart from one another.
#[test]
fn milestones_are_minima() {
    let (_, grown) = grown();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/p.toml");
    let cx = Problem::parse(&file, TEXT).unwrap().context();
    let scratch = &mut Scratch::new();
    let mut slope = vec![0.0; cx.space().cube_dimensions()];
    // The sets come in the order of the strategies: 20 of hops, 20 of the surface, 10 uniform ones.
    let energy = |at: usize| grown.roadmap.values()[at];
    for round in [0, 50, 100] {
        for pair in (round + 20..round + 40).step_by(2) {
            assert!(
                energy(pair + 1) <= energy(pair),
                "{} above {}",
                energy(pair + 1),
                energy(pair)
            );
        }
        for at in round..round + 20 {
            let q = grown.roadmap.configs().get(at);
            assert!(cx.model().is_valid(q, scratch));
            assert_eq!(cx.model().gradient(q, &mut slope, scratch), Some(energy(at)));
        }
        // The five of a chain.
        for chain in (round..round + 20).step_by(5) {
            let of = |at: usize| grown.roadmap.configs().get(at);
            for a in chain..chain + 5 {
                for b in chain..a {
                    assert!(cx.space().distance(of(a), of(b)) >= 1.0);
                }
            }
        }
    }
}
