/// Which nodes are connected, and nothing else: four bytes per node.
#[derive(Clone, Debug, Default)]
pub(crate) struct Forest {
    /// Per node another of its component, with a lower id but for the lowest one.
    lower: Vec<u32>,
}

impl Forest {
    /// Number of nodes.
    pub fn len(&self) -> u32 {
        self.lower.len() as u32
    }

    /// Appends so many nodes, each on its own.
    pub fn grow(&mut self, nodes: u32) {
        self.lower.extend(self.len()..self.len() + nodes);
    }

    /// Unites the components of two nodes; what their lowest nodes were, the lower one first.
    pub fn unite(&mut self, a: u32, b: u32) -> [u32; 2] {
        let (a, b) = (self.lowest(a), self.lowest(b));
        let (low, high) = (a.min(b), a.max(b));
        self.lower[high as usize] = low;
        [low, high]
    }

    fn lowest(&mut self, mut node: u32) -> u32 {
        while self.lower[node as usize] != node {
            let next = self.lower[node as usize];
            self.lower[node as usize] = self.lower[next as usize];
            node = next;
        }
        node
    }
}
