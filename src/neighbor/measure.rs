//! [`FAN`] points or boxes measured at once, by the instructions that were chosen.

use super::embedding::{Embedding, FAN};
use super::lanes::Lanes;

/// Squares of distances, and a bit for each that is not beyond the limit; what is not a number is not.
pub(super) type Measured = ([f32; FAN], u32);

impl Embedding {
    /// Squares of the distances between a point and those of a leaf, and which are within a limit.
    #[inline]
    pub(super) fn near_points(&self, point: &[f32], leaf: &[f32], limit: f32) -> Measured {
        self.lanes.points(self, point, leaf, limit)
    }

    /// The same for boxes: along each axis their least coordinates, then their largest.
    #[inline]
    pub(super) fn near_boxes(&self, point: &[f32], sides: &[f32], limit: f32) -> Measured {
        self.lanes.boxes(self, point, sides, limit)
    }
}

impl Lanes {
    /// The points of a leaf.
    #[inline]
    pub(super) fn points(
        self,
        embedding: &Embedding,
        point: &[f32],
        leaf: &[f32],
        limit: f32,
    ) -> Measured {
        match self {
            Lanes::Baseline => {
                let squares = embedding.squares(point, leaf);
                (squares, within(&squares, limit))
            }
            // SAFETY: `all` asks the processor.
            #[cfg(target_arch = "x86_64")]
            Lanes::Avx2 => unsafe { avx2::points(embedding, point, leaf, limit) },
        }
    }

    /// Boxes: along each axis their least coordinates, then their largest.
    #[inline]
    pub(super) fn boxes(
        self,
        embedding: &Embedding,
        point: &[f32],
        sides: &[f32],
        limit: f32,
    ) -> Measured {
        match self {
            Lanes::Baseline => {
                let squares = embedding.box_squares(point, sides);
                (squares, within(&squares, limit))
            }
            // SAFETY: `all` asks the processor.
            #[cfg(target_arch = "x86_64")]
            Lanes::Avx2 => unsafe { avx2::boxes(embedding, point, sides, limit) },
        }
    }
}

/// A bit for every square that is not beyond the limit.
#[cfg(not(target_arch = "x86_64"))]
fn within(squares: &[f32; FAN], limit: f32) -> u32 {
    let mut bits = 0;
    for (at, square) in squares.iter().enumerate() {
        let beyond = *square > limit;
        bits |= u32::from(!beyond) << at;
    }
    bits
}

/// A bit for every square that is not beyond the limit.
#[cfg(target_arch = "x86_64")]
#[inline]
fn within(squares: &[f32; FAN], limit: f32) -> u32 {
    use std::arch::x86_64::*;
    let [a, b, c, d] = *squares.as_chunks::<4>().0 else { unreachable!("sixteen are four fours") };
    // SAFETY: every x86-64 processor has SSE2.
    unsafe {
        let limit = _mm_set1_ps(limit);
        let beyond =
            |four: [f32; 4]| _mm_castps_si128(_mm_cmpgt_ps(_mm_loadu_ps(four.as_ptr()), limit));
        let [low, high] = [(a, b), (c, d)].map(|(a, b)| _mm_packs_epi32(beyond(a), beyond(b)));
        !_mm_movemask_epi8(_mm_packs_epi16(low, high)) as u32 & 0xFFFF
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{Embedding, FAN, Measured};
    use std::arch::x86_64::*;

    #[target_feature(enable = "avx2")]
    pub(super) fn points(
        embedding: &Embedding,
        point: &[f32],
        leaf: &[f32],
        limit: f32,
    ) -> Measured {
        let squares = embedding.squares(point, leaf);
        (squares, within(&squares, limit))
    }

    #[target_feature(enable = "avx2")]
    pub(super) fn boxes(
        embedding: &Embedding,
        point: &[f32],
        sides: &[f32],
        limit: f32,
    ) -> Measured {
        let squares = embedding.box_squares(point, sides);
        (squares, within(&squares, limit))
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn within(squares: &[f32; FAN], limit: f32) -> u32 {
        let limit = _mm256_set1_ps(limit);
        let (low, high) = squares.split_at(FAN / 2);
        let near = |eight: &[f32]| {
            // SAFETY: there are eight.
            let eight = unsafe { _mm256_loadu_ps(eight.as_ptr()) };
            _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_NGT_UQ>(eight, limit)) as u32
        };
        near(low) | near(high) << 8
    }
}
