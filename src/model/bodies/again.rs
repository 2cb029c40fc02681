//! From a checked description back to what asks for it.

use super::Bodies;
use super::padding::spec_of_padding;
use super::robot::{Joint, JointKind, Limits, Link, Mimic};
use super::spec::{
    BodiesSpec, BodySpec, FrameSpec, JointSpec, LinkSpec, RobotSpec, ShapeSpec, SpaceSpec,
};
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::space::BaseJoint;

/// What asks for these bodies: a description equal to the last bit comes of it. Every mesh is one in memory.
pub(super) fn spec_of(bodies: &Bodies) -> BodiesSpec {
    let (robot, bounds) = (&bodies.robot, &bodies.bounds);
    let axes = robot.motion.bounded_axes();
    let space =
        SpaceSpec::new(robot.motion, &bounds.min[..axes], &bounds.max[..axes], bounds.meaning)
            .resolution(bodies.resolution)
            .edges(bodies.edges)
            .rotation_length(bodies.rotation_length);
    let base = &robot.links[0];
    let mut spec = RobotSpec::new().name(&base.name);
    if robot.motion == BaseJoint::Fixed {
        spec = spec.base(frame(&robot.base));
    }
    spec = base.bodies.iter().map(body).fold(spec, RobotSpec::body);
    let name = |link: u32| &robot.links[link as usize].name;
    for link in &robot.links[1..] {
        let Link { name: own, bodies, joint } = link;
        let joint = joint.as_ref().expect("every link but the base hangs on a joint");
        let mut hang = joint_spec(joint, name(joint.parent));
        if let Some(Mimic { value, multiplier, offset }) = joint.kind.mimic()
            && let Some(followed) = robot.link_of_value(*value)
        {
            hang = hang.mimic(name(followed as u32), *multiplier, *offset);
        }
        let hung = LinkSpec::new(own, hang);
        spec = spec.link(bodies.iter().map(body).fold(hung, LinkSpec::body));
    }
    for (first, second) in &robot.may_touch {
        spec = spec.may_touch(name(*first), name(*second));
    }
    let spec = RobotSpec { padding: spec_of_padding(robot), ..spec };
    BodiesSpec::new(space, spec).obstacles(bodies.obstacles.iter().map(body))
}

fn joint_spec(joint: &Joint, parent: &str) -> JointSpec {
    let spec = match joint.kind {
        JointKind::Fixed => JointSpec::fixed(),
        JointKind::Spherical => JointSpec::spherical(),
        JointKind::Locked => JointSpec::locked(),
        JointKind::PrismaticMimic { axis, .. } => JointSpec::prismatic_mimic(axis),
        JointKind::Revolute { axis, limits: None } | JointKind::RevoluteMimic { axis, .. } => {
            JointSpec::revolute(axis)
        }
        JointKind::Revolute { axis, limits: Some(Limits { min, max }) } => {
            JointSpec::revolute_in_radians(axis, [min, max])
        }
        JointKind::Prismatic { axis, limits: Limits { min, max } } => {
            JointSpec::prismatic(axis, [min, max])
        }
    };
    let spec = spec.name(&joint.name).parent(parent);
    spec.before(frame(&joint.before)).after(frame(&joint.after))
}

fn frame(pose: &Pose) -> FrameSpec {
    FrameSpec::at(pose.translation).orientation(pose.rotation)
}

fn body(body: &Body) -> BodySpec {
    let shape = match &body.shape {
        Shape::Point => ShapeSpec::Point {},
        Shape::Box { size } => ShapeSpec::Box { size: *size },
        Shape::Sphere { radius } => ShapeSpec::Sphere { radius: *radius },
        Shape::Cylinder { radius, height } => {
            ShapeSpec::Cylinder { radius: *radius, height: *height }
        }
        Shape::Capsule { radius, height } => {
            ShapeSpec::Capsule { radius: *radius, height: *height }
        }
        Shape::Mesh(Mesh { vertices, triangles }) => {
            // As the mesh is: nothing is left to be joined.
            let (vertices, triangles) = (vertices.clone(), triangles.clone());
            ShapeSpec::Triangles { vertices, triangles, scale: 1.0, weld: 0.0 }
        }
    };
    let is_mesh = matches!(body.shape, Shape::Mesh(_));
    let spec = BodySpec::new(shape).at(body.pose.translation).orientation(body.pose.rotation);
    if is_mesh { spec.solid(body.solid) } else { spec }
}
