use super::frames::expect_coarse;
use super::k_best::value;
use super::via_nodes::{Tried, ViaNodes};
use super::{Frames, Pathway, Pathways, TooFine, pairs};
use crate::cancel::Cancel;
use crate::context::{Context, Ends};
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::query::{Attachment, Path, Ways, shorten_within};
use crate::roadmap::{Rank, Roadmap, Route};
use rayon::prelude::*;

/// How far apart pathways of molecules are at least, Å of Cα RMSD, unless told otherwise.
pub const DISTANCE: f64 = 1.5;

/// So many penalised routes are found before what becomes of them is looked at.
const BATCH: usize = 8;

/// How much of a path's length a shortcut replaces at most where a candidate is to stay where it is.
const LOCAL: f64 = 0.125;

/// More edges that fail the finer check are not left out one after the other; the search then ends with what was found.
const FAILED_MAX: usize = 1000;

/// What is asked for: pathways that are at least a distance apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dissimilar {
    /// How many.
    pub count: usize,
    /// By what they are ranked.
    pub rank: Rank,
    /// The least discrete Fréchet distance of any two, Å of Cα RMSD or in the space's metric.
    pub distance: f64,
    /// How far apart neighbouring frames are at most, see [`Frames`](super::Frames).
    pub spacing: f64,
    /// How many candidates are shortened and measured, first of those over single nodes, then, if there are still too few
    /// pathways, of penalised searches: at most so many of either.
    pub tries: usize,
    /// How often a shortcut is tried on each, see [`shorten`](crate::query::shorten).
    pub shortcuts: u32,
}

/// Pathways from the start to the goal each two of which are at least a distance apart, as many as are asked for where that
/// many are found.
///
/// - *Candidates* are routes over single nodes, the best first, which do not share more than 80 % of their length with one
///   before. Where these do not suffice, penalised searches add others: the shortest route when every edge costs more by how
///   many candidates go along it, both as a multiple of its cost and by the mean cost of the edges of the best route.
/// - Every edge of a candidate passes the finer check of paths that are given out; one that fails is left out, and routes are
///   found anew. Then the candidate is shortened in two ways, neither of which raises cost or highest energy: as far as it can be
///   ([`shorten`](crate::query::shorten)), which draws paths toward one another where little is between them, and within an eighth of its length
///   ([`shorten_within`]), which leaves it where it is. As it was it is a pathway, too.
/// - While there are too few pathways, the best routes are taken over nodes that are at least `distance` from all that is accepted so
///   far: whatever goes there is as far from these.
/// - The shortened candidates are *ranked* by what they then come to, ties by the order in which they were found. The best is
///   accepted, and then each whose frames have a discrete Fréchet distance of at least `distance` from those of all that
///   were accepted before: the distance is that of what is given out.
///
/// The work is bounded by `tries`, for each of the three kinds of candidates. Candidates are shortened in several threads; the outcome does not depend on how many.
///
/// The search ends when `cancel` says so, once the route or the shortcut that is being looked at is done, with what is found by then
/// ([`Pathways::is_cut`]): candidates as far as they are shortened, and the best one in any case if it is known. Only then does the
/// outcome depend on time.
///
/// # Errors
/// A path would have too many frames.
pub fn dissimilar(
    cx: &Context,
    roadmap: &Roadmap,
    ends: &Ends,
    attachment: &Attachment,
    asked: &Dissimilar,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Result<Pathways, TooFine> {
    let configs = [&ends.start[..], &ends.goal];
    let ways = Ways::between(cx, roadmap, configs, attachment, scratch);
    search(ways, configs, asked, Forms::Shortened, cancel, scratch)
}

/// [`dissimilar`] with pathways as the roadmap has them: each motion is that of one of its edges, or attaches an end to it.
/// `asked.shortcuts` does not count.
///
/// # Errors
/// As [`dissimilar`].
pub fn dissimilar_unshortened(
    cx: &Context,
    roadmap: &Roadmap,
    ends: &Ends,
    attachment: &Attachment,
    asked: &Dissimilar,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Result<Pathways, TooFine> {
    let configs = [&ends.start[..], &ends.goal];
    let ways = Ways::between(cx, roadmap, configs, attachment, scratch);
    search(ways, configs, asked, Forms::AsTheyAre, cancel, scratch)
}

/// What becomes of a candidate.
#[derive(Clone, Copy, PartialEq)]
enum Forms {
    /// It is shortened in two ways, and as it is, too.
    Shortened,
    /// It is as it is.
    AsTheyAre,
}

fn search(
    mut ways: Ways,
    configs: [&[f64]; 2],
    asked: &Dissimilar,
    form: Forms,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Result<Pathways, TooFine> {
    let cx = ways.cx;
    expect_coarse(cx, configs, asked.spacing, scratch)?;
    let mut tried = Tried::default();
    let routes = over_nodes(&mut ways, &mut tried, asked, cancel, scratch);
    let [from, to] = ways.ends();
    let connected = ways.graph.shortest_where(from, to, |_, _| true).is_some();
    let mut found = shortened(&ways, &routes, (asked, form), cancel)?;
    let mut chosen = choose(cx, &mut found, asked);
    let (mut looked_at, mut far, mut penalised) = (routes.len(), 0, 0);
    while chosen.len() < asked.count && far < asked.tries && !cancel.is_cancelled() {
        let accepted: Vec<&Frames> = chosen.iter().map(|index| &found[*index].frames).collect();
        let route = far_route(&mut ways, &mut tried, &accepted, asked, cancel, scratch);
        let Some(route) = route else { break };
        far += 1;
        looked_at += 1;
        found.extend(shortened(&ways, &[route], (asked, form), cancel)?);
        chosen = choose(cx, &mut found, asked);
    }
    let scale = routes.first().map_or(0.0, |best| best.length / best.edges.len().max(1) as f64);
    while chosen.len() < asked.count
        && penalised < asked.tries
        && !routes.is_empty()
        && !cancel.is_cancelled()
    {
        let most = BATCH.min(asked.tries - penalised);
        let more = penalised_routes(&mut ways, &mut tried, (scale, most), cancel, scratch);
        if more.is_empty() {
            break;
        }
        penalised += more.len();
        looked_at += more.len();
        found.extend(shortened(&ways, &more, (asked, form), cancel)?);
        chosen = choose(cx, &mut found, asked);
    }
    let is_cut = cancel.is_cancelled();
    let pathways: Vec<Pathway> = chosen.into_iter().map(|index| found[index].clone()).collect();
    let dropped_edges = ways.failed.len() as u64;
    let pairs = pairs(cx, &pathways, cancel);
    Ok(Pathways { pairs, pathways, connected, tried: looked_at, dropped_edges, is_cut })
}

/// The best routes over single nodes that pass the finer check.
fn over_nodes(
    ways: &mut Ways,
    tried: &mut Tried,
    asked: &Dissimilar,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Vec<Route> {
    let mut routes = Vec::new();
    let mut candidates = ViaNodes::of(ways, asked.rank);
    while routes.len() < asked.tries && ways.failed.len() <= FAILED_MAX && !cancel.is_cancelled() {
        let Some(route) = candidates.next(ways, tried, cancel) else { break };
        if ways.passes(&route, scratch) {
            tried.add(&route);
            routes.push(route);
        } else {
            candidates = ViaNodes::of(ways, asked.rank);
        }
    }
    routes
}

/// The best route that passes the finer check over a node that is at least the distance asked for from all frames of the
/// pathways that are accepted.
fn far_route(
    ways: &mut Ways,
    tried: &mut Tried,
    accepted: &[&Frames],
    asked: &Dissimilar,
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Option<Route> {
    let [from, to] = ways.ends();
    let mut candidates = ViaNodes::of(ways, asked.rank);
    while ways.failed.len() <= FAILED_MAX && !cancel.is_cancelled() {
        let is_far = |node: NodeId| {
            let q = ways.config(node);
            let is_far = |of: &&Frames| of.apart(ways.cx, q, scratch) >= asked.distance;
            node != from && node != to && accepted.iter().all(is_far)
        };
        let route = candidates.next_over(ways, tried, cancel, is_far)?;
        tried.add(&route);
        if ways.passes(&route, scratch) {
            return Some(route);
        }
        candidates = ViaNodes::of(ways, asked.rank);
    }
    None
}

/// At most `most` routes that avoid the edges of those that were tried as far as that costs little. `scale` is what an edge
/// usually costs.
fn penalised_routes(
    ways: &mut Ways,
    tried: &mut Tried,
    (scale, most): (f64, usize),
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Vec<Route> {
    let ([from, to], mut routes) = (ways.ends(), Vec::new());
    while routes.len() < most && ways.failed.len() <= FAILED_MAX && !cancel.is_cancelled() {
        let weigh = |edge: u32, weight: f64| {
            let uses = tried.uses(edge) as f64;
            let least = if scale > 0.0 { scale } else { 1.0 };
            (!ways.failed.contains(&edge)).then_some(weight + uses * (weight + least))
        };
        let tree = ways.graph.tree(from, false, Rank::Cost, weigh);
        let Some(mut route) = tree.route(to) else { break };
        // What it costs, without the penalties that it was found by.
        route.length = value(ways, from, &route.nodes[1..], &route.edges).cost;
        if ways.passes(&route, scratch) {
            tried.add(&route);
            routes.push(route);
        }
    }
    routes
}

/// Routes as paths, shortened if that is asked for, measured, and cut into frames. Once `cancel` says so no other route is
/// taken up; the first always is.
fn shortened(
    ways: &Ways,
    routes: &[Route],
    (asked, form): (&Dissimilar, Forms),
    cancel: &Cancel,
) -> Result<Vec<Pathway>, TooFine> {
    let paths: Vec<_> = routes.iter().map(|route| ways.path(route)).collect();
    let cx = ways.cx;
    let finished = |scratch: &mut Scratch, (index, path): (usize, &Path)| {
        if index > 0 && cancel.is_cancelled() {
            return Ok(Vec::new());
        }
        let within = |reach: f64, scratch: &mut Scratch| {
            shorten_within(cx, path, asked.shortcuts, reach, cancel, scratch)
        };
        let mut forms = match form {
            Forms::AsTheyAre => vec![path.clone()],
            Forms::Shortened => vec![within(1.0, scratch)],
        };
        if form == Forms::Shortened && !cancel.is_cancelled() {
            forms.extend([within(LOCAL, scratch), path.clone()]);
        }
        let mut measured = |path| Pathway::of(cx, path, asked.spacing, scratch);
        forms.into_iter().filter_map(|path| measured(path).transpose()).collect()
    };
    let all = paths.par_iter().enumerate().map_init(Scratch::new, finished);
    let all: Vec<Result<Vec<Pathway>, TooFine>> = all.collect();
    Ok(all.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
}

/// The indices of the accepted ones among those that were found, the best first. Brings what was found in the order of the
/// ranking.
fn choose(cx: &Context, found: &mut [Pathway], asked: &Dissimilar) -> Vec<usize> {
    // Stable: what was found first stays first among equals.
    found.sort_by_key(|pathway| pathway.measured.key(asked.rank));
    let mut chosen: Vec<usize> = Vec::new();
    for (index, candidate) in found.iter().enumerate() {
        if chosen.len() == asked.count {
            break;
        }
        let is_apart = |accepted: &usize| {
            let apart = found[*accepted].frames.frechet(&candidate.frames, &cx.space);
            apart.value >= asked.distance
        };
        if chosen.iter().all(is_apart) {
            chosen.push(index);
        }
    }
    chosen
}
