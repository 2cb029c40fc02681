use super::increment::Increment;
use crate::numbers::NodeId;

/// Which nodes are of node sets that grew: whose own edges lead to nodes that were there before. It tells the nodes of trees from those of sets that
/// were sampled, whatever strategies a problem has.
///
/// Sets are told apart and not single nodes. What a set of trees draws where its trees get on no more counts as grown, and so do the roots of local trees; sets of the
/// first round do not, for there was nothing that they could have grown from.
#[derive(Clone, Debug, Default)]
pub struct Grown {
    /// First nodes of stretches of nodes that all grew or all did not, by turns; the first stretch did not grow, and may be empty.
    turns: Vec<u32>,
    /// How many nodes there are.
    nodes: u32,
}

impl Grown {
    /// Takes the next set in.
    pub(super) fn add_set(&mut self, increment: &Increment) {
        if !increment.configs.is_empty() {
            let grew = !increment.root_edges.is_empty();
            if grew != self.ends_with_grown() {
                self.turns.push(self.nodes);
            }
            self.nodes += increment.configs.len() as u32;
        }
    }

    fn ends_with_grown(&self) -> bool {
        self.turns.len() % 2 == 1
    }

    /// Whether a node is of a set that grew.
    pub fn contains(&self, node: NodeId) -> bool {
        self.turns.partition_point(|first| *first <= node.0) % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roadmap::{Edge, EdgeCost};

    #[test]
    fn nodes_of_sets_with_edges_to_what_was_there_have_grown() {
        let mut grown = Grown::default();
        let cost = EdgeCost::Metric(1.0);
        let edge = Edge { low: NodeId(0), high: NodeId(0), planner: 0, cost };
        for (nodes, grew) in [(2, false), (1, true), (0, false), (2, true), (1, false), (1, true)] {
            let mut increment = Increment::empty(1);
            (0..nodes).for_each(|_| increment.configs.push(&[0.0]));
            increment.root_edges.extend(grew.then_some(edge));
            grown.add_set(&increment);
        }
        let found: Vec<u32> = (0..7).filter(|node| grown.contains(NodeId(*node))).collect();
        assert_eq!(found, [2, 3, 4, 6]);
    }
}
