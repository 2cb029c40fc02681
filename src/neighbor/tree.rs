//! A segment of the index: a bounding-volume hierarchy over points that never change.

use super::build::{self, Source};
use super::embedding::{Embedding, FAN};
use super::layout::{Head, Level, SegmentLayout};
use crate::shelf::Block;
use std::ops::Range;

/// A balanced tree of axis-aligned bounding boxes. Each leaf is a bucket of [`FAN`] points, but for the last, which
/// may have fewer. Every [`FAN`] consecutive leaves have a common box, every [`FAN`] consecutive boxes of a level
/// have one on the next level. Points are arranged as for a k-d tree, by cutting sets of points across the axis of
/// their widest spread; cuts are placed so that only the last box of a level is not full.
#[derive(Debug)]
pub(super) struct Tree {
    head: Head,
    layout: SegmentLayout,
    block: Block,
}

impl Tree {
    /// Builds the tree over the configurations of these ids. `keep` provides the block: it is given
    /// the block's length in bytes and the function that fills a block of zeros.
    pub(super) fn new(
        source: &Source,
        ids: Range<u32>,
        keep: impl FnOnce(usize, &mut dyn FnMut(&mut [u8])) -> Block,
    ) -> Tree {
        let layout = SegmentLayout::new(source.embedding.axes(), ids.len());
        let mut fill = |block: &mut [u8]| build::fill(source, &layout, ids.clone(), block);
        let block = keep(layout.bytes, &mut fill);
        Tree { head: Head::read(&block), layout, block }
    }

    /// The tree over the configurations of these ids, built earlier, if `find` has its block. `find` is
    /// given the block's length in bytes.
    pub(super) fn found(
        embedding: &Embedding,
        ids: Range<u32>,
        find: impl FnOnce(usize) -> Option<Block>,
    ) -> Option<Tree> {
        let axes = embedding.axes();
        let layout = SegmentLayout::new(axes, ids.len());
        let block = find(layout.bytes)?;
        let head = Head::read(&block);
        let as_expected =
            head.first == ids.start && head.len as usize == ids.len() && head.axes == axes as u32;
        as_expected.then_some(Tree { head, layout, block })
    }

    /// The first id.
    pub(super) fn first(&self) -> u32 {
        self.head.first
    }

    /// Number of points.
    pub(super) fn len(&self) -> u32 {
        self.head.len
    }

    /// One more than the last id.
    pub(super) fn end(&self) -> u32 {
        self.head.first + self.head.len
    }

    /// Euclidean length of the longest point.
    pub(super) fn longest(&self) -> f64 {
        self.head.longest
    }

    /// Number of configurations of the whole index when the tree was built: the labels are those of that state.
    pub(super) fn configs_at_build(&self) -> u32 {
        self.head.configs_at_build
    }

    /// Number of levels of boxes.
    pub(super) fn height(&self) -> usize {
        self.layout.levels.len()
    }

    /// Per leaf [`FAN`] ids of its points; [`NONE`](super::layout::NONE) where it has fewer points.
    pub(super) fn ids(&self) -> &[u32] {
        bytemuck::cast_slice(&self.block[self.layout.ids.clone()])
    }

    /// Per leaf and axis the coordinates of its [`FAN`] points.
    pub(super) fn points(&self) -> &[f32] {
        bytemuck::cast_slice(&self.block[self.layout.points.clone()])
    }

    /// A group of boxes of a level, those from number `FAN * group` on: how many boxes the level has from there
    /// on, and per axis the least, then the largest coordinates of the first [`FAN`] of these.
    pub(super) fn boxes(&self, level: usize, group: usize) -> (usize, &[f32]) {
        let Level { count, sides, .. } = &self.layout.levels[level];
        let bytes = 2 * FAN * self.head.axes as usize * size_of::<f32>();
        let sides = &self.block[sides.clone()][group * bytes..(group + 1) * bytes];
        (count - group * FAN, bytemuck::cast_slice(sides))
    }

    /// Whether all points of a box had the same label when the tree was built.
    pub(super) fn is_uniform(&self, level: usize, index: usize) -> bool {
        self.block[self.layout.levels[level].uniform.start + index] == 1
    }
}
