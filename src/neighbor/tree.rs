//! One segment: a balanced box tree over points that never change.

use super::build::{self, Source};
use super::embedding::{Embedding, FAN};
use super::layout::{Head, Layout, Level};
use crate::shelf::Block;

/// Stands where a leaf has no point.
pub(super) const NONE: u32 = u32::MAX;
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

pub(super) fn length(point: &[f32]) -> f64 {
    point.iter().map(|value| f64::from(*value) * f64::from(*value)).sum::<f64>().sqrt()
}

/// A balanced tree of boxes. Leaves hold [`FAN`] points but for the last; [`FAN`] leaves following one
/// another have a box together, as many such boxes one again, and so on. Points are put in order by
/// cutting parts across their longest axis, always so that whole boxes go to the left.
#[derive(Debug)]
pub(super) struct Tree {
    head: Head,
    layout: Layout,
    block: Block,
}

impl Tree {
    /// A tree over `len` configurations from `first` on, in a block that `keep` has filled: it is given how
    /// long the block is and what fills it.
    pub(super) fn new(
        source: &Source,
        (first, len): (u32, u32),
        keep: impl FnOnce(usize, &mut dyn FnMut(&mut [u8])) -> Block,
    ) -> Tree {
        let layout = Layout::new(source.embedding.axes(), len as usize);
        let mut fill = |block: &mut [u8]| build::fill(source, &layout, (first, len), block);
        let block = keep(layout.bytes, &mut fill);
        Tree { head: Head::read(&block), layout, block }
    }

    /// The same, if `find` has such a block: it is given how long that is.
    pub(super) fn found(
        embedding: &Embedding,
        (first, len): (u32, u32),
        find: impl FnOnce(usize) -> Option<Block>,
    ) -> Option<Tree> {
        let axes = embedding.axes();
        let layout = Layout::new(axes, len as usize);
        let block = find(layout.bytes)?;
        let head = Head::read(&block);
        let is_it = (head.first, head.len, head.axes) == (first, len, axes as u32);
        is_it.then_some(Tree { head, layout, block })
    }

    /// The first id.
    pub(super) fn first(&self) -> u32 {
        self.head.first
    }

    /// Number of points.
    pub(super) fn len(&self) -> u32 {
        self.head.len
    }

    /// The id behind the last.
    pub(super) fn end(&self) -> u32 {
        self.head.first + self.head.len
    }

    /// Shows the seeker, when there are `now` configurations, every point whose configuration may be within
    /// its bound.
    pub(super) fn seek(
        &self,
        embedding: &Embedding,
        place: &Place,
        now: u32,
        seeker: &mut impl Seeker,
    ) {
        if self.head.len == 0 {
            return;
        }
        let search = Search {
            points: bytemuck::cast_slice(&self.block[self.layout.points.clone()]),
            ids: bytemuck::cast_slice(&self.block[self.layout.ids.clone()]),
            tree: self,
            embedding,
            place,
            margin: embedding.margin(place.length + self.head.longest),
            slack: embedding.slack(),
            // Whoever built it may have been further: what was united there may not be so yet.
            knows_labels: self.head.time <= now,
        };
        search.visit(self.layout.levels.len() - 1, 0, false, seeker);
    }
}

struct Search<'a> {
    tree: &'a Tree,
    embedding: &'a Embedding,
    place: &'a Place,
    points: &'a [f32],
    ids: &'a [u32],
    margin: f64,
    slack: f64,
    knows_labels: bool,
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
        let Level { count, sides, uniform } = &self.tree.layout.levels[level];
        let bytes = 2 * FAN * self.place.point.len() * size_of::<f32>();
        let sides = &self.tree.block[sides.clone()][block * bytes..(block + 1) * bytes];
        let squares = self.embedding.box_squares(&self.place.point, bytemuck::cast_slice(sides));
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
            if !counts && self.knows_labels && self.tree.block[uniform.start + index] == 1 {
                match seeker.label_counts(self.ids[build::an_id(level, index)]) {
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
        let values = FAN * self.place.point.len();
        let points = &self.points[leaf * values..(leaf + 1) * values];
        let squares = self.embedding.squares(&self.place.point, points);
        let mut limit = self.limit(seeker.bound());
        let ids = &self.ids[leaf * FAN..(leaf + 1) * FAN];
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
