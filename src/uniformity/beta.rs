//! The incomplete beta function, of which the tails of the F distribution are values.

use crate::math;

/// The most terms of the continued fraction; a few dozen are needed.
const TERMS: u32 = 10_000;
/// The relative change of the last term.
const FINE: f64 = 1e-14;
/// In the place of a denominator that is 0.
const TINY: f64 = 1e-300;

/// The regularized incomplete beta function I_x(a, b) for x in [0, 1] and positive a and b: relative error about 1e-12, where a and b are at
/// most a few thousand. By its continued fraction (NIST Digital Library of Mathematical Functions, 8.17.22), evaluated by the method of Lentz.
pub(super) fn regularized(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    // The fraction converges fast below the mean.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - regularized(1.0 - x, b, a);
    }
    let log = a * math::ln(x) + b * math::ln(1.0 - x) - math::ln(a);
    let front = math::exp(log + math::ln_gamma(a + b) - math::ln_gamma(a) - math::ln_gamma(b));
    let not_zero = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / not_zero(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for term in 1..=TERMS {
        let m = f64::from(term);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let before = fraction;
        for share in [even, odd] {
            d = 1.0 / not_zero(1.0 + share * d);
            c = not_zero(1.0 + share / c);
            fraction *= c * d;
        }
        if (fraction - before).abs() <= FINE * fraction.abs() {
            break;
        }
    }
    front * fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_closed_forms_and_tables() {
        // I_x(1, b) = 1 − (1 − x)^b, I_x(a, 1) = x^a, I_x(1/2, 1/2) = 2 asin(√x) / π.
        for x in [0.01, 0.2, 0.5, 0.77, 0.999] {
            let powers = [(1.0, 3.0, 1.0 - (1.0 - x) * (1.0 - x) * (1.0 - x)), (2.0, 1.0, x * x)];
            for (a, b, expected) in powers {
                let found = regularized(x, a, b);
                assert!((found - expected).abs() < 1e-12, "I_{x}({a}, {b}) = {found}");
            }
            let arc = math::atan2(x.sqrt(), (1.0 - x).sqrt()) / std::f64::consts::FRAC_PI_2;
            assert!((regularized(x, 0.5, 0.5) - arc).abs() < 1e-12);
        }
        // Where the upper 5 % of F(1, 10) and of F(10, 10) begin, from tables.
        let upper = |f: f64, p: f64, q: f64| regularized(q / (q + p * f), q / 2.0, p / 2.0);
        assert!((upper(4.964_603, 1.0, 10.0) - 0.05).abs() < 1e-6);
        assert!((upper(2.978_237, 10.0, 10.0) - 0.05).abs() < 1e-6);
        assert_eq!((regularized(0.0, 2.0, 3.0), regularized(1.0, 2.0, 3.0)), (0.0, 1.0));
    }
}
