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
/// To how many milestones a pose is joined.
const NEIGHBORS: usize = 10;

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
    /// The roadmap's edges, and one from every milestone outside of the protein to [`WaysOut::outside`].
    edges: Vec<Edge>,
    /// The node after all others, to which every milestone outside of the protein leads.
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
        WaysOut { exact, roadmap, edges, outside }
    }

    /// The way out from a pose, which is first joined to the milestones nearest to it, by exact sums; `None` if the roadmap has none.
    pub fn from(&self, pose: &[f64], energy: f64, scratch: &mut Scratch) -> Option<WayOut> {
        let WaysOut { exact, roadmap, outside, .. } = *self;
        let (cx, configs) = (exact.context(), roadmap.configs());
        let start = outside.next();
        let mut edges = self.edges.clone();
        for near in roadmap.k_nearest(&cx.space, pose, NEIGHBORS) {
            let node = NodeId(near.id);
            let cost = cx.model.motion(configs.get(node.index()), pose, 1, scratch);
            edges.extend(cost.map(|cost| Edge {
                low: node,
                high: start,
                planner: 0,
                cost: EdgeCost::of(cost, near.distance),
            }));
        }
        let graph = Graph::new(start.index() + 1, &edges);
        let (_, route) = graph.lowest_barrier(start, outside, energy, &BTreeSet::new())?;
        let is_milestone = |node: &NodeId| *node < outside;
        let nodes: Vec<NodeId> = route.nodes.into_iter().filter(is_milestone).collect();
        let milestones = nodes.iter().map(|node| configs.get(node.index()));
        let stations: Vec<&[f64]> = std::iter::once(pose).chain(milestones).collect();
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
