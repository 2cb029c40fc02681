use super::classes::{EdgeCrossings, Shortest, shortest_of_classes};
use super::frames::expect_coarse;
use super::topology::{PathClass, Topology};
use super::via_nodes::{Tried, ViaNodes};
use super::{Pathway, Pathways, TooFine, pairs};
use crate::cancel::Cancel;
use crate::context::{Context, Ends};
use crate::model::Scratch;
use crate::query::{Attachment, Path, Ways, shorten_within};
use crate::roadmap::{Rank, Roadmap, Route};
use std::collections::BTreeMap;

/// What is asked for: pathways that pass the obstacles differently.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distinct {
    /// How many.
    pub count: usize,
    /// How far apart neighbouring frames are at most, see [`Frames`](super::Frames).
    pub spacing: f64,
    /// In space: how many candidates are shortened and classified. In the plane: how often at most routes are found anew since
    /// an edge has failed the finer check.
    pub tries: usize,
    /// How often a shortcut is tried on each, see [`shorten`](crate::query::shorten).
    pub shortcuts: u32,
}

/// Pathways, each with its class.
#[derive(Clone, Debug)]
pub struct DistinctPathways {
    /// The pathways, the shortest first.
    pub pathways: Pathways,
    /// The class of each; no two are equal.
    pub classes: Vec<PathClass>,
}

/// The shortest pathway of each class of paths from the start to the goal ([`Topology`]), as many classes as are asked for where
/// that many are found.
///
/// - *In the plane* the classes are those whose shortest routes through the roadmap are the shortest, and all of these: also ones that
///   wind around an obstacle.
/// - *In space* the classes are those that come up among routes over single nodes, the best first, which do not share more than
///   80 % of their length with one before; of each class the shortest that was found.
///
/// Every edge of a route passes the finer check of paths that are given out; one that fails is left out, and routes are found
/// anew. Then paths are shortened: as far as it can be, and within an eighth of their length. A path that has thereby left its class stands for
/// the class that it has come to, if it is the shortest there, but in the plane for none. Costs are lengths, or whatever
/// the model's motions cost.
///
/// The search ends when `cancel` says so, with what is found by then ([`Pathways::is_cut`]): the classes of routes that were looked at
/// closely. If there is none yet, the first route that has a class is given as it is.
///
/// # Errors
/// A path would have too many frames.
#[allow(clippy::too_many_arguments, reason = "a search is told where, between what and for what")]
pub fn distinct(
    cx: &Context,
    roadmap: &Roadmap,
    ends: &Ends,
    attachment: &Attachment,
    topology: &Topology,
    asked: &Distinct,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Result<DistinctPathways, TooFine> {
    let configs = [&ends.start[..], &ends.goal];
    expect_coarse(cx, configs, asked.spacing, scratch)?;
    let mut ways = Ways::between(cx, roadmap, configs, attachment, scratch);
    let [from, to] = ways.ends();
    let connected = ways.graph.shortest_where(from, to, |_, _| true).is_some();
    let routes = match topology.punctures() {
        Some(punctures) => {
            let crossings = EdgeCrossings::of(&ways, punctures, |q| topology.point(q));
            in_plane(&mut ways, &crossings, asked, cancel, scratch)
        }
        None => in_space(&mut ways, asked, cancel, scratch),
    };
    let mut best: BTreeMap<PathClass, Pathway> = BTreeMap::new();
    let tried = routes.len();
    for route in &routes {
        // To tell a route's class may take long.
        if cancel.is_cancelled() && !best.is_empty() {
            break;
        }
        let path = ways.path(route);
        let mut of_route = None;
        for form in forms(cx, path, asked, cancel, scratch) {
            let Some(pathway) = Pathway::of(cx, form, asked.spacing, scratch)? else { continue };
            let class = topology.class(cx, &pathway.path, &pathway.frames, scratch);
            let own = of_route.get_or_insert_with(|| class.clone());
            if topology.punctures().is_some() && class != *own {
                continue;
            }
            let key = |pathway: &Pathway| pathway.measured.key(Rank::Cost);
            if best.get(&class).is_none_or(|known| key(&pathway) < key(known)) {
                best.insert(class, pathway);
            }
        }
    }
    let mut found: Vec<(PathClass, Pathway)> = best.into_iter().collect();
    // Stable: ties in the order of the classes.
    found.sort_by_key(|(_, pathway)| pathway.measured.key(Rank::Cost));
    found.truncate(asked.count);
    let (classes, pathways): (Vec<PathClass>, Vec<Pathway>) = found.into_iter().unzip();
    let (dropped_edges, is_cut) = (ways.failed.len() as u64, cancel.is_cancelled());
    let pairs = pairs(cx, &pathways, cancel);
    let pathways = Pathways { pathways, pairs, connected, tried, dropped_edges, is_cut };
    Ok(DistinctPathways { pathways, classes })
}

/// A path as it is, and shortened in two ways.
fn forms(
    cx: &Context,
    path: Path,
    asked: &Distinct,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Vec<Path> {
    let mut forms = vec![path];
    for reach in [LOCAL, 1.0] {
        if !cancel.is_cancelled() {
            forms.push(shorten_within(cx, &forms[0], asked.shortcuts, reach, cancel, scratch));
        }
    }
    forms
}

/// How much of a path's length a shortcut replaces at most where the path is to stay where it is.
const LOCAL: f64 = 0.125;

/// The shortest routes of the first classes, all of whose edges pass the finer check, or as far as that is found out.
fn in_plane(
    ways: &mut Ways,
    crossings: &EdgeCrossings,
    asked: &Distinct,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Vec<Route> {
    let mut passed = Vec::new();
    for _ in 0..=asked.tries {
        let Shortest { routes, has_failed } =
            shortest_of_classes(ways, crossings, asked.count, cancel, scratch);
        // A search that is cut may come to fewer than the one before, whose routes have all passed.
        if !cancel.is_cancelled() || routes.len() > passed.len() {
            passed = routes;
        }
        if !has_failed || cancel.is_cancelled() {
            break;
        }
    }
    passed
}

/// The best routes over single nodes that pass the finer check.
fn in_space(
    ways: &mut Ways,
    asked: &Distinct,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Vec<Route> {
    let (mut routes, mut tried) = (Vec::new(), Tried::default());
    let mut candidates = ViaNodes::of(ways, Rank::Cost);
    let mut failures = 0;
    while routes.len() < asked.tries && failures <= asked.tries && !cancel.is_cancelled() {
        let Some(route) = candidates.next(ways, &tried, cancel) else { break };
        if ways.passes(&route, scratch) {
            tried.add(&route);
            routes.push(route);
        } else {
            failures += 1;
            candidates = ViaNodes::of(ways, Rank::Cost);
        }
    }
    routes
}
