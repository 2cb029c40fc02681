//! Paths that keep away from obstacles.

use super::{Attachment, Path, Ways};
use crate::clearance::{self, AlongMotion};
use crate::context::Context;
use crate::model::{Directed, Scratch};
use crate::roadmap::{EdgeCost, Roadmap, Route};

/// Which path of a roadmap is the one that keeps away from obstacles best.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clearest {
    /// The one whose least clearance is highest; of several the shortest. Where an end of the query itself is near an
    /// obstacle, that decides.
    Widest,
    /// The one for which the sum of the edges' lengths, each divided by its mean clearance, is least: a long way far from obstacles for a
    /// short one past them.
    Weighted,
}

/// A path with the clearance along it.
#[derive(Clone, Debug, PartialEq)]
pub struct ClearPath {
    /// The path. Every edge of it has passed the finer check of paths that are given out. Its length is that in the space's metric.
    pub path: Path,
    /// The clearance along it.
    pub clearance: AlongMotion,
}

/// The least mean clearance by which lengths are divided, as a share of the tolerance: edges that touch an obstacle are not
/// dearer than any others.
const FLOOR: f64 = 1e-3;

/// The path from the start to the goal, both valid, that keeps away from obstacles best, through a roadmap whose edges have the
/// clearances `of_edges` ([`clearance::of_edges`]), which are found once for any number of queries. The ends are attached, and edges
/// checked, as by [`solve`](super::solve); the direct motion is an edge beside the others. Clearances are certain to within `tolerance`.
///
/// `None` where there is no path, and of a model without distances to obstacles or without obstacles.
pub fn clearest(
    cx: &Context,
    roadmap: &Roadmap,
    ends: [&[f64]; 2],
    attachment: &Attachment,
    of_edges: &[AlongMotion],
    (by, tolerance): (Clearest, f64),
    scratch: &mut Scratch,
) -> Option<ClearPath> {
    let mut ways = Ways::between(cx, roadmap, ends, attachment, scratch);
    let mut clearances = of_edges.to_vec();
    for edge in ways.edges.get(of_edges.len()..)? {
        let nodes = [ways.config(edge.low), ways.config(edge.high)];
        clearances.push(clearance::of_edge(cx, edge, nodes, tolerance, scratch)?);
    }
    ways.search_by(|index| {
        let AlongMotion { least, mean, length } = clearances[index];
        match by {
            Clearest::Weighted => EdgeCost::Metric(length / mean.max(FLOOR * tolerance)),
            Clearest::Widest => {
                EdgeCost::Directed(Directed { forward: length, backward: length, peak: -least })
            }
        }
    });
    let [from, to] = ways.ends();
    loop {
        let route: Route = match by {
            Clearest::Weighted => ways.graph.shortest(from, to, &ways.failed)?,
            Clearest::Widest => {
                ways.graph.lowest_barrier(from, to, f64::NEG_INFINITY, &ways.failed)?.1
            }
        };
        if !ways.passes(&route, scratch) {
            continue;
        }
        let mut path = ways.path(&route);
        path.length = path.lengths(&cx.space).last().copied().unwrap_or(0.0);
        let clearance = clearance::of_path(cx, &path.configs, tolerance, scratch)?;
        return Some(ClearPath { path, clearance });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::img::{Grown, Setup, build};
    use crate::numbers::NodeId;
    use crate::problem::Problem;
    use petgraph::unionfind::UnionFind;
    use std::sync::Arc;

    /// A wall across a room with a narrow gap, through which the start sees the goal, and a wide one far off.
    const TWO_GAPS: &str = "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [10, 10]\nbounds = \"reference\"\n\
        [robot]\nbodies = [{ shape = { point = {} } }]\n\
        [[obstacles]]\nshape = { box = { size = [1, 4.7, 1] } }\nposition = [5, 3.65, 0]\n\
        [[obstacles]]\nshape = { box = { size = [1, 2.7, 1] } }\nposition = [5, -0.65, 0]\n\
        [query]\nstart = [2, 1]\ngoal = [8, 1]\n\
        [img]\nsets_per_round = 1\n[[strategies]]\nlabel = \"even\"\nnodes = 150\nsampler = { halton = { block = 150 } }\n";

    #[test]
    fn the_widest_way_is_that_of_the_highest_least_clearance_and_the_direct_one_the_shortest() {
        let problem = Problem::parse("gaps.toml".as_ref(), TWO_GAPS);
        let setup = Arc::new(Setup::new(problem.unwrap_or_else(|error| panic!("{error}"))));
        let Grown { roadmap, .. } = build(&setup);
        let (cx, tolerance, scratch) = (&setup.cx, 0.05, &mut Scratch::new());
        let ends: [&[f64]; 2] = [&[2.0, 1.0], &[8.0, 1.0]];
        let attachment = Attachment::default();
        let of_edges = clearance::of_edges(cx, &roadmap, tolerance).expect("obstacles");
        let mut ask = |by| {
            clearest(cx, &roadmap, ends, &attachment, &of_edges, (by, tolerance), scratch).unwrap()
        };
        let (widest, weighted) = (ask(Clearest::Widest), ask(Clearest::Weighted));
        let direct = clearance::of_motion(cx, ends[0], ends[1], tolerance, scratch).unwrap();
        assert!((0.3 - 1e-9..0.36).contains(&direct.least), "{direct:?}");
        assert!(widest.clearance.least > 0.8, "{:?}", widest.clearance);
        assert!(widest.clearance.mean > direct.mean && widest.path.length > direct.length);
        assert_eq!(widest.path.length, widest.clearance.length);
        let cost = |along: &AlongMotion| along.length / along.mean;
        assert!(cost(&weighted.clearance) <= cost(&direct) + 0.1, "{:?}", weighted.clearance);

        // No way has more: without the edges that have no more than the one found, start and goal are apart.
        let ways = Ways::between(cx, &roadmap, ends, &attachment, scratch);
        let mut united = UnionFind::<usize>::new(ways.graph.nodes());
        for (index, edge) in ways.edges.iter().enumerate() {
            let nodes = [ways.config(edge.low), ways.config(edge.high)];
            let found = clearance::of_edge(cx, edge, nodes, tolerance, scratch).unwrap();
            assert!(of_edges.get(index).is_none_or(|known| *known == found));
            if found.least > widest.clearance.least + tolerance {
                united.union(edge.low.index(), edge.high.index());
            }
        }
        let [from, to]: [NodeId; 2] = ways.ends();
        assert!(!united.equiv(from.index(), to.index()));

        // Nodes as well.
        let of_nodes = clearance::of_nodes(cx, &roadmap).expect("obstacles");
        assert_eq!(of_nodes.len(), roadmap.configs().len());
        assert!(of_nodes.iter().all(|distance| *distance > 0.0));
    }
}
