//! Rotations and poses as foreign files write them.

use crate::math;
use crate::scene::Pose;
use crate::space::canonical;
use std::f64::consts::PI;

/// The unit quaternion of the rotation about a unit axis by twice `half`, in radians.
fn about(axis: [f64; 3], half: f64) -> [f64; 4] {
    let (sine, cosine) = (math::sin(half), math::cos(half));
    [cosine, axis[0] * sine, axis[1] * sine, axis[2] * sine]
}

/// The rotation by an angle in radians about an axis of any length but zero; `None` for that.
pub(super) fn turn(axis: [f64; 3], angle: f64) -> Option<[f64; 4]> {
    let length = axis.iter().map(|value| value * value).sum::<f64>().sqrt();
    if !(length.is_finite() && length > 1e-100) {
        return None;
    }
    canonical(about(axis.map(|value| value / length), angle / 2.0))
}

/// Rz(z)·Ry(y)·Rx(x), the angles in half turns (fractions of π).
pub(super) fn euler(half_turns: [f64; 3]) -> [f64; 4] {
    by_halves(half_turns.map(|angle| angle * PI / 2.0))
}

/// Rz(yaw)·Ry(pitch)·Rx(roll), the angles in radians.
pub(super) fn roll_pitch_yaw(angles: [f64; 3]) -> [f64; 4] {
    by_halves(angles.map(|angle| angle / 2.0))
}

/// Rz·Ry·Rx by twice these angles in radians.
fn by_halves([x, y, z]: [f64; 3]) -> [f64; 4] {
    let about_x = about([1.0, 0.0, 0.0], x);
    let about_y = about([0.0, 1.0, 0.0], y);
    let about_z = about([0.0, 0.0, 1.0], z);
    unit(times(about_z, times(about_y, about_x)))
}

/// The pose that acts as `b` first and `a` after it: frame 3 in frame 1 from 2 in 1 and 3 in 2.
pub(super) fn compose(a: &Pose, b: &Pose) -> Pose {
    let moved = a.apply(b.translation);
    Pose { translation: moved, rotation: unit(times(a.rotation, b.rotation)) }
}

fn times(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

fn unit(quaternion: [f64; 4]) -> [f64; 4] {
    canonical(quaternion).unwrap_or(Pose::IDENTITY.rotation)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(found: [f64; 3], expected: [f64; 3]) {
        assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-12), "{found:?} {expected:?}");
    }

    #[test]
    fn euler_turns_about_x_first_and_about_z_last() {
        let turned = |half_turns| Pose { rotation: euler(half_turns), ..Pose::IDENTITY };
        assert_near(turned([0.5, 0.0, 0.0]).apply([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_near(turned([0.0, 0.5, 0.0]).apply([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
        assert_near(turned([0.0, 0.0, 0.5]).apply([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        // y → z by the turn about x, which the turn about z leaves alone.
        assert_near(turned([0.5, 0.0, 0.5]).apply([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        // y → z → x → y
        assert_near(turned([0.5, 0.5, 0.5]).apply([0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn composed_poses_act_one_after_the_other() {
        let a = Pose { translation: [1.0, 2.0, 3.0], rotation: euler([0.3, -0.2, 0.7]) };
        let b = Pose { translation: [-4.0, 0.5, 0.0], rotation: euler([-0.9, 0.1, 0.4]) };
        let point = [0.3, -7.0, 2.0];
        assert_near(compose(&a, &b).apply(point), a.apply(b.apply(point)));
        assert_eq!(turn([0.0; 3], 1.0), None);
        assert_eq!(turn([0.0, 0.0, 2.0], 0.5 * PI).unwrap()[3], math::sin(PI / 4.0));
    }
}
