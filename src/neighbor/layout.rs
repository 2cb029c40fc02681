//! How a segment lies in its block.

use super::embedding::FAN;
use crate::shelf::ALIGNMENT;
use std::ops::Range;

/// Stands where a leaf has no point.
pub(super) const NONE: u32 = u32::MAX;

/// Where the parts of a segment of so many points stand in its block, in bytes: after the head all that is
/// numbers of four bytes, then a byte per box.
#[derive(Debug)]
pub(super) struct Layout {
    /// Per leaf and axis the coordinates of its points.
    pub points: Range<usize>,
    /// Per leaf the ids of its points, in ascending order.
    pub ids: Range<usize>,
    /// The boxes of leaves, then those around them; the last level has no more than [`FAN`].
    pub levels: Vec<Level>,
    /// Length of the block.
    pub bytes: usize,
}

/// Where the boxes of a level stand.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// Number of boxes.
    pub count: usize,
    /// Per [`FAN`] boxes and axis their least, then their largest coordinates.
    pub sides: Range<usize>,
    /// Per box whether all its points had one label when the tree was built. Labels only unite.
    pub uniform: Range<usize>,
}

impl Layout {
    pub(super) fn new(axes: usize, len: usize) -> Layout {
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
        Layout { points, ids, levels, bytes: end }
    }
}

/// What stands at the begin of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Head {
    /// The first id; the others follow it.
    pub first: u32,
    /// Number of points.
    pub len: u32,
    /// Number of coordinates.
    pub axes: u32,
    /// How many configurations there were when the labels were looked up.
    pub time: u32,
    /// Length of the longest point.
    pub longest: f64,
}

impl Head {
    pub(super) fn read(block: &[u8]) -> Head {
        let [first, len, axes, time] = *bytemuck::from_bytes(&block[..16]);
        Head { first, len, axes, time, longest: *bytemuck::from_bytes(&block[16..24]) }
    }

    pub(super) fn write(self, block: &mut [u8]) {
        let Head { first, len, axes, time, longest } = self;
        *bytemuck::from_bytes_mut(&mut block[..16]) = [first, len, axes, time];
        *bytemuck::from_bytes_mut(&mut block[16..24]) = longest;
    }
}
