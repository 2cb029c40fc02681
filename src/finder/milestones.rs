use crate::numbers::NodeId;
use crate::roadmap::{Component, Components, Configs};

/// The milestones among which a finder looks: the nodes of a graph, or some of them.
#[derive(Clone, Copy, Debug)]
pub struct Milestones<'a> {
    /// Their configurations.
    pub configs: &'a Configs,
    /// The components of the graph over `configs`, which keep its indices.
    pub components: &'a Components,
    /// Only the nodes of this component, if one is given.
    pub component: Option<&'a Component>,
    /// A node that is no neighbour: the one whose neighbours are sought.
    pub but: Option<u32>,
    /// How many milestones there are in all, of which these may be a part: `"auto"` numbers of neighbours follow from it.
    pub total: usize,
}

impl<'a> Milestones<'a> {
    /// All nodes of a graph.
    pub fn all(configs: &'a Configs, components: &'a Components) -> Milestones<'a> {
        let total = components.nodes() as usize;
        Milestones { configs, components, component: None, but: None, total }
    }

    /// The same without one.
    pub fn but(self, node: u32) -> Milestones<'a> {
        Milestones { but: Some(node), ..self }
    }

    /// Whether a node is one of them.
    pub fn has(&self, node: u32) -> bool {
        let is_in = |component: &Component| self.components.same(NodeId(node), component.name);
        self.but != Some(node) && self.component.is_none_or(is_in)
    }

    /// Their ids, of a component in no particular order.
    pub fn ids(&self) -> Box<dyn Iterator<Item = u32> + 'a> {
        let but = self.but;
        match self.component {
            Some(component) => {
                Box::new(component.members.iter().copied().filter(move |id| but != Some(*id)))
            }
            None => Box::new((0..self.components.nodes()).filter(move |id| but != Some(*id))),
        }
    }
}
