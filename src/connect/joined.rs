//! Which components an increment's own edges have joined.

use crate::numbers::NodeId;
use std::collections::BTreeMap;

/// Sets of components, each named by the smallest node id among what it unites: a union-find over names.
#[derive(Default)]
pub(super) struct Joined(BTreeMap<NodeId, NodeId>);

impl Joined {
    /// The name of the set that a component belongs to.
    pub fn root(&mut self, name: NodeId) -> NodeId {
        let mut root = name;
        while let Some(next) = self.0.get(&root) {
            root = *next;
        }
        if root != name {
            self.0.insert(name, root);
        }
        root
    }

    /// Whether two components are joined, directly or by way of others.
    pub fn same(&mut self, [a, b]: [NodeId; 2]) -> bool {
        self.root(a) == self.root(b)
    }

    /// Joins two components.
    pub fn unite(&mut self, [a, b]: [NodeId; 2]) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.0.insert(a.max(b), a.min(b));
        }
    }
}
