//! Boxes in single precision, for tests that only say where to look closer: four lanes to an operation, which
//! hold the three axes of a box.
//!
//! Rounding never makes two boxes seem apart that are not. Let S be the largest coordinate, ε = 2⁻²⁴. The vector
//! between the centres is off by at most 19 ε S along any axis, and its product with an axis by 24 ε S more; a
//! box reaches at most √3 S along an axis, and what is reckoned of that is off by 35 ε S. [`grain`], 128 ε S, is
//! added to every reach.

use super::obb::{Obb, Placed};
use parry3d_f64::math::Vector;
use wide::f32x4;

/// Larger coordinates are not told apart.
const FAR: f64 = 1e29;

/// What outweighs the rounding of tests in single precision, coordinates being at most `scale`.
pub(super) fn grain(scale: f64) -> f32 {
    if scale < FAR { (scale / f64::from(1 << 17)).max(1e-36) as f32 } else { 1e38 }
}

/// A length, rounded upwards.
pub(super) fn above(length: f64) -> f32 {
    (length * (1.0 + 1e-6)) as f32
}

/// Three axes, one to a lane: their first coordinates, their second ones, their third ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes([f32x4; 3]);

/// The same number in every lane, of each of three coordinates.
pub(super) type Each = [f32x4; 3];

impl Axes {
    #[inline(always)]
    fn new([a, b, c]: [[f32; 3]; 3]) -> Axes {
        Axes([0, 1, 2].map(|k| f32x4::from([a[k], b[k], c[k], 0.0])))
    }

    /// The products with one vector.
    #[inline(always)]
    pub fn dot(&self, v: &Each) -> f32x4 {
        self.0[0] * v[0] + self.0[1] * v[1] + self.0[2] * v[2]
    }
}

#[inline(always)]
fn each(v: [f32; 3]) -> Each {
    v.map(f32x4::splat)
}

#[inline(always)]
fn single(v: Vector) -> [f32; 3] {
    v.to_array().map(|x| x as f32)
}

/// The sum of the first three lanes.
#[inline(always)]
fn sum(v: f32x4) -> f32 {
    let [x, y, z, _] = v.to_array();
    x + y + z
}

/// A box that stands still.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightBox {
    centre: f32x4,
    pub axes: Axes,
    pub half: f32x4,
    /// Its last axis.
    long: [f32; 3],
}

impl LightBox {
    pub fn new(space: &Obb) -> LightBox {
        let [x, y, z] = space.half.to_array().map(|half| above(half.min(FAR)));
        let axes = space.axes.map(single);
        LightBox {
            centre: centre(space.centre),
            axes: Axes::new(axes),
            half: f32x4::from([x, y, z, 0.0]),
            long: axes[2],
        }
    }

    /// Half its sides.
    #[inline(always)]
    pub fn sides(&self) -> Each {
        let [x, y, z, _] = self.half.to_array();
        each([x, y, z])
    }
}

#[inline(always)]
fn centre(at: Vector) -> f32x4 {
    let far = Vector::splat(FAR);
    let [x, y, z] = single(at.clamp(-far, far));
    f32x4::from([x, y, z, 0.0])
}

/// A point that moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightPoint(f32x4);

impl LightPoint {
    #[inline]
    pub fn new(at: Vector) -> LightPoint {
        LightPoint(centre(at))
    }

    /// How a ball around it lies to a box, along the axes of the box.
    #[inline(always)]
    pub fn gaps(&self, still: &LightBox, room: f32x4) -> Gaps {
        Gaps::new(room, still.axes.dot(&between(self.0, still)))
    }
}

/// From a centre to that of a box.
#[inline(always)]
fn between(from: f32x4, still: &LightBox) -> Each {
    let [x, y, z, _] = (still.centre - from).to_array();
    each([x, y, z])
}

/// A box that moves, at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    centre: f32x4,
    axes: Axes,
    each: [Each; 3],
    long: [f32; 3],
}

/// How a box that moves lies to one that stands still.
pub(super) struct Across {
    between: Each,
    /// How much of each of its own axes lies along those of the other.
    turns: [f32x4; 3],
}

impl Stand {
    #[inline]
    pub fn new(Placed { centre: at, axes }: &Placed) -> Stand {
        let axes = axes.map(single);
        let long = axes[2];
        Stand { centre: centre(*at), axes: Axes::new(axes), each: axes.map(each), long }
    }

    #[inline(always)]
    pub fn across(&self, still: &LightBox) -> Across {
        let between = between(self.centre, still);
        Across { between, turns: self.each.map(|axis| still.axes.dot(&axis).abs()) }
    }

    /// Along the axes of what stands still; `own` are the sides of the box, `room` what else it may reach.
    #[inline(always)]
    pub fn along_still(&self, still: &LightBox, across: &Across, own: &Each, room: f32x4) -> Gaps {
        let [x, y, z] = &across.turns;
        let reach = room + still.half + *x * own[0] + *y * own[1] + *z * own[2];
        Gaps::new(reach, still.axes.dot(&across.between))
    }

    /// Along the box's own axes; `own` are its sides.
    #[inline(always)]
    pub fn along_own(&self, still: &LightBox, across: &Across, own: f32x4, room: f32x4) -> Gaps {
        let [x, y, z] = across.turns.map(|turn| turn * still.half);
        let [x, y, z, _] = f32x4::transpose([x, y, z, f32x4::ZERO]);
        Gaps::new(room + own + x + y + z, self.axes.dot(&across.between))
    }
}

impl Stand {
    /// Whether the box, `own` as it is in its own frame, may come within `room` of another.
    #[inline]
    pub fn may_meet(&self, own: &LightBox, still: &LightBox, room: f32) -> bool {
        let (across, room) = (self.across(still), f32x4::splat(room));
        !self.along_still(still, &across, &own.sides(), room).apart()
            && !self.along_own(still, &across, own.half, room).apart()
    }
}

/// At either end, along the product of the longest axes, which tells crossing boxes apart; `None` where they
/// are parallel.
#[inline]
pub(super) fn crossing(
    stands: &[Stand; 2],
    still: &LightBox,
    across: [&Across; 2],
    own: f32x4,
    room: f32,
) -> Option<[Gaps; 2]> {
    let ([a, b, c], [first, last]) = (still.long, stands.each_ref().map(|stand| stand.long));
    let [x, y, z] = [0, 1, 2].map(|k| first[k] + last[k]);
    let axis = [b * z - c * y, c * x - a * z, a * y - b * x];
    let square = axis.iter().map(|x| x * x).sum::<f32>();
    if square <= 1e-6 {
        return None;
    }
    let axis = each(axis);
    let room = room * square.sqrt() + sum(still.axes.dot(&axis).abs() * still.half);
    let gaps = |stand: &Stand, across: &Across| {
        let reach = room + sum(stand.axes.dot(&axis).abs() * own);
        let [x, y, z] = [0, 1, 2].map(|k| across.between[k] * axis[k]);
        Gaps::new(f32x4::splat(reach), x + y + z)
    };
    Some([gaps(&stands[0], across[0]), gaps(&stands[1], across[1])])
}

/// By how much two bodies overlap from either side, along an axis in each lane; negative where they are apart.
#[derive(Clone, Copy)]
pub(super) struct Gaps(pub [f32x4; 2]);

impl Gaps {
    #[inline(always)]
    fn new(reach: f32x4, apart: f32x4) -> Gaps {
        Gaps([reach - apart, reach + apart])
    }

    /// Whether they are apart along some axis.
    #[inline(always)]
    pub fn apart(&self) -> bool {
        (self.0[0] | self.0[1]).to_bitmask() != 0
    }

    /// Whether they are so at both of two times, from the same side.
    #[inline(always)]
    pub fn both_apart(&self, other: &Gaps) -> bool {
        (self.0[0] & other.0[0] | self.0[1] & other.0[1]).to_bitmask() != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use crate::robot::rates_tests::drawn_pose;
    use crate::seed::{Purpose, Seed, Stream};
    use crate::validity::frame::Frame;
    use proptest::prelude::*;

    fn drawn(stream: &mut Stream, size: f64) -> (Obb, Frame) {
        let frame = Frame::of(&drawn_pose(stream, 1.0).to_parry());
        let turn = frame.turn;
        let half = Vector::new(0.01 + stream.unit(), 0.01 + stream.unit(), 1e-9) * size;
        let centre = frame.shift * size;
        let axes = [turn.x_axis, turn.y_axis, turn.z_axis];
        let frame = Frame::of(&drawn_pose(stream, 1.0).to_parry());
        (Obb { centre, axes, half, radius: half.length() }, frame)
    }

    proptest! {
        /// A corner of one is put onto a corner of the other.
        #[test]
        fn boxes_that_touch_are_never_told_apart(ordinal in any::<u64>(), size in -38i32..38) {
            let mut stream = Seed::of_set(5, "light", ordinal).stream(Purpose::Sampling);
            let size = math::exp(f64::from(size) * std::f64::consts::LN_10);
            let (mover, mut frame) = drawn(&mut stream, size);
            let (still, _) = drawn(&mut stream, size);
            let corner = |space: &Obb, at: u64| {
                let sign = |axis: u64| if at >> axis & 1 == 1 { 1.0 } else { -1.0 };
                let along = |axis: usize| space.axes[axis] * (space.half[axis] * sign(axis as u64));
                space.centre + along(0) + along(1) + along(2)
            };
            frame.shift = corner(&still, ordinal >> 3) - frame.direction(corner(&mover, ordinal));
            let [own, other] = [&mover, &still].map(LightBox::new);
            let stand = Stand::new(&mover.placed(&frame));
            prop_assert!(stand.may_meet(&own, &other, grain(4.0 * size)));
            frame.shift += Vector::X * (20.0 * size);
            let stand = Stand::new(&mover.placed(&frame));
            let told = !stand.may_meet(&own, &other, grain(4.0 * size));
            // Where single precision ends nothing is told apart.
            prop_assert!(told || !(1e-30..1e27).contains(&size));
        }
    }
}
