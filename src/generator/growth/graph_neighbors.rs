use super::directions::Adjacency;
use super::set::GrowingSet;
use super::tree::GrowingTree;
use crate::context::Context;
use crate::finder::{CountVisitor, FinderKind, KNearest, NeighborCount};
use crate::methods::Complaint;
use bincode::{Decode, Encode};
use serde::de::{MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// Which nodes of the graph each new node is tried with: in a problem file `"auto"`, a number, or a table with a neighbour finder
/// and a hop limit.
#[derive(Clone, Debug, Default, PartialEq, Encode, Decode)]
pub enum GraphNeighbors {
    /// The nearest, as many as [`NeighborCount::Auto`] says.
    #[default]
    Auto,
    /// The nearest, as many as said.
    Fixed(u32),
    /// Those that a neighbour finder gives.
    Found(FoundNeighbors),
}

/// Neighbours by a neighbour finder, among all nodes of the graph or only among those a few edges away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct FoundNeighbors {
    /// The neighbour finder.
    #[serde(default = "nearest")]
    pub finder: FinderKind,
    /// How many edges at most a neighbour may be away, in the graph, from the node that the new one was grown from (S. K. Nath 2013, §4.2,
    /// Algorithm 6: h). Any number if none is given.
    #[serde(default)]
    pub hop_limit: Option<u32>,
}

/// The `"auto"` nearest.
fn nearest() -> FinderKind {
    FinderKind::KNearest(KNearest { neighbors: NeighborCount::Auto })
}

impl Default for FoundNeighbors {
    fn default() -> FoundNeighbors {
        FoundNeighbors { finder: nearest(), hop_limit: None }
    }
}

impl From<NeighborCount> for GraphNeighbors {
    fn from(count: NeighborCount) -> GraphNeighbors {
        match count {
            NeighborCount::Auto => GraphNeighbors::Auto,
            NeighborCount::Fixed(count) => GraphNeighbors::Fixed(count),
        }
    }
}

impl Serialize for GraphNeighbors {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            GraphNeighbors::Auto => serializer.serialize_str("auto"),
            GraphNeighbors::Fixed(count) => serializer.serialize_u32(*count),
            GraphNeighbors::Found(found) => found.serialize(serializer),
        }
    }
}

/// By hand, so that what is wrong within the table is reported at its own line.
impl<'de> Deserialize<'de> for GraphNeighbors {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<GraphNeighbors, D::Error> {
        deserializer.deserialize_any(GraphNeighborsVisitor)
    }
}

struct GraphNeighborsVisitor;

/// Reads what is no table.
const COUNT: CountVisitor = CountVisitor { or: ", or a table with finder and hop_limit" };

impl<'de> Visitor<'de> for GraphNeighborsVisitor {
    type Value = GraphNeighbors;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        COUNT.expecting(f)
    }

    fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<GraphNeighbors, E> {
        COUNT.visit_str(word).map(GraphNeighbors::from)
    }

    fn visit_u64<E: serde::de::Error>(self, count: u64) -> Result<GraphNeighbors, E> {
        COUNT.visit_u64(count).map(GraphNeighbors::from)
    }

    fn visit_i64<E: serde::de::Error>(self, count: i64) -> Result<GraphNeighbors, E> {
        COUNT.visit_i64(count).map(GraphNeighbors::from)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<GraphNeighbors, A::Error> {
        FoundNeighbors::deserialize(MapAccessDeserializer::new(map)).map(GraphNeighbors::Found)
    }
}

impl GraphNeighbors {
    /// Whether no node is tried, which makes a tree.
    pub(in crate::generator) fn is_none(&self) -> bool {
        *self == GraphNeighbors::Fixed(0)
    }

    /// What is wrong with the settings, where a graph must have neighbours.
    pub(in crate::generator) fn complaint(&self) -> Option<Complaint> {
        match self {
            GraphNeighbors::Auto => None,
            GraphNeighbors::Fixed(count) => {
                (*count == 0).then(|| Complaint::new("neighbors", "0", "\"auto\" or at least 1"))
            }
            GraphNeighbors::Found(FoundNeighbors { finder, hop_limit }) => {
                let is_still = *hop_limit == Some(0);
                let of_limit = is_still.then(|| Complaint::new("hop_limit", "0", "at least 1"));
                of_limit.or_else(|| finder.method().complaint())
            }
        }
    }

    /// Whether the finder is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    pub(in crate::generator) fn suits(&self, cx: &Context) -> Result<(), String> {
        match self {
            GraphNeighbors::Found(found) => found.finder.method().suits(cx),
            GraphNeighbors::Auto | GraphNeighbors::Fixed(_) => Ok(()),
        }
    }
}

/// [`GraphNeighbors`] made ready for searches.
pub(in crate::generator) struct NeighborSearch {
    finder: FinderKind,
    pub(super) hop_limit: Option<u32>,
}

impl NeighborSearch {
    /// `None` in a tree.
    pub fn of(neighbors: &GraphNeighbors) -> Option<NeighborSearch> {
        let (finder, hop_limit) = match neighbors.clone() {
            GraphNeighbors::Fixed(0) => return None,
            GraphNeighbors::Auto => (nearest(), None),
            GraphNeighbors::Fixed(count) => {
                (FinderKind::KNearest(KNearest { neighbors: count.into() }), None)
            }
            GraphNeighbors::Found(FoundNeighbors { finder, hop_limit }) => (finder, hop_limit),
        };
        Some(NeighborSearch { finder, hop_limit })
    }

    /// The numbers of the nodes near `q`, nearest first, ties by number. `q` is that of a milestone that was grown from the place
    /// `from` and is in neither the tree nor the adjacency yet.
    pub(super) fn near(
        &self,
        set: &mut GrowingSet,
        tree: &GrowingTree,
        adjacency: Option<&Adjacency>,
        from: u32,
        q: &[f64],
    ) -> Vec<u32> {
        let (finder, total) = (self.finder.method(), tree.nodes(set));
        let mut near = match (self.hop_limit, adjacency) {
            (Some(hops), Some(adjacency)) => {
                let mut numbers = adjacency.within(from, hops);
                numbers.retain(|number| set.is_node(*number));
                tree.near_of_few(set, finder, total, q, &numbers)
            }
            _ => tree.near_nodes(set, finder, total, q),
        };
        near.truncate(finder.most(total).unwrap_or(usize::MAX));
        finder.choose(&mut near, total, &mut set.connecting);
        near.into_iter().map(|neighbor| neighbor.id).collect()
    }
}
