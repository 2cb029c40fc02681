use super::*;
use crate::lanes::{Lanes, with_widest_lanes};
use crate::math;
use crate::model::bodies::robot::rates_tests::drawn_pose;
use crate::model::bodies::validity::frame::Frame;
use crate::numbers::Ordinal;
use crate::scene::Pose;
use crate::seed::{Purpose, Seed, Stream};
use fearless_simd::f32x8;
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

/// Two boxes of some power of ten, and where the first has a corner on a corner of the second; the frame is that of the
/// first box's origin as seen from the second box's.
pub(in crate::model::bodies::validity) struct Touching {
    pub mover: LightBox,
    pub still: LightBox,
    pub frame: Frame,
    /// How far the moving box reaches from its origin.
    pub reach: f64,
    pub size: f64,
}

impl Touching {
    /// More than rounding comes to.
    pub fn grain(&self) -> f32 {
        grain(self.reach + self.frame.shift.abs().max_element())
    }
}

/// The second box may be as much larger than the first as `larger` says, and flat.
pub(in crate::model::bodies::validity) fn touching(
    ordinal: u64,
    power: i32,
    larger: f64,
) -> Touching {
    let mut stream = Seed::of_set(5, "light", Ordinal(ordinal)).stream(Purpose::Sampling);
    let size = math::exp(f64::from(power) * std::f64::consts::LN_10);
    let (mover, mut frame) = drawn(&mut stream, size);
    let (mut still, _) = drawn(&mut stream, size * larger);
    still.half.x /= larger;
    still.radius = still.half.length();
    let corner = |space: &Obb, at: u64| {
        let sign = |axis: u64| if at >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let along = |axis: usize| space.axes[axis] * (space.half[axis] * sign(axis as u64));
        space.centre + along(0) + along(1) + along(2)
    };
    let touched = corner(&still, ordinal >> 3);
    frame.shift = touched - frame.direction(corner(&mover, ordinal));
    // Origins somewhere near the box that moves, that of the other box near where the two touch.
    let near = |stream: &mut Stream| Vector::from_array([0; 3].map(|_| size * stream.normal()));
    let origin = mover.centre + near(&mut stream);
    let other_origin = touched + near(&mut stream);
    frame.shift = frame.point(origin) - other_origin;
    let reach = (mover.centre - origin).length() + mover.radius;
    let mover = LightBox::new(&mover, origin);
    Touching { mover, still: LightBox::new(&still, other_origin), frame, reach, size }
}

proptest! {
    #[test]
    fn boxes_that_touch_are_never_told_apart(
        ordinal in any::<u64>(), size in -38i32..38, larger in prop::sample::select(vec![1.0, 1.0, 1e3, 1e6]),
    ) {
        let touching = touching(ordinal, size, larger);
        let room = touching.grain();
        let Touching { mover, still, frame, size: length, .. } = touching;
        let met = |frame: &Frame, lanes: Lanes| {
            with_widest_lanes!(lanes, simd => {
                let frames: Frames<f32x8<_>> = Frames::new(simd, [frame, frame]);
                let stands = Stands::new(&frames, &Eight::same(simd, &mover));
                stands.may_meet(simd, &Eight::new(simd, [&still; 8]), room)
            })
        };
        let apart = Frame { shift: frame.shift + Vector::X * (20.0 * length), ..frame };
        for lanes in Lanes::all() {
            prop_assert_eq!(met(&frame, lanes), 255);
            // Where single precision ends nothing is told apart.
            let told = met(&apart, lanes) == 0;
            prop_assert!(told || larger > 1.0 || !(1e-30..1e27).contains(&length));
        }
    }
}

/// A plate along the axes, a million times larger than a box and far from its own origin, is told apart from the box at a
/// tenth of the box's size.
#[test]
fn a_huge_plate_is_told_apart_from_a_small_box() {
    let upright = [Vector::X, Vector::Y, Vector::Z];
    let cuboid =
        |centre: Vector, half: Vector| Obb { centre, axes: upright, half, radius: half.length() };
    let mover = cuboid(Vector::ZERO, Vector::splat(1.0));
    let still = cuboid(Vector::new(3e5, -4e5, -1.0), Vector::new(1e6, 1e6, 1.0));
    let [mover, still] = [mover, still].map(|space| LightBox::new(&space, Vector::ZERO));
    let turn =
        Frame::of(&Pose { translation: [0.0; 3], rotation: [0.8, 0.0, 0.0, 0.6] }.to_parry()).turn;
    for (height, expected) in [(0.99, 255), (1.001, 255), (1.1, 0)] {
        let frame = Frame { turn, shift: Vector::new(2.0, 3.0, height) };
        for lanes in Lanes::all() {
            let met = with_widest_lanes!(lanes, simd => {
                let frames: Frames<f32x8<_>> = Frames::new(simd, [&frame, &frame]);
                let stands = Stands::new(&frames, &Eight::same(simd, &mover));
                stands.may_meet(simd, &Eight::new(simd, [&still; 8]), grain(4.0))
            });
            // A thousandth is told apart in double precision alone, a tenth here already.
            assert!(met == expected || height == 1.001, "{height} {met}");
        }
    }
}
