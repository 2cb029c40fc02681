use super::candidates::CandidatePairs;
use super::{Among, JoinInput, complaint, default_neighbors, default_planners};
use crate::context::Context;
use crate::local::Planner;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Edge;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The pairs of [`NearestNodes`](super::NearestNodes), closest first, but each only while its two
/// components are not joined yet: the fewest edges that connect what can be connected, as Kruskal's
/// algorithm picks them, for TR05-007 §5, *"techniques for connecting more efficiently"*.
///
/// What counts as joined is what this increment's own edges join, directly or by way of others. What other sets
/// of the same round join at the same time is not known here, since a join's inputs are frozen. The
/// roadmap gets no cycles between sets, so paths along it are longer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct UntilJoined {
    /// How many nearest nodes of each new one.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

impl Among for UntilJoined {
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge> {
        let Some(candidates) = CandidatePairs::new(input) else { return Vec::new() };
        let mut pairs = candidates.nearest(cx, self.neighbors);
        pairs.sort_by(|a, b| {
            a.distance.total_cmp(&b.distance).then((a.new, a.old).cmp(&(b.new, b.old)))
        });
        let mut joined = Joined::default();
        // What the edges with which a growing set was made have joined.
        for pair in candidates.linked() {
            let sides = pair.map(|node| joined.root(candidates.component(node)));
            if sides[0] != sides[1] {
                joined.unite(sides);
            }
        }
        let mut edges = Vec::new();
        for pair in pairs {
            let sides = [pair.old, pair.new].map(|node| joined.root(candidates.component(node)));
            if sides[0] == sides[1] {
                continue;
            }
            if let Some(edge) = candidates.connect(cx, &self.planners, pair, scratch) {
                joined.unite(sides);
                edges.push(edge);
            }
        }
        edges
    }

    fn complaint(&self) -> Option<Complaint> {
        complaint(self.neighbors, &self.planners)
    }
}

/// Which components an increment's own edges have joined, by a smaller name each.
#[derive(Default)]
struct Joined(BTreeMap<u32, u32>);

impl Joined {
    fn root(&mut self, name: u32) -> u32 {
        let mut root = name;
        while let Some(next) = self.0.get(&root) {
            root = *next;
        }
        if root != name {
            self.0.insert(name, root);
        }
        root
    }

    fn unite(&mut self, [a, b]: [u32; 2]) {
        self.0.insert(a.max(b), a.min(b));
    }
}
