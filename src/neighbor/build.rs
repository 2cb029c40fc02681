//! Filling the block of a segment.

use super::embedding::{Embedding, FAN, length};
use super::layout::NONE;
use super::layout::{Head, Layout};
use bytemuck::{cast_slice, cast_slice_mut};

/// How many points of a part are looked at to see along which axis it is longest.
const LOOKED_AT: usize = 32;

/// What a segment is built of.
pub(super) struct Source<'a, 'q> {
    pub embedding: &'a Embedding,
    /// The configuration of an id.
    pub config_of: &'a dyn Fn(u32) -> &'q [f64],
    /// Its label, as it is when there are `time` configurations.
    pub label_of: &'a dyn Fn(u32) -> u32,
    pub time: u32,
}

/// Fills a block with the tree over `len` configurations from `first` on.
pub(super) fn fill(source: &Source, layout: &Layout, (first, len): (u32, u32), block: &mut [u8]) {
    let axes = source.embedding.axes();
    let mut rows = Vec::with_capacity(len as usize * axes);
    (first..first + len).for_each(|id| source.embedding.embed((source.config_of)(id), &mut rows));
    let mut order: Vec<u32> = (0..len).collect();
    let mut build = Build { axes, rows, keys: Vec::new() };
    build.sort(layout.levels[0].count, &mut order);
    for level in &layout.levels {
        // Boxes that are not there contain nothing.
        for side in cast_slice_mut::<_, [[f32; FAN]; 2]>(&mut block[level.sides.clone()]) {
            *side = [[f32::INFINITY; FAN], [f32::NEG_INFINITY; FAN]];
        }
    }
    let mut longest: f64 = 0.0;
    for (leaf, rows) in order.chunks_mut(FAN).enumerate() {
        rows.sort_unstable();
        longest = longest.max(build.leaf(source, layout, first, (leaf, rows), block));
    }
    for level in 1..layout.levels.len() {
        enclose(source, layout, level, block);
    }
    Head { first, len, axes: axes as u32, time: source.time, longest }.write(block);
}

/// Widens a box along an axis.
fn cover(sides: &mut [f32], at: usize, (least, largest): (f32, f32)) {
    sides[at] = sides[at].min(least);
    sides[at + FAN] = sides[at + FAN].max(largest);
}

/// Where the least coordinate of a box stands; its largest stands [`FAN`] behind.
fn side(axes: usize, index: usize, axis: usize) -> usize {
    (index / FAN * axes + axis) * 2 * FAN + index % FAN
}

/// Fills the boxes around those of the level below.
fn enclose(source: &Source, layout: &Layout, level: usize, block: &mut [u8]) {
    let (below, own) = (&layout.levels[level - 1], &layout.levels[level]);
    let axes = source.embedding.axes();
    let parts = [&below.sides, &own.sides, &layout.ids, &below.uniform, &own.uniform];
    let parts = block.get_disjoint_mut(parts.map(Clone::clone));
    let [inner, outer, ids, inner_uniform, uniform] = parts.expect("parts do not overlap");
    let (inner, outer) = (cast_slice::<_, f32>(inner), cast_slice_mut(outer));
    let label = |index: usize| {
        let an_id = cast_slice::<_, u32>(ids)[an_id(level - 1, index)];
        (source.label_of)(an_id)
    };
    uniform.fill(1);
    for index in 0..below.count {
        for axis in 0..axes {
            let at = side(axes, index, axis);
            cover(outer, side(axes, index / FAN, axis), (inner[at], inner[at + FAN]));
        }
        let same = inner_uniform[index] == 1 && label(index) == label(index / FAN * FAN);
        uniform[index / FAN] &= u8::from(same);
    }
}

/// Where the first id in a box stands.
pub(super) fn an_id(level: usize, index: usize) -> usize {
    index << (FAN.ilog2() as usize * (level + 1))
}

struct Build {
    axes: usize,
    rows: Vec<f32>,
    keys: Vec<u64>,
}

impl Build {
    /// Puts the rows of so many leaves in order.
    fn sort(&mut self, leaves: usize, order: &mut [u32]) {
        if leaves <= 1 {
            return;
        }
        // Leaves in the largest boxes that the part is made of.
        let mut whole = 1;
        while whole * FAN < leaves {
            whole *= FAN;
        }
        let left = leaves.div_ceil(whole) / 2 * whole;
        self.part(left * FAN, order);
        let (low, high) = order.split_at_mut(left * FAN);
        self.sort(left, low);
        self.sort(leaves - left, high);
    }

    /// Brings the rows with the `count` least coordinates along the longest axis to the front.
    fn part(&mut self, count: usize, order: &mut [u32]) {
        let axes = self.axes;
        let mut longest = (0.0, 0);
        for axis in 0..axes {
            let (mut least, mut largest) = (f32::INFINITY, f32::NEG_INFINITY);
            for row in order.iter().step_by(order.len().div_ceil(LOOKED_AT)) {
                let value = self.rows[*row as usize * axes + axis];
                (least, largest) = (least.min(value), largest.max(value));
            }
            if largest - least > longest.0 {
                longest = (largest - least, axis);
            }
        }
        let axis = longest.1;
        // The bits of a number, changed so that they order as numbers do, then the row.
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

    /// Fills a leaf with its rows; the length of the longest point.
    fn leaf(
        &self,
        source: &Source,
        layout: &Layout,
        first: u32,
        (leaf, rows): (usize, &[u32]),
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
            for (place, row) in values.iter_mut().zip(rows) {
                let value = self.rows[*row as usize * axes + axis];
                cover(sides, side(axes, leaf, axis), (value, value));
                *place = value;
            }
        }
        let label = |row: &u32| (source.label_of)(first + row);
        uniform[leaf] = u8::from(rows.iter().all(|row| label(row) == label(&rows[0])));
        let row = |row: &u32| &self.rows[*row as usize * axes..(*row as usize + 1) * axes];
        rows.iter().map(|at| length(row(at))).fold(0.0, f64::max)
    }
}
