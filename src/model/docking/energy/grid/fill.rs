//! The values of a grid.

use super::super::cells::LANES;
use super::super::parameters::hydrophobic_radius;
use super::super::sum::{CoulombField, HydrophobicField, PairSum};
use super::super::switch::NEAREST_SQUARED;
use super::super::terms::{HYDROPHOBIC_DEPTH, HYDROPHOBIC_FAR, HYDROPHOBIC_NEAR};
use super::encode::encode;
use super::Grid;
use crate::lanes::with_lanes;
use crate::structure::Point;
use fearless_simd::f64x8;
use fearless_simd::prelude::*;

impl Grid {
    pub fn fill_layer(&self, sum: &PairSum, layer: usize, out: &mut [f32]) {
        with_lanes!(sum.lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.fill_with(simd, sum, layer, out)
        ));
    }

    #[inline(always)]
    fn fill_with<S: Simd>(&self, simd: S, sum: &PairSum, layer: usize, out: &mut [f32]) {
        let zero = f64x8::splat(simd, 0.0);
        let channels = self.lookup.channels();
        let plane = self.counts[0] * self.counts[1];
        let mut powers = vec![[zero; 2]; sum.all.elements.len()];
        let mut shares = vec![zero; sum.kinds.len()];
        for y in 0..self.counts[1] {
            for block in 0..self.counts[0].div_ceil(LANES) {
                let x = block * LANES;
                let from = self.point([x, y, layer]);
                self.powers(simd, sum, from, &mut powers);
                self.shares(simd, sum, from, &mut shares);
                let lanes = LANES.min(self.counts[0] - x);
                for kind in 0..sum.kinds.len() {
                    let (mut repulsion, mut attraction) = (zero, shares[kind]);
                    for ([twelfth, sixth], pair) in powers.iter().zip(&sum.all.pairs[kind]) {
                        repulsion += *twelfth * f64x8::splat(simd, pair.a);
                        attraction += *sixth * f64x8::splat(simd, pair.b);
                    }
                    let begin = (kind * plane + y * self.counts[0] + x) * channels;
                    let out = &mut out[begin..begin + lanes * channels];
                    for (lane, out) in out.chunks_exact_mut(channels).enumerate() {
                        encode(self.lookup, repulsion[lane], attraction[lane], out);
                    }
                }
                if let Some(field) = &sum.charged {
                    let potential = self.potential(simd, sum, field, from);
                    let begin = sum.kinds.len() * plane * channels + y * self.counts[0] + x;
                    for lane in 0..lanes {
                        out[begin + lane] = potential[lane] as f32;
                    }
                }
            }
        }
    }

    pub fn point(&self, place: [usize; 3]) -> Point {
        let at = |axis: usize| self.low[axis] + place[axis] as f64 * self.spacing;
        Point::new(at(0), at(1), at(2))
    }

    #[inline(always)]
    fn xs<S: Simd>(&self, simd: S, from: Point) -> f64x8<S> {
        let steps = f64x8::simd_from(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        steps * f64x8::splat(simd, self.spacing) + f64x8::splat(simd, from.x)
    }

    #[inline(always)]
    fn powers<S: Simd>(&self, simd: S, sum: &PairSum, from: Point, powers: &mut [[f64x8<S>; 2]]) {
        let number = |value: f64| f64x8::splat(simd, value);
        powers.fill([number(0.0); 2]);
        let xs = self.xs(simd, from);
        let [at_x, at_y, at_z] = &sum.all.cells.at;
        let nearest = number(NEAREST_SQUARED);
        let length = self.spacing * 7.0;
        sum.all.cells.runs(from, length, sum.cutoff, |run| {
            for atom in run {
                let x = xs - number(at_x[atom]);
                let (y, z) = (from.y - at_y[atom], from.z - at_z[atom]);
                let squared = (x * x + number(y * y + z * z)).max(nearest);
                let (factor, _) = sum.switch.at_eight(simd, squared);
                let inverse = number(1.0) / squared;
                let sixth = inverse * inverse * inverse;
                let switched = sixth * factor;
                let [twelfths, sixths] = &mut powers[sum.all.element_of[atom]];
                *twelfths += switched * sixth;
                *sixths += switched;
            }
        });
    }

    #[inline(always)]
    fn shares<S: Simd>(&self, simd: S, sum: &PairSum, from: Point, shares: &mut [f64x8<S>]) {
        let number = |value: f64| f64x8::splat(simd, value);
        shares.fill(number(0.0));
        let Some(HydrophobicField { cells, radii, widest }) = &sum.hydrophobic else { return };
        let xs = self.xs(simd, from);
        let [at_x, at_y, at_z] = &cells.at;
        let width = HYDROPHOBIC_FAR - HYDROPHOBIC_NEAR;
        for (kind, total) in sum.kinds.iter().zip(shares) {
            if !kind.is_hydrophobic {
                continue;
            }
            let radius = hydrophobic_radius(kind.element);
            let reach = radius + widest + HYDROPHOBIC_FAR;
            cells.runs(from, self.spacing * 7.0, reach, |run| {
                for atom in run {
                    let x = xs - number(at_x[atom]);
                    let (y, z) = (from.y - at_y[atom], from.z - at_z[atom]);
                    let distance = (x * x + number(y * y + z * z)).sqrt();
                    let left = number(HYDROPHOBIC_FAR + radius + radii[atom]) - distance;
                    *total += left.max(number(0.0)).min(number(width)) * number(-HYDROPHOBIC_DEPTH / width);
                }
            });
        }
    }

    #[inline(always)]
    fn potential<S: Simd>(&self, simd: S, sum: &PairSum, field: &CoulombField, from: Point) -> f64x8<S> {
        let number = |value: f64| f64x8::splat(simd, value);
        let xs = self.xs(simd, from);
        let [at_x, at_y, at_z] = &field.cells.at;
        let mut total = number(0.0);
        field.cells.runs(from, self.spacing * 7.0, sum.cutoff, |run| {
            for atom in run {
                let x = xs - number(at_x[atom]);
                let (y, z) = (from.y - at_y[atom], from.z - at_z[atom]);
                let squared = (x * x + number(y * y + z * z)).max(number(NEAREST_SQUARED));
                let (factor, _) = sum.switch.at_eight(simd, squared);
                total += number(field.strengths[atom]) / squared * factor;
            }
        });
        total
    }
}
