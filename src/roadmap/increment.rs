use super::Configs;
use crate::model::{Asked, Cost, Description, Directed};
use crate::numbers::NodeId;

/// An edge between two milestones that a local planner found valid from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The node with the lower id.
    pub low: NodeId,
    /// The node with the higher id.
    pub high: NodeId,
    /// Tag of the local planner that succeeded.
    pub planner: u8,
    /// What the edge costs.
    pub cost: EdgeCost,
}

/// What an edge costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeCost {
    /// The length of the local planner's motion in the space's metric, the same there and back.
    Metric(f64),
    /// Something that depends on the direction; forward is from the lower node to the higher.
    Directed(Directed),
}

impl EdgeCost {
    /// The cost of a motion of this length in the metric.
    pub fn of(cost: Cost, length: f64) -> EdgeCost {
        match cost {
            Cost::Metric => EdgeCost::Metric(length),
            Cost::Directed(directed) => EdgeCost::Directed(directed),
        }
    }

    /// What the edge costs from its lower node to its higher.
    pub fn forward(&self) -> f64 {
        match self {
            EdgeCost::Metric(length) => *length,
            EdgeCost::Directed(directed) => directed.forward,
        }
    }

    /// What the edge costs from its higher node to its lower.
    pub fn backward(&self) -> f64 {
        match self {
            EdgeCost::Metric(length) => *length,
            EdgeCost::Directed(directed) => directed.backward,
        }
    }

    /// The three numbers of an edge in a model with energies.
    pub fn directed(&self) -> Option<Directed> {
        match self {
            EdgeCost::Metric(_) => None,
            EdgeCost::Directed(directed) => Some(*directed),
        }
    }

    /// Whether the numbers are ones that a search can work with: what decoded bytes must be.
    pub fn is_sound(&self) -> bool {
        match self {
            EdgeCost::Metric(length) => length.is_finite(),
            EdgeCost::Directed(directed) => Cost::Directed(*directed).is_sound(),
        }
    }
}

impl Edge {
    /// An edge whose cost is its length.
    pub fn metric(low: NodeId, high: NodeId, planner: u8, length: f64) -> Edge {
        Edge { low, high, planner, cost: EdgeCost::Metric(length) }
    }

    /// The cost from the lower node to the higher: of most models a length, the same there and back.
    pub fn weight(&self) -> f64 {
        self.cost.forward()
    }

    /// The same edge with both ids raised by `first`.
    pub fn shifted(self, first: u32) -> Edge {
        Edge { low: self.low + first, high: self.high + first, ..self }
    }
}

/// What a model says of all node sets: how many numbers their nodes have, and how their edges cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SetForm {
    /// Values of a configuration.
    pub dofs: usize,
    /// Numbers that the model gives every milestone.
    pub values: usize,
    /// Whether edges have directed costs.
    pub directed: bool,
}

impl SetForm {
    /// That of a model's sets.
    pub fn of(model: &dyn Description) -> SetForm {
        SetForm {
            dofs: model.space().len(),
            values: model.node_values().len(),
            directed: model.has_directed_costs(),
        }
    }

    /// Whether an edge's cost is of the model's kind and one that a search can work with.
    pub fn has_cost(self, edge: &Edge) -> bool {
        edge.cost.directed().is_some() == self.directed && edge.cost.is_sound()
    }
}

/// What one node set adds: milestones and the edges among them, numbered from 0 (TR05-007
/// §3.1: a roadmap increment).
#[derive(Clone, Debug, PartialEq)]
pub struct Increment {
    /// The milestones.
    pub configs: Configs,
    /// Edges among them, in the order in which they were found.
    pub edges: Vec<Edge>,
    /// The validity checks that making the increment took.
    pub asked: Asked,
    /// The numbers that the model gives every milestone, milestone after milestone; see
    /// [`Model::node_values`](crate::model::Model::node_values).
    pub values: Vec<f64>,
    /// Of a set that grew from the roadmap: edges from a node that was there at the start of the round, the
    /// lower id, to one of the milestones, which the higher id numbers from 0.
    pub root_edges: Vec<Edge>,
}

impl Increment {
    /// The increment of nothing.
    pub fn empty(dofs: usize) -> Increment {
        Increment {
            configs: Configs::new(dofs),
            edges: Vec::new(),
            asked: Asked::default(),
            values: Vec::new(),
            root_edges: Vec::new(),
        }
    }

    /// Whether the increment is one that a strategy could have made: what decoded bytes must be. `before` is
    /// the number of nodes at the start of the round.
    pub fn is_sound(&self, form: SetForm, before: u64) -> bool {
        let nodes = self.configs.len() as u64;
        let of_roots =
            |edge: &Edge| u64::from(edge.low.0) < before && u64::from(edge.high.0) < nodes;
        self.configs.is_sound(form.dofs)
            && self.edges.iter().all(|edge| {
                edge.low < edge.high && u64::from(edge.high.0) < nodes && form.has_cost(edge)
            })
            && self.root_edges.iter().all(|edge| of_roots(edge) && form.has_cost(edge))
            && self.values.len() as u64 == nodes * form.values as u64
            && self.values.iter().all(|value| value.is_finite())
    }

    /// The root edges as edges of a roadmap in which the first milestone is called `first`.
    pub fn root_edges_from(&self, first: u32) -> impl Iterator<Item = Edge> {
        self.root_edges.iter().map(move |edge| Edge { high: edge.high + first, ..*edge })
    }
}
