//! The one arithmetic: transcendental functions whose bits do not depend on the machine.
//!
//! Everything else in the library uses `+ - * /`, `sqrt`, `floor` and comparisons, which IEEE 754
//! defines to the last bit. The platform's `sin`, `cos`, … differ between C libraries in the last
//! bit of up to 14 % of values, so this module, over the `libm` crate, is their only door
//! (`clippy.toml` forbids the others).

use fearless_simd::prelude::*;
use fearless_simd::{f64x8, u64x8};
use std::f64::consts::{FRAC_2_PI, PI};

/// One full turn, in radians.
pub const TURN: f64 = 2.0 * PI;

/// The largest angle, in radians, from which whole turns are subtracted: about 167 000 turns.
const WRAPPED_BY_TURNS: f64 = 1_048_576.0;

/// Sine of an angle in radians.
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine of an angle in radians.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Arc cosine in radians, in `[0, π]`; the argument is clamped to `[-1, 1]`.
pub fn acos(x: f64) -> f64 {
    libm::acos(x.clamp(-1.0, 1.0))
}

/// Exponential.
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Natural logarithm of the gamma function, of a positive number.
pub fn ln_gamma(x: f64) -> f64 {
    libm::lgamma(x)
}

/// Complementary error function, 1 − erf(x).
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// Angle of the vector `(x, y)` in radians, in `[-π, π]`.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// The largest angle, in radians, that [`sin_cos`] takes.
pub(crate) const SIN_COS_WITHIN: f64 = 2048.0;

/// Sines and cosines of eight angles in radians at once, for angles of at most [`SIN_COS_WITHIN`]; beyond, and for what is
/// no number, they are any numbers. The same bits with any lanes; other bits than [`sin`] and [`cos`] give, in the
/// last place. Eight, where processors do four at once, so that they need not wait for one result before the next.
///
/// The angle is n π/2 + r with |r| ≤ π/4 (and a little). π/2 is taken off in two parts: the first has 41 bits, so that n times
/// it is exact, n having at most 12; its difference to the angle is exact too. The second is rounded where it cannot be
/// seen. So r is rounded once. Then sine and cosine of r are the polynomials of FreeBSD's msun (k_sin.c, k_cos.c: minimax
/// over |r| ≤ π/4, off by less than 2⁻⁵⁸), and n says which of the two, and which sign. The error is below 1 unit in the last
/// place, and below 2⁻⁹⁰ n near zeros, where units are smaller than that.
#[inline(always)]
pub(crate) fn sin_cos<S: Simd>(simd: S, angle: f64x8<S>) -> (f64x8<S>, f64x8<S>) {
    // Added to a small number, this puts the nearest integer into the last bits.
    const LAST_BITS: f64 = 6_755_399_441_055_744.0;
    const HALF_PI_FIRST: f64 = 1.570_796_326_794_152_3;
    const HALF_PI_REST: f64 = 7.443_547_480_486_623e-13;
    let number = |value: f64| f64x8::splat(simd, value);

    let shifted = angle * number(FRAC_2_PI) + number(LAST_BITS);
    let n = shifted - number(LAST_BITS);
    let r = (angle - n * number(HALF_PI_FIRST)) - n * number(HALF_PI_REST);

    let z = r * r;
    let s = number(1.589_690_995_211_55e-10);
    let s = s * z + number(-2.505_076_025_340_686_3e-8);
    let s = s * z + number(2.755_731_370_707_006_8e-6);
    let s = s * z + number(-0.000_198_412_698_298_579_5);
    let s = s * z + number(0.008_333_333_333_322_49);
    let s = s * z + number(-0.166_666_666_666_666_32);
    let sine = r + (z * r) * s;

    let c = number(-1.135_964_755_778_819_5e-11);
    let c = c * z + number(2.087_572_321_298_175e-9);
    let c = c * z + number(-2.755_731_435_139_066_3e-7);
    let c = c * z + number(2.480_158_728_947_673e-5);
    let c = c * z + number(-0.001_388_888_888_887_411);
    let c = c * z + number(0.041_666_666_666_666_6);
    // 1 − z/2 is rounded; what was lost comes back.
    let half = z * number(0.5);
    let most = number(1.0) - half;
    let cosine = most + (((number(1.0) - most) - half) + (z * z) * c);

    let quarter = shifted.to_bits();
    let one = u64x8::splat(simd, 1);
    let two = u64x8::splat(simd, 2);
    let is_odd = (quarter & one).simd_eq(one);
    let sine_sign = (quarter & two) << 62;
    let cosine_sign = ((quarter + one) & two) << 62;
    let sines = f64x8::from_bits(is_odd.select(cosine, sine).to_bits() ^ sine_sign);
    let cosines = f64x8::from_bits(is_odd.select(sine, cosine).to_bits() ^ cosine_sign);
    (sines, cosines)
}

/// The same angle in `[-π, π)`.
pub fn wrap_angle(angle: f64) -> f64 {
    if (-PI..PI).contains(&angle) {
        return angle;
    }
    // The floating-point number nearest to a turn is none, by 2e-16; over many turns that adds up. The reduction of
    // sines is exact.
    if angle.abs() > WRAPPED_BY_TURNS {
        let direction = atan2(sin(angle), cos(angle));
        return if direction >= PI { -PI } else { direction };
    }
    let wrapped = angle - TURN * ((angle + PI) / TURN).floor();
    // The subtraction may round on to the open end.
    if wrapped >= PI { -PI } else { wrapped }
}

/// Size of the shortest turn between two angles in `[-π, π)`; symmetric to the bit.
pub fn angle_between(a: f64, b: f64) -> f64 {
    let difference = (a - b).abs();
    if difference > PI { (TURN - difference).max(0.0) } else { difference }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Lanes, with_lanes};
    use fearless_simd::Fallback;
    use proptest::prelude::*;

    #[test]
    fn very_many_turns_are_taken_off_exactly() {
        // 10¹⁶ less 1 591 549 430 918 953 turns, computed with a hundred digits.
        assert!((wrap_angle(1e16) - 2.247_425_249_162_367).abs() < 1e-12, "{}", wrap_angle(1e16));
        assert!(
            (-PI..PI).contains(&wrap_angle(f64::MAX)) && (-PI..PI).contains(&wrap_angle(f64::MIN))
        );
    }

    #[test]
    fn sines_in_lanes_are_those_of_libm_but_for_a_last_bit_and_the_same_in_all_lanes() {
        let units = |value: f64, exact: f64| (value - exact).abs() / (exact.abs() * f64::EPSILON);
        let mut worst = 0.0f64;
        let mut look = |angle: f64| {
            let plain = Fallback::new();
            let (sine, cosine) = sin_cos(plain, f64x8::splat(plain, angle));
            let (sine, cosine) = (sine[0], cosine[0]);
            // Near zeros the error is in units of numbers that are not as small.
            for (value, exact) in [(sine, sin(angle)), (cosine, cos(angle))] {
                assert!((value - exact).abs() < 1.3e-16, "{angle}: {value}, {exact}");
                if exact.abs() > 1e-6 {
                    worst = worst.max(units(value, exact));
                }
            }
            for lanes in Lanes::all() {
                with_lanes!(lanes, simd => {
                    let angles = [0.1, angle, 0.2, 0.3, 0.4, 0.5, angle, 0.6];
                    let angles = f64x8::load_array(simd, angles);
                    let (sines, cosines) = sin_cos(simd, angles);
                    assert_eq!(sines[1].to_bits(), sine.to_bits(), "{lanes:?}");
                    assert_eq!(cosines[6].to_bits(), cosine.to_bits(), "{lanes:?}");
                });
            }
        };
        for step in -40_000..=40_000 {
            let step = f64::from(step);
            look(step * 1e-3);
            look(step * 0.051_199);
            look(step / 40.0 * std::f64::consts::FRAC_PI_4);
            look(step * 1e-13);
        }
        assert!(worst < 1.0, "{worst} units");
        println!("at most {worst} units in the last place from libm");
    }

    proptest! {
        #[test]
        fn wrapped_angles_lie_in_range_and_name_the_same_direction(angle in -1e6f64..1e6) {
            let wrapped = wrap_angle(angle);
            prop_assert!((-PI..PI).contains(&wrapped));
            prop_assert!((sin(wrapped) - sin(angle)).abs() < 1e-9);
            prop_assert!((cos(wrapped) - cos(angle)).abs() < 1e-9);
        }

        #[test]
        fn angles_of_any_size_lie_in_range_and_name_the_same_direction(exponent in -10f64..308.0, sign in any::<bool>()) {
            let angle = if sign { exp(exponent * std::f64::consts::LN_10) } else { -exp(exponent * 2.3) };
            prop_assert!(angle.is_finite());
            let wrapped = wrap_angle(angle);
            prop_assert!((-PI..PI).contains(&wrapped), "{} {}", angle, wrapped);
            prop_assert!((sin(wrapped) - sin(angle)).abs() < 1e-9);
            prop_assert!((cos(wrapped) - cos(angle)).abs() < 1e-9);
        }

        #[test]
        fn the_angle_between_is_symmetric_to_the_bit(a in -PI..PI, b in -PI..PI) {
            prop_assert_eq!(angle_between(a, b).to_bits(), angle_between(b, a).to_bits());
            prop_assert!(angle_between(a, b) <= PI);
        }
    }
}
