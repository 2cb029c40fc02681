//! Which parts of surfaces the witnesses of a clearance lie on, and how far the robot is from the bounds.

use super::tests::{cuboid, cuboid_mesh, solid};
use super::{BodyValidity, Bounds, BoundsMeaning, MotionChecking};
use crate::model::bodies::robot::Robot;
use crate::model::{Clearances, Model, PartKind, Scratch, SurfacePart, Validity, Witnesses};
use crate::numbers::Ordinal;
use crate::scene::{Body, Mesh, Shape};
use crate::seed::{Purpose, Seed};
use crate::space::BaseJoint;
use proptest::prelude::*;

fn validity(motion: BaseJoint, robot: Body, obstacles: &[Body]) -> BodyValidity {
    let robot = Robot::rigid(motion, vec![robot]);
    let bounds = Bounds { min: [-5.0; 3], max: [5.0; 3], meaning: BoundsMeaning::Body };
    let space = robot.space(bounds.min, bounds.max, 1.0);
    BodyValidity::new(space, &robot, bounds, MotionChecking::Swept, 0.1, obstacles)
}

fn witnesses(validity: &BodyValidity, q: &[f64]) -> Witnesses {
    validity.witnesses(q, &mut Scratch::new()).expect("there are obstacles")
}

/// The sorted corners of a part.
fn corners(part: &SurfacePart) -> Vec<[f64; 3]> {
    let mut corners = part.kind.corners().to_vec();
    corners.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    corners
}

#[test]
fn a_point_is_near_faces_edges_and_vertices_of_a_cube() {
    let obstacles = [cuboid([1.0; 3], [4.0, 4.0, 4.0]), cuboid_mesh([2.0; 3], [0.0; 3], true)];
    let point = solid(Shape::Point, [0.0; 3]);
    let validity = validity(BaseJoint::Translation3d, point, &obstacles);
    let part = |q: [f64; 3]| witnesses(&validity, &q).of_obstacle;
    let (top, side) = (part([0.3, 0.2, 1.5]), part([1.5, 0.3, 0.4]));
    let (edge, vertex) = (part([1.5, 0.3, 1.5]), part([1.5, 1.5, 1.5]));
    let bottom = part([0.3, 0.2, -1.5]);
    assert!(matches!(top.kind, PartKind::Face(_)) && matches!(side.kind, PartKind::Face(_)));
    assert_eq!((top.body, top.link, top.outward), (1, None, [0.0, 0.0, 1.0]));
    assert_eq!(top.point, [0.3, 0.2, 1.0]);
    assert_eq!(corners(&edge), [[1.0, -1.0, 1.0], [1.0, 1.0, 1.0]]);
    assert_eq!(corners(&vertex), [[1.0, 1.0, 1.0]]);
    // Around convex edges the surface goes on; to the other side of the cube it does not.
    for (one, two) in [(&top, &edge), (&edge, &side), (&top, &side), (&edge, &vertex)] {
        assert!(one.leads_to(two) && two.leads_to(one) && !one.is_same(two), "{one:?} {two:?}");
    }
    assert!(!top.leads_to(&bottom) && top.is_same(&part([0.31, 0.2, 1.1])));
    let other = part([4.0, 4.0, 3.0]);
    assert_eq!((other.kind, other.body, other.triangle), (PartKind::Convex, 0, 0));
    assert!(!other.leads_to(&vertex) && other.leads_to(&part([3.2, 3.3, 3.4])));
    // The triangles are those of the mesh.
    let Shape::Mesh(mesh) = &obstacles[1].shape else { panic!("a mesh") };
    let named = mesh.faces().nth(top.triangle).expect("a face");
    assert!(named.iter().all(|index| mesh.vertices[*index as usize][2] == 1.0));
    let robot = witnesses(&validity, &[0.3, 0.2, 1.5]).of_robot;
    assert_eq!((robot.link, robot.kind), (Some(0), PartKind::Convex));
}

/// Two sides of a step: they share an edge, which is concave.
#[test]
fn a_witness_jumps_at_a_concave_edge() {
    let floor = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    let wall = [[0.0, 0.0, 2.0], [0.0, 2.0, 2.0]];
    let mesh = Mesh {
        vertices: floor.into_iter().chain(wall).collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 5], [0, 5, 4]],
    };
    let step = Body { solid: false, ..solid(Shape::Mesh(mesh), [0.0; 3]) };
    let point = solid(Shape::Point, [0.0; 3]);
    let validity = validity(BaseJoint::Translation3d, point, &[step]);
    let part = |q: [f64; 3]| witnesses(&validity, &q).of_obstacle;
    let (on_floor, on_wall) = (part([0.6, 1.0, 0.5]), part([0.5, 1.0, 0.6]));
    assert!(!on_floor.leads_to(&on_wall) && !on_wall.leads_to(&on_floor));
    // Two triangles in a plane.
    assert!(on_floor.leads_to(&part([1.5, 0.2, 0.1])));
    // Below the floor the same edge is convex.
    let (below, behind) = (part([0.6, 1.0, -0.5]), part([-0.5, 1.0, 0.6]));
    assert!(below.leads_to(&behind));
}

proptest! {
    /// Witnesses are those of the clearance, and lie on the parts that are named.
    #[test]
    fn witnesses_lie_on_their_parts(ordinal in any::<u64>(), padding in prop_oneof![Just(0.0), Just(0.2)]) {
        let mut stream = Seed::of_set(5, "witnesses", Ordinal(ordinal)).stream(Purpose::Sampling);
        let obstacles = [
            cuboid_mesh([1.0, 0.7, 2.0], [1.0, 0.0, 0.5], true),
            solid(Shape::Sphere { radius: 0.4 }, [-1.0, 1.0, 0.0]),
        ];
        let mut robot = Robot::rigid(BaseJoint::Rigid3d, vec![cuboid_mesh([0.8, 0.1, 0.3], [0.2, 0.0, 0.0], true)]);
        robot.padding = vec![padding];
        let bounds = Bounds { min: [-5.0; 3], max: [5.0; 3], meaning: BoundsMeaning::Body };
        let space = robot.space(bounds.min, bounds.max, 1.0);
        let validity = BodyValidity::new(space.clone(), &robot, bounds, MotionChecking::Swept, 0.1, &obstacles);
        let mut q = vec![0.0; 7];
        for _ in 0..10 {
            space.sample_uniform(&mut stream, &mut q);
            let found = witnesses(&validity, &q);
            prop_assert_eq!(Some(found.clearance), validity.clearance(&q, &mut Scratch::new()));
            prop_assert_eq!(found.of_obstacle.body, found.clearance.obstacle);
            for part in [&found.of_obstacle, &found.of_robot] {
                let hull = part.kind.corners();
                if hull.is_empty() || found.clearance.distance == 0.0 {
                    continue;
                }
                // The mean of the corners and the witness lie in one plane or on one line.
                let at = |k: usize| hull[k % hull.len()];
                let way = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
                let to = |p| way(p, part.point);
                let cross = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    a[j] * b[k] - a[k] * b[j]
                });
                let size = |a: [f64; 3]| (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt();
                let pieces = (0..3).map(|k| 0.5 * size(cross(to(at(k)), to(at(k + 1))))).sum::<f64>();
                let whole = 0.5 * size(cross(way(at(1), at(0)), way(at(2), at(0))));
                prop_assert!((pieces - whole).abs() < 1e-6, "{:?}", part);
                prop_assert!((size(part.outward) - 1.0).abs() < 1e-9);
            }
        }
    }

    /// The robot is within the bounds where there is room on all sides.
    #[test]
    fn there_is_room_within_the_bounds(ordinal in any::<u64>()) {
        let mut stream = Seed::of_set(5, "room", Ordinal(ordinal)).stream(Purpose::Sampling);
        let robots = [
            cuboid([3.0, 1.0, 0.5], [0.5, 0.0, 0.0]),
            cuboid_mesh([3.0, 1.0, 0.5], [0.5, 0.0, 0.0], true),
            solid(Shape::Cylinder { radius: 0.5, height: 3.0 }, [0.0; 3]),
        ];
        for robot in robots {
            for motion in [BaseJoint::Rigid3d, BaseJoint::Rigid2d, BaseJoint::Translation3d] {
                let validity = validity(motion, robot.clone(), &[]);
                let mut q = vec![0.0; validity.space().len()];
                for _ in 0..20 {
                    validity.space().sample_uniform(&mut stream, &mut q);
                    let room = validity.room(&q, &mut Scratch::new());
                    let least = room.iter().flatten().fold(f64::INFINITY, |least, x| least.min(*x));
                    if least.abs() > 1e-9 {
                        let found = validity.validity(&q, &mut Scratch::new());
                        prop_assert_eq!(least > 0.0, found != Validity::OutOfBounds);
                    }
                    prop_assert_eq!(room[2][0].is_infinite(), motion == BaseJoint::Rigid2d);
                }
            }
        }
    }
}
