//! The ways on which a ligand leaves a protein.

use super::candidates::Exact;
use crate::model::{Directed, LigandAtProtein, Scratch};
use crate::numbers::NodeId;
use crate::roadmap::{Edge, EdgeCost, Graph, Roadmap};
use crate::structure::Point;
use std::collections::BTreeSet;

/// A ligand is outside if no atom of the protein is so near to one of its atoms, Å.
const OUTSIDE: f64 = 6.0;
/// How far an atom moves at most between two energies along a way out, Å.
const STEP: f64 = 0.25;

/// A way out: the route through the roadmap whose highest energy is lowest (the minimax path; M. Pollack, *The maximum capacity through a
/// network*, Operations Research 8 (1960) 733-736).
#[derive(Clone, Debug, PartialEq)]
pub struct WayOut {
    /// The milestones on the way; at the last one the ligand is outside.
    pub nodes: Vec<NodeId>,
    /// The configurations along the way, the pose first, at most 0.25 Å apart for every atom.
    pub configurations: Vec<Vec<f64>>,
    /// Their energies by exact sums, kJ/mol.
    pub energies: Vec<f64>,
}

impl WayOut {
    /// The highest energy on the way, kJ/mol.
    pub fn barrier(&self) -> f64 {
        self.energies.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// How much higher the barrier is than the pose, kJ/mol.
    pub fn depth(&self) -> f64 {
        self.barrier() - self.energies.first().copied().unwrap_or(0.0)
    }
}

/// The ways out of a roadmap.
pub(super) struct WaysOut<'a> {
    exact: &'a Exact,
    roadmap: &'a Roadmap,
    graph: Graph,
    /// The node after all others, which every milestone outside of the protein leads to.
    outside: NodeId,
}

impl<'a> WaysOut<'a> {
    /// Those of a roadmap.
    pub fn of(exact: &'a Exact, roadmap: &'a Roadmap) -> WaysOut<'a> {
        let outside = NodeId(roadmap.configs().len() as u32);
        let ligand = exact.context().model.ligand();
        let is_outside = |node: &NodeId| {
            ligand.is_some_and(|ligand| {
                let q = roadmap.configs().get(node.index());
                is_outside(ligand, &ligand.positions(q))
            })
        };
        let leads_out = |node: NodeId| {
            let peak = roadmap.values().get(node.index()).copied().unwrap_or(0.0);
            let cost = EdgeCost::Directed(Directed { forward: 0.0, backward: 0.0, peak });
            Edge { low: node, high: outside, planner: 0, cost }
        };
        let mut edges: Vec<Edge> = roadmap.edges().iter().collect();
        edges.extend(roadmap.nodes().filter(is_outside).map(leads_out));
        let graph = Graph::new(outside.index() + 1, &edges);
        WaysOut { exact, roadmap, graph, outside }
    }

    /// The way out from a milestone, beginning at a pose near it; `None` if the roadmap has none.
    pub fn from(&self, node: NodeId, pose: &[f64]) -> Option<WayOut> {
        let energy = self.roadmap.values().get(node.index()).copied()?;
        let found = self.graph.lowest_barrier(node, self.outside, energy, &BTreeSet::new());
        let (_, route) = found?;
        let nodes: Vec<NodeId> =
            route.nodes.into_iter().filter(|node| *node != self.outside).collect();
        let configs = self.roadmap.configs();
        let stations =
            std::iter::once(pose).chain(nodes.iter().map(|node| configs.get(node.index())));
        let stations: Vec<&[f64]> = stations.collect();
        let (cx, scratch) = (self.exact.context(), &mut Scratch::new());
        let ligand = cx.model.ligand()?;
        let mut configurations = vec![pose.to_vec()];
        for pair in stations.windows(2) {
            let steps = ligand.steps(pair[0], pair[1], STEP);
            for step in 1..=steps {
                let mut q = vec![0.0; pose.len()];
                cx.space.interpolate(pair[0], pair[1], step as f64 / steps as f64, &mut q);
                configurations.push(q);
            }
        }
        let energy = |q: &Vec<f64>| cx.model.energy(q, scratch).unwrap_or(f64::INFINITY);
        let energies = configurations.iter().map(energy).collect();
        Some(WayOut { nodes, configurations, energies })
    }
}

/// Whether no atom of the protein is near.
fn is_outside(ligand: &dyn LigandAtProtein, positions: &[Point]) -> bool {
    positions.iter().all(|at| {
        let mut is_near = false;
        ligand.atoms_near(at, OUTSIDE, &mut |atom| {
            is_near |= (atom - at).norm_squared() < OUTSIDE * OUTSIDE;
        });
        !is_near
    })
}
