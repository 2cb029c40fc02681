//! Measuring [`FAN`] points or boxes at once, with the processor's instructions for several numbers.
//!
//! Every lane does the same operations of single precision in the same order, and none of them is fused, so
//! squared distances have the same bits whatever instructions compute them.

use super::embedding::{Embedding, FAN};
use crate::lanes::with_lanes;
use fearless_simd::f32x16;
use fearless_simd::prelude::*;

/// Squared distances, and a bit for each that is not above the pruning bound. One that is not a number is not
/// above it, so that nothing is pruned because of overflow.
pub(super) type Measured = ([f32; FAN], u32);

impl Embedding {
    /// Measures the squared distances between a point and the points of a leaf.
    #[inline]
    pub(super) fn near_points(&self, point: &[f32], leaf: &[f32], bound: f32) -> Measured {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || compare(simd, self.squares(point, leaf), bound),
        ))
    }

    /// Measures the squared distances between a point and boxes. `sides` has along each axis the least, then
    /// the largest coordinates of the boxes.
    #[inline]
    pub(super) fn near_boxes(&self, point: &[f32], sides: &[f32], bound: f32) -> Measured {
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || compare(simd, self.box_squares(point, sides), bound),
        ))
    }
}

#[inline(always)]
fn compare<S: Simd>(simd: S, squares: [f32; FAN], bound: f32) -> Measured {
    let above = f32x16::load_array_ref(simd, &squares).simd_gt(bound).to_bitmask();
    (squares, !above as u32 & 0xFFFF)
}
