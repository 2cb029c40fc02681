//! [`FAN`] points or boxes measured at once, by the instructions that were chosen.
//!
//! Every lane does the same operations of single precision in the same order, none of them fused, so that
//! squares have the same bits whatever the instructions.

use super::embedding::{Embedding, FAN};
use crate::lanes::with_lanes;
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// Squares of distances, and a bit for each that is not beyond the limit; what is not a number is not.
pub(super) type Measured = ([f32; FAN], u32);

impl Embedding {
    /// Squares of the distances between a point and those of a leaf, and which are within a limit.
    #[inline]
    pub(super) fn near_points(&self, point: &[f32], leaf: &[f32], limit: f32) -> Measured {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || within(simd, self.squares(point, leaf), limit),
        ))
    }

    /// The same for boxes: along each axis their least coordinates, then their largest.
    #[inline]
    pub(super) fn near_boxes(&self, point: &[f32], sides: &[f32], limit: f32) -> Measured {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || within(simd, self.box_squares(point, sides), limit),
        ))
    }
}

#[inline(always)]
fn within<S: Simd>(simd: S, squares: [f32; FAN], limit: f32) -> Measured {
    let beyond = f32x16::load_array_ref(simd, &squares).simd_gt(limit).to_bitmask();
    (squares, !beyond as u32 & 0xFFFF)
}
