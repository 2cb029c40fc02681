//! The search of a tree for what is near a place.

use super::build::an_id;
use super::embedding::{Embedding, FAN, length};
use super::layout::NONE;
use super::tree::Tree;

/// Whoever looks for points near a place.
pub(super) trait Seeker {
    /// Points farther from the place, their distance squared, do not matter any more.
    fn limit(&self) -> f32;
    /// Takes in a point, given the square of its distance. `counts` says that it is known to matter.
    fn meet(&mut self, id: u32, square: f32, counts: bool);
    /// Whether all that has the label of `id` matters, or none. `None` where labels do not decide.
    fn label_counts(&self, id: u32) -> Option<bool>;
}

/// The search of one tree around one point.
pub(super) struct Search<'a, S> {
    tree: &'a Tree,
    ids: &'a [u32],
    points: &'a [f32],
    embedding: &'a Embedding,
    point: &'a [f32],
    knows_labels: bool,
    seeker: &'a mut S,
}

impl<'a, S: Seeker> Search<'a, S> {
    /// A search when there are `now` configurations.
    pub(super) fn new(
        tree: &'a Tree,
        embedding: &'a Embedding,
        point: &'a [f32],
        now: u32,
        seeker: &'a mut S,
    ) -> Search<'a, S> {
        // Whoever built it may have been further: what was united there may not be so yet.
        let knows_labels = tree.time() <= now;
        let (ids, points) = (tree.ids(), tree.points());
        Search { tree, ids, points, embedding, point, knows_labels, seeker }
    }

    /// Shows the seeker every point that may matter.
    pub(super) fn everywhere(mut self) {
        if self.tree.len() > 0 {
            self.visit(self.tree.height() - 1, 0, None, false);
        }
    }

    /// The same, but from a leaf outwards: for a point that lies there.
    pub(super) fn outwards(mut self, leaf: usize) {
        self.look(leaf, false);
        let mut index = leaf;
        for level in 0..self.tree.height() {
            self.visit(level, index / FAN, Some(index % FAN), false);
            index /= FAN;
        }
    }

    /// Visits boxes `FAN * block` and following of a level but for one, nearest first. `counts` says that
    /// all their points are known to matter: looking a label up is what costs most.
    fn visit(&mut self, level: usize, block: usize, but: Option<usize>, counts: bool) {
        let (count, sides) = self.tree.boxes(level, block);
        let limit = self.seeker.limit();
        let (squares, mut within) = self.embedding.near_boxes(self.point, sides, limit);
        let first = block * FAN;
        if count < FAN {
            within &= (1 << count) - 1;
        }
        if let Some(but) = but {
            within &= !(1 << but);
        }
        if level == 0 && but.is_none() && limit.is_finite() {
            // Of the last boxes the order hardly matters once there is a limit, and finding it costs.
            for child in ones(within) {
                if squares[child] <= self.seeker.limit() {
                    self.enter(level, first + child, counts);
                }
            }
            return;
        }
        // Squares of boxes are numbers and not negative, so their bits order as they do.
        let (mut near, mut found) = ([0u64; FAN], 0);
        for child in ones(within) {
            let key = u64::from(squares[child].to_bits()) << 32 | child as u64;
            // Few are within, and mostly in no order: insertion beats what sorts many.
            let mut at = found;
            while at > 0 && near[at - 1] > key {
                near[at] = near[at - 1];
                at -= 1;
            }
            near[at] = key;
            found += 1;
        }
        for key in &near[..found] {
            if f32::from_bits((key >> 32) as u32) > self.seeker.limit() {
                return;
            }
            self.enter(level, first + (key & u64::from(u32::MAX)) as usize, counts);
        }
    }

    fn enter(&mut self, level: usize, index: usize, mut counts: bool) {
        if !counts && self.knows_labels && self.tree.is_uniform(level, index) {
            match self.seeker.label_counts(self.ids[an_id(level, index)]) {
                Some(false) => return,
                Some(true) => counts = true,
                None => {}
            }
        }
        match level {
            0 => self.look(index, counts),
            _ => self.visit(level - 1, index, None, counts),
        }
    }

    fn look(&mut self, leaf: usize, counts: bool) {
        let values = FAN * self.point.len();
        let points = &self.points[leaf * values..(leaf + 1) * values];
        let ids = &self.ids[leaf * FAN..(leaf + 1) * FAN];
        look(self.embedding, self.point, (ids, points), counts, self.seeker);
    }
}

/// Shows a seeker the points of a leaf that may matter.
fn look(
    embedding: &Embedding,
    point: &[f32],
    (ids, points): (&[u32], &[f32]),
    counts: bool,
    seeker: &mut impl Seeker,
) {
    let (squares, within) = embedding.near_points(point, points, seeker.limit());
    for at in ones(within) {
        if squares[at] > seeker.limit() || ids[at] == NONE {
            continue;
        }
        seeker.meet(ids[at], squares[at], counts);
    }
}

/// Points without boxes, [`FAN`] to a leaf: too few to be put in order.
pub(super) struct Leaves {
    ids: Vec<u32>,
    points: Vec<f32>,
    /// Length of the longest point.
    pub longest: f64,
}

impl Leaves {
    /// Those of some ids that are known to matter.
    pub(super) fn new<'a>(
        embedding: &Embedding,
        ids: impl Iterator<Item = u32>,
        config_of: impl Fn(u32) -> &'a [f64],
    ) -> Leaves {
        let (mut ids, axes) = (Vec::from_iter(ids), embedding.axes());
        let leaves = ids.len().div_ceil(FAN);
        let mut points = vec![f32::INFINITY; leaves * FAN * axes];
        let (mut point, mut longest) = (Vec::with_capacity(axes), 0.0);
        for (place, id) in ids.iter().enumerate() {
            point.clear();
            embedding.embed(config_of(*id), &mut point);
            longest = length(&point).max(longest);
            for (axis, value) in point.iter().enumerate() {
                points[(place / FAN * axes + axis) * FAN + place % FAN] = *value;
            }
        }
        ids.resize(leaves * FAN, NONE);
        Leaves { ids, points, longest }
    }

    /// Shows the seeker every point that may matter.
    pub(super) fn look(&self, embedding: &Embedding, point: &[f32], seeker: &mut impl Seeker) {
        let values = FAN * point.len();
        for (leaf, ids) in self.ids.chunks_exact(FAN).enumerate() {
            let points = &self.points[leaf * values..(leaf + 1) * values];
            look(embedding, point, (ids, points), true, seeker);
        }
    }
}

/// The places of the bits that are set, lowest first.
fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let at = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (at < u32::BITS).then_some(at as usize)
    })
}
