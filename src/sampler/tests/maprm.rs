//! The law of medial axis sampling: equally far from two witnesses, and on axes that are known.

use super::medial_axis::{TOLERANCE, among_balls, milestones, on_axis};
use super::statistics::{fits, follows};
use super::{context, plane, points};
use crate::math;
use std::f64::consts::TAU;

const MAPRM: &str = "maprm = { step = 0.1, tolerance = 0.01 }";
const BOUNDED: &str = "maprm = { step = 0.1, tolerance = 0.01, bounds = true }";

/// A passage of width 1 between two half spaces. Configurations drawn inside a half space are moved out by its side;
/// then all are pushed straight to the middle of the passage, so that along the passage milestones are uniform.
#[test]
fn between_two_walls_milestones_lie_in_the_middle_and_uniformly_along() {
    let cx = plane(21.0, 20.0, &[[0.0, 0.0, 10.0, 20.0], [11.0, 0.0, 10.0, 20.0]]);
    let found = points(&cx, MAPRM, 3000);
    assert!(found.iter().all(|[x, _]| (x - 10.5).abs() <= TOLERANCE / 2.0));
    let far = found.iter().filter(|[_, y]| (5.0..15.0).contains(y));
    follows(far.map(|[_, y]| (y - 5.0) / 10.0).collect(), |share| share);
}

/// A block that nearly fills the room. The points nearest to each of its sides form two triangles and two trapezoids.
#[test]
fn a_point_inside_a_block_leaves_it_by_the_nearest_side() {
    let (width, height, gap) = (2.0, 1.0, 0.01);
    let cx = plane(width + 2.0 * gap, height + 2.0 * gap, &[[gap, gap, width, height]]);
    let text =
        "maprm = { step = 0.001, tolerance = 0.0001, bounds = true, directions = 2, steps = 1 }";
    let mut sides = [0; 4];
    for [x, y] in points(&cx, text, 3000) {
        let gaps = [x, width + 2.0 * gap - x, y, height + 2.0 * gap - y];
        let near = gaps.iter().position(|far| *far < 0.0051).expect("it lies in a gap");
        assert!(gaps[near] > 0.0049);
        sides[near] += 1;
    }
    let (end, side) = (0.25 + gap * (height + gap), 0.75 + gap * (width + gap));
    fits(&sides, &[end, end, side, side]);
}

/// In an empty box whose bounds count as obstacles every point is pushed along the normal of its nearest side. It ends
/// in the middle plane if it started above or below the part of that plane that is nearest to the two large sides.
#[test]
fn in_a_room_milestones_are_as_far_from_two_walls() {
    let cx = context(
        "[space]\nmotion = \"translation-3d\"\nmin = [0, 0, 0]\nmax = [4, 3, 2]\n\
         bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n",
    );
    let mut planes = [0; 2];
    for q in milestones(&cx, BOUNDED, 2000).iter() {
        on_axis(vec![q[0], 4.0 - q[0], q[1], 3.0 - q[1], q[2], 2.0 - q[2]], 1.0);
        planes[usize::from((q[2] - 1.0).abs() > TOLERANCE / 2.0)] += 1;
    }
    fits(&planes, &[4.0, 20.0]);
}

/// A rod that turns in the plane, in a room of three bounds and a wall: its distances from them follow from its angle.
#[test]
fn a_rod_that_turns_is_as_far_from_two_walls() {
    let cx = context(
        "[space]\nmotion = \"rigid-2d\"\nmin = [-1, 0]\nmax = [3, 3]\nbounds = \"body\"\n\
         [robot]\nbodies = [{ shape = { box = { size = [1.0, 0.2, 0.2] } } }]\n\
         [[obstacles]]\nshape = { box = { size = [0.5, 3, 1] } }\nposition = [2.75, 1.5, 0]\n",
    );
    for q in milestones(&cx, BOUNDED, 300).iter() {
        let (sin, cos) = (math::sin(q[2]).abs(), math::cos(q[2]).abs());
        let (x, y) = (0.5 * cos + 0.1 * sin, 0.5 * sin + 0.1 * cos);
        on_axis(vec![q[0] + 1.0 - x, 2.5 - q[0] - x, q[1] - y, 3.0 - q[1] - y], 1.0);
    }
}

/// A ball that could also turn, and a point, among balls: two balls are equally near, or a ball and a side of the
/// bounds.
#[test]
fn among_balls_milestones_have_two_witnesses() {
    among_balls([MAPRM, BOUNDED], 300);
}

/// A ball on a turning arm among three other balls. The space is a circle, on which random directions find the nearest
/// obstacle exactly. So there are just three possible milestones, the middles between neighbouring balls, and each is
/// reached from the configurations between the centres of its two balls.
#[test]
fn an_arm_that_turns_stops_in_the_middle_between_two_obstacles() {
    let obstacles = [0.0f64, 100.0, 220.0].map(f64::to_radians);
    let mut scene =
        "[space]\nmotion = \"fixed\"\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\nbounds = \"body\"\n\
         [robot]\nbodies = []\n\
         [[robot.links]]\nname = \"arm\"\n\
         bodies = [{ shape = { sphere = { radius = 0.1 } }, position = [1, 0, 0] }]\n\
         joint = { kind = { revolute = { axis = [0, 0, 1] } } }\n"
            .to_owned();
    for angle in obstacles {
        scene += &format!(
            "[[obstacles]]\nshape = {{ sphere = {{ radius = 0.3 }} }}\nposition = [{}, {}, 0]\n",
            math::cos(angle),
            math::sin(angle)
        );
    }
    let cx = context(&scene);
    let mut counts = [0; 3];
    for q in milestones(&cx, "maprm = { step = 0.1, tolerance = 0.01, directions = 2 }", 600).iter()
    {
        let near = (0..3).find(|&i| {
            let [one, other] = [i, (i + 1) % 3].map(|i| obstacles[i]);
            let middle = one + (other - one).rem_euclid(TAU) / 2.0;
            cx.space.distance(q, &[math::wrap_angle(middle)]) <= TOLERANCE
        });
        counts[near.expect("it is in the middle of two")] += 1;
    }
    fits(&counts, &[100.0, 120.0, 140.0]);
}
