//! Pathways to look at.

use super::pathways::ToNative;
use super::{Formation, Native};
use crate::cancel::Cancel;
use crate::context::Context;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::pathways::{Pathway, Pathways, TooFine, pairs};
use crate::query::{Attachment, Path};
use crate::roadmap::Roadmap;

/// A pathway of each of the `count` most frequent orders of the elements: of those with that order the one that costs
/// least, all of whose edges pass the finer check of paths that are given out. Orders none of whose pathways does are passed over.
///
/// The pathways begin at different conformations, and end at the native one. `spacing` is as of
/// [`Frames`](crate::pathways::Frames). Once `cancel` says so no further pathway is looked at.
///
/// # Errors
/// A pathway would have too many frames.
pub fn examples(
    cx: &Context,
    roadmap: &Roadmap,
    (native, formation): (&Native, &Formation),
    attachment: &Attachment,
    (count, spacing): (usize, f64),
    cancel: &Cancel,
    scratch: &mut Scratch,
) -> Result<Pathways, TooFine> {
    let [tree] = ToNative::at(cx, roadmap, [roadmap.extent()], (native, attachment), scratch);
    let (mut found, mut tried, mut dropped_edges) = (Vec::new(), 0, 0);
    for order in 0..count.min(formation.elements.len()) {
        for (start, _) in formation.starts.iter().filter(|(_, its)| *its == order) {
            if cancel.is_cancelled() {
                break;
            }
            let Some(route) = tree.route(*start) else { continue };
            let config = |node: NodeId| match node {
                node if node == tree.native => &native.q[..],
                node => roadmap.configs().get(node.index()),
            };
            tried += 1;
            let path = Path::along(cx, &route, |index| tree.edges[index as usize], config);
            if let Some(pathway) = Pathway::of(cx, path, spacing, scratch)? {
                found.push(pathway);
                break;
            }
            dropped_edges += 1;
        }
    }
    Ok(Pathways {
        pairs: pairs(cx, &found, cancel),
        connected: formation.pathways > 0,
        pathways: found,
        tried,
        dropped_edges,
        is_cut: cancel.is_cancelled(),
    })
}
