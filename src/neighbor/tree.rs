//! One segment: a balanced box tree over points that never change.

use super::embedding::FAN;

/// Stands where a leaf has no point.
pub(super) const NONE: u32 = u32::MAX;
/// How many points of a part are looked at to see along which axis it is longest.
const LOOKED_AT: usize = 32;

pub(super) fn length(point: &[f32]) -> f64 {
    point.iter().map(|value| f64::from(*value) * f64::from(*value)).sum::<f64>().sqrt()
}

/// A balanced tree of boxes. Leaves hold [`FAN`] points but for the last; [`FAN`] leaves following one
/// another have a box together, as many such boxes one again, and so on. Points are put in order by
/// cutting parts across their longest axis, always so that whole boxes go to the left.
#[derive(Debug)]
pub(super) struct Tree {
    len: usize,
    axes: usize,
    /// Per leaf the ids of its points, in ascending order.
    ids: Vec<u32>,
    /// Per leaf and axis the coordinates of its points.
    points: Vec<f32>,
    /// The boxes of leaves, then those around them; the last level has no more than [`FAN`].
    levels: Vec<Level>,
    /// Length of the longest point.
    longest: f64,
}

#[derive(Debug)]
struct Level {
    count: usize,
    /// Per [`FAN`] boxes and axis their least, then their largest coordinates.
    sides: Vec<f32>,
    /// Per box whether all its points had one label when the tree was built. Labels only unite.
    uniform: Vec<bool>,
}

impl Level {
    fn new(axes: usize, count: usize) -> Level {
        let empty = [f32::INFINITY, f32::NEG_INFINITY].map(|side| [side; FAN]);
        let axis = empty.as_flattened();
        let sides = axis.repeat(count.div_ceil(FAN) * axes);
        Level { count, sides, uniform: vec![true; count] }
    }

    /// Widens a box along an axis.
    fn cover(&mut self, axes: usize, index: usize, axis: usize, (least, largest): (f32, f32)) {
        let at = (index / FAN * axes + axis) * 2 * FAN + index % FAN;
        self.sides[at] = self.sides[at].min(least);
        self.sides[at + FAN] = self.sides[at + FAN].max(largest);
    }

    fn side(&self, axes: usize, index: usize, axis: usize) -> (f32, f32) {
        let at = (index / FAN * axes + axis) * 2 * FAN + index % FAN;
        (self.sides[at], self.sides[at + FAN])
    }
}

impl Tree {
    /// A tree over some points, `rows` holding one after the other.
    pub(super) fn new(
        axes: usize,
        ids: Vec<u32>,
        rows: Vec<f32>,
        label_of: &dyn Fn(u32) -> u32,
    ) -> Tree {
        let leaves = ids.len().div_ceil(FAN);
        let mut tree = Tree {
            len: ids.len(),
            axes,
            ids: Vec::with_capacity(leaves * FAN),
            points: Vec::with_capacity(leaves * FAN * axes),
            levels: vec![Level::new(axes, leaves)],
            longest: 0.0,
        };
        let mut order: Vec<u32> = (0..ids.len() as u32).collect();
        let mut build = Build { ids, rows, keys: Vec::new() };
        build.sort(axes, leaves, &mut order);
        for (leaf, rows) in order.chunks_mut(FAN).enumerate() {
            tree.leaf(&build, leaf, rows, label_of);
        }
        while tree.levels[tree.levels.len() - 1].count > FAN {
            tree.enclose(label_of);
        }
        tree
    }

    /// Number of points.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Appends all ids and points.
    pub(super) fn unpack(&self, ids: &mut Vec<u32>, rows: &mut Vec<f32>) {
        for (index, id) in self.ids.iter().enumerate().filter(|(_, id)| **id != NONE) {
            ids.push(*id);
            let first = index / FAN * FAN * self.axes + index % FAN;
            rows.extend((0..self.axes).map(|axis| self.points[first + axis * FAN]));
        }
    }

    fn leaf(
        &mut self,
        build: &Build,
        leaf: usize,
        rows: &mut [u32],
        label_of: &dyn Fn(u32) -> u32,
    ) {
        rows.sort_unstable_by_key(|row| build.ids[*row as usize]);
        let absent = FAN - rows.len();
        self.ids.extend(rows.iter().map(|row| build.ids[*row as usize]));
        self.ids.extend(std::iter::repeat_n(NONE, absent));
        for axis in 0..self.axes {
            for row in rows.iter() {
                let value = build.rows[*row as usize * self.axes + axis];
                self.levels[0].cover(self.axes, leaf, axis, (value, value));
                self.points.push(value);
            }
            self.points.extend(std::iter::repeat_n(f32::INFINITY, absent));
        }
        for row in rows.iter() {
            let first = *row as usize * self.axes;
            self.longest = self.longest.max(length(&build.rows[first..first + self.axes]));
        }
        let label = |row: u32| label_of(build.ids[row as usize]);
        self.levels[0].uniform[leaf] = rows.iter().all(|row| label(*row) == label(rows[0]));
    }

    /// Adds the boxes around those of the last level.
    fn enclose(&mut self, label_of: &dyn Fn(u32) -> u32) {
        let top = self.levels.len() - 1;
        let below = &self.levels[top];
        let mut level = Level::new(self.axes, below.count.div_ceil(FAN));
        for index in 0..below.count {
            for axis in 0..self.axes {
                level.cover(self.axes, index / FAN, axis, below.side(self.axes, index, axis));
            }
            let label = |index: usize| label_of(self.an_id(top, index));
            let first = index / FAN * FAN;
            level.uniform[index / FAN] &= below.uniform[index] && label(index) == label(first);
        }
        self.levels.push(level);
    }

    /// The first id in a box.
    pub(super) fn an_id(&self, level: usize, index: usize) -> u32 {
        self.ids[index << (FAN.ilog2() as usize * (level + 1))]
    }

    /// Length of the longest point.
    pub(super) fn longest(&self) -> f64 {
        self.longest
    }

    /// Number of levels of boxes.
    pub(super) fn height(&self) -> usize {
        self.levels.len()
    }

    /// Number of boxes of a level.
    pub(super) fn boxes(&self, level: usize) -> usize {
        self.levels[level].count
    }

    /// Per axis the least, then the largest coordinates of boxes `FAN * block` and following of a level.
    pub(super) fn sides(&self, level: usize, block: usize) -> &[f32] {
        let values = 2 * FAN * self.axes;
        &self.levels[level].sides[block * values..(block + 1) * values]
    }

    /// Whether all points of a box had one label when the tree was built.
    pub(super) fn is_uniform(&self, level: usize, index: usize) -> bool {
        self.levels[level].uniform[index]
    }

    /// The ids of a leaf, [`NONE`] where it has no point, and per axis the coordinates of its points.
    pub(super) fn leaf_at(&self, leaf: usize) -> (&[u32], &[f32]) {
        let values = FAN * self.axes;
        let points = &self.points[leaf * values..(leaf + 1) * values];
        (&self.ids[leaf * FAN..(leaf + 1) * FAN], points)
    }
}

struct Build {
    ids: Vec<u32>,
    rows: Vec<f32>,
    keys: Vec<u64>,
}

impl Build {
    /// Puts the rows of so many leaves in order.
    fn sort(&mut self, axes: usize, leaves: usize, order: &mut [u32]) {
        if leaves <= 1 {
            return;
        }
        // Leaves in the largest boxes that the part is made of.
        let mut whole = 1;
        while whole * FAN < leaves {
            whole *= FAN;
        }
        let left = leaves.div_ceil(whole) / 2 * whole;
        self.part(axes, left * FAN, order);
        let (low, high) = order.split_at_mut(left * FAN);
        self.sort(axes, left, low);
        self.sort(axes, leaves - left, high);
    }

    /// Brings the rows with the `count` least coordinates along the longest axis to the front.
    fn part(&mut self, axes: usize, count: usize, order: &mut [u32]) {
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
}
