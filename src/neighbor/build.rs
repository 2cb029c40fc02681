//! Building the tree of a segment of the index, in the segment's block of bytes.

use super::embedding::{Embedding, FAN, length};
use super::layout::{Head, NONE, SegmentLayout};
use bytemuck::{cast_slice, cast_slice_mut};
use std::ops::Range;

/// About so many points, evenly spaced in their order, are looked at to find the axis of the widest spread.
const SAMPLED: usize = 32;

/// What a segment is built from.
pub(super) struct Source<'a, 'q> {
    pub embedding: &'a Embedding,
    /// The configuration of an id.
    pub config_of: &'a dyn Fn(u32) -> &'q [f64],
    /// The label of an id, in the state of the index with `configs` configurations.
    pub label_of: &'a dyn Fn(u32) -> u32,
    /// Number of configurations of the whole index.
    pub configs: u32,
}

/// Fills a block of zeros with the tree over the configurations of these ids.
pub(super) fn fill(source: &Source, layout: &SegmentLayout, ids: Range<u32>, block: &mut [u8]) {
    let (first, len) = (ids.start, ids.end - ids.start);
    let axes = source.embedding.axes();
    let mut rows = Vec::with_capacity(len as usize * axes);
    ids.for_each(|id| source.embedding.embed((source.config_of)(id), &mut rows));
    let mut order: Vec<u32> = (0..len).collect();
    let mut build = Build { axes, rows, keys: Vec::new() };
    build.arrange(layout.levels[0].count, &mut order);
    for level in &layout.levels {
        // Boxes begin empty. Those that fill up the last group of a level remain so.
        for side in cast_slice_mut::<_, [[f32; FAN]; 2]>(&mut block[level.sides.clone()]) {
            *side = [[f32::INFINITY; FAN], [f32::NEG_INFINITY; FAN]];
        }
    }
    let mut longest: f64 = 0.0;
    for (leaf, rows) in order.chunks_mut(FAN).enumerate() {
        rows.sort_unstable();
        longest = longest.max(build.leaf(source, layout, first, leaf, rows, block));
    }
    for level in 1..layout.levels.len() {
        enclose(source, layout, level, block);
    }
    Head { first, len, axes: axes as u32, configs_at_build: source.configs, longest }.write(block);
}

/// Widens the box whose least coordinate along an axis is `sides[at]`, so that it contains an interval.
fn widen(sides: &mut [f32], at: usize, (least, largest): (f32, f32)) {
    sides[at] = sides[at].min(least);
    sides[at + FAN] = sides[at + FAN].max(largest);
}

/// Index, among the sides of a level, of a box's least coordinate along an axis; the largest follows [`FAN`]
/// later.
fn side(axes: usize, index: usize, axis: usize) -> usize {
    (index / FAN * axes + axis) * 2 * FAN + index % FAN
}

/// Fills the boxes of a level, each around [`FAN`] boxes of the level below.
fn enclose(source: &Source, layout: &SegmentLayout, level: usize, block: &mut [u8]) {
    let (below, own) = (&layout.levels[level - 1], &layout.levels[level]);
    let axes = source.embedding.axes();
    let parts = [&below.sides, &own.sides, &layout.ids, &below.uniform, &own.uniform];
    let parts = block.get_disjoint_mut(parts.map(Clone::clone));
    let [inner, outer, ids, inner_uniform, uniform] = parts.expect("parts do not overlap");
    let (inner, outer) = (cast_slice::<_, f32>(inner), cast_slice_mut(outer));
    let label =
        |index: usize| (source.label_of)(cast_slice::<_, u32>(ids)[first_id(level - 1, index)]);
    uniform.fill(1);
    for index in 0..below.count {
        for axis in 0..axes {
            let at = side(axes, index, axis);
            widen(outer, side(axes, index / FAN, axis), (inner[at], inner[at + FAN]));
        }
        let same = inner_uniform[index] == 1 && label(index) == label(index / FAN * FAN);
        uniform[index / FAN] &= u8::from(same);
    }
}

/// Index, among the ids of a tree, of the first id in a box.
pub(super) fn first_id(level: usize, index: usize) -> usize {
    index << (FAN.ilog2() as usize * (level + 1))
}

/// Arranges the points of a segment into leaves. A row is a point, numbered in the order of ids.
struct Build {
    axes: usize,
    /// The coordinates of all rows, row after row.
    rows: Vec<f32>,
    /// Scratch memory of [`Build::partition`].
    keys: Vec<u64>,
}

impl Build {
    /// Orders rows so that each [`FAN`] of them make a leaf, by halving them recursively across their widest
    /// axis. Cuts are such that boxes of all levels are full but for the last of each.
    fn arrange(&mut self, leaves: usize, order: &mut [u32]) {
        if leaves <= 1 {
            return;
        }
        // Number of leaves in each of the largest boxes that the rows fill more than one of.
        let mut full = 1;
        while full * FAN < leaves {
            full *= FAN;
        }
        let left = leaves.div_ceil(full) / 2 * full;
        self.partition(left * FAN, order);
        let (low, high) = order.split_at_mut(left * FAN);
        self.arrange(left, low);
        self.arrange(leaves - left, high);
    }

    /// Brings the `count` rows with the least coordinates along the axis of the widest spread to the front.
    fn partition(&mut self, count: usize, order: &mut [u32]) {
        let axes = self.axes;
        let mut widest = (0.0, 0);
        for axis in 0..axes {
            let (mut least, mut largest) = (f32::INFINITY, f32::NEG_INFINITY);
            for row in order.iter().step_by(order.len().div_ceil(SAMPLED)) {
                let value = self.rows[*row as usize * axes + axis];
                (least, largest) = (least.min(value), largest.max(value));
            }
            if largest - least > widest.0 {
                widest = (largest - least, axis);
            }
        }
        let axis = widest.1;
        // Keys are a coordinate's bits, changed so that they order as the numbers do, followed by the row, which
        // breaks ties.
        self.keys.clear();
        self.keys.extend(order.iter().map(|row| {
            let value = self.rows.get(*row as usize * axes + axis).copied().unwrap_or(0.0);
            let bits = value.to_bits();
            let key = if bits >> 31 == 0 { bits | 1 << 31 } else { !bits };
            u64::from(key) << 32 | u64::from(*row)
        }));
        self.keys.select_nth_unstable(count);
        for (row, key) in order.iter_mut().zip(&self.keys) {
            *row = *key as u32;
        }
    }

    /// Fills a leaf with the points of its rows, and returns the Euclidean length of the longest.
    fn leaf(
        &self,
        source: &Source,
        layout: &SegmentLayout,
        first: u32,
        leaf: usize,
        rows: &[u32],
        block: &mut [u8],
    ) -> f64 {
        let (axes, level) = (self.axes, &layout.levels[0]);
        let parts = [&layout.points, &layout.ids, &level.sides, &level.uniform].map(Clone::clone);
        let parts = block.get_disjoint_mut(parts).expect("parts do not overlap");
        let [points, ids, sides, uniform] = parts;
        let ids = &mut cast_slice_mut::<_, [u32; FAN]>(ids)[leaf];
        let points = &mut cast_slice_mut::<_, [f32; FAN]>(points)[leaf * axes..];
        let sides = cast_slice_mut(sides);
        *ids = [NONE; FAN];
        for (id, row) in ids.iter_mut().zip(rows) {
            *id = first + row;
        }
        for (axis, values) in points.iter_mut().enumerate().take(axes) {
            *values = [f32::INFINITY; FAN];
            for (coordinate, row) in values.iter_mut().zip(rows) {
                let value = self.rows[*row as usize * axes + axis];
                widen(sides, side(axes, leaf, axis), (value, value));
                *coordinate = value;
            }
        }
        let label = |row: &u32| (source.label_of)(first + row);
        uniform[leaf] = u8::from(rows.iter().all(|row| label(row) == label(&rows[0])));
        let row = |index: &u32| &self.rows[*index as usize * axes..(*index as usize + 1) * axes];
        rows.iter().map(|index| length(row(index))).fold(0.0, f64::max)
    }
}
