//! Where the parts of a native structure form, on every pathway.

use super::orders::Orders;
use super::pathways::ToNative;
use super::{Native, Order, Precedence};
use crate::cancel::Cancel;
use crate::context::Context;
use crate::local::Planner;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::query::Attachment;
use crate::roadmap::{Extent, Roadmap};
use std::ops::Range;
use std::rc::Rc;

/// How far apart the frames of a pathway are at most, at which contacts are looked at: the root of the mean squared turn of all torsions, rad;
/// half a degree. Milestones would be too far apart: the last motion to the native conformation leads down, which costs nothing
/// however long it is, so that on the cheapest route most parts form within it.
const FRAMES_APART: f64 = 0.5 / 180.0 * std::f64::consts::PI;

/// What counts as formed, and what as unstructured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The share of a part's native contacts from which on it is formed, more than 0, at most 1.
    pub formed: f64,
    /// A conformation is unstructured if it has at most so many native contacts.
    pub unstructured: u32,
}

impl Settings {
    /// The share from which on a part is formed, as text: `60 %`.
    pub fn formed_percent(&self) -> String {
        format!("{} %", (self.formed * 1e8).round() / 1e6)
    }
}

impl Default for Settings {
    /// 60 %, and no contact: S. Nath 2013, §5.3; the share is that of N. M. Amato & G. Song 2002.
    fn default() -> Settings {
        Settings { formed: 0.6, unstructured: 0 }
    }
}

/// How the parts of a native structure form over all pathways of a roadmap: one pathway from each unstructured node that any
/// route joins to the native conformation, the one of the least cost by the edges as they are recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Formation {
    /// The number of pathways.
    pub pathways: u64,
    /// The orders of the elements of secondary structure, the most frequent first.
    pub elements: Vec<Order>,
    /// The orders of the pairings.
    pub pairings: Vec<Order>,
    /// Which part forms before which, elements and pairings alike.
    pub precedence: Precedence,
    /// Per part, the mean over all pathways of the share of all native contacts that is there where the part forms: early parts have
    /// a low one. NaN without pathways.
    pub at: Vec<f64>,
    /// The same per native contact, of the frame from which on it is never broken again.
    pub contacts: Vec<f64>,
    /// Per native contact, on which share of the pathways it is never broken again once a fifth of all native contacts is there, two
    /// fifths, and so on to all. 0 without pathways.
    pub by_fifths: Vec<[f64; 5]>,
    /// The pathways' first nodes, those that cost least first, each with the order of its elements: an index in
    /// [`Formation::elements`].
    pub(super) starts: Vec<(NodeId, usize)>,
}

/// Since when something is there, seen from a frame on the way to the native conformation.
#[derive(Clone, Copy)]
struct Since {
    /// How many frames before the end.
    depth: u32,
    /// The share of native contacts there.
    share: f64,
}

/// What is known at a frame of a pathway.
struct AtFrame {
    depth: u32,
    /// Per part, then per contact.
    since: Vec<Since>,
}

impl Formation {
    /// Looks at all pathways of a roadmap; `None` if `cancel` says so before that is done. Some of the pathways would not stand for
    /// all: those that are looked at one after the other share their last motions.
    pub fn of(
        cx: &Context,
        roadmap: &Roadmap,
        native: &Native,
        settings: &Settings,
        attachment: &Attachment,
        cancel: &Cancel,
        scratch: &mut Scratch,
    ) -> Option<Formation> {
        let (now, of) = ([roadmap.extent()], (native, settings, attachment));
        let [formation] = Formation::at(cx, roadmap, now, of, cancel, scratch);
        (!cancel.is_cancelled()).then_some(formation)
    }

    /// The same of a roadmap as it was at the ends of several rounds. Once `cancel` says so no further pathway is looked at.
    pub(crate) fn at<const N: usize>(
        cx: &Context,
        roadmap: &Roadmap,
        extents: [Extent; N],
        (native, settings, attachment): (&Native, &Settings, &Attachment),
        cancel: &Cancel,
        scratch: &mut Scratch,
    ) -> [Formation; N] {
        let kept_at = |q: &[f64], scratch: &mut Scratch| -> Vec<bool> {
            native.kept(&cx.model.shape(q, scratch).unwrap_or_default()).collect()
        };
        let is_unstructured = |q: &[f64]| {
            if cancel.is_cancelled() {
                return false;
            }
            let kept = kept_at(q, scratch).into_iter().filter(|kept| *kept).count();
            kept <= settings.unstructured as usize
        };
        let configs = roadmap.configs();
        let unstructured: Vec<bool> = configs.iter().map(is_unstructured).collect();
        let trees = ToNative::at(cx, roadmap, extents, (native, attachment), scratch);
        trees.map(|tree| {
            let starts = (0..unstructured.len() as u32).map(NodeId);
            let starts = starts.filter(|node| unstructured[node.index()]);
            let config = |node: NodeId| match node {
                node if node == tree.native => &native.q[..],
                node => configs.get(node.index()),
            };
            let frames = |node: NodeId| {
                let frames = frames(cx, &tree, node, config);
                frames.iter().map(|q| kept_at(q, scratch)).collect()
            };
            Formation::along(&tree, starts, frames, (native, settings), cancel)
        })
    }

    /// Looks at the pathways from `starts`, those among them that have one. `kept` gives, for a node, which contacts are there
    /// frame by frame from the next node on its way, which is left out, to the node itself. Once `cancel` says so no further node is
    /// looked at.
    pub(super) fn along(
        tree: &ToNative,
        starts: impl Iterator<Item = NodeId>,
        mut kept: impl FnMut(NodeId) -> Vec<Vec<bool>>,
        (native, settings): (&Native, &Settings),
        cancel: &Cancel,
    ) -> Formation {
        let (parts, contacts) = (native.parts.len(), native.contacts.len());
        let all = Since { depth: 0, share: 1.0 };
        let end = Rc::new(AtFrame { depth: 0, since: vec![all; parts + contacts] });
        let [mut is_start, mut is_on_way] = [(); 2].map(|()| vec![false; tree.native.index() + 1]);
        for start in starts {
            let mut node = start;
            is_start[start.index()] = tree.next(start).is_some();
            while let Some((next, _)) = tree.next(node)
                && !std::mem::replace(&mut is_on_way[node.index()], true)
            {
                node = next;
            }
        }
        let mut precedence = Precedence::new(parts);
        let (mut found, mut depths) = (Vec::new(), Vec::new());
        let mut sums = vec![0.0; parts + contacts];
        let mut by_fifths = vec![[0.0; 5]; contacts];
        // Nodes to be looked at, with what is known at the next one on their way; the one with the lowest id last.
        let mut open: Vec<(NodeId, Rc<AtFrame>)> = Vec::new();
        let open_before = |node: NodeId, here: &Rc<AtFrame>, open: &mut Vec<_>| {
            let before = tree.before(node).iter().rev().filter(|node| is_on_way[node.index()]);
            open.extend(before.map(|before| (*before, here.clone())));
        };
        open_before(tree.native, &end, &mut open);
        while let Some((node, mut here)) = open.pop()
            && !cancel.is_cancelled()
        {
            for kept in kept(node) {
                here = Rc::new(here.before(&kept, native, settings));
            }
            open_before(node, &here, &mut open);
            if !is_start[node.index()] {
                continue;
            }
            let of_parts: Vec<u32> = here.since[..parts].iter().map(|since| since.depth).collect();
            precedence.count(&of_parts);
            for (sum, since) in sums.iter_mut().zip(&here.since) {
                *sum += since.share;
            }
            for (fifths, since) in by_fifths.iter_mut().zip(&here.since[parts..]) {
                let later =
                    (1..=5).zip(fifths).filter(|(fifth, _)| 5.0 * since.share <= f64::from(*fifth));
                later.for_each(|(_, count)| *count += 1.0);
            }
            found.push(node);
            depths.push(of_parts);
        }
        Formation::counted(tree, native, precedence, (found, depths), (sums, by_fifths))
    }

    /// What was found, put in order.
    fn counted(
        tree: &ToNative,
        native: &Native,
        precedence: Precedence,
        (starts, depths): (Vec<NodeId>, Vec<Vec<u32>>),
        (sums, mut by_fifths): (Vec<f64>, Vec<[f64; 5]>),
    ) -> Formation {
        let (parts, count) = (native.parts.len(), native.elements());
        let ranked = |range: Range<usize>| {
            let mut orders = Orders::default();
            depths.iter().for_each(|depths| orders.count(range.clone(), depths));
            orders.ranked()
        };
        let (elements, pairings) = (ranked(0..count), ranked(count..parts));
        let order_of = |depths: &[u32]| {
            let groups = Orders::groups(0..count, depths);
            elements.iter().position(|order| order.groups == groups).unwrap_or_default()
        };
        let mut starts: Vec<(NodeId, usize)> = starts
            .into_iter()
            .zip(&depths)
            .map(|(node, depths)| (node, order_of(depths)))
            .collect();
        let pathways = starts.len() as u64;
        let cost = |node: NodeId| tree.cost(node).unwrap_or(f64::INFINITY);
        starts.sort_by(|a, b| cost(a.0).total_cmp(&cost(b.0)).then(a.0.cmp(&b.0)));
        let mut means: Vec<f64> = sums.into_iter().map(|sum| sum / pathways as f64).collect();
        let contacts = means.split_off(parts);
        by_fifths.iter_mut().flatten().for_each(|count| *count /= pathways.max(1) as f64);
        Formation {
            pathways,
            elements,
            pairings,
            precedence,
            at: means,
            contacts,
            by_fifths,
            starts,
        }
    }

    /// The greatest change of any share since `before`: of one part forming before another.
    pub fn change(&self, before: &Formation) -> f64 {
        self.precedence.change(&before.precedence)
    }

    /// The share of the most frequent order of the elements; 0 without pathways.
    pub fn dominant(&self) -> f64 {
        self.elements.first().map_or(0.0, |order| order.pathways as f64 / self.pathways as f64)
    }
}

impl AtFrame {
    /// What is known at the frame that comes before this one on its way, by the contacts that it has.
    fn before(&self, kept: &[bool], native: &Native, settings: &Settings) -> AtFrame {
        let depth = self.depth + 1;
        let all = kept.iter().filter(|kept| **kept).count();
        let share = all as f64 / kept.len().max(1) as f64;
        let since = |index: usize, is_there: bool| {
            let known = self.since[index];
            // There without a break from here to the end.
            if is_there && known.depth == self.depth { Since { depth, share } } else { known }
        };
        let parts = native.parts.iter().map(|part| {
            let there = part.contacts.iter().filter(|at| kept[**at as usize]).count();
            // 0.55 times 20 is a little more than 11 in binary numbers.
            there as f64 >= settings.formed * part.contacts.len() as f64 - 1e-9
        });
        let all = parts.chain(kept.iter().copied()).enumerate();
        AtFrame { depth, since: all.map(|(index, is_there)| since(index, is_there)).collect() }
    }
}

/// The frames of the motion from the next node on the way of `node`, which is left out, to `node`.
fn frames<'a>(
    cx: &Context,
    tree: &ToNative,
    node: NodeId,
    config: impl Fn(NodeId) -> &'a [f64],
) -> Vec<Vec<f64>> {
    let Some((_, edge)) = tree.next(node) else { return Vec::new() };
    let planner = Planner::from_tag(edge.planner).expect("edges carry known planners");
    let motion = planner.motion(cx, config(edge.low), config(edge.high));
    let mut points: Vec<&[f64]> = motion.iter().collect();
    if node == edge.low {
        points.reverse();
    }
    let apart = FRAMES_APART * (cx.space.len() as f64).sqrt();
    let mut frames = Vec::new();
    for ends in points.windows(2) {
        let count = (cx.space.distance(ends[0], ends[1]) / apart).ceil().max(1.0);
        for index in 1..=count as u32 {
            let mut q = vec![0.0; cx.space.len()];
            cx.space.interpolate(ends[0], ends[1], f64::from(index) / count, &mut q);
            frames.push(q);
        }
    }
    frames
}
