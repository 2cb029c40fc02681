use super::{ATTEMPTS_MAX, Generator, Parent, Reads};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::{Configs, Edge, EdgeCost, Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::scene::LENGTH_MAX;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The roadmap of another run, made use of in this problem: of the same robot among other obstacles, or in the
/// problem relaxed (O. B. Bayazit, D. Xie, N. M. Amato, *Iterative relaxation of constraints: a framework for
/// improving automated motion planning*, IROS 2005, where the roadmap of an easier problem is carried over and
/// what is invalid in it is repaired).
///
/// Set number `i` takes the next `nodes` nodes of the parent's roadmap, in the order of their numbers. A node
/// that is valid here becomes a milestone as it is; for any other, and for every node once the parent's are used
/// up and taken again from the first, a valid configuration is drawn at a distance up to `spread` from it. The
/// parent's edges between nodes of the set are tried again, and those that are valid here become edges.
/// Edges of the parent between nodes of two sets are left to the connection among sets; a strategy whose
/// `nodes` is the number of the parent's nodes tries them all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Reuse {
    /// The run whose roadmap is read.
    pub parent: Parent,
    /// How far from a node of the parent a milestone may lie, in the space's metric.
    pub spread: f64,
    /// The most configurations tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Reuse {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(parent: Parent, spread: f64) -> Reuse {
        Reuse { parent, spread, attempts: default_attempts() }
    }
}

fn default_attempts() -> u64 {
    10_000
}

impl Generator for Reuse {
    fn reads(&self) -> Reads {
        self.parent.ledger.map_or(Reads::Nothing, Reads::Parent)
    }

    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        _frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let (parent, mut moving) = (self.parent.roadmap(), seed.stream(Purpose::Sampling));
        let mut made = Increment::empty(cx.space.len());
        // In 128 bits, since nothing bounds a set's number.
        let taken = u128::from(seed.ordinal().0) * count as u128;
        let nodes = parent.len() as u128;
        if nodes == 0 {
            return Err(GaveUp { attempts: 0 });
        }
        let mut at = vec![0.0; cx.space.len()];
        for index in taken..taken + count as u128 {
            let node = parent.config((index % nodes) as usize);
            at.copy_from_slice(node);
            let mut tried = 0;
            while index >= nodes && tried == 0 || !cx.model.is_valid(&at, scratch) {
                if tried == self.attempts {
                    return Err(GaveUp { attempts: tried });
                }
                tried += 1;
                let length = moving.unit() * self.spread;
                let direction = cx.space.direction(&mut moving);
                cx.space.along(node, &direction, length, &mut at);
            }
            made.configs.push(&at);
        }
        made.edges = self.edges(cx, taken, &made.configs, scratch);
        Ok(made)
    }

    fn parent(&self) -> Option<&Parent> {
        Some(&self.parent)
    }

    fn parent_mut(&mut self) -> Option<&mut Parent> {
        Some(&mut self.parent)
    }

    fn complaint(&self) -> Option<Complaint> {
        if let Some(complaint) = Complaint::of_length("spread", self.spread, LENGTH_MAX) {
            return Some(complaint);
        }
        Complaint::of_attempts(self.attempts, ATTEMPTS_MAX)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.parent.fits(&cx.space)
    }
}

impl Reuse {
    /// The parent's edges that are valid between the milestones `configs`, the first of which stands for node
    /// number `taken` of the parent, counted on past its last node.
    fn edges(
        &self,
        cx: &Context,
        taken: u128,
        configs: &Configs,
        scratch: &mut Scratch,
    ) -> Vec<Edge> {
        let parent = self.parent.roadmap();
        let (nodes, count) = (parent.len() as u128, configs.len() as u128);
        let mut edges = Vec::new();
        // A set larger than the parent's roadmap holds several copies of it.
        for copy in taken / nodes..=(taken + count - 1) / nodes {
            let milestone = |node: NodeId| {
                let index = (copy * nodes + u128::from(node.0)).checked_sub(taken)?;
                (index < count).then_some(index as usize)
            };
            for [low, high] in parent.edges() {
                let (Some(low), Some(high)) = (milestone(*low), milestone(*high)) else { continue };
                let (a, b) = (configs.get(low), configs.get(high));
                let Some(cost) = cx.model.motion(a, b, 1, scratch) else { continue };
                edges.push(Edge {
                    low: NodeId(low as u32),
                    high: NodeId(high as u32),
                    planner: Planner::StraightLine.tag(),
                    cost: EdgeCost::of(cost, cx.space.distance(a, b)),
                });
            }
        }
        edges
    }
}
