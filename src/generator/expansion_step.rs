use super::{ATTEMPTS_MAX, Generator, Reads};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::{Scratch, Validity};
use crate::numbers::NodeId;
use crate::roadmap::{Edge, EdgeCost, Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::scene::LENGTH_MAX;
use crate::seed::{Purpose, Seed, Stream};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The expansion step (L. E. Kavraki, P. Švestka, J.-C. Latombe, M. H. Overmars, *Probabilistic roadmaps for
/// path planning in high-dimensional configuration spaces*, 1996, §III-A: *"we select a number of nodes …
/// which are likely to lie in such 'difficult' regions … We then expand these nodes"*).
///
/// A node of the roadmap at the start of the round is chosen with a probability proportional to
/// 1 / (1 + its degree): nodes with few edges lie where connecting is hard. From it a random-bounce walk
/// sets out: in a direction drawn uniformly as far as the motion is valid, then from where it was stopped
/// in a new direction, for `bounces` legs. Every end of a leg becomes a milestone, joined to the one before
/// it, and the first to the chosen node. Another node is then chosen, until the set is full.
///
/// Two things differ from the paper. It weighs a node by how often the local planner failed there; of
/// failures a roadmap here knows nothing, so the degree stands for them. And it keeps the end of a walk
/// alone, with the walk as an edge; here edges are single motions of a local planner, so the turns between
/// are milestones too. Legs are looked at in steps of `step`, and the last step is halved `halvings` times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct ExpansionStep {
    /// Length of a step in the space's metric.
    pub step: f64,
    /// The most steps of a leg.
    #[serde(default = "default_steps")]
    pub steps: u32,
    /// How often the last step of a leg is halved, to come closer to what stopped it.
    #[serde(default = "default_halvings")]
    pub halvings: u32,
    /// Legs of a walk.
    #[serde(default = "default_bounces")]
    pub bounces: u32,
    /// The most legs tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl ExpansionStep {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(step: f64) -> ExpansionStep {
        ExpansionStep {
            step,
            steps: default_steps(),
            halvings: default_halvings(),
            bounces: default_bounces(),
            attempts: default_attempts(),
        }
    }
}

fn default_steps() -> u32 {
    50
}

fn default_halvings() -> u32 {
    4
}

fn default_bounces() -> u32 {
    5
}

fn default_attempts() -> u64 {
    10_000
}

const HALVINGS_MAX: u32 = 30;
const STEPS_MAX: u32 = 1_000_000;

impl Generator for ExpansionStep {
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
        let mut walks = Walks {
            expansion: self,
            cx,
            scratch,
            choosing: seed.stream(Purpose::Accepting),
            moving: seed.stream(Purpose::Sampling),
            made: Increment::empty(cx.space.len()),
        };
        let weights = Weights::of(frozen);
        while walks.made.configs.len() < count {
            let from = frozen.and_then(|frozen| weights.choose(&mut walks.choosing, frozen));
            walks.walk(from, count)?;
        }
        Ok(walks.made)
    }

    fn complaint(&self) -> Option<Complaint> {
        if let Some(complaint) = Complaint::of_length("step", self.step, LENGTH_MAX) {
            return Some(complaint);
        }
        if self.halvings > HALVINGS_MAX {
            return Some(Complaint::new("halvings", self.halvings, "0 to 30"));
        }
        if !(1..=STEPS_MAX).contains(&self.steps) {
            return Some(Complaint::new("steps", self.steps, "1 to 1000000"));
        }
        if self.bounces == 0 {
            return Some(Complaint::new("bounces", "0", "at least 1"));
        }
        Complaint::of_attempts(self.attempts, ATTEMPTS_MAX)
    }
}

/// Running sums of the nodes' weights, by which a node is found for a number drawn.
struct Weights(Vec<f64>);

impl Weights {
    fn of(frozen: Option<&Roadmap>) -> Weights {
        let Some(frozen) = frozen else { return Weights(Vec::new()) };
        let mut degrees = vec![0u32; frozen.configs().len()];
        for edge in frozen.edges().iter() {
            degrees[edge.low.index()] += 1;
            degrees[edge.high.index()] += 1;
        }
        let mut sum = 0.0;
        let sums = degrees.into_iter().map(|degree| {
            sum += 1.0 / (1.0 + f64::from(degree));
            sum
        });
        Weights(sums.collect())
    }

    /// A node and where it is; `None` in a roadmap without nodes.
    fn choose<'a>(&self, stream: &mut Stream, frozen: &'a Roadmap) -> Option<(NodeId, &'a [f64])> {
        let drawn = stream.unit() * self.0.last()?;
        let node = self.0.partition_point(|sum| *sum <= drawn).min(self.0.len() - 1);
        Some((NodeId(node as u32), frozen.configs().get(node)))
    }
}

/// The walks of a set.
struct Walks<'a> {
    expansion: &'a ExpansionStep,
    cx: &'a Context,
    scratch: &'a mut Scratch,
    choosing: Stream,
    moving: Stream,
    made: Increment,
}

/// Where a leg of a walk begins.
#[derive(Clone, Copy)]
enum Start {
    /// At a node that was there before.
    Old(NodeId),
    /// At a milestone of this set.
    New(NodeId),
}

impl Walks<'_> {
    /// One walk from a node, until the set has `count` milestones. In a roadmap without nodes it begins at a
    /// valid configuration drawn uniformly, which becomes a milestone.
    fn walk(&mut self, from: Option<(NodeId, &[f64])>, count: usize) -> Result<(), GaveUp> {
        let (mut start, mut at) = match from {
            Some((node, q)) => (Start::Old(node), q.to_vec()),
            None => {
                let q = self.draw()?;
                let first = self.next_node();
                self.made.configs.push(&q);
                (Start::New(first), q)
            }
        };
        for _ in 0..self.expansion.bounces {
            if self.made.configs.len() == count {
                break;
            }
            let (there, cost) = self.leg(&at)?;
            let (planner, high) = (Planner::StraightLine.tag(), self.next_node());
            self.made.configs.push(&there);
            match start {
                Start::Old(low) => self.made.root_edges.push(Edge { low, high, planner, cost }),
                Start::New(low) => self.made.edges.push(Edge { low, high, planner, cost }),
            }
            (start, at) = (Start::New(high), there);
        }
        Ok(())
    }

    /// The id of the next milestone within the set.
    fn next_node(&self) -> NodeId {
        NodeId(self.made.configs.len() as u32)
    }

    /// A valid configuration drawn uniformly.
    fn draw(&mut self) -> Result<Vec<f64>, GaveUp> {
        let attempts = self.expansion.attempts;
        let mut q = vec![0.0; self.cx.space.len()];
        for _ in 0..attempts {
            self.cx.space.sample_uniform(&mut self.moving, &mut q);
            if self.cx.model.is_valid(&q, self.scratch) {
                return Ok(q);
            }
        }
        Err(GaveUp { attempts })
    }

    /// Goes from `at` in a direction drawn uniformly as far as the way is valid: where that is, and the cost of
    /// the motion. A direction in which the motion is not valid is drawn again.
    fn leg(&mut self, at: &[f64]) -> Result<(Vec<f64>, EdgeCost), GaveUp> {
        let space = &self.cx.space;
        let ExpansionStep { step, steps, halvings, attempts, .. } = *self.expansion;
        let mut there = vec![0.0; space.len()];
        for _ in 0..attempts {
            let direction = space.direction(&mut self.moving);
            let mut is_valid = |length: f64| {
                space.along(at, &direction, length, &mut there);
                self.cx.model.validity(&there, self.scratch) == Validity::Valid
            };
            let free = (1..=steps).take_while(|step_| is_valid(f64::from(*step_) * step)).count();
            let (mut reached, mut stopped) = (free as f64 * step, (free + 1) as f64 * step);
            if free < steps as usize {
                for _ in 0..halvings {
                    let middle = (reached + stopped) / 2.0;
                    if is_valid(middle) { reached = middle } else { stopped = middle }
                }
            }
            if reached == 0.0 {
                continue;
            }
            space.along(at, &direction, reached, &mut there);
            // A step can be too short to move anything.
            if there == at {
                continue;
            }
            // The steps were looked at one by one; the motion is to be valid as every edge is. It follows the
            // shortest way, which is not the one that was walked where an angle turned by more than half a turn.
            if let Some(cost) = self.cx.model.motion(at, &there, 1, self.scratch) {
                let cost = EdgeCost::of(cost, space.distance(at, &there));
                return Ok((there, cost));
            }
        }
        Err(GaveUp { attempts })
    }
}
