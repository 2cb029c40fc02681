//! The law of uniform medial axis sampling: equally far from two witnesses, and uniform along axes that are known.

use super::medial_axis::{TOLERANCE, among_balls, milestones, on_axis};
use super::statistics::{fits, follows};
use super::{context, plane, points, sampler};
use crate::context::Context;
use crate::math;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::roadmap::Configs;
use crate::sampler::GaveUp;
use crate::scene::{Mesh, Shape};
use crate::seed::Seed;
use crate::space::FactorKind;

const UMAPRM: &str = "umaprm = { length = 2.0, step = 0.2, tolerance = 0.01 }";
const BOUNDED: &str = "umaprm = { length = 1.0, step = 0.05, tolerance = 0.01, bounds = true }";

/// The scene with the shape of its first obstacle, and perhaps that of its robot, as a mesh.
fn with_mesh(scene: &str, obstacle: Mesh, robot: Option<Mesh>) -> Context {
    let mut problem = Problem::parse("scene.toml".as_ref(), scene).unwrap();
    let bodies = problem.model.bodies_mut().unwrap();
    bodies.obstacles[0].shape = Shape::Mesh(obstacle);
    if let Some(robot) = robot {
        bodies.robot.links[0].bodies[0].shape = Shape::Mesh(robot);
    }
    problem.context()
}

/// A prism over a polygon that is seen whole from its first corner, as high as −5 to 5.
fn prism(polygon: &[[f64; 2]]) -> Mesh {
    let n = polygon.len() as u32;
    let at = |z: f64| polygon.iter().map(move |[x, y]| [*x, *y, z]);
    let sides = (0..n).flat_map(|i| {
        let j = (i + 1) % n;
        [[i, j, n + j], [i, n + j, n + i]]
    });
    let caps = (1..n - 1).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]);
    let mesh = Mesh {
        vertices: at(-5.0).chain(at(5.0)).collect(),
        triangles: sides.chain(caps).collect(),
    };
    assert!(mesh.is_closed());
    mesh
}

fn gives_up(cx: &Context, text: &str) {
    let (mut configs, mut scratch) = (Configs::new(cx.space.len()), Scratch::new());
    let seed = Seed::of_set(7, "laws", Ordinal(0));
    let done = sampler(text).method().sample(cx, &seed, 1, &mut scratch, &mut configs);
    assert_eq!(done, Err(GaveUp { attempts: 100 }), "{configs:?}");
}

/// Two blocks beside each other (Figure 5.6a): the axis is the whole line between them, also beyond the blocks, where MAPRM
/// seldom comes.
#[test]
fn between_two_blocks_milestones_are_uniform_along_the_whole_line() {
    let cx = plane(8.0, 6.0, &[[2.0, 2.5, 1.0, 1.0], [5.0, 2.5, 1.0, 1.0]]);
    let found = points(&cx, UMAPRM, 1000);
    assert!(found.iter().all(|[x, _]| (x - 4.0).abs() <= TOLERANCE / 2.0), "{found:?}");
    follows(found.iter().map(|[_, y]| y / 6.0).collect(), |share| share);
    let pushed = points(&cx, "maprm = { step = 0.1, tolerance = 0.01 }", 1000);
    let beside = |points: &[[f64; 2]]| {
        points.iter().filter(|[_, y]| (2.5..3.5).contains(y)).count() as f64 / 1000.0
    };
    assert!(
        beside(&found) < 0.22 && beside(&pushed) > 0.26,
        "{} {}",
        beside(&found),
        beside(&pushed)
    );
}

/// The plane between two balls.
#[test]
fn between_two_balls_milestones_are_uniform_on_the_whole_plane() {
    let mut scene = "[space]\nmotion = \"translation-3d\"\nmin = [-2, -1, -1]\nmax = [2, 1, 1]\n\
                     bounds = \"reference\"\n[robot]\nbodies = [{ shape = { point = {} } }]\n"
        .to_owned();
    for x in [-1.5, 1.5] {
        scene += &format!(
            "[[obstacles]]\nshape = {{ sphere = {{ radius = 0.4 }} }}\nposition = [{x}, 0, 0]\n"
        );
    }
    let found = milestones(&context(&scene), UMAPRM, 1000);
    assert!(found.iter().all(|q| q[0].abs() <= TOLERANCE / 2.0));
    for axis in [1, 2] {
        follows(found.iter().map(|q| (q[axis] + 1.0) / 2.0).collect(), |share| share);
    }
}

/// A concave corner (Figure 5.5, b and c): the axis leaves it along the bisector of its two sides, and goes on between the two convex corners
/// beside it, which are parts that are not adjacent.
#[test]
fn a_concave_corner_has_an_axis_and_a_convex_one_has_none() {
    let corner = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
    let scene = "[space]\nmotion = \"translation-2d\"\nmin = [-2, -2]\nmax = [6, 6]\nbounds = \"reference\"\n\
                 [robot]\nbodies = [{ shape = { point = {} } }]\n\
                 [[obstacles]]\nshape = { box = { size = [1, 1, 1] } }\n";
    let cx = with_mesh(scene, prism(&corner), None);
    let found = points(&cx, UMAPRM, 1200);
    // The witnesses' distances differ by no more than the tolerance, and so do x and y where these are the distances.
    assert!(found.iter().all(|[x, y]| *x > 1.0 && (x - y).abs() <= 2.0 * TOLERANCE));
    follows(
        found.iter().map(|[x, _]| (x - 1.5) / 4.5).filter(|share| *share > 0.0).collect(),
        |share| share,
    );
    let block = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [1.0, 4.0], [0.0, 3.0]];
    let text = "umaprm = { length = 2.0, step = 0.2, tolerance = 0.01, attempts = 100 }";
    gives_up(&with_mesh(scene, prism(&block), None), text);
    // A rod that turns, of triangles as the block: at a given angle, what it touches is a convex polygon.
    let rod = prism(&[[-0.5, -0.1], [0.5, -0.1], [0.5, 0.1], [-0.5, 0.1]]);
    let turning = scene
        .replace("\"translation-2d\"", "\"rigid-2d\"\nrotation_length = 0.5")
        .replace("point = {}", "sphere = { radius = 0.1 }");
    gives_up(&with_mesh(&turning, prism(&block), Some(rod)), text);
}

/// Two blocks that stand flush are one wall: there is no axis at the seam.
#[test]
fn where_obstacles_stand_flush_there_is_no_axis() {
    let cx = plane(10.0, 5.0, &[[0.0, 0.0, 5.0, 2.0], [5.0, 0.0, 5.0, 2.0], [0.0, 3.0, 10.0, 2.0]]);
    let found = points(&cx, UMAPRM, 1000);
    assert!(found.iter().all(|[_, y]| (y - 2.5).abs() <= TOLERANCE / 2.0));
    follows(found.iter().map(|[x, _]| x / 10.0).collect(), |share| share);
}

/// A rectangle whose sides are obstacles: its axis is a piece of the middle line and four bisectors, with the lengths that they have.
#[test]
fn in_a_room_the_pieces_of_the_axis_are_hit_by_their_lengths() {
    let cx = plane(4.0, 2.0, &[]);
    let mut pieces = [0; 2];
    for [x, y] in points(&cx, BOUNDED, 1500) {
        on_axis(vec![x, 4.0 - x, y, 2.0 - y], 1.0);
        // Where the sides meet, a step may be beyond them.
        if (1.0..3.0).contains(&x) {
            pieces[0] += 1;
        } else if (0.2..3.8).contains(&x) {
            pieces[1] += 1;
        }
    }
    fits(&pieces, &[2.0, 4.0 * 0.8 * (2.0f64).sqrt()]);
}

/// A ball that could also turn, and a point, among balls: two balls are equally near, or a ball and a side.
#[test]
fn among_balls_milestones_have_two_witnesses() {
    among_balls([UMAPRM, BOUNDED], 100);
}

/// A rod that turns in the plane, in a room of three bounds and a wall: its distances from them follow from its angle.
#[test]
fn a_rod_that_turns_is_as_far_from_two_walls() {
    let cx = context(
        "[space]\nmotion = \"rigid-2d\"\nmin = [-1, 0]\nmax = [3, 3]\nbounds = \"body\"\n\
         [robot]\nbodies = [{ shape = { box = { size = [1.0, 0.2, 0.2] } } }]\n\
         [[obstacles]]\nshape = { box = { size = [0.5, 3, 1] } }\nposition = [2.75, 1.5, 0]\n",
    );
    let turns = cx.space.factors().iter().find(|factor| factor.kind == FactorKind::Angle).unwrap();
    // What a turn of the tolerance's length may change of a distance, and the base's translation.
    let tolerances = 1.0 + 0.51 / turns.weight;
    for q in milestones(&cx, BOUNDED, 200).iter() {
        let (sin, cos) = (math::sin(q[2]).abs(), math::cos(q[2]).abs());
        let (x, y) = (0.5 * cos + 0.1 * sin, 0.5 * sin + 0.1 * cos);
        on_axis(vec![q[0] + 1.0 - x, 2.5 - q[0] - x, q[1] - y, 3.0 - q[1] - y], tolerances);
    }
}

/// A ball on a turning arm among three other balls. The space is a circle, the axis the three middles between neighbouring balls, each
/// of which is as likely: it does not matter how far the balls are.
#[test]
fn an_arm_that_turns_stops_in_each_middle_as_often() {
    let obstacles = [0.0f64, 100.0, 220.0].map(f64::to_radians);
    let mut scene =
        "[space]\nmotion = \"fixed\"\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\nbounds = \"body\"\n\
                     [robot]\nbodies = []\n[[robot.links]]\nname = \"arm\"\n\
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
    let text = "umaprm = { length = 1.0, step = 0.1, tolerance = 0.01 }";
    for q in milestones(&cx, text, 300).iter() {
        let near = (0..3).find(|&i| {
            let [one, other] = [i, (i + 1) % 3].map(|i| obstacles[i]);
            let middle = one + (other - one).rem_euclid(math::TURN) / 2.0;
            cx.space.distance(q, &[math::wrap_angle(middle)]) <= TOLERANCE
        });
        counts[near.expect("it is in the middle of two")] += 1;
    }
    fits(&counts, &[1.0; 3]);
}
