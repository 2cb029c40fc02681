use super::set::{GrowingSet, Place};
use crate::numbers::NodeId;
use std::collections::{BTreeMap, BTreeSet};

/// Which nodes are adjacent in the graph that a set grows: the roadmap at the start of the round, and the set.
pub(super) struct Adjacency {
    /// Where the neighbours of each node of that roadmap end in `old`; those of node `i` begin where those of `i` − 1 end.
    ends: Vec<usize>,
    /// The neighbours within that roadmap, node after node.
    old: Vec<u32>,
    /// Per place, by its number, the numbers of the places next to it by edges that the set has.
    new: BTreeMap<u32, Vec<u32>>,
    /// How many of the set's edges and root edges are taken in.
    taken: [usize; 2],
}

impl Adjacency {
    /// That of the roadmap at the start of the round.
    pub fn of(set: &GrowingSet) -> Adjacency {
        let nodes = set.frozen.map_or(0, |frozen| frozen.configs().len());
        let edges = || {
            let edges = set.frozen.into_iter().flat_map(|frozen| frozen.edges().iter());
            edges.flat_map(|edge| [(edge.low, edge.high.0), (edge.high, edge.low.0)])
        };
        let mut ends = vec![0; nodes];
        edges().for_each(|(node, _)| ends[node.index()] += 1);
        let mut sum = 0;
        for end in &mut ends {
            // Where the node's begin, for now: every neighbour that is filled in moves it on.
            sum += std::mem::replace(end, sum);
        }
        let mut old = vec![0; sum];
        for (node, other) in edges() {
            old[ends[node.index()]] = other;
            ends[node.index()] += 1;
        }
        Adjacency { ends, old, new: BTreeMap::new(), taken: [0; 2] }
    }

    /// Takes in a milestone that was grown from a place, and the edges that the set has got by it.
    pub fn grown(&mut self, set: &GrowingSet, from: u32, milestone: u32) {
        let number = |node: NodeId| set.number(node);
        let [edges, root_edges] = self.taken;
        for edge in &set.made.edges[edges..] {
            self.add(number(edge.low), number(edge.high));
        }
        for edge in &set.made.root_edges[root_edges..] {
            self.add(edge.low.0, number(edge.high));
        }
        self.taken = [set.made.edges.len(), set.made.root_edges.len()];
        // The direction is taken though there is no edge.
        if matches!(set.place(from), Place::Root(_)) {
            self.add(from, milestone);
        }
    }

    fn add(&mut self, one: u32, other: u32) {
        self.new.entry(one).or_default().push(other);
        self.new.entry(other).or_default().push(one);
    }

    /// The places next to a place, in no order that matters.
    fn next_to(&self, number: u32) -> impl Iterator<Item = u32> {
        let old = self.ends.get(number as usize).map_or(&[][..], |end| {
            let begin = number.checked_sub(1).map_or(0, |before| self.ends[before as usize]);
            &self.old[begin..*end]
        });
        old.iter().chain(self.new.get(&number).into_iter().flatten()).copied()
    }

    /// The places at most so many edges away from a place, itself among them, in ascending order: a breadth-first search
    /// (S. K. Nath 2013, §4.2).
    pub fn within(&self, number: u32, hops: u32) -> Vec<u32> {
        let (mut found, mut last) = (BTreeSet::from([number]), vec![number]);
        for _ in 0..hops {
            let mut next = Vec::new();
            for place in last {
                next.extend(self.next_to(place).filter(|other| found.insert(*other)));
            }
            if next.is_empty() {
                break;
            }
            last = next;
        }
        found.into_iter().collect()
    }

    /// A configuration in a direction from the place `from` that is dispersed from those already taken: of `trials`
    /// configurations drawn uniformly the one whose direction has the greatest least angle to the directions of the nodes
    /// adjacent to `from`, the first of equals.
    ///
    /// The directions are [displacements](crate::space::Space::displacement), their angles those of the metric. What lies at
    /// the place itself has no direction: such a node does not count, and such a draw is worse than any other. Where no
    /// node counts, the first draw with a direction is taken.
    pub fn dispersed(&self, set: &mut GrowingSet, from: u32, trials: u32) -> Vec<f64> {
        let (space, at) = (&set.cx.space, set.config(from).to_vec());
        let toward = |number| space.displacement(&at, set.config(number));
        let taken: Vec<_> = self.next_to(from).map(toward).collect();
        let (mut best, mut greatest) = (at.clone(), f64::NEG_INFINITY);
        for _ in 0..trials {
            let q = set.draw();
            let direction = space.displacement(&at, &q);
            let angles = taken.iter().filter_map(|other| direction.angle(other));
            let least = angles.fold(f64::INFINITY, f64::min);
            if direction.length() > 0.0 && greatest < least {
                (best, greatest) = (q, least);
            }
        }
        best
    }
}
