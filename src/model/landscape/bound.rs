//! The highest energy along a straight motion, from above.
//!
//! Along a motion, at the time t in [0, 1], the exponent of every term is a polynomial of degree two in t, so
//! its least and largest values over an interval are known exactly, and with them bounds on the term
//! and on its derivative. Where the derivative of the sum has one sign the highest energy is at an end of the
//! interval; elsewhere the sum is at most its value in the middle and half the interval's length times the
//! largest slope. The interval with the highest bound is halved until that bound is within the tolerance of an
//! energy that occurs: a branch and bound search, as interval arithmetic uses it (R. E. Moore, *Interval
//! Analysis*, 1966).

use super::energy::Term;
use crate::math;

/// More halvings would tell times apart that rounding does not.
const HALVINGS_MAX: u32 = 50;
/// Relative rounding error of a term, of its exponent with the polynomial's coefficients, and of the sum, in
/// units of the term's largest value: generous, see [`Along::range`].
const ROUNDING: f64 = 1e-13;

/// An interval of times, with a bound on the energies in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    from: f64,
    to: f64,
    halvings: u32,
    above: f64,
    /// By how much rounding may have moved the bound.
    rounding: f64,
}

impl Interval {
    /// One that could mislead.
    pub fn rubbish(rubbish: u64) -> Interval {
        Interval {
            from: rubbish as f64,
            to: f64::NAN,
            halvings: 7,
            above: f64::INFINITY,
            rounding: f64::NAN,
        }
    }
}

/// A number that no energy on the way from one end to the other exceeds, and that is at most `tolerance` and
/// three times the rounding above the highest of them. `open` is memory.
pub(super) fn peak(
    terms: &[Term],
    ends: [[f64; 2]; 2],
    tolerance: f64,
    open: &mut Vec<Interval>,
) -> f64 {
    let (mut below, mut above) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    let along = Along { terms, ends };
    open.clear();
    open.push(along.bounded(0.0, 1.0, 0, &mut below));
    while let Some(interval) = open.pop() {
        // The energy is known to reach `below`. Both bounds give way to rounding, so no halving brings them nearer
        // to each other than twice that.
        let near = tolerance + 2.0 * interval.rounding;
        if interval.above <= below + near || interval.halvings == HALVINGS_MAX {
            above = above.max(interval.above);
            continue;
        }
        let middle = (interval.from + interval.to) / 2.0;
        let halves = [(interval.from, middle), (middle, interval.to)];
        let mut halves =
            halves.map(|(from, to)| along.bounded(from, to, interval.halvings + 1, &mut below));
        // The more promising half on top, so that `below` rises soon.
        if halves[0].above > halves[1].above {
            halves.swap(0, 1);
        }
        open.extend(halves);
    }
    above
}

struct Along<'a> {
    terms: &'a [Term],
    ends: [[f64; 2]; 2],
}

/// What a sum of terms comes to over an interval.
#[derive(Default)]
struct Range {
    /// The largest value, bounded term by term.
    above: f64,
    /// Bounds on the derivative.
    slope: [f64; 2],
    /// The sum of the terms' largest sizes, by which rounding is measured.
    size: f64,
}

impl Along<'_> {
    fn energy(&self, t: f64) -> f64 {
        let [a, b] = self.ends;
        super::energy::energy(self.terms, [0, 1].map(|i| a[i] + t * (b[i] - a[i])))
    }

    /// An interval with its bound; `below` rises to the energies that are looked at.
    fn bounded(&self, from: f64, to: f64, halvings: u32, below: &mut f64) -> Interval {
        let Range { above, slope: [least, largest], size } = self.range(from, to);
        let ends = self.energy(from).max(self.energy(to));
        let mut highest = ends;
        let bound = if least >= 0.0 || largest <= 0.0 {
            ends
        } else {
            let middle = self.energy((from + to) / 2.0);
            highest = highest.max(middle);
            above.min(middle + (to - from) / 2.0 * largest.max(-least))
        };
        let rounding = ROUNDING * size;
        *below = below.max(highest - rounding);
        Interval { from, to, halvings, above: bound + rounding, rounding }
    }

    /// Bounds over the times from `from` to `to`.
    ///
    /// The exponent is c₂ t² + c₁ t + c₀; with |c₀|, |c₁|, |c₂| at most some hundreds (`resolve.rs` bounds
    /// exponents) its rounding error is some 10⁻¹³ at most, which is the term's relative error. Sizes
    /// take it into account by the factor 1 + |exponent|.
    fn range(&self, from: f64, to: f64) -> Range {
        let mut range = Range::default();
        let [a, b] = self.ends;
        for term in self.terms {
            let (du, dv) = (b[0] - a[0], b[1] - a[1]);
            let (u, v) = (a[0] - term.centre[0], a[1] - term.centre[1]);
            let c2 = term.xx * du * du + term.xy * du * dv + term.yy * dv * dv;
            let c1 = 2.0 * term.xx * u * du + term.xy * (u * dv + v * du) + 2.0 * term.yy * v * dv;
            let c0 = term.xx * u * u + term.xy * u * v + term.yy * v * v;
            let exponent = |t: f64| (c2 * t + c1) * t + c0;
            let (mut low, mut high) = (exponent(from), exponent(to));
            if low > high {
                std::mem::swap(&mut low, &mut high);
            }
            // Where the exponent turns.
            let turn = -c1 / (2.0 * c2);
            if turn > from && turn < to {
                let there = exponent(turn);
                low = low.min(there);
                high = high.max(there);
            }
            let sizes = [math::exp(low), math::exp(high)];
            let values = sizes.map(|size| term.height * size);
            range.above += values[0].max(values[1]);
            // The derivative of the exponent is linear.
            let slopes = [2.0 * c2 * from + c1, 2.0 * c2 * to + c1];
            let products = values.map(|value| slopes.map(|slope| value * slope));
            let all = [products[0][0], products[0][1], products[1][0], products[1][1]];
            range.slope[0] += all.into_iter().fold(f64::INFINITY, f64::min);
            range.slope[1] += all.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let exponents = 1.0 + low.abs().max(high.abs()) + c0.abs() + c1.abs() + c2.abs();
            range.size += term.height.abs() * sizes[1] * exponents;
            let slope_rounding = ROUNDING
                * term.height.abs()
                * sizes[1]
                * exponents
                * (1.0 + slopes[0].abs().max(slopes[1].abs()));
            range.slope[0] -= slope_rounding;
            range.slope[1] += slope_rounding;
        }
        range
    }
}
