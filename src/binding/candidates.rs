//! From a roadmap of a ligand at a protein to the poses in which the ligand may bind.
//!
//! Milestones of low energy are improved once more by exact sums, joined to clusters, and the cluster's best pose is a candidate, with
//! its score, and with its way out of the protein (O. B. Bayazit, PhD thesis, 2003, chapter V F 1).

use super::way_out::{WayOut, WaysOut};
use super::{Cluster, clusters};
use crate::cancel::Cancel;
use crate::context::Context;
use crate::descent::{Descent, Gradient};
use crate::model::docking::Docking;
use crate::model::{EnergyParts, Model, Scratch};
use crate::numbers::NodeId;
use crate::roadmap::Roadmap;
use crate::seed::{Purpose, Seed, Stream};
use crate::structure::Point;

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// How many candidates.
    pub count: usize,
    /// How many milestones, those of the lowest energies, are improved once more.
    pub improved: usize,
    /// The radius of a cluster, Å.
    pub radius: f64,
    /// The score of a candidate.
    pub score: Score,
    /// Whether ways out of the protein are looked for.
    pub ways_out: bool,
}

impl Default for Asked {
    fn default() -> Asked {
        let score = Score::default();
        Asked { count: 20, improved: 500, radius: super::RADIUS, score, ways_out: true }
    }
}

/// The score of a pose: the mean energy of configurations near it, none counted above `highest` (Bayazit, eq. 5.3). How many and how near, the
/// thesis does not say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// n, how many configurations are drawn.
    pub samples: usize,
    /// r, how far from the pose at most, in the metric of the space: uniformly distributed in that ball.
    pub distance: f64,
    /// What higher energies count as, kJ/mol.
    pub highest: f64,
}

impl Default for Score {
    fn default() -> Score {
        Score { samples: 100, distance: 0.5, highest: 5_000.0 }
    }
}

/// A pose in which the ligand may bind.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The milestone from which it comes.
    pub node: NodeId,
    /// The configuration.
    pub q: Vec<f64>,
    /// The positions of the ligand's atoms, Å.
    pub positions: Vec<Point>,
    /// Its energy by exact sums, kJ/mol.
    pub energy: EnergyParts,
    /// The mean energy of configurations near it, by exact sums, kJ/mol.
    pub score: f64,
    /// How many of the improved milestones are of its cluster.
    pub population: usize,
    /// The way on which the ligand leaves the protein over the lowest barrier, if the roadmap has one.
    pub way_out: Option<WayOut>,
}

/// A milestone, improved.
#[derive(Clone, Debug, PartialEq)]
pub struct Improved {
    /// The milestone.
    pub node: NodeId,
    /// The configuration that a descent from it leads to.
    pub q: Vec<f64>,
    /// The positions of the ligand's atoms there, Å.
    pub positions: Vec<Point>,
    /// Its energy by exact sums, kJ/mol.
    pub energy: f64,
}

/// The candidates, and what they were chosen from.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidates {
    /// The candidates in rising energy.
    pub candidates: Vec<Candidate>,
    /// All milestones that were improved, in rising energy of the milestones.
    pub improved: Vec<Improved>,
    /// The clusters of what was improved, by places in `improved`.
    pub clusters: Vec<Cluster>,
}

/// A problem of docking by exact sums.
pub struct Exact {
    cx: Context,
}

impl Exact {
    /// The problem of a description, whatever grid that has.
    pub fn of(docking: &Docking, base_seed: u64) -> Exact {
        let model: Box<dyn Model> = docking.exactly();
        let space = model.space().clone();
        let cx = Context { space, model, base_seed, query: None, tries_direct_motion: true };
        Exact { cx }
    }

    /// The problem made ready for work.
    pub fn context(&self) -> &Context {
        &self.cx
    }

    /// The energy of a configuration, part by part.
    pub fn energy(&self, q: &[f64]) -> EnergyParts {
        self.cx.model.ligand().map(|ligand| ligand.exact(q)).unwrap_or_default()
    }

    /// The positions of the ligand's atoms at a configuration.
    pub fn positions(&self, q: &[f64]) -> Vec<Point> {
        self.cx.model.ligand().map(|ligand| ligand.positions(q)).unwrap_or_default()
    }

    /// The configuration to which the energy falls from `q`, and its energy.
    pub fn improved(&self, q: &[f64], scratch: &mut Scratch) -> (Vec<f64>, f64) {
        let mut lowest = q.to_vec();
        // A descent by the gradient draws nothing.
        let mut stream =
            Seed::of_calibration(self.cx.base_seed, "descent").stream(Purpose::Sampling);
        let energy = Gradient::default().descend(&self.cx, &mut stream, &mut lowest, scratch);
        (lowest, energy)
    }

    /// The score of a pose.
    pub fn score(
        &self,
        q: &[f64],
        asked: Score,
        stream: &mut Stream,
        scratch: &mut Scratch,
    ) -> f64 {
        let mut near = vec![0.0; q.len()];
        let mut sum = 0.0;
        for _ in 0..asked.samples {
            self.cx.space.step_within(q, asked.distance, stream, &mut near);
            let energy = self.cx.model.energy(&near, scratch).unwrap_or(f64::INFINITY);
            sum += if energy < asked.highest { energy } else { asked.highest };
        }
        sum / asked.samples.max(1) as f64
    }
}

/// The candidates of a roadmap. `distance` is that of two poses by their atoms' positions, Å, whatever is the same of a symmetric
/// ligand; what is found by then where `cancel` ends the search.
pub fn candidates(
    exact: &Exact,
    roadmap: &Roadmap,
    asked: &Asked,
    distance: impl Fn(&[Point], &[Point]) -> f64,
    cancel: &Cancel,
) -> Candidates {
    let scratch = &mut Scratch::new();
    let energies = roadmap.values();
    let mut order: Vec<NodeId> = roadmap.nodes().collect();
    order.sort_by(|a, b| {
        let energy = |node: &NodeId| energies.get(node.index()).copied().unwrap_or(f64::INFINITY);
        energy(a).total_cmp(&energy(b)).then(a.cmp(b))
    });
    let mut improved = Vec::new();
    for node in order.into_iter().take(asked.improved) {
        if cancel.is_cancelled() {
            break;
        }
        let (q, energy) = exact.improved(roadmap.configs().get(node.index()), scratch);
        improved.push(Improved { node, positions: exact.positions(&q), q, energy });
    }
    let energies: Vec<f64> = improved.iter().map(|of| of.energy).collect();
    let clusters = clusters(&energies, asked.radius, |leader, pose| {
        // What is not compared by then joins nothing: a distance that is no number is within no radius.
        match cancel.is_cancelled() {
            true => f64::NAN,
            false => distance(&improved[leader].positions, &improved[pose].positions),
        }
    });
    let ways = asked.ways_out.then(|| WaysOut::of(exact, roadmap));
    let candidate = |cluster: &Cluster| {
        let of = &improved[cluster.leader];
        let label = format!("score of node {}", of.node);
        let mut stream = Seed::of_calibration(exact.cx.base_seed, &label).stream(Purpose::Sampling);
        Candidate {
            node: of.node,
            q: of.q.clone(),
            positions: of.positions.clone(),
            energy: exact.energy(&of.q),
            score: exact.score(&of.q, asked.score, &mut stream, scratch),
            population: cluster.members.len(),
            way_out: ways.as_ref().and_then(|ways| ways.from(&of.q, of.energy, scratch)),
        }
    };
    let candidates = clusters.iter().take(asked.count).map(candidate).collect();
    Candidates { candidates, improved, clusters }
}
