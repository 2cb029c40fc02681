use super::{Generator, Parent, Reads};
use crate::cancel::Cancel;
use crate::context::Context;
use crate::digest::Digest;
use crate::finder::{Finder, KNearest};
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::model::{SceneChange, Scratch};
use crate::numbers::NodeId;
use crate::query::{Attachment, attach};
use crate::replan::{Revalidation, retried_until};
use crate::roadmap::{Configs, Edge, Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;

/// What is left of the roadmap of another run, of the same robot among obstacles that have changed since: the first set
/// of a build that [replans](crate::replan).
///
/// Its one set has the nodes and edges of the parent's roadmap that are valid still, in their order, then the edges that
/// obstacles which went stood in the way of. Components that do not contain the start are dropped or kept. How the scene
/// has changed, and by which planner each edge was found, are part of the problem, as the parent's roadmap is.
///
/// No problem file can name the method: the number of its nodes is that of the survivors.
/// [`Problem::replanned`](crate::problem::Problem::replanned) makes the problem.
#[derive(Clone, Debug, PartialEq, Serialize, Encode, Decode)]
pub struct Survivors {
    /// The run whose roadmap is left.
    pub(crate) parent: Parent,
    /// The planners that joined the parent's edges, by their tags, edge by edge.
    #[serde(skip)]
    pub(crate) planners: Arc<Vec<u8>>,
    /// How the scene differs from the parent's.
    #[serde(skip)]
    pub(crate) change: Arc<SceneChange>,
    /// Where components are to begin that are kept; `None` keeps all.
    pub(crate) start: Option<Start>,
    /// With how many nearest nodes each is tried again where obstacles went.
    pub(crate) neighbors: u32,
}

/// Where a component begins: it has a node at a configuration, or the configuration can be attached to one of its nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Encode, Decode)]
pub struct Start {
    /// The configuration.
    pub(crate) at: Vec<f64>,
    /// To how many nearest nodes it may be attached, and by which planners.
    pub(crate) neighbors: u32,
    /// See there.
    pub(crate) planners: Vec<Planner>,
}

/// What became of a roadmap in a changed scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Survived {
    /// What is left of it.
    pub increment: Increment,
    /// How many nodes are valid still.
    pub valid_nodes: usize,
    /// How many edges are.
    pub valid_edges: usize,
    /// For how many nodes and edges boxes did not suffice to say so.
    pub checked: u64,
    /// How many edges were found where obstacles went.
    pub new_edges: usize,
    /// How many nodes were dropped with components without the start.
    pub dropped_nodes: usize,
}

/// A problem file cannot say it.
impl<'de> Deserialize<'de> for Survivors {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Survivors, D::Error> {
        Err(D::Error::custom(
            "`survivors` is what `roadmill replan` begins a run with; a problem file can `reuse` a run",
        ))
    }
}

impl Generator for Survivors {
    fn reads(&self) -> Reads {
        self.parent.ledger.map_or(Reads::Nothing, Reads::Parent)
    }

    /// # Errors
    /// [`GaveUp`] where another number is asked for than there are survivors, or another set than the first.
    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        _frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let is_first = seed.ordinal().0 == 0;
        let made = is_first.then(|| self.survived(cx, scratch).increment);
        made.filter(|made| made.configs.len() == count).ok_or(GaveUp { attempts: 0 })
    }

    fn parent(&self) -> Option<&Parent> {
        Some(&self.parent)
    }

    fn parent_mut(&mut self) -> Option<&mut Parent> {
        Some(&mut self.parent)
    }

    fn complaint(&self) -> Option<Complaint> {
        let roadmap = self.parent.roadmap();
        let (edges, tags) = (roadmap.edges().len(), self.planners.len());
        if edges != tags {
            return Some(Complaint::new("planners", tags, "one for each edge of the parent"));
        }
        if let Some(tag) = self.planners.iter().find(|tag| Planner::from_tag(**tag).is_none()) {
            return Some(Complaint::new("planners", tag, "tags of local planners"));
        }
        if let Err(why) = self.change.sound() {
            return Some(Complaint::new("change", why, "sound obstacles"));
        }
        if let Some(Start { at, neighbors, planners }) = &self.start {
            if at.len() != roadmap.dofs() || !at.iter().all(|value| value.is_finite()) {
                return Some(Complaint::new("start", format!("{at:?}"), "a configuration"));
            }
            if *neighbors == 0 {
                return Some(Complaint::new("start", "0 neighbors", "at least 1"));
            }
            if let Some(complaint) = local::complaint(planners) {
                return Some(complaint);
            }
        }
        KNearest { neighbors: self.neighbors.into() }.complaint()
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.parent.fits(&cx.space)
    }
}

impl Survivors {
    /// The hash of the parent's ledger.
    pub fn ledger(&self) -> Option<Digest> {
        self.parent.ledger
    }

    /// How the scene differs from the parent's.
    pub fn change(&self) -> &SceneChange {
        &self.change
    }

    /// Whether what was taken from the parent, and how the scene differs, is the same in `other`: two that are made of the
    /// same run for the same scene.
    pub fn is_of_same_parent(&self, other: &Survivors) -> bool {
        (&self.parent, &self.planners, &self.change)
            == (&other.parent, &other.planners, &other.change)
    }

    /// What is left of the parent's roadmap in the scene of `cx`.
    pub fn survived(&self, cx: &Context, scratch: &mut Scratch) -> Survived {
        let survived = self.survived_until(cx, &Cancel::new(), scratch);
        survived.expect("nothing ends it before it is done")
    }

    /// [`Survivors::survived`]; `None` where `cancel` ends it before it is done. It is asked between two nodes or edges.
    pub fn survived_until(
        &self,
        cx: &Context,
        cancel: &Cancel,
        scratch: &mut Scratch,
    ) -> Option<Survived> {
        let parent = self.parent.roadmap();
        let mut revalidation = Revalidation::new(cx, &self.change);
        let mut made = Increment::empty(cx.space.len());
        // What each node of the parent is called now.
        let mut names: Vec<Option<NodeId>> = Vec::with_capacity(parent.len());
        for node in 0..parent.len() {
            if cancel.is_cancelled() {
                return None;
            }
            let q = parent.config(node);
            let name = NodeId(made.configs.len() as u32);
            names.push(revalidation.keeps_node(q, scratch).then(|| {
                made.configs.push(q);
                name
            }));
        }
        for ([low, high], tag) in parent.edges().iter().zip(&*self.planners) {
            if cancel.is_cancelled() {
                return None;
            }
            let (Some(low), Some(high)) = (names[low.index()], names[high.index()]) else {
                continue;
            };
            let Some(planner) = Planner::from_tag(*tag) else { continue };
            let ends = (made.configs.get(low.index()), made.configs.get(high.index()));
            if let Some(cost) = revalidation.keeps_motion(planner, ends, 1, scratch) {
                made.edges.push(Edge { low, high, planner: *tag, cost });
            }
        }
        let (valid_nodes, valid_edges) = (made.configs.len(), made.edges.len());
        let checked = revalidation.checked();
        let planners = self.planners_of_edges();
        let graph = (&made.configs, &made.edges[..]);
        let asked = (self.neighbors, &planners[..]);
        let new = retried_until(cx, &self.change, graph, asked, cancel, scratch);
        if cancel.is_cancelled() {
            return None;
        }
        let new_edges = new.len();
        made.edges.extend(new);
        let increment = match &self.start {
            Some(start) => start.reached(cx, made, scratch),
            None => made,
        };
        let dropped_nodes = valid_nodes - increment.configs.len();
        Some(Survived { increment, valid_nodes, valid_edges, checked, new_edges, dropped_nodes })
    }

    /// The planners that joined the parent's edges, in the order of their tags; straight lines where it has none.
    fn planners_of_edges(&self) -> Vec<Planner> {
        let tags: BTreeSet<u8> = self.planners.iter().copied().collect();
        let planners: Vec<Planner> = tags.into_iter().filter_map(Planner::from_tag).collect();
        if planners.is_empty() { vec![Planner::StraightLine] } else { planners }
    }
}

impl Start {
    /// The components of a graph that contain the start.
    fn reached(&self, cx: &Context, made: Increment, scratch: &mut Scratch) -> Increment {
        let mut roadmap = Roadmap::new(&cx.space);
        roadmap.fold_round(&cx.space, [(&made, &[][..])]);
        let attachment = Attachment { neighbors: self.neighbors, planners: self.planners.clone() };
        let id = NodeId(made.configs.len() as u32);
        let attached = attach(cx, &roadmap, &self.at, id, &attachment, scratch);
        let attached = attached.into_iter().map(|edge| edge.low);
        let at_start = roadmap.nodes().filter(|node| made.configs.get(node.index()) == self.at);
        let component = |node: NodeId| roadmap.components().of_node(node).name;
        let reached: BTreeSet<NodeId> = attached.chain(at_start).map(component).collect();
        let mut configs = Configs::new(cx.space.len());
        let names: Vec<Option<NodeId>> = roadmap
            .nodes()
            .map(|node| {
                reached.contains(&component(node)).then(|| {
                    configs.push(made.configs.get(node.index()));
                    NodeId(configs.len() as u32 - 1)
                })
            })
            .collect();
        let renamed = |edge: &Edge| {
            let (low, high) = (names[edge.low.index()]?, names[edge.high.index()]?);
            Some(Edge { low, high, ..*edge })
        };
        Increment { edges: made.edges.iter().filter_map(renamed).collect(), configs, ..made }
    }
}
