//! One segment: a balanced box tree over points that never change.

use super::build::{self, Source};
use super::embedding::{Embedding, FAN};
use super::layout::{Head, Layout, Level};
use crate::shelf::Block;

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

    /// Length of the longest point.
    pub(super) fn longest(&self) -> f64 {
        self.head.longest
    }

    /// How many configurations there were when the labels were looked up.
    pub(super) fn time(&self) -> u32 {
        self.head.time
    }

    /// Number of levels of boxes.
    pub(super) fn height(&self) -> usize {
        self.layout.levels.len()
    }

    /// Per leaf the ids of its points, [`NONE`] where it has none.
    pub(super) fn ids(&self) -> &[u32] {
        bytemuck::cast_slice(&self.block[self.layout.ids.clone()])
    }

    /// Per leaf and axis the coordinates of its points.
    pub(super) fn points(&self) -> &[f32] {
        bytemuck::cast_slice(&self.block[self.layout.points.clone()])
    }

    /// How many boxes follow `FAN * group` on a level, it included, and per axis the least, then the largest
    /// coordinates of at most [`FAN`] of them.
    pub(super) fn boxes(&self, level: usize, group: usize) -> (usize, &[f32]) {
        let Level { count, sides, .. } = &self.layout.levels[level];
        let bytes = 2 * FAN * self.head.axes as usize * size_of::<f32>();
        let sides = &self.block[sides.clone()][group * bytes..(group + 1) * bytes];
        (count - group * FAN, bytemuck::cast_slice(sides))
    }

    /// Whether all points of a box had one label when they were looked up.
    pub(super) fn is_uniform(&self, level: usize, index: usize) -> bool {
        self.block[self.layout.levels[level].uniform.start + index] == 1
    }
}
