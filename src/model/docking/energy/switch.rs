//! How terms end at the cut-off, and how near two atoms may be.

use super::spec::SWITCH_WIDTH;
use fearless_simd::f64x8;
use fearless_simd::prelude::*;

/// The least squared distance in Å²: atoms that are nearer count as 0.1 Å apart, so that every energy is a finite number.
pub(super) const NEAREST_SQUARED: f64 = 0.01;

/// CHARMM's switching function of the squared distance x: 1 up to the inner radius, 0 from the cut-off on, and between
/// them (c − x)² (c + 2x − 3i) / (c − i)³ with c and i the squares of cut-off and inner radius. Energies have a continuous
/// slope at both ends.
///
/// B. R. Brooks et al., "CHARMM: A program for macromolecular energy, minimization, and dynamics calculations", J. Comput.
/// Chem. 4 (1983) 187-217.
#[derive(Clone, Copy, Debug)]
pub(super) struct Switch {
    /// The square of the distance in Å from which on terms are switched off.
    inner: f64,
    /// The square of the cut-off in Å.
    outer: f64,
    /// 1 / (outer − inner)³, in Å⁻⁶.
    scale: f64,
}

impl Switch {
    /// Of a cut-off in Å.
    pub fn new(cutoff: f64) -> Switch {
        let start = cutoff - SWITCH_WIDTH;
        let (inner, outer) = (start * start, cutoff * cutoff);
        let width = outer - inner;
        Switch { inner, outer, scale: 1.0 / (width * width * width) }
    }

    /// The factor at a squared distance in Å², and its derivative by the squared distance.
    pub fn at(&self, squared: f64) -> (f64, f64) {
        let x = squared.max(self.inner).min(self.outer);
        let (to_outer, to_inner) = (self.outer - x, x - self.inner);
        let value = to_outer * to_outer * (to_outer + 3.0 * to_inner) * self.scale;
        (value, -6.0 * to_outer * to_inner * self.scale)
    }

    /// The same of eight squared distances at once, to the same bits.
    #[inline(always)]
    pub fn at_eight<S: Simd>(&self, simd: S, squared: f64x8<S>) -> (f64x8<S>, f64x8<S>) {
        let number = |value: f64| f64x8::splat(simd, value);
        let x = squared.max(number(self.inner)).min(number(self.outer));
        let (to_outer, to_inner) = (number(self.outer) - x, x - number(self.inner));
        let value = to_outer * to_outer * (to_outer + number(3.0) * to_inner) * number(self.scale);
        (value, number(-6.0) * to_outer * to_inner * number(self.scale))
    }
}
