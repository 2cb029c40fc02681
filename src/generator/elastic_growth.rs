use super::elastic_walk::{Node, Place, Walks, complaint, complaint_of_length, residues, suits};
use super::{Generator, Reads};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::{Component, Edge, Graph, Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use crate::structure::measure::CentredPoints;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// Growth of a protein's roadmap by elastic steps, where it is wanted.
///
/// A walk begins at a node of the roadmap as it was at the start of the round, and goes on in steps of an elastic network (see
/// [`Elastic`](crate::model::Elastic)): large parts of the chain move against one another, and what is near stays near.
/// Each step that is valid, joined by a valid motion, and kept by its energy (L. Jaillet, J. Cortés, T. Siméon, *Sampling-based
/// path planning on configuration-space costmaps*, IEEE Trans. Robotics 26, 2010: a transition test) becomes a milestone.
/// `aim` says where walks begin and where they go.
///
/// In an empty roadmap walks begin at the query's ends, which the first set at the frontier makes milestones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct ElasticGrowth {
    /// Where walks begin and where they go.
    #[serde(default)]
    pub aim: GrowthAim,
    /// How far the Cα move in a step, RMSD in Å after superposition: the walks take turns with these.
    #[serde(default = "default_lengths")]
    pub lengths: Vec<f64>,
    /// How many random steps are tried at every place of a walk that goes at random. All that are kept become milestones; the
    /// walk goes on from the first.
    #[serde(default = "default_children")]
    pub children: u32,
    /// The most steps of a walk.
    #[serde(default = "default_steps")]
    pub steps: u32,
    /// A step from energy E to E′ > E is kept with the probability e^(−(E′ − E)/kT), this being kT in the model's unit of energy.
    #[serde(default = "default_kt")]
    pub kt: f64,
    /// The most steps tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

/// Where walks begin and where they go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum GrowthAim {
    /// At the frontier: of pairs of nodes, one joined to the query's start and one to its goal, the nearest of some that are drawn; from
    /// one of the two toward the other. Where start and goal are joined already, pairs are any two nodes.
    #[default]
    Frontier,
    /// Anywhere, at random.
    Anywhere,
    /// At the lowest barrier: at nodes of the route between the ends whose highest energy is least, the oftener the nearer
    /// to its peak, at random. As `anywhere` while there is no route.
    Barrier,
}

const LENGTHS_MAX: usize = 100;
const STEPS_MAX: u32 = 100_000;

/// How many pairs are drawn for one walk, of which the nearest is taken.
const PAIRS: usize = 12;

/// A walk is joined to its target, if that can be, where it is nearer than so many steps.
const NEAR: f64 = 2.0;

/// How many nodes before and after the peak of a route most walks begin at.
const NEAR_PEAK: f64 = 3.0;

impl Default for ElasticGrowth {
    fn default() -> ElasticGrowth {
        ElasticGrowth {
            aim: GrowthAim::default(),
            lengths: default_lengths(),
            children: default_children(),
            steps: default_steps(),
            kt: default_kt(),
            attempts: default_attempts(),
        }
    }
}

fn default_lengths() -> Vec<f64> {
    vec![0.5, 1.0, 3.0]
}

fn default_children() -> u32 {
    4
}

fn default_steps() -> u32 {
    5
}

fn default_kt() -> f64 {
    100.0
}

fn default_attempts() -> u64 {
    1000
}

impl Generator for ElasticGrowth {
    fn reads(&self) -> Reads {
        Reads::Roadmap
    }

    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let (Some(residues), Some(query)) = (residues(cx), &cx.query) else {
            return Err(GaveUp { attempts: 0 });
        };
        // What is refused in a problem file can still come in bytes.
        if self.complaint().is_some() {
            return Err(GaveUp { attempts: 0 });
        }
        let ends = [&query.start[..], &query.goal];
        let mut walks = Walks::new(cx, seed, scratch, count, (self.kt, self.attempts));
        let frozen = frozen.filter(|frozen| !frozen.configs().is_empty());
        let Some(frozen) = frozen else {
            self.begin(&mut walks, seed, ends, residues)?;
            return Ok(walks.made);
        };
        let choice = Choice::of(self.aim, cx, frozen, ends);
        let config = |node: NodeId| frozen.configs().get(node.index());
        for walk in 0usize.. {
            let (from, to) = choice.pair(&mut walks, frozen);
            let place = Place { node: Node::Old(from), q: config(from).to_vec() };
            let toward = to.map(|node| Target { node: Some(node), q: config(node) });
            self.walk(&mut walks, place, toward, residues, walk)?;
            if walks.is_full() {
                break;
            }
        }
        Ok(walks.made)
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.lengths.is_empty() || self.lengths.len() > LENGTHS_MAX {
            let found = format!("{} lengths", self.lengths.len());
            return Some(Complaint::new("lengths", found, "1 to 100"));
        }
        let of_length = |length: &f64| complaint_of_length("lengths", *length);
        if let Some(complaint) = self.lengths.iter().find_map(of_length) {
            return Some(complaint);
        }
        if !(1..=STEPS_MAX).contains(&self.children) {
            return Some(Complaint::new("children", self.children, "1 to 100000"));
        }
        if !(1..=STEPS_MAX).contains(&self.steps) {
            return Some(Complaint::new("steps", self.steps, "1 to 100000"));
        }
        complaint(self.kt, self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        suits(cx)
    }
}

/// What a walk goes toward.
#[derive(Clone, Copy)]
struct Target<'a> {
    /// The node there, if it is one.
    node: Option<NodeId>,
    /// The configuration.
    q: &'a [f64],
}

impl ElasticGrowth {
    /// The walks of a set in an empty roadmap: from the query's ends, in turn.
    ///
    /// The first set at the frontier makes the ends milestones. All walks begin with random steps, so that no two are the same.
    fn begin(
        &self,
        walks: &mut Walks,
        seed: &Seed,
        ends: [&[f64]; 2],
        residues: usize,
    ) -> Result<(), GaveUp> {
        let is_first = seed.ordinal().0 == 0 && self.aim == GrowthAim::Frontier;
        let places = ends.map(|end| match is_first && !walks.is_full() {
            true => walks.settle(end),
            false => Place { node: Node::None, q: end.to_vec() },
        });
        for walk in 0usize.. {
            if walks.is_full() {
                break;
            }
            let [from, to] = [walk % 2, (walk + 1) % 2];
            walks.attempt(self.attempts)?;
            let length = self.lengths[walk % self.lengths.len()];
            let mut heading = walks.deviates();
            let next = walks.scatter(&places[from], &mut heading, self.children, length);
            let Some(place) = next else { continue };
            if self.aim == GrowthAim::Frontier && !walks.is_full() {
                let toward = Some(Target { node: None, q: ends[to] });
                self.walk(walks, place, toward, residues, walk)?;
            } else if !walks.is_full() {
                self.walk(walks, place, None, residues, walk)?;
            }
        }
        Ok(())
    }

    /// One walk, toward a target if there is one, until it has its steps, is joined to the target or as near as it gets, no step is
    /// kept, or the set is full.
    fn walk(
        &self,
        walks: &mut Walks,
        from: Place,
        toward: Option<Target>,
        residues: usize,
        number: usize,
    ) -> Result<(), GaveUp> {
        let length = self.lengths[number % self.lengths.len()];
        match toward {
            Some(target) => self.walk_toward(walks, from, target, residues, length),
            None => self.walk_freely(walks, from, length),
        }
    }

    fn walk_toward(
        &self,
        walks: &mut Walks,
        from: Place,
        Target { node, q }: Target,
        residues: usize,
        length: f64,
    ) -> Result<(), GaveUp> {
        let window = walks.window(residues);
        let mut place = from;
        for _ in 0..self.steps {
            walks.attempt(self.attempts)?;
            let Some(next) = walks.toward(&place, (q, window.clone()), length) else { break };
            let before = std::mem::replace(&mut place, next);
            let is_near = walks.apart(&place.q, q) < NEAR * length;
            let is_joined = is_near && node.is_some_and(|node| walks.join(node, q, &place));
            if is_joined || walks.has_arrived(&before, &place, length) || walks.is_full() {
                break;
            }
        }
        Ok(())
    }

    fn walk_freely(&self, walks: &mut Walks, from: Place, length: f64) -> Result<(), GaveUp> {
        let mut heading = walks.deviates();
        let mut place = from;
        for _ in 0..self.steps {
            walks.attempt(self.attempts)?;
            let next = walks.scatter(&place, &mut heading, self.children, length);
            let Some(next) = next else { break };
            place = next;
            if walks.is_full() {
                break;
            }
        }
        Ok(())
    }
}

/// Where the walks of a set can begin.
enum Choice<'a> {
    /// Between two components, or within one.
    Pairs([&'a Component; 2]),
    Anywhere,
    /// At the nodes of a route, whose peak is near this one of them.
    Route(Vec<NodeId>, usize),
}

impl<'a> Choice<'a> {
    fn of(aim: GrowthAim, cx: &Context, frozen: &'a Roadmap, ends: [&[f64]; 2]) -> Choice<'a> {
        let homes = || ends.map(|end| home(cx, frozen, end));
        match aim {
            GrowthAim::Anywhere => Choice::Anywhere,
            GrowthAim::Frontier => {
                Choice::Pairs(homes().map(|node| frozen.components().of_node(node)))
            }
            GrowthAim::Barrier => {
                let [from, to] = homes();
                let edges: Vec<Edge> = frozen.edges().iter().collect();
                let graph = Graph::new(frozen.configs().len(), &edges);
                let route = graph.lowest_barrier(from, to, f64::NEG_INFINITY, &BTreeSet::new());
                let Some((_, route)) = route else { return Choice::Anywhere };
                let peak = |edge: &u32| {
                    edges[*edge as usize].cost.directed().map_or(0.0, |cost| cost.peak)
                };
                // The first of the highest.
                let highest = route.edges.iter().enumerate().fold(
                    (0, f64::NEG_INFINITY),
                    |best, (at, edge)| {
                        if peak(edge) > best.1 { (at, peak(edge)) } else { best }
                    },
                );
                Choice::Route(route.nodes, highest.0)
            }
        }
    }

    /// Where a walk begins, and toward where it goes.
    fn pair(&self, walks: &mut Walks, frozen: &Roadmap) -> (NodeId, Option<NodeId>) {
        match self {
            Choice::Anywhere => {
                let len = frozen.configs().len();
                (NodeId((walks.choosing.unit() * len as f64) as u32), None)
            }
            Choice::Route(nodes, peak) => {
                let away = walks.choosing.normal() * NEAR_PEAK + 0.5;
                let at = (*peak as f64 + away).clamp(0.0, (nodes.len() - 1) as f64);
                (nodes[at as usize], None)
            }
            Choice::Pairs(components) => {
                let cx = walks.cx;
                let mut draw = |of: &Component| {
                    let at = (walks.choosing.unit() * of.members.len() as f64) as usize;
                    let node = NodeId(of.members[at]);
                    let q = frozen.configs().get(node.index());
                    let shape = cx.model.shape(q, walks.scratch).unwrap_or_default();
                    (node, CentredPoints::new(&shape))
                };
                let mut nearest: Option<(f64, [NodeId; 2])> = None;
                for _ in 0..PAIRS {
                    let [(a, here), (b, there)] = components.map(&mut draw);
                    let distance = here.rmsd(&there);
                    if a != b && nearest.is_none_or(|(least, _)| distance < least) {
                        nearest = Some((distance, [a, b]));
                    }
                }
                match nearest {
                    Some((_, [a, b])) if walks.choosing.unit() < 0.5 => (a, Some(b)),
                    Some((_, [a, b])) => (b, Some(a)),
                    None => (NodeId(components[0].members[0]), None),
                }
            }
        }
    }
}

/// The node that stands for an end of the query: the nearest, ties by id.
fn home(cx: &Context, frozen: &Roadmap, end: &[f64]) -> NodeId {
    let nearest = frozen.k_nearest(&cx.space, end, 1);
    NodeId(nearest.first().map_or(0, |near| near.id))
}
