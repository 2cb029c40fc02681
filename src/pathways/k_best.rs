use super::frames::expect_coarse;
use super::{Pathway, Pathways, TooFine, pairs};
use crate::cancel::Cancel;
use crate::context::{Context, Ends};
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::query::{Attachment, Ways};
use crate::roadmap::{Rank, Roadmap, Route, Value};
use std::collections::{BTreeMap, BTreeSet};

/// What is asked for: the best routes without loops, which may be much alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KBest {
    /// How many.
    pub count: usize,
    /// By what they are ranked.
    pub rank: Rank,
    /// How far apart neighbouring frames are at most, see [`Frames`](super::Frames).
    pub spacing: f64,
}

/// The `count` best routes from the start to the goal that visit no node twice, as paths; fewer where there are no more.
///
/// The routes are those of J. Y. Yen, *Finding the k shortest loopless paths in a network*, Management Science 17 (1971) 712,
/// by the directed costs of edges. All routes but the best are divided by where they leave it, and so on with the best of
/// each part: a part is the routes that begin alike and go on to none of some nodes (E. L. Lawler, Management Science 18,
/// 1972, 401), so that none is found twice. By [`Rank::Barrier`] the routes are in the order of their highest peaks, and of
/// their costs where these are equal. Of equally good routes the one whose nodes' ids are lower where they first differ
/// comes first.
///
/// Edges that fail the finer check are left out, and so are routes along which the same configurations stand as along one
/// before, such as those that begin at a node where the start is. The paths are given as the roadmap has them: shortened,
/// many would become the same. Where many nodes stand at the same configuration, so many routes can be the same that fewer paths
/// are found than are asked for: at most 4 routes are looked at for each, and 20 more.
///
/// The search ends when `cancel` says so, once the route that is being looked for is found, with what is found by then
/// ([`Pathways::is_cut`]): the best one in any case, unless it fails the finer check.
///
/// # Errors
/// A path would have too many frames.
pub fn k_best(
    cx: &Context,
    roadmap: &Roadmap,
    ends: &Ends,
    attachment: &Attachment,
    asked: &KBest,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Result<Pathways, TooFine> {
    let configs = [&ends.start[..], &ends.goal];
    expect_coarse(cx, configs, asked.spacing, scratch)?;
    let mut ways = Ways::between(cx, roadmap, configs, attachment, scratch);
    let mut parts = Parts::of(&ways, asked.rank, cancel);
    let connected = !parts.found.is_empty();
    let mut pathways: Vec<Pathway> = Vec::new();
    let most = TRIED_BESIDE + TRIED_FOR_ONE * asked.count;
    while pathways.len() < asked.count && parts.tried < most {
        let Some(route) = parts.next(&mut ways, scratch) else { break };
        let path = ways.path(&route);
        let is_new =
            pathways.iter().all(|known| !known.path.configs.iter().eq(path.configs.iter()));
        if is_new {
            pathways.extend(Pathway::of(cx, path, asked.spacing, scratch)?);
        }
    }
    // The peaks of edges, by which routes were found, are bounds that a finer look may lower.
    pathways.sort_by_key(|pathway| pathway.measured.key(asked.rank));
    let dropped_edges = ways.failed.len() as u64;
    let tried = parts.tried;
    let pairs = pairs(cx, &pathways, cancel);
    let is_cut = cancel.is_cancelled();
    Ok(Pathways { pairs, pathways, connected, tried, dropped_edges, is_cut })
}

/// How many routes are looked at for each path that is asked for, and how many beside.
const TRIED_FOR_ONE: usize = 4;
const TRIED_BESIDE: usize = 20;

/// Routes that begin alike and go on to none of some nodes.
#[derive(Clone, Default)]
struct Part {
    /// How they begin: the nodes after the start, and the edges to them.
    nodes: Vec<NodeId>,
    edges: Vec<u32>,
    /// To which nodes they do not go next.
    closed: BTreeSet<NodeId>,
}

/// A place in the ranking of routes: what the route comes to, then its nodes.
type Place = ([u64; 2], Vec<NodeId>);

/// The best route of each part that has one.
pub(super) struct Parts {
    rank: Rank,
    found: BTreeMap<Place, (Part, Route)>,
    /// How many routes were looked at.
    tried: usize,
    /// Ends the search once a route was looked at.
    cancel: Cancel,
}

impl Parts {
    /// One part: all routes from the start to the goal.
    pub fn of(ways: &Ways, rank: Rank, cancel: &Cancel) -> Parts {
        let cancel = cancel.clone();
        let mut parts = Parts { rank, found: BTreeMap::new(), tried: 0, cancel };
        parts.offer(ways, Part::default());
        parts
    }

    /// The best route that was not given before and whose edges all pass the finer check; none once the search is cancelled,
    /// but for the first.
    pub fn next(&mut self, ways: &mut Ways, scratch: &mut Scratch) -> Option<Route> {
        while self.tried == 0 || !self.cancel.is_cancelled() {
            let (_, (part, route)) = self.found.pop_first()?;
            self.tried += 1;
            let has_failed = route.edges.iter().any(|edge| ways.failed.contains(edge));
            if has_failed || !ways.passes(&route, scratch) {
                self.offer(ways, part);
                continue;
            }
            self.divide(ways, &part, &route);
            return Some(route);
        }
        None
    }

    /// Finds the best route of a part.
    fn offer(&mut self, ways: &Ways, part: Part) {
        let [from, to] = ways.ends();
        let spur = part.nodes.last().copied().unwrap_or(from);
        let mut is_closed: BTreeSet<NodeId> = part.nodes.iter().copied().collect();
        is_closed.insert(from);
        let is_first = |edge: u32| {
            let edge = &ways.edges[edge as usize];
            edge.low == spur || edge.high == spur
        };
        let is_allowed = |node: NodeId, edge: u32| {
            let is_closed_next = part.closed.contains(&node) && is_first(edge);
            !(is_closed_next || is_closed.contains(&node) || ways.failed.contains(&edge))
        };
        let begin = value(ways, from, &part.nodes, &part.edges);
        let rest = match self.rank {
            Rank::Cost => ways.graph.shortest_where(spur, to, is_allowed),
            Rank::Barrier => {
                let found = ways.graph.lowest_barrier_where(spur, to, begin.peak, is_allowed);
                found.map(|(_, route)| route)
            }
        };
        let Some(rest) = rest else { return };
        let mut nodes = vec![from];
        nodes.extend(&part.nodes);
        nodes.extend(&rest.nodes[1..]);
        let edges: Vec<u32> = part.edges.iter().chain(&rest.edges).copied().collect();
        let whole = value(ways, from, &nodes[1..], &edges);
        let place = (whole.key(self.rank), nodes.clone());
        self.found.insert(place, (part, Route { nodes, edges, length: whole.cost }));
    }

    /// Divides what is left of a part without its best route by where routes leave that. Not to the end where the search is
    /// cancelled, after which no route is given any more.
    fn divide(&mut self, ways: &Ways, part: &Part, route: &Route) {
        for kept in part.nodes.len()..route.edges.len() {
            if self.cancel.is_cancelled() {
                break;
            }
            let mut closed = BTreeSet::from([route.nodes[kept + 1]]);
            if kept == part.nodes.len() {
                closed.extend(&part.closed);
            }
            let (nodes, edges) = (route.nodes[1..=kept].to_vec(), route.edges[..kept].to_vec());
            self.offer(ways, Part { nodes, edges, closed });
        }
    }
}

/// What the route from `from` over `nodes` by `edges` comes to.
pub(super) fn value(ways: &Ways, from: NodeId, nodes: &[NodeId], edges: &[u32]) -> Value {
    let (mut whole, mut before) = (Value::NOTHING, from);
    for (node, edge) in nodes.iter().zip(edges) {
        let cost = ways.graph.weight(before, *node, *edge);
        whole = whole.then(Value { peak: ways.graph.peak(*edge), cost });
        before = *node;
    }
    whole
}
