use crate::numbers::NodeId;

/// Which nodes of a graph are connected, in four bytes per node: a union-find forest (R. E. Tarjan 1975).
#[derive(Clone, Debug, Default)]
pub(crate) struct Forest {
    /// Per node its parent: a node of the same component with a lower id, or, for the lowest one, the node itself.
    lower: Vec<u32>,
}

impl Forest {
    /// Number of nodes.
    pub fn len(&self) -> u32 {
        self.lower.len() as u32
    }

    /// Appends that many nodes without edges.
    pub fn grow(&mut self, nodes: u32) {
        self.lower.extend(self.len()..self.len() + nodes);
    }

    /// Unites the components of two nodes. Returns the lowest nodes that the two components had, the lower one first;
    /// they are the same if it was one component already.
    pub fn unite(&mut self, a: NodeId, b: NodeId) -> [NodeId; 2] {
        let (a, b) = (self.lowest(a.0), self.lowest(b.0));
        let (low, high) = (a.min(b), a.max(b));
        self.lower[high as usize] = low;
        [low, high].map(NodeId)
    }

    /// The lowest node of a node's component; halves the path to it on the way.
    fn lowest(&mut self, mut node: u32) -> u32 {
        while self.lower[node as usize] != node {
            let next = self.lower[node as usize];
            self.lower[node as usize] = self.lower[next as usize];
            node = next;
        }
        node
    }
}
