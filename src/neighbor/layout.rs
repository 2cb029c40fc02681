//! The layout of a segment of the index: where in its block of bytes the parts of its tree lie.

use super::embedding::FAN;
use crate::shelf::ALIGNMENT;
use std::ops::Range;

/// Stands in place of an id where the last leaf has fewer than [`FAN`] points.
pub(super) const NONE: u32 = u32::MAX;

/// Where the parts of a segment lie in its block, in bytes from its begin. The head comes first, then everything
/// made of numbers of four bytes, then what has one byte per box.
#[derive(Debug)]
pub(super) struct SegmentLayout {
    /// Per leaf and axis the coordinates of its [`FAN`] points, an `f32` each.
    pub points: Range<usize>,
    /// Per leaf the ids of its points in ascending order, a `u32` each.
    pub ids: Range<usize>,
    /// The levels of bounding boxes. The first has the boxes of the leaves, each further one the boxes around
    /// those of the level before; the last has at most [`FAN`].
    pub levels: Vec<Level>,
    /// Length of the block in bytes.
    pub bytes: usize,
}

/// Where the boxes of a level lie in the block.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// Number of boxes.
    pub count: usize,
    /// Per [`FAN`] boxes and axis their least, then their largest coordinates, an `f32` each.
    pub sides: Range<usize>,
    /// Per box a byte: 1 if all its points had the same label when the tree was built. Labels only unite, so
    /// that they still have the same one.
    pub uniform: Range<usize>,
}

impl SegmentLayout {
    /// The layout of a segment of `len` points with `axes` coordinates.
    pub(super) fn new(axes: usize, len: usize) -> SegmentLayout {
        let leaves = len.div_ceil(FAN);
        let mut counts = vec![leaves];
        while counts[counts.len() - 1] > FAN {
            counts.push(counts[counts.len() - 1].div_ceil(FAN));
        }
        let mut end = ALIGNMENT;
        let mut next = |bytes: usize| {
            end += bytes;
            end - bytes..end
        };
        let points = next(4 * leaves * FAN * axes);
        let sides: Vec<_> =
            counts.iter().map(|count| next(4 * count.div_ceil(FAN) * axes * 2 * FAN)).collect();
        let ids = next(4 * leaves * FAN);
        let level = |(count, sides)| Level { count, sides, uniform: next(count) };
        let levels = counts.into_iter().zip(sides).map(level).collect();
        SegmentLayout { points, ids, levels, bytes: end }
    }
}

/// The head of a block: what the segment is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Head {
    /// The first id; a segment has consecutive ids.
    pub first: u32,
    /// Number of points.
    pub len: u32,
    /// Number of coordinates of a point.
    pub axes: u32,
    /// Number of configurations of the whole index when the tree was built: the labels are those of that state.
    pub configs_at_build: u32,
    /// Euclidean length of the longest point.
    pub longest: f64,
}

impl Head {
    pub(super) fn read(block: &[u8]) -> Head {
        let [first, len, axes, configs_at_build] = *bytemuck::from_bytes(&block[..16]);
        let longest = *bytemuck::from_bytes(&block[16..24]);
        Head { first, len, axes, configs_at_build, longest }
    }

    pub(super) fn write(self, block: &mut [u8]) {
        let Head { first, len, axes, configs_at_build, longest } = self;
        *bytemuck::from_bytes_mut(&mut block[..16]) = [first, len, axes, configs_at_build];
        *bytemuck::from_bytes_mut(&mut block[16..24]) = longest;
    }
}
