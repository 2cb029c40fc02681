//! The one arithmetic: transcendental functions whose bits do not depend on the machine.
//!
//! Everything else in the library uses `+ - * /`, `sqrt`, `floor` and comparisons, which IEEE 754
//! defines to the last bit. The platform's `sin`, `cos`, … differ between C libraries in the last
//! bit of up to 14 % of values, so this module, over the `libm` crate, is their only door
//! (`clippy.toml` forbids the others).

use std::f64::consts::PI;

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

/// Angle of the vector `(x, y)` in radians, in `[-π, π]`.
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
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
    use proptest::prelude::*;

    #[test]
    fn very_many_turns_are_taken_off_exactly() {
        // 10¹⁶ less 1 591 549 430 918 953 turns, computed with a hundred digits.
        assert!((wrap_angle(1e16) - 2.247_425_249_162_367).abs() < 1e-12, "{}", wrap_angle(1e16));
        assert!(
            (-PI..PI).contains(&wrap_angle(f64::MAX)) && (-PI..PI).contains(&wrap_angle(f64::MIN))
        );
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
