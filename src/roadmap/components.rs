use super::Configs;
use super::centre::CentreSum;
use super::component::Component;
use super::indices::Indices;
use crate::numbers::NodeId;
use crate::shelf::Shelf;
use crate::space::Space;
use std::sync::Arc;

/// The connected components of a graph that only grows.
///
/// Each node knows its component and each component its nodes; when two unite the smaller one's
/// nodes are relabelled, which costs O(log n) per node over any number of unions and leaves
/// look-ups without side effects.
#[derive(Clone, Debug, Default)]
pub struct Components {
    /// Per node, the slot of its component.
    slot_of: Vec<u32>,
    slots: Vec<Option<Component>>,
    /// Slots without a component.
    free: Vec<u32>,
    /// Slots that got a component since the last refresh of the centres, or whose component grew.
    changed: Vec<u32>,
    /// Indices for searches of nodes and components, built when searches first need them.
    pub(super) indices: Indices,
}

impl Components {
    /// The components of the empty graph, whose node index will share its segments on a shelf.
    pub(super) fn with_shelf(shelf: Arc<dyn Shelf>) -> Components {
        Components { indices: Indices::with_shelf(shelf), ..Components::default() }
    }

    /// The components of a graph given whole.
    pub fn of(space: &Space, configs: &Configs, edges: &[super::Edge]) -> Components {
        Components::built(space, configs, configs.iter(), edges.iter().copied())
    }

    /// The components of a graph over `nodes`, which are the first of `configs`.
    pub(super) fn built<'a>(
        space: &Space,
        configs: &Configs,
        nodes: impl Iterator<Item = &'a [f64]>,
        edges: impl Iterator<Item = super::Edge>,
    ) -> Components {
        let mut components = Components::default();
        for (node, q) in nodes.enumerate() {
            let slot = components.put(Component {
                name: NodeId(node as u32),
                members: vec![node as u32],
                centre: Vec::new(),
                sum: CentreSum::of(space, q),
            });
            components.slot_of.push(slot);
        }
        for edge in edges {
            components.unite(edge.low, edge.high);
        }
        components.refresh_centres(space, configs);
        components
    }

    /// Number of components.
    pub fn count(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> u32 {
        self.slot_of.len() as u32
    }

    /// The component of a node.
    pub fn of_node(&self, node: NodeId) -> &Component {
        self.slots[self.slot_of[node.index()] as usize].as_ref().expect("labels are current")
    }

    /// Whether two nodes are connected.
    pub fn same(&self, a: NodeId, b: NodeId) -> bool {
        self.slot_of[a.index()] == self.slot_of[b.index()]
    }

    /// Whether a node, which need not be one of the graph, is in a component.
    pub fn contains(&self, component: &Component, node: NodeId) -> bool {
        node.index() < self.slot_of.len() && self.of_node(node).name == component.name
    }

    /// All components, in an order that depends on nothing but the graph's history.
    pub fn iter(&self) -> impl Iterator<Item = &Component> {
        self.slots.iter().flatten()
    }

    /// The slot of a node's component; valid until the graph next changes.
    pub(super) fn slot_of(&self, node: NodeId) -> u32 {
        self.slot_of[node.index()]
    }

    /// The components by slot.
    pub(super) fn slots(&self) -> &[Option<Component>] {
        &self.slots
    }

    /// Appends the nodes and components of another graph.
    pub(super) fn append(&mut self, other: Components) {
        let first = self.nodes();
        let mut slot_of = Vec::with_capacity(other.slots.len());
        for component in other.slots {
            slot_of.push(component.map_or(u32::MAX, |mut component| {
                component.name = component.name + first;
                component.members.iter_mut().for_each(|node| *node += first);
                self.put(component)
            }));
        }
        self.slot_of.extend(other.slot_of.iter().map(|slot| slot_of[*slot as usize]));
    }

    fn put(&mut self, component: Component) -> u32 {
        let slot = match self.free.pop() {
            Some(slot) => {
                self.slots[slot as usize] = Some(component);
                slot
            }
            None => {
                self.slots.push(Some(component));
                self.slots.len() as u32 - 1
            }
        };
        self.changed.push(slot);
        slot
    }

    /// Unites the components of two nodes.
    pub(super) fn unite(&mut self, a: NodeId, b: NodeId) {
        let (a, b) = (self.slot_of(a), self.slot_of(b));
        if a == b {
            return;
        }
        // Which of two equally large components is kept changes no result, since adding two sums commutes.
        let size = |slot: u32| self.slots[slot as usize].as_ref().map_or(0, |c| c.members.len());
        let (kept, gone) = if size(a) >= size(b) { (a, b) } else { (b, a) };
        let smaller = self.slots[gone as usize].take().expect("labels are current");
        self.free.push(gone);
        for node in &smaller.members {
            self.slot_of[*node as usize] = kept;
        }
        let larger = self.slots[kept as usize].as_mut().expect("labels are current");
        larger.name = larger.name.min(smaller.name);
        larger.members.extend(smaller.members);
        larger.sum.add(&smaller.sum);
        larger.centre.clear();
        self.changed.push(kept);
    }

    /// Brings the centres of changed components up to date.
    pub(super) fn refresh_centres(&mut self, space: &Space, configs: &Configs) {
        let mut changed = std::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        for slot in &changed {
            if let Some(component) = &mut self.slots[*slot as usize]
                && component.centre.is_empty()
            {
                let fallback = configs.get(component.name.index());
                component.centre = component.sum.centre(space, fallback);
            }
        }
        self.indices.centres_changed(&self.slots, &changed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roadmap::Edge;
    use crate::space::{BaseJoint, rigid_space};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn components_agree_with_reachability(
            edges in proptest::collection::vec((0u32..30, 0u32..30), 0..40),
        ) {
            let space = rigid_space(BaseJoint::Translation2d, [0.0; 3], [30.0; 3], 0.0);
            let mut configs = Configs::new(2);
            for i in 0..30 {
                configs.push(&[f64::from(i), 0.0]);
            }
            let edges: Vec<Edge> = edges
                .into_iter()
                .filter(|(a, b)| a < b)
                .map(|(low, high)| Edge::metric(NodeId(low), NodeId(high), 0, 1.0))
                .collect();
            let components = Components::of(&space, &configs, &edges);

            let mut label: Vec<u32> = (0..30).collect();
            for _ in 0..30 {
                for edge in &edges {
                    let least = label[edge.low.index()].min(label[edge.high.index()]);
                    label[edge.low.index()] = least;
                    label[edge.high.index()] = least;
                }
            }
            for node in 0..30u32 {
                let component = components.of_node(NodeId(node));
                prop_assert_eq!(component.name.0, label[node as usize]);
                prop_assert!(component.members.contains(&node));
                let mean = component.members.iter().map(|m| f64::from(*m)).sum::<f64>()
                    / component.members.len() as f64;
                prop_assert!((component.centre[0] - mean).abs() < 1e-9);
            }
            label.sort_unstable();
            label.dedup();
            prop_assert_eq!(components.count(), label.len());
            prop_assert_eq!(components.iter().count(), label.len());
        }
    }
}
