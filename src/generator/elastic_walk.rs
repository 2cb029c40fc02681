//! Walks of elastic steps: what the generators have in common that grow a chain's roadmap.

use crate::context::Context;
use crate::local::Planner;
use crate::math;
use crate::methods::Complaint;
use crate::model::{Draw, Scratch};
use crate::numbers::NodeId;
use crate::roadmap::{Edge, EdgeCost, Increment};
use crate::sampler::GaveUp;
use crate::seed::{Purpose, Seed, Stream};
use crate::structure::measure::rmsd;
use std::ops::Range;

/// A walk's present place.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// The node there, if it is one.
    pub node: Node,
    /// The configuration.
    pub q: Vec<f64>,
}

/// The node at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Node {
    /// A node of the roadmap.
    Old(NodeId),
    /// A milestone of this set.
    New(NodeId),
    /// None: the step away from here makes no edge.
    None,
}

/// The walks of a set.
pub(super) struct Walks<'a> {
    pub cx: &'a Context,
    pub scratch: &'a mut Scratch,
    /// Draws steps.
    pub moving: Stream,
    /// Draws where walks begin and which steps are kept.
    pub choosing: Stream,
    /// What the set has so far.
    pub made: Increment,
    /// The milestones that the set is to have.
    pub count: usize,
    /// A step from energy E to E′ > E is kept with the probability e^(−(E′ − E)/kT).
    pub kt: f64,
    /// Steps that may still be tried.
    pub attempts: u64,
}

/// The shortest and the longest step, Å: coordinates of structures are known to the thousandth.
const LENGTH_MIN: f64 = 1e-3;
const LENGTH_MAX: f64 = 10.0;
/// The most steps tried for one milestone. Each takes about a millisecond.
const ATTEMPTS_MAX: u64 = 1_000_000;
const KT_MAX: f64 = 1e9;

/// How strongly residues are drawn toward a configuration, kT/Å². With a tenth of it walks end within 1 Å of their aim, with ten
/// times as much hydrogen bonds break that need not.
const STRENGTH: f64 = 10.0;

/// How much of where a walk is heading is kept from step to step, and the rest of it: the squares add up to 1. With fresh directions
/// in every step a walk would stay about where it began.
const STEADY: f64 = 0.96;
const UNSTEADY: f64 = 0.28;

/// How often a step is made half as long where it is refused.
const HALVINGS: usize = 3;

/// A chain has at least so many residues: two Cα are always as far apart as the peptide between them holds them.
const RESIDUES_MIN: usize = 3;

/// A step toward a configuration that moves less than this share of what is asked has arrived.
const ARRIVED: f64 = 0.1;

impl<'a> Walks<'a> {
    /// A set without milestones yet.
    pub fn new(
        cx: &'a Context,
        seed: &Seed,
        scratch: &'a mut Scratch,
        count: usize,
        (kt, attempts): (f64, u64),
    ) -> Walks<'a> {
        Walks {
            cx,
            scratch,
            moving: seed.stream(Purpose::Sampling),
            choosing: seed.stream(Purpose::Accepting),
            made: Increment::empty(cx.space.len()),
            count,
            kt,
            // A set of many milestones may take as many times more.
            attempts: attempts.saturating_mul(count as u64),
        }
    }

    /// Whether the set has all its milestones.
    pub fn is_full(&self) -> bool {
        self.made.configs.len() >= self.count
    }

    /// Counts a step that is tried.
    ///
    /// # Errors
    /// When none are left.
    pub fn attempt(&mut self, attempts: u64) -> Result<(), GaveUp> {
        self.attempts = self.attempts.checked_sub(1).ok_or(GaveUp { attempts })?;
        Ok(())
    }

    /// Makes a configuration a milestone of the set, without an edge.
    pub fn settle(&mut self, q: &[f64]) -> Place {
        let node = NodeId(self.made.configs.len() as u32);
        self.made.configs.push(q);
        Place { node: Node::New(node), q: q.to_vec() }
    }

    /// A residue range: all, or a window whose length is drawn from an eighth to a half of the chain, in turn by chance.
    pub fn window(&mut self, residues: usize) -> Range<usize> {
        if self.choosing.unit() < 0.5 || residues < 8 {
            return 0..residues;
        }
        let share = 0.125 + 0.375 * self.choosing.unit();
        let len = ((residues as f64 * share) as usize).clamp(1, residues);
        // Windows may stick out at either end, so that the ends are in as many of them as the middle.
        let first = (self.choosing.unit() * (residues + len) as f64) as usize;
        first.saturating_sub(len)..first.clamp(1, residues)
    }

    /// One step of a walk toward a configuration, with these residues drawn, of `length` Å at most: where it leads, which is a
    /// milestone now. `None` where no step is kept.
    pub fn toward(
        &mut self,
        from: &Place,
        (target, residues): (&[f64], Range<usize>),
        length: f64,
    ) -> Option<Place> {
        let elastic = self.cx.model.elastic(&from.q)?;
        let draw = Draw { target, residues, strength: STRENGTH };
        self.halving(from, length, |length| elastic.toward(&draw, length))
    }

    /// One random step of a walk, likewise.
    pub fn random(&mut self, from: &Place, length: f64) -> Option<Place> {
        let elastic = self.cx.model.elastic(&from.q)?;
        let deviates = self.deviates();
        self.halving(from, length, |length| elastic.random(&deviates, length))
    }

    /// Random steps from one place, as many as are asked for or as the set has room for: the first of those that are kept.
    /// The first step is about where the walk is heading, and changes that a little; the others go anywhere.
    pub fn scatter(
        &mut self,
        from: &Place,
        heading: &mut Vec<f64>,
        children: u32,
        length: f64,
    ) -> Option<Place> {
        let elastic = self.cx.model.elastic(&from.q)?;
        let fresh = self.deviates();
        let turned = heading.iter().zip(&fresh).map(|(old, new)| STEADY * old + UNSTEADY * new);
        *heading = turned.collect();
        let mut first = self.halving(from, length, |length| elastic.random(heading, length));
        for _ in 1..children {
            if self.is_full() {
                break;
            }
            let deviates = self.deviates();
            let child = elastic.random(&deviates, length);
            let kept = child.and_then(|child| self.keep(from, &child));
            first = first.or(kept);
        }
        first
    }

    /// Independent normal deviates, one for each degree of freedom.
    pub fn deviates(&mut self) -> Vec<f64> {
        (0..self.cx.space.len()).map(|_| self.moving.normal()).collect()
    }

    /// A step, half as long where it is refused, and so on.
    fn halving(
        &mut self,
        from: &Place,
        length: f64,
        step: impl Fn(f64) -> Option<Vec<f64>>,
    ) -> Option<Place> {
        let mut length = length;
        for _ in 0..=HALVINGS {
            if let Some(next) = step(length)
                && let Some(place) = self.keep(from, &next)
            {
                return Some(place);
            }
            length /= 2.0;
        }
        None
    }

    /// Makes `next` a milestone with an edge from where the walk is, if it is valid, the motion there is, and chance keeps it.
    fn keep(&mut self, from: &Place, next: &[f64]) -> Option<Place> {
        let Walks { cx, scratch, choosing, made, kt, .. } = self;
        // Drawn for every step, so that no verdict shifts the numbers of later ones.
        let drawn = choosing.unit();
        if next == from.q || !cx.model.is_valid(next, scratch) {
            return None;
        }
        let [before, after] = [&from.q[..], next].map(|q| cx.model.energy(q, scratch));
        let climb = after? - before?;
        if climb > 0.0 && drawn >= math::exp(-climb / *kt) {
            return None;
        }
        let high = NodeId(made.configs.len() as u32);
        let edge = |low, scratch: &mut Scratch| {
            let cost = cx.model.motion(&from.q, next, 1, scratch)?;
            let cost = EdgeCost::of(cost, cx.space.distance(&from.q, next));
            Some(Edge { low, high, planner: Planner::StraightLine.tag(), cost })
        };
        match from.node {
            Node::Old(low) => made.root_edges.push(edge(low, scratch)?),
            Node::New(low) => made.edges.push(edge(low, scratch)?),
            Node::None => {}
        }
        made.configs.push(next);
        Some(Place { node: Node::New(high), q: next.to_vec() })
    }

    /// How far apart two configurations are, RMSD of all Cα in Å; infinitely where they have none.
    pub fn apart(&mut self, a: &[f64], b: &[f64]) -> f64 {
        let [a, b] = [a, b].map(|q| self.cx.model.shape(q, self.scratch));
        a.zip(b).map_or(f64::INFINITY, |(a, b)| rmsd(&a, &b))
    }

    /// Whether a step toward a configuration was so short that the walk has arrived.
    pub fn has_arrived(&mut self, before: &Place, after: &Place, length: f64) -> bool {
        self.apart(&before.q, &after.q) < ARRIVED * length
    }

    /// Joins a milestone of this set to a node of the roadmap, if the motion between them is valid.
    pub fn join(&mut self, node: NodeId, there: &[f64], place: &Place) -> bool {
        let Node::New(high) = place.node else { return false };
        let Some(cost) = self.cx.model.motion(there, &place.q, 1, self.scratch) else {
            return false;
        };
        let cost = EdgeCost::of(cost, self.cx.space.distance(there, &place.q));
        let planner = Planner::StraightLine.tag();
        self.made.root_edges.push(Edge { low: node, high, planner, cost });
        true
    }
}

/// The residues of the context's model; `None` where it is no chain, or there is no query.
pub(super) fn residues(cx: &Context) -> Option<usize> {
    let query = cx.query.as_ref()?;
    cx.model.shape(&query.start, &mut Scratch::new()).map(|shape| shape.len())
}

/// Whether the methods that walk elastically are defined for the problem.
pub(super) fn suits(cx: &Context) -> Result<(), String> {
    let Some(query) = &cx.query else {
        return Err("elastic steps between the ends of a query found, but no [query]".to_owned());
    };
    if !query.other_goals.is_empty() {
        return Err("elastic steps found beside several goals; one goal expected".to_owned());
    }
    match residues(cx).filter(|_| cx.model.elastic(&query.start).is_some()) {
        Some(RESIDUES_MIN..) => Ok(()),
        Some(residues) => Err(format!(
            "elastic steps, which move Cα against one another, found, and {residues} residues, whose Cα no torsion moves so; \
             at least {RESIDUES_MIN} expected"
        )),
        None => Err("elastic steps found, a model that is a chain of residues expected".to_owned()),
    }
}

/// What is wrong with a length of steps.
pub(super) fn complaint_of_length(key: &'static str, length: f64) -> Option<Complaint> {
    let fits = (LENGTH_MIN..=LENGTH_MAX).contains(&length);
    (!fits).then(|| Complaint::new(key, format_args!("{length:?}"), "0.001 to 10 Å"))
}

/// What is wrong with settings that several methods have.
pub(super) fn complaint(kt: f64, attempts: u64) -> Option<Complaint> {
    // Written so that NaN fails it.
    if !(kt > 0.0 && kt <= KT_MAX) {
        return Some(Complaint::new("kt", kt, "an energy above 0, at most 1e9"));
    }
    Complaint::of_attempts(attempts, ATTEMPTS_MAX)
}
