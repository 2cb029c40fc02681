use super::*;
use crate::model::bodies::robot::{Joint, JointKind, Limits, Link, Robot};
use crate::model::{Asked, Model, Scratch};
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::seed::{Purpose, Seed};
use crate::space::{BaseJoint, Space, rigid_space};
use proptest::prelude::*;

pub(super) fn solid(shape: Shape, translation: [f64; 3]) -> Body {
    Body { shape, pose: Pose { translation, ..Pose::IDENTITY }, solid: true }
}

pub(super) fn cuboid(size: [f64; 3], translation: [f64; 3]) -> Body {
    solid(Shape::Box { size }, translation)
}

/// The same box as a closed mesh.
pub(super) fn cuboid_mesh(size: [f64; 3], translation: [f64; 3], solid: bool) -> Body {
    let corner = |i: usize| {
        [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { size[axis] } else { -size[axis] } / 2.0)
    };
    let quads =
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let mesh = Mesh {
        vertices: (0..8).map(corner).collect(),
        triangles: quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    };
    assert!(mesh.is_closed());
    Body { shape: Shape::Mesh(mesh), pose: Pose { translation, ..Pose::IDENTITY }, solid }
}

fn validity(
    motion: BaseJoint,
    meaning: BoundsMeaning,
    robot: &[Body],
    obstacles: &[Body],
) -> (Space, BodyValidity) {
    let bounds = Bounds { min: [-5.0; 3], max: [5.0; 3], meaning };
    let space = rigid_space(motion, bounds.min, bounds.max, 1.0);
    let validity = BodyValidity::new(
        space.clone(),
        &Robot::rigid(motion, robot.to_vec()),
        bounds,
        (MotionChecking::Swept, 0.05),
        obstacles,
    );
    (space, validity)
}

fn valid(validity: &BodyValidity, q: &[f64]) -> bool {
    validity.is_valid(q, &mut Scratch::new())
}

proptest! {
    /// Boxes that only translate collide exactly when their intervals overlap on every axis; what
    /// they are made of must not matter, nor which of them lies inside the other.
    #[test]
    fn boxes_collide_when_their_intervals_overlap(
        x in -3.0f64..3.0, y in -3.0f64..3.0, z in -3.0f64..3.0,
        robot_size in prop_oneof![Just([0.5, 0.6, 0.7]), Just([3.0, 3.1, 3.2])],
    ) {
        let obstacle_size = [1.5, 1.6, 1.7];
        let gaps = [x, y, z].into_iter().enumerate().map(|(axis, offset): (usize, f64)| {
            offset.abs() - (robot_size[axis] + obstacle_size[axis]) / 2.0
        });
        let gap = gaps.fold(f64::NEG_INFINITY, f64::max);
        prop_assume!(gap.abs() > 1e-6);
        for robot in [cuboid(robot_size, [0.0; 3]), cuboid_mesh(robot_size, [0.0; 3], true)] {
            for obstacle in [cuboid(obstacle_size, [0.0; 3]), cuboid_mesh(obstacle_size, [0.0; 3], true)] {
                let (_, validity) = validity(
                    BaseJoint::Translation3d, BoundsMeaning::Reference, std::slice::from_ref(&robot), &[obstacle],
                );
                prop_assert_eq!(valid(&validity, &[x, y, z]), gap > 0.0);
            }
        }
    }

    /// What a scratch remembers changes no verdict.
    #[test]
    fn verdicts_are_the_same_cold_warm_and_poisoned(ordinal in any::<u64>()) {
        let robot = [cuboid([1.0, 0.2, 0.2], [0.0; 3]), cuboid([0.2, 1.0, 0.2], [0.4, 0.0, 0.0])];
        let obstacles = [
            solid(Shape::Sphere { radius: 1.0 }, [2.0, 0.0, 0.0]),
            solid(Shape::Capsule { radius: 0.5, height: 2.0 }, [-2.0, 0.0, 0.0]),
            cuboid_mesh([1.0, 1.0, 4.0], [0.0, 2.0, 0.0], true),
            solid(Shape::Cylinder { radius: 0.7, height: 3.0 }, [0.0, -2.0, 0.0]),
        ];
        let (space, validity) = validity(BaseJoint::Rigid3d, BoundsMeaning::Body, &robot, &obstacles);
        let mut stream = Seed::of_set(5, "verdicts", ordinal).stream(Purpose::Sampling);
        let (mut warm, mut poisoned) = (Scratch::new(), Scratch::new());
        let (mut a, mut b) = (vec![0.0; 7], vec![0.0; 7]);
        for rubbish in 0..40u64 {
            space.sample_uniform(&mut stream, &mut a);
            space.sample_uniform(&mut stream, &mut b);
            let cold = valid(&validity, &a);
            poisoned.poison(rubbish.wrapping_mul(ordinal));
            prop_assert_eq!(validity.is_valid(&a, &mut warm), cold);
            prop_assert_eq!(validity.is_valid(&a, &mut poisoned), cold);
            let cold = validity.motion(&a, &b, 1, &mut Scratch::new()).is_some();
            poisoned.poison(rubbish.wrapping_add(ordinal));
            prop_assert_eq!(validity.motion(&a, &b, 1, &mut warm).is_some(), cold);
            prop_assert_eq!(validity.motion(&a, &b, 1, &mut poisoned).is_some(), cold);
        }
    }

    /// No vertex of the robot leaves the bounds, and no configuration is refused for less.
    #[test]
    fn body_bounds_hold_every_vertex(ordinal in any::<u64>()) {
        let bodies = [cuboid([3.0, 1.0, 0.5], [0.7, 0.0, 0.0]), cuboid_mesh([3.0, 1.0, 0.5], [0.7, 0.0, 0.0], true)];
        let (space, boxed) = validity(BaseJoint::Rigid3d, BoundsMeaning::Body, &bodies[..1], &[]);
        let (_, meshed) = validity(BaseJoint::Rigid3d, BoundsMeaning::Body, &bodies[1..], &[]);
        let mut stream = Seed::of_set(5, "bounds", ordinal).stream(Purpose::Sampling);
        let mut q = vec![0.0; 7];
        for _ in 0..40 {
            space.sample_uniform(&mut stream, &mut q);
            let pose = Pose { translation: [q[0], q[1], q[2]], rotation: [q[3], q[4], q[5], q[6]] };
            let mut margin = f64::INFINITY;
            for i in 0..8 {
                let half = [1.5, 0.5, 0.25];
                let corner = [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { half[axis] } else { -half[axis] });
                for value in pose.apply([corner[0] + 0.7, corner[1], corner[2]]) {
                    margin = margin.min(5.0 - value.abs());
                }
            }
            if margin.abs() > 1e-9 {
                prop_assert_eq!(valid(&boxed, &q), margin > 0.0);
                prop_assert_eq!(valid(&meshed, &q), margin > 0.0);
            }
        }
    }
}

#[test]
fn every_primitive_stands_along_its_axis() {
    let probe = [solid(Shape::Sphere { radius: 0.01 }, [0.0; 3])];
    for (shape, inside, outside) in [
        (Shape::Cylinder { radius: 1.0, height: 4.0 }, [0.9, 0.0, 1.9], [0.0, 1.9, 0.0]),
        (Shape::Capsule { radius: 1.0, height: 2.0 }, [0.0, 0.0, 1.9], [0.0, 1.9, 0.0]),
        (Shape::Box { size: [2.0, 4.0, 6.0] }, [0.9, 1.9, 2.9], [1.9, 0.0, 0.0]),
        (Shape::Sphere { radius: 2.0 }, [1.1, 1.1, 1.1], [1.2, 1.2, 1.2]),
    ] {
        let obstacle = [solid(shape.clone(), [0.0; 3])];
        let (_, validity) =
            validity(BaseJoint::Translation3d, BoundsMeaning::Reference, &probe, &obstacle);
        assert!(!valid(&validity, &inside), "{shape:?}");
        assert!(valid(&validity, &outside), "{shape:?}");
        assert!(shape.extent([0.0, 0.0, 1.0]) >= inside[2]);
    }
}

#[test]
fn the_inside_of_a_surface_is_free_and_that_of_a_solid_is_not() {
    for (is_solid, point_robot) in [(true, false), (false, false), (true, true)] {
        let shape = if point_robot { Shape::Point } else { Shape::Sphere { radius: 0.1 } };
        let robot = [solid(shape, [0.0; 3])];
        let obstacle = [cuboid_mesh([2.0; 3], [0.0; 3], is_solid)];
        let (_, validity) =
            validity(BaseJoint::Translation3d, BoundsMeaning::Reference, &robot, &obstacle);
        assert_eq!(valid(&validity, &[0.0, 0.1, 0.0]), !is_solid);
        assert!(valid(&validity, &[0.0, 2.1, 0.0]));
    }
}

#[test]
fn a_motion_through_a_thin_wall_is_seen_at_the_resolution() {
    let robot = [cuboid([0.2; 3], [0.0; 3])];
    let wall = [cuboid([0.01, 20.0, 20.0], [0.0; 3])];
    let (_, validity) = validity(BaseJoint::Rigid2d, BoundsMeaning::Reference, &robot, &wall);
    let mut scratch = Scratch::new();
    let (left, right) = ([-2.0, 0.0, 0.0], [2.0, 1.0, 3.0]);
    assert!(validity.motion(&left, &right, 1, &mut scratch).is_none());
    assert!(validity.motion(&left, &[-2.0, 3.0, -3.0], 20, &mut scratch).is_some());
    assert_eq!(scratch.take_asked(), Asked { configurations: 0, motions: 2 });
}

#[test]
fn steps_keep_the_promise_of_the_resolution() {
    // A long robot that turns: between two checks its far end moves no farther than 0.05.
    let robot = [cuboid([4.0, 0.1, 0.1], [0.0; 3])];
    let (space, validity) = validity(BaseJoint::Rigid3d, BoundsMeaning::Reference, &robot, &[]);
    let mut stream = Seed::of_set(5, "steps", 0).stream(Purpose::Sampling);
    let (mut a, mut b, mut q) = (vec![0.0; 7], vec![0.0; 7], vec![0.0; 7]);
    for _ in 0..50 {
        space.sample_uniform(&mut stream, &mut a);
        space.sample_uniform(&mut stream, &mut b);
        let steps = validity.steps(&a, &b, 1);
        let mut before: Option<[f64; 3]> = None;
        for i in 0..=steps {
            space.interpolate(&a, &b, i as f64 / steps as f64, &mut q);
            let pose = Pose { translation: [q[0], q[1], q[2]], rotation: [q[3], q[4], q[5], q[6]] };
            let end = pose.apply([2.0, 0.05, 0.05]);
            if let Some(before) = before {
                let moved: f64 = (0..3).map(|k| (end[k] - before[k]) * (end[k] - before[k])).sum();
                assert!(moved.sqrt() <= 0.05 * (1.0 + 1e-9));
            }
            before = Some(end);
        }
    }
}

/// A chain in the plane: links of length 1 along x, each turning about z at its near end.
pub(super) fn chain(links: usize, motion: BaseJoint) -> Robot {
    let rod = || cuboid([0.9, 0.1, 0.1], [0.5, 0.0, 0.0]);
    let mut robot = Robot::rigid(motion, vec![rod()]);
    for i in 1..links {
        let limits = Some(Limits { min: -3.0, max: 3.0 });
        robot.links.push(Link {
            name: format!("link {i}"),
            bodies: vec![rod()],
            joint: Some(Joint {
                name: format!("joint {i}"),
                parent: i as u32 - 1,
                kind: JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits },
                before: Pose { translation: [1.0, 0.0, 0.0], ..Pose::IDENTITY },
                after: Pose::IDENTITY,
            }),
        });
    }
    robot
}

#[test]
fn links_that_are_not_neighbours_must_not_touch_unless_they_may() {
    let bounds = Bounds { min: [-9.0; 3], max: [9.0; 3], meaning: BoundsMeaning::Body };
    let mut robot = chain(4, BaseJoint::Fixed);
    assert_eq!(robot.self_pairs().collect::<Vec<_>>(), [(0, 2), (0, 3), (1, 3)]);
    // Turns of 2π/3 close a triangle: the fourth link comes to lie on the first.
    let turn = 2.0 * std::f64::consts::FRAC_PI_3;
    let straight = [0.0, 0.0, 0.0];
    let closed = [turn, turn, turn];
    let space = robot.space(bounds.min, bounds.max, 1.0);
    let validity =
        BodyValidity::new(space.clone(), &robot, bounds, (MotionChecking::Swept, 0.05), &[]);
    assert!(valid(&validity, &straight));
    assert!(!valid(&validity, &closed));
    assert!(validity.motion(&straight, &[2.9, 2.9, 2.9], 1, &mut Scratch::new()).is_none());
    robot.may_touch = vec![(0, 2), (0, 3), (1, 3)];
    let validity = BodyValidity::new(space, &robot, bounds, (MotionChecking::Swept, 0.05), &[]);
    assert!(valid(&validity, &closed));
}

/// What is stored grows with the number of joints and of pairs, not with the joints between the links of every pair.
#[test]
fn a_long_chain_stores_one_entry_per_joint_and_two_numbers_per_pair() {
    let links = 1000;
    let robot = chain(links, BaseJoint::Fixed);
    let far = 2.0 * links as f64;
    let bounds = Bounds { min: [-far; 3], max: [far; 3], meaning: BoundsMeaning::Body };
    let space = robot.space(bounds.min, bounds.max, 1.0);
    let validity = BodyValidity::new(space, &robot, bounds, (MotionChecking::Swept, 0.05), &[]);
    assert_eq!(validity.hops.len(), links - 1);
    assert_eq!(validity.links.len(), links);
    assert_eq!(validity.self_pairs.len(), (links - 1) * (links - 2) / 2);
    assert_eq!(size_of_val(&validity.self_pairs[0]), 8);
    let mut q = vec![0.0; links - 1];
    assert!(valid(&validity, &q));
    // Turns by a third of a circle, one after the other, close a triangle.
    q[links - 4..].fill(2.1);
    assert!(!valid(&validity, &q));
}

#[test]
fn a_linkage_collides_with_obstacles_and_leaves_the_bounds_by_any_link() {
    let robot = chain(3, BaseJoint::Fixed);
    let bounds = Bounds { min: [-4.0, -1.5, -1.0], max: [4.0; 3], meaning: BoundsMeaning::Body };
    let space = robot.space(bounds.min, bounds.max, 1.0);
    let obstacle = [cuboid([0.5; 3], [2.5, 0.0, 0.0])];
    let validity =
        BodyValidity::new(space, &robot, bounds, (MotionChecking::Swept, 0.05), &obstacle);
    assert!(!valid(&validity, &[0.0, 0.0]), "the last link lies in the obstacle");
    assert!(valid(&validity, &[0.0, 1.5]));
    assert!(valid(&validity, &[1.0, 0.0]));
    assert!(valid(&validity, &[0.0, -1.5]), "inside by a little");
    assert!(!valid(&validity, &[-1.5, 0.0]), "the last link is out of bounds");
}

proptest! {
    /// The law of the resolution holds for linkages: no vertex of any link moves farther than the
    /// resolution between two checks.
    #[test]
    fn steps_of_linkages_keep_the_promise_of_the_resolution(ordinal in any::<u64>()) {
        for motion in [BaseJoint::Fixed, BaseJoint::Rigid2d, BaseJoint::Rigid3d] {
            let robot = chain(4, motion);
            let bounds = Bounds { min: [-9.0; 3], max: [9.0; 3], meaning: BoundsMeaning::Reference };
            let space = robot.space(bounds.min, bounds.max, 1.0);
            let validity = BodyValidity::new(space.clone(), &robot, bounds, (MotionChecking::Swept, 0.3), &[]);
            let mut stream = Seed::of_set(5, "linkage steps", ordinal).stream(Purpose::Sampling);
            let (mut a, mut b) = (vec![0.0; space.len()], vec![0.0; space.len()]);
            let mut q = a.clone();
            space.sample_uniform(&mut stream, &mut a);
            space.sample_uniform(&mut stream, &mut b);
            let steps = validity.steps(&a, &b, 1);
            let ends = |q: &[f64]| -> Vec<[f64; 3]> {
                robot.bodies_at(q).iter().flat_map(|body| {
                    [-0.45, 0.45].map(|x| body.pose.apply([x, 0.05, 0.05]))
                }).collect()
            };
            let mut before = ends(&a);
            for i in 1..=steps {
                space.interpolate(&a, &b, i as f64 / steps as f64, &mut q);
                let now = ends(&q);
                for (p, r) in before.iter().zip(&now) {
                    let moved: f64 = (0..3).map(|k| (p[k] - r[k]) * (p[k] - r[k])).sum();
                    prop_assert!(moved.sqrt() <= 0.3 * (1.0 + 1e-9));
                }
                before = now;
            }
        }
    }
}

/// Two blocks that overlap, in one mesh, as an obstacle and as a robot: what lies in both is not free.
#[test]
fn blocks_that_overlap_in_one_mesh_are_solid_all_through() {
    let block = |at: f64| match cuboid_mesh([2.0; 3], [0.0; 3], true).shape {
        Shape::Mesh(mesh) => {
            let vertices = mesh.vertices.iter().map(|vertex| vertex.map(|x| x + at)).collect();
            Mesh { vertices, ..mesh }
        }
        _ => unreachable!("it is a mesh"),
    };
    let (first, mut second) = (block(1.0), block(2.0));
    second.triangles.iter_mut().flatten().for_each(|corner| *corner += 8);
    let blocks = Mesh {
        vertices: [first.vertices, second.vertices].concat(),
        triangles: [first.triangles, second.triangles].concat(),
    };
    assert!(blocks.is_closed());
    let blocks = solid(Shape::Mesh(blocks), [0.0; 3]);
    for small in [cuboid([0.1; 3], [0.0; 3]), cuboid_mesh([0.1; 3], [0.0; 3], false)] {
        for (robot, obstacle, sign) in [(&small, &blocks, 1.0), (&blocks, &small, -1.0)] {
            let (robot, obstacle) = (std::slice::from_ref(robot), std::slice::from_ref(obstacle));
            let (_, validity) =
                validity(BaseJoint::Translation3d, BoundsMeaning::Reference, robot, obstacle);
            for (at, expected) in
                [(0.5, false), (1.5, false), (2.5, false), (3.5, true), (-0.5, true)]
            {
                assert_eq!(valid(&validity, &[at * sign; 3]), expected, "{at}");
            }
        }
    }
}
