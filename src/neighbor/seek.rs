//! Searching a tree for the points near a query: branch and bound, nearest boxes first.

use super::build::first_id;
use super::embedding::{Embedding, FAN, length};
use super::layout::NONE;
use super::tree::Tree;

/// Receives what a search finds, and says how far the search still has to look.
pub(super) trait Seeker {
    /// Points and boxes with a larger squared distance to the query's point are pruned.
    fn pruning_bound(&self) -> f32;
    /// Receives a point that is not pruned: its id and its squared distance to the query's point. `eligible` says
    /// that the id is known to be eligible; otherwise the seeker has to find out.
    fn offer(&mut self, id: u32, square: f32, eligible: bool);
    /// Whether all ids with the same label as `id` are eligible, or none of them; `None` if labels do not decide
    /// that.
    fn label_is_eligible(&self, id: u32) -> Option<bool>;
}

/// The search of one tree for the points near the point of one query.
pub(super) struct Search<'a, S> {
    tree: &'a Tree,
    ids: &'a [u32],
    points: &'a [f32],
    embedding: &'a Embedding,
    point: &'a [f32],
    trusts_labels: bool,
    seeker: &'a mut S,
}

impl<'a, S: Seeker> Search<'a, S> {
    /// A search by an index that knows the labels of `configs` configurations.
    pub(super) fn new(
        tree: &'a Tree,
        embedding: &'a Embedding,
        point: &'a [f32],
        configs: u32,
        seeker: &'a mut S,
    ) -> Search<'a, S> {
        // A shared tree may have been built by another process that was further on. Labels that had united
        // there may still be different here.
        let trusts_labels = tree.configs_at_build() <= configs;
        let (ids, points) = (tree.ids(), tree.points());
        Search { tree, ids, points, embedding, point, trusts_labels, seeker }
    }

    /// Searches from the root, and offers the seeker every point that is not pruned.
    pub(super) fn search_from_root(mut self) {
        if self.tree.len() > 0 {
            self.search_boxes(self.tree.height() - 1, 0, None, false);
        }
    }

    /// Does the same from a leaf outwards. That is faster for a query whose point lies in the leaf, since the
    /// first points offered are near.
    pub(super) fn search_from_leaf(mut self, leaf: usize) {
        self.search_leaf(leaf, false);
        let mut index = leaf;
        for level in 0..self.tree.height() {
            self.search_boxes(level, index / FAN, Some(index % FAN), false);
            index /= FAN;
        }
    }

    /// Searches a group of boxes, those of a level from number `FAN * group` on, without the one at index `but`;
    /// nearest first. `eligible` says that all their ids are known to be eligible: looking labels up is what costs
    /// most.
    fn search_boxes(&mut self, level: usize, group: usize, but: Option<usize>, eligible: bool) {
        let (count, sides) = self.tree.boxes(level, group);
        let bound = self.seeker.pruning_bound();
        let (squares, mut near) = self.embedding.near_boxes(self.point, sides, bound);
        let first = group * FAN;
        if count < FAN {
            near &= (1 << count) - 1;
        }
        if let Some(but) = but {
            near &= !(1 << but);
        }
        if level == 0 && but.is_none() && bound.is_finite() {
            // Among leaves the order hardly matters once there is a bound, and finding it costs time.
            for child in ones(near) {
                if squares[child] <= self.seeker.pruning_bound() {
                    self.search_box(level, first + child, eligible);
                }
            }
            return;
        }
        // Squared distances of boxes are numbers and not negative, so their bits order as they do.
        let (mut keys, mut found) = ([0u64; FAN], 0);
        for child in ones(near) {
            let key = u64::from(squares[child].to_bits()) << 32 | child as u64;
            // Insertion is the fastest way to sort few keys in no particular order.
            let mut at = found;
            while at > 0 && keys[at - 1] > key {
                keys[at] = keys[at - 1];
                at -= 1;
            }
            keys[at] = key;
            found += 1;
        }
        for key in &keys[..found] {
            if f32::from_bits((key >> 32) as u32) > self.seeker.pruning_bound() {
                return;
            }
            self.search_box(level, first + (key & u64::from(u32::MAX)) as usize, eligible);
        }
    }

    /// Searches what is in a box, unless its label rules it out.
    fn search_box(&mut self, level: usize, index: usize, mut eligible: bool) {
        if !eligible && self.trusts_labels && self.tree.is_uniform(level, index) {
            match self.seeker.label_is_eligible(self.ids[first_id(level, index)]) {
                Some(false) => return,
                Some(true) => eligible = true,
                None => {}
            }
        }
        match level {
            0 => self.search_leaf(index, eligible),
            _ => self.search_boxes(level - 1, index, None, eligible),
        }
    }

    fn search_leaf(&mut self, leaf: usize, eligible: bool) {
        let values = FAN * self.point.len();
        let points = &self.points[leaf * values..(leaf + 1) * values];
        let ids = &self.ids[leaf * FAN..(leaf + 1) * FAN];
        offer_leaf(self.embedding, self.point, ids, points, eligible, self.seeker);
    }
}

/// Offers a seeker the points of a leaf that are not pruned.
fn offer_leaf(
    embedding: &Embedding,
    point: &[f32],
    ids: &[u32],
    points: &[f32],
    eligible: bool,
    seeker: &mut impl Seeker,
) {
    let (squares, near) = embedding.near_points(point, points, seeker.pruning_bound());
    for at in ones(near) {
        if squares[at] > seeker.pruning_bound() || ids[at] == NONE {
            continue;
        }
        seeker.offer(ids[at], squares[at], eligible);
    }
}

/// Leaves without a tree, for configurations too few to be arranged: they are searched one after another.
pub(super) struct Leaves {
    ids: Vec<u32>,
    points: Vec<f32>,
    /// Euclidean length of the longest point.
    pub longest: f64,
}

impl Leaves {
    /// Leaves with the configurations of some ids, all of them eligible.
    pub(super) fn new<'a>(
        embedding: &Embedding,
        ids: impl Iterator<Item = u32>,
        config_of: impl Fn(u32) -> &'a [f64],
    ) -> Leaves {
        let (mut ids, axes) = (Vec::from_iter(ids), embedding.axes());
        let leaves = ids.len().div_ceil(FAN);
        let mut points = vec![f32::INFINITY; leaves * FAN * axes];
        let (mut point, mut longest) = (Vec::with_capacity(axes), 0.0);
        for (index, id) in ids.iter().enumerate() {
            point.clear();
            embedding.embed(config_of(*id), &mut point);
            longest = length(&point).max(longest);
            for (axis, value) in point.iter().enumerate() {
                points[(index / FAN * axes + axis) * FAN + index % FAN] = *value;
            }
        }
        ids.resize(leaves * FAN, NONE);
        Leaves { ids, points, longest }
    }

    /// Offers a seeker every point that is not pruned.
    pub(super) fn search(&self, embedding: &Embedding, point: &[f32], seeker: &mut impl Seeker) {
        let values = FAN * point.len();
        for (leaf, ids) in self.ids.chunks_exact(FAN).enumerate() {
            let points = &self.points[leaf * values..(leaf + 1) * values];
            offer_leaf(embedding, point, ids, points, true, seeker);
        }
    }
}

/// The indices of the bits that are set, lowest first.
fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let at = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (at < u32::BITS).then_some(at as usize)
    })
}
