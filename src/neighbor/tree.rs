//! One segment: a balanced box tree over points that never change.

use super::embedding::{Embedding, FAN};

/// Stands where a leaf has no point.
const NONE: u32 = u32::MAX;
/// How many points of a part are looked at to see along which axis it is longest.
const LOOKED_AT: usize = 32;
/// Squares of distances below this are not told apart: single precision ends near 10⁻³⁸.
const TINY: f64 = 1e-36;

/// Whoever looks for points near a place.
pub(super) trait Seeker {
    /// Nothing farther than this matters any more.
    fn bound(&self) -> f64;
    /// Looks at a point that may be near enough. `counts` says that it is known to matter.
    fn meet(&mut self, id: u32, counts: bool);
    /// Whether all that has the label of `id` matters, or none. `None` where labels do not decide.
    fn label_counts(&self, id: u32) -> Option<bool>;
}

/// The place around which points are sought, and how long it is as a vector.
pub(super) struct Place {
    point: Vec<f32>,
    length: f64,
}

impl Place {
    pub(super) fn new(embedding: &Embedding, q: &[f64]) -> Place {
        let mut point = Vec::with_capacity(embedding.axes());
        embedding.embed(q, &mut point);
        Place { length: length(&point), point }
    }
}

fn length(point: &[f32]) -> f64 {
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
    fn an_id(&self, level: usize, index: usize) -> u32 {
        self.ids[index << (FAN.ilog2() as usize * (level + 1))]
    }

    /// Shows the seeker every point whose configuration may be within its bound.
    pub(super) fn seek(&self, embedding: &Embedding, place: &Place, seeker: &mut impl Seeker) {
        if self.len == 0 {
            return;
        }
        let margin = embedding.margin(place.length + self.longest);
        let search = Search { tree: self, embedding, place, margin, slack: embedding.slack() };
        search.visit(self.levels.len() - 1, 0, false, seeker);
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

struct Search<'a> {
    tree: &'a Tree,
    embedding: &'a Embedding,
    place: &'a Place,
    margin: f64,
    slack: f64,
}

impl Search<'_> {
    /// Squares beyond this belong to configurations beyond the bound.
    fn limit(&self, bound: f64) -> f32 {
        let reach = bound + self.margin;
        // Rounded up; squares beyond single precision are infinite and say nothing.
        ((reach * reach * self.slack + TINY) as f32).next_up()
    }

    /// Visits boxes `FAN * block` and following of a level, nearest first. `counts` says that all
    /// their points are known to matter: looking a label up is what costs most.
    fn visit(&self, level: usize, block: usize, counts: bool, seeker: &mut impl Seeker) {
        let Level { count, sides, uniform } = &self.tree.levels[level];
        let values = 2 * FAN * self.tree.axes;
        let squares = self
            .embedding
            .box_squares(&self.place.point, &sides[block * values..(block + 1) * values]);
        let first = block * FAN;
        let mut within = within(&squares, self.limit(seeker.bound()));
        if count - first < FAN {
            within &= (1 << (count - first)) - 1;
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
            if f32::from_bits((key >> 32) as u32) > self.limit(seeker.bound()) {
                return;
            }
            let index = first + (key & u64::from(u32::MAX)) as usize;
            let mut counts = counts;
            if !counts && uniform[index] {
                match seeker.label_counts(self.tree.an_id(level, index)) {
                    Some(false) => continue,
                    Some(true) => counts = true,
                    None => {}
                }
            }
            match level {
                0 => self.look(index, counts, seeker),
                _ => self.visit(level - 1, index, counts, seeker),
            }
        }
    }

    fn look(&self, leaf: usize, counts: bool, seeker: &mut impl Seeker) {
        let values = FAN * self.tree.axes;
        let points = &self.tree.points[leaf * values..(leaf + 1) * values];
        let squares = self.embedding.squares(&self.place.point, points);
        let mut limit = self.limit(seeker.bound());
        let ids = &self.tree.ids[leaf * FAN..(leaf + 1) * FAN];
        for at in ones(within(&squares, limit)) {
            if squares[at] > limit || ids[at] == NONE {
                continue;
            }
            seeker.meet(ids[at], counts);
            limit = self.limit(seeker.bound());
        }
    }
}

/// A bit for every square that is not beyond the limit; what is not a number is looked at.
#[inline]
fn within(squares: &[f32; FAN], limit: f32) -> u32 {
    let mut bits = 0;
    for (at, square) in squares.iter().enumerate() {
        let beyond = *square > limit;
        bits |= u32::from(!beyond) << at;
    }
    bits
}

/// The places of the bits that are set, lowest first.
fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let at = bits.trailing_zeros();
        bits &= bits.wrapping_sub(1);
        (at < u32::BITS).then_some(at as usize)
    })
}
