//! Naming the first thing in which two sets differ, bit by bit.

use roadmill::evaluate::Verdict;
use roadmill::img::Joined;
use roadmill::internal::wire;
use roadmill::model::Asked;
use roadmill::roadmap::{Edge, Increment};
use roadmill::space::Space;

/// The first difference between two increments; each is named as what it is on either side.
pub fn of_increments(space: &Space, left: &Increment, right: &Increment) -> Option<String> {
    let (ours, theirs) = (left.configs.len(), right.configs.len());
    let dofs = space.len().max(1);
    let values = left.configs.values().zip(right.configs.values());
    let differing = values.enumerate().find(|(_, (a, b))| a.to_bits() != b.to_bits());
    if let Some((index, (a, b))) = differing {
        let name = &space.dofs()[index % dofs].name;
        return Some(format!("node {}, {name}: {a:?} and {b:?}", index / dofs));
    }
    if ours != theirs {
        return Some(format!("{ours} and {theirs} nodes"));
    }
    let values = left.values.iter().zip(&right.values);
    let differing = values.enumerate().find(|(_, (a, b))| a.to_bits() != b.to_bits());
    if let Some((index, (a, b))) = differing {
        return Some(format!("value {index} of the nodes: {a:?} and {b:?}"));
    }
    of_edges("edge", &left.edges, &right.edges)
        .or_else(|| of_edges("root edge", &left.root_edges, &right.root_edges))
        .or_else(|| of_counts(left.asked, right.asked))
}

/// The first difference between two joins.
pub fn of_joins(left: &Joined, right: &Joined) -> Option<String> {
    let edges = of_edges("joining edge", &left.edges, &right.edges);
    edges.or_else(|| of_counts(left.asked, right.asked))
}

/// The first difference between the verdicts on a round.
pub fn of_verdicts(left: &[Verdict], right: &[Verdict]) -> Option<String> {
    if left.len() != right.len() {
        return Some(format!("{} and {} verdicts", left.len(), right.len()));
    }
    let differs =
        |(_, (a, b)): &(usize, (&Verdict, &Verdict))| wire::encode(*a) != wire::encode(*b);
    let (index, (a, b)) = left.iter().zip(right).enumerate().find(differs)?;
    let values = format!("values {:?} and {:?}", a.value, b.value);
    let what = if a.value.to_bits() == b.value.to_bits() { ", in its details" } else { "" };
    Some(format!("evaluator {index}: {values}{what}"))
}

fn of_edges(what: &str, left: &[Edge], right: &[Edge]) -> Option<String> {
    let numbers = |edge: &Edge| {
        let peak = edge.cost.directed().map(|directed| directed.peak);
        (edge.cost.forward(), edge.cost.backward(), peak)
    };
    let bits = |edge: &Edge| {
        let (forward, backward, peak) = numbers(edge);
        let costs = (forward.to_bits(), backward.to_bits(), peak.map(f64::to_bits));
        (edge.low, edge.high, edge.planner, costs)
    };
    let text = |edge: &Edge| {
        let Edge { low, high, planner, .. } = edge;
        let weight = match numbers(edge) {
            (weight, _, None) => format!("weight {weight:?}"),
            (there, back, Some(peak)) => format!("weights {there:?}, {back:?} and peak {peak:?}"),
        };
        format!("{low}–{high} of {weight} by planner {planner}")
    };
    let mut pairs = left.iter().zip(right).enumerate();
    if let Some((index, (a, b))) = pairs.find(|(_, (a, b))| bits(a) != bits(b)) {
        return Some(format!("{what} {index}: {} and {}", text(a), text(b)));
    }
    let (ours, theirs) = (left.len(), right.len());
    (ours != theirs).then(|| format!("{ours} and {theirs} {what}s"))
}

fn of_counts(left: Asked, right: Asked) -> Option<String> {
    (left != right).then(|| {
        format!(
            "{} and {} configurations, {} and {} motions were checked",
            left.configurations, right.configurations, left.motions, right.motions
        )
    })
}
