use super::extent::Extent;
use super::tree::Near;
use crate::context::Context;
use crate::local::{self, Planner};
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::{Purpose, Seed, Stream};

/// A node set while it grows, from the roadmap as it was at the start of its round.
///
/// What it can grow from are *places*. They are numbered, which breaks ties of distance: first the nodes of that roadmap
/// by their ids, then the roots that are no nodes, then the milestones of the set in their order.
pub(in crate::generator) struct GrowingSet<'a> {
    pub cx: &'a Context,
    pub scratch: &'a mut Scratch,
    /// The roadmap at the start of the round, if it has any nodes.
    pub frozen: Option<&'a Roadmap>,
    /// What has grown.
    pub made: Increment,
    /// How many milestones the set is to have.
    count: usize,
    /// The most by which an extension moves, in the space's metric.
    pub(in crate::generator) step: f64,
    /// How many motions are tried to bend one blocked extension aside.
    pub(super) trials: u32,
    /// Whether the end of a blocked extension is first retracted along the normals of its contacts.
    pub(super) retracts: bool,
    /// Whether blocked extensions slide along what blocks them, in the place of being bent aside.
    slides: bool,
    /// Whether trees are made of the ends and of what grew alone, and not of all that is connected with it.
    pub(super) grown_only: bool,
    /// Which share of what extensions lead toward is drawn from the box around the tree.
    pub(super) nearby: f64,
    /// Where trees begin that begin at no node.
    roots: Vec<&'a [f64]>,
    pub(super) proposing: Stream,
    deciding: Stream,
    /// For what neighbour finders leave to chance.
    pub(super) connecting: Stream,
    attempts: u64,
    /// Attempts since the last milestone.
    tried: u64,
}

/// What a number stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::generator) enum Place {
    /// A node of the roadmap at the start of the round.
    Old(NodeId),
    /// A root that is no node.
    Root(usize),
    /// A milestone of the set, numbered from 0.
    New(NodeId),
}

/// What became of an extension (J. J. Kuffner, S. M. LaValle, *RRT-Connect: an efficient approach to single-query path
/// planning*, ICRA 2000, who name the three outcomes so).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::generator) enum Extension {
    /// The motion is not valid.
    Trapped,
    /// A milestone a step nearer, by its number.
    Advanced(u32),
    /// A milestone where it was to lead, by its number.
    Reached(u32),
}

impl Extension {
    /// The milestone that was made, by its number.
    pub fn milestone(self) -> Option<u32> {
        match self {
            Extension::Trapped => None,
            Extension::Advanced(place) | Extension::Reached(place) => Some(place),
        }
    }
}

impl<'a> GrowingSet<'a> {
    /// A set without milestones, that is to have `count` of them. `attempts` bounds the attempts for each.
    pub fn new(
        cx: &'a Context,
        seed: &Seed,
        scratch: &'a mut Scratch,
        frozen: Option<&'a Roadmap>,
        count: usize,
        (step, attempts): (f64, u64),
    ) -> GrowingSet<'a> {
        GrowingSet {
            cx,
            scratch,
            frozen: frozen.filter(|frozen| !frozen.configs().is_empty()),
            made: Increment::empty(cx.space.len()),
            count,
            step,
            trials: 0,
            retracts: false,
            slides: false,
            grown_only: false,
            nearby: 0.0,
            roots: Vec::new(),
            proposing: seed.stream(Purpose::Sampling),
            deciding: seed.stream(Purpose::Accepting),
            connecting: seed.stream(Purpose::Connecting),
            attempts,
            tried: 0,
        }
    }

    /// The same set, which tries so many motions to bend a blocked extension aside, and draws this share of what extensions
    /// lead toward from the box around the tree.
    pub fn with_bending(self, trials: u32, nearby: f64) -> GrowingSet<'a> {
        GrowingSet { trials, nearby, ..self }
    }

    /// The same set, which first retracts the end of a blocked extension along the normals of its contacts.
    pub fn with_retraction(self) -> GrowingSet<'a> {
        GrowingSet { retracts: true, ..self }
    }

    /// The same set, whose blocked extensions slide.
    pub fn with_sliding(self) -> GrowingSet<'a> {
        GrowingSet { slides: true, ..self }
    }

    /// The same set, whose trees are made of the ends that they grow from and of nodes that grew. What else is connected with these,
    /// sampled nodes say, is no part of them.
    pub fn of_grown_only(self) -> GrowingSet<'a> {
        GrowingSet { grown_only: true, ..self }
    }

    /// Whether blocked extensions slide.
    pub fn slides(&self) -> bool {
        self.slides
    }

    /// The number that the next milestone will have.
    pub fn next_number(&self) -> u32 {
        self.number(NodeId(self.made.configs.len() as u32))
    }

    /// How many milestones it is to have, at least one.
    pub fn count(&self) -> usize {
        self.count.max(1)
    }

    /// Whether it has all its milestones.
    pub fn is_full(&self) -> bool {
        self.made.configs.len() >= self.count
    }

    /// Counts an attempt.
    ///
    /// # Errors
    /// [`GaveUp`] where there were too many since the last milestone.
    pub fn attempt(&mut self) -> Result<(), GaveUp> {
        if self.tried == self.attempts {
            return Err(GaveUp { attempts: self.attempts });
        }
        self.tried += 1;
        Ok(())
    }

    /// A configuration drawn uniformly, valid or not.
    pub fn draw(&mut self) -> Vec<f64> {
        let mut q = vec![0.0; self.cx.space.len()];
        self.cx.space.sample_uniform(&mut self.proposing, &mut q);
        q
    }

    /// A configuration, valid or not, drawn uniformly, or, for the share `nearby` of all draws, from the box around a tree and a
    /// step more.
    pub(super) fn draw_around(&mut self, extent: &Extent) -> Vec<f64> {
        let is_nearby = self.nearby > 0.0 && self.decide(self.nearby);
        let mut q = self.draw();
        if is_nearby {
            extent.shrink_into(&self.cx.space, self.step, &mut q);
        }
        q
    }

    /// Whether what has this probability is to be.
    pub fn decide(&mut self, probability: f64) -> bool {
        self.deciding.unit() < probability
    }

    /// Number of nodes of the roadmap at the start of the round.
    fn old(&self) -> u32 {
        self.frozen.map_or(0, |frozen| frozen.configs().len() as u32)
    }

    /// Whether a node of the roadmap at the start of the round, connected with an end, is a part of its tree.
    pub(super) fn may_extend(&self, node: NodeId) -> bool {
        !self.grown_only || self.frozen.is_some_and(|frozen| frozen.grown().contains(node))
    }

    /// What a number stands for.
    pub fn place(&self, number: u32) -> Place {
        let past_old = number.checked_sub(self.old());
        match past_old.map(|past| (past, past.checked_sub(self.roots.len() as u32))) {
            None => Place::Old(NodeId(number)),
            Some((root, None)) => Place::Root(root as usize),
            Some((_, Some(new))) => Place::New(NodeId(new)),
        }
    }

    /// Whether a place is a node, of the roadmap or of the set.
    pub fn is_node(&self, number: u32) -> bool {
        !matches!(self.place(number), Place::Root(_))
    }

    /// The configuration of a place.
    pub fn config(&self, number: u32) -> &[f64] {
        match self.place(number) {
            Place::Old(node) => {
                self.frozen.expect("there are old nodes").configs().get(node.index())
            }
            Place::Root(root) => self.roots[root],
            Place::New(node) => self.made.configs.get(node.index()),
        }
    }

    /// The number of the set's milestone `node`, which is numbered from 0.
    pub fn number(&self, node: NodeId) -> u32 {
        self.old() + self.roots.len() as u32 + node.0
    }

    /// Takes in a root that is no node. To be called before there are milestones, which it would renumber.
    pub fn add_root(&mut self, q: &'a [f64]) -> u32 {
        assert!(self.made.configs.is_empty(), "roots come first");
        self.roots.push(q);
        self.old() + self.roots.len() as u32 - 1
    }

    /// Makes a valid configuration a milestone.
    pub fn add(&mut self, q: &[f64]) -> u32 {
        let node = NodeId(self.made.configs.len() as u32);
        self.made.configs.push(q);
        self.tried = 0;
        self.number(node)
    }

    /// Goes from a place straight toward a configuration by at most a step: the milestone at the end of a valid motion, with an
    /// edge to where it came from. Of a root that is no node the milestone gets no edge.
    pub(super) fn extend_straight(&mut self, from: Near, toward: &[f64]) -> Extension {
        let start = self.config(from.number);
        if start == toward {
            return Extension::Trapped;
        }
        let is_there = from.distance <= self.step;
        let mut q = toward.to_vec();
        if !is_there {
            self.cx.space.interpolate(start, toward, self.step / from.distance, &mut q);
            // A step can be too short to move anything, or, of rotations, to move anything by what was asked.
            if self.cx.space.canonicalize(&mut q).is_err()
                || self.cx.space.distance(start, &q) < 0.5 * self.step
            {
                return Extension::Trapped;
            }
        }
        if !self.cx.model.is_valid(&q, self.scratch) {
            return Extension::Trapped;
        }
        match self.add_reached_from(from, &q) {
            None => Extension::Trapped,
            Some(number) if is_there => Extension::Reached(number),
            Some(number) => Extension::Advanced(number),
        }
    }

    /// Makes a valid configuration a milestone, with an edge to a place, if the motion from there is valid.
    pub(super) fn add_reached_from(&mut self, from: Near, q: &[f64]) -> Option<u32> {
        let new = NodeId(self.made.configs.len() as u32);
        self.try_edge(from.number, new, q).then(|| self.add(q))
    }

    /// Joins two places, one of which is a milestone of the set, if the motion between them is valid, and says whether it is.
    /// Between a root that is no node and a milestone there is no edge.
    pub fn join(&mut self, one: u32, other: u32) -> bool {
        let (low, high) = (one.min(other), one.max(other));
        let Place::New(new) = self.place(high) else { return false };
        let q = self.made.configs.get(new.index()).to_vec();
        self.try_edge(low, new, &q)
    }

    /// Whether two places are near enough for a motion between them to be one step.
    pub fn is_a_step(&self, near: Near) -> bool {
        near.distance <= self.step
    }

    /// Tries the motion from a place to the milestone `new`, which comes after it and lies at `q`, and makes it an edge.
    fn try_edge(&mut self, from: u32, new: NodeId, q: &[f64]) -> bool {
        let place = self.place(from);
        let low = match place {
            Place::Old(node) | Place::New(node) => node,
            Place::Root(_) => NodeId(0),
        };
        let start = match place {
            Place::Old(node) => {
                self.frozen.expect("there are old nodes").configs().get(node.index())
            }
            Place::Root(root) => self.roots[root],
            Place::New(node) => self.made.configs.get(node.index()),
        };
        let ends = [(low, start), (new, q)];
        let edge = local::edge(self.cx, &[Planner::StraightLine], ends, 1, self.scratch);
        let Some(edge) = edge else { return false };
        match place {
            Place::Old(_) => self.made.root_edges.push(edge),
            Place::New(_) => self.made.edges.push(edge),
            Place::Root(_) => {}
        }
        true
    }
}
