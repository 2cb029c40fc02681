use super::*;
use crate::lanes::{Lanes, with_lanes};
use crate::math;
use crate::model::bodies::robot::rates_tests::drawn_pose;
use crate::model::bodies::validity::frame::Frame;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed, Stream};
use fearless_simd::f32x4;
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

/// Two boxes of some power of ten, and where the first has a corner on a corner of the second.
pub(in crate::model::bodies::validity) fn touching(
    ordinal: u64,
    power: i32,
) -> (LightBox, LightBox, Frame, f64) {
    let mut stream = Seed::of_set(5, "light", Ordinal(ordinal)).stream(Purpose::Sampling);
    let size = math::exp(f64::from(power) * std::f64::consts::LN_10);
    let (mover, mut frame) = drawn(&mut stream, size);
    let (still, _) = drawn(&mut stream, size);
    let corner = |space: &Obb, at: u64| {
        let sign = |axis: u64| if at >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let along = |axis: usize| space.axes[axis] * (space.half[axis] * sign(axis as u64));
        space.centre + along(0) + along(1) + along(2)
    };
    frame.shift = corner(&still, ordinal >> 3) - frame.direction(corner(&mover, ordinal));
    (LightBox::new(&mover), LightBox::new(&still), frame, size)
}

proptest! {
    #[test]
    fn boxes_that_touch_are_never_told_apart(ordinal in any::<u64>(), size in -38i32..38) {
        let (own, other, frame, size) = touching(ordinal, size);
        let room = grain(4.0 * size);
        let met = |frame: &Frame, lanes: Lanes| {
            with_lanes!(lanes, simd => {
                let frames: Frames<f32x4<_>> = Frames::new(simd, [frame, frame]);
                let stands = Stands::new(&frames, &Four::same(simd, &own));
                stands.may_meet(simd, &Four::new(simd, [&other; 4]), room)
            })
        };
        let apart = Frame { shift: frame.shift + Vector::X * (20.0 * size), ..frame };
        for lanes in Lanes::all() {
            prop_assert_eq!(met(&frame, lanes), 15);
            // Where single precision ends nothing is told apart.
            let told = met(&apart, lanes) == 0;
            prop_assert!(told || !(1e-30..1e27).contains(&size));
        }
    }
}
