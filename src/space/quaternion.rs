//! Unit quaternions `w x y z`.

use crate::math;

/// The rotation, in stored form, that three numbers in `[0, 1]` stand for: where they are uniform, so
/// is the rotation on SO(3) (K. Shoemake, *Uniform random rotations*, Graphics Gems III, 1992).
pub(super) fn rotation_of([share, first, second]: [f64; 3]) -> [f64; 4] {
    let (first, second) = (math::TURN * first, math::TURN * second);
    let (low, high) = ((1.0 - share).sqrt(), share.sqrt());
    let quaternion = [
        high * math::cos(second),
        low * math::sin(first),
        low * math::cos(first),
        high * math::sin(second),
    ];
    canonical(quaternion).unwrap_or([1.0, 0.0, 0.0, 0.0])
}

/// The same rotation with unit length and the first non-zero value positive; `None` where the
/// values are too small or too large to have a direction.
pub fn canonical(quaternion: [f64; 4]) -> Option<[f64; 4]> {
    let largest = quaternion.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    if !(1e-150..=1e150).contains(&largest) {
        return None;
    }
    let scaled = quaternion.map(|value| value / largest);
    let length = scaled.iter().map(|value| value * value).sum::<f64>().sqrt();
    let sign = match scaled.iter().find(|value| **value != 0.0) {
        Some(first) if *first < 0.0 => -1.0,
        _ => 1.0,
    };
    Some(scaled.map(|value| value / length * sign + 0.0))
}

/// [`canonical`], except that a quaternion that has this form up to rounding is returned unchanged, so that one that
/// is written out and read again stays the same to the bit.
pub fn stored_form(quaternion: [f64; 4]) -> Option<[f64; 4]> {
    let stored = canonical(quaternion)?;
    let same = (0..4).all(|i| (stored[i] - quaternion[i]).abs() <= 2.0 * f64::EPSILON);
    Some(if same { quaternion.map(|value| value + 0.0) } else { stored })
}

/// The rotation turned by a rotation vector (its direction the axis, its length the angle in radians),
/// in stored form.
pub(super) fn turned(from: [f64; 4], by: [f64; 3]) -> [f64; 4] {
    let angle = by.iter().map(|value| value * value).sum::<f64>().sqrt();
    if angle == 0.0 {
        return from;
    }
    let share = math::sin(angle / 2.0) / angle;
    let [a, b, c, d] = from;
    let [w, x, y, z] = [math::cos(angle / 2.0), by[0] * share, by[1] * share, by[2] * share];
    let product = [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ];
    canonical(product).unwrap_or(from)
}

/// The rotation vector by which `from` is to be [`turned`] to become `to`, by the shorter way: its direction the axis, its
/// length the angle in radians, at most π. Both quaternions have unit length.
pub(super) fn rotation_vector(from: [f64; 4], to: [f64; 4]) -> [f64; 3] {
    // The product of the inverse of `from`, which is its conjugate, and `to`.
    let ([a, b, c, d], [w, x, y, z]) = (from, to);
    let cosine = a * w + b * x + c * y + d * z;
    let axis = [
        a * x - b * w - c * z + d * y,
        a * y + b * z - c * w - d * x,
        a * z - b * y + c * x - d * w,
    ];
    let sine = axis.iter().map(|value| value * value).sum::<f64>().sqrt();
    if sine == 0.0 {
        return [0.0; 3];
    }
    let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
    let angle = 2.0 * math::atan2(sine, cosine.abs());
    axis.map(|value| value * sign * (angle / sine))
}

/// Spherical linear interpolation along the shorter arc; turns `to` around only when the dot
/// product is negative.
pub fn slerp(from: [f64; 4], to: [f64; 4], t: f64) -> [f64; 4] {
    Slerp::new(from, to).at(t)
}

/// [`slerp`] prepared for many values of `t`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slerp {
    from: [f64; 4],
    to: [f64; 4],
    sign: f64,
    angle: f64,
    sine: f64,
}

impl Slerp {
    pub(crate) fn new(from: [f64; 4], to: [f64; 4]) -> Slerp {
        let mut dot = 0.0;
        for (a, b) in from.iter().zip(&to) {
            dot += a * b;
        }
        let sign = if dot < 0.0 { -1.0 } else { 1.0 };
        let angle = math::acos(dot.abs());
        Slerp { from, to, sign, angle, sine: math::sin(angle) }
    }

    pub(crate) fn at(&self, t: f64) -> [f64; 4] {
        let Slerp { from, to, sign, angle, sine } = *self;
        let (weight_from, weight_to) = if angle < 1e-6 {
            (1.0 - t, t)
        } else {
            (math::sin((1.0 - t) * angle) / sine, math::sin(t * angle) / sine)
        };
        let mut between = [0.0; 4];
        for (value, (a, b)) in between.iter_mut().zip(from.iter().zip(&to)) {
            *value = a * weight_from + b * sign * weight_to;
        }
        // The sign is left as it is, so that the quaternion changes continuously along the motion.
        let length = between.iter().map(|value| value * value).sum::<f64>().sqrt();
        between.map(|value| value / length)
    }
}
