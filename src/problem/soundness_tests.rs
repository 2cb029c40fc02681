//! Bytes of problems that no file could give are refused before anything is asked of them.

use super::*;
use crate::model::Scratch;
use crate::model::bodies::Bodies;
use crate::model::bodies::robot::{Joint, JointKind, Limits as Range, Link, Mimic};
use crate::model::landscape::{Energy, Landscape, Term};
use crate::scene::{Body, Mesh, Pose, Shape};
use crate::space::BaseJoint;
use proptest::prelude::*;

const WALLS: &str = include_str!("../../problems/walls.toml");

fn walls() -> Problem {
    Problem::parse(Path::new("walls.toml"), WALLS).unwrap()
}

/// The problem again from its bytes.
fn again(problem: &Problem) -> Result<Problem, String> {
    let (layout, bytes) = problem.to_bytes();
    Problem::from_bytes(layout, &bytes).map_err(|error| error.to_string())
}

fn tetrahedron() -> Mesh {
    let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Mesh { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] }
}

fn joint(parent: u32, kind: JointKind) -> Option<Joint> {
    let name = "joint".to_owned();
    Some(Joint { name, parent, kind, before: Pose::IDENTITY, after: Pose::IDENTITY })
}

/// A robot with a link of every kind of joint, a mesh among the obstacles.
fn linkage() -> Problem {
    let mut problem = walls();
    problem.query = None;
    let bodies = problem.model.bodies_mut().unwrap();
    let axis = [0.0, 0.0, 1.0];
    let limits = Range { min: -1.0, max: 1.0 };
    let revolute = JointKind::Revolute { axis, limits: Some(limits) };
    let follows = |value, multiplier| Mimic { value, multiplier, offset: 0.5 };
    let kinds = [
        revolute,
        JointKind::Prismatic { axis, limits },
        JointKind::Spherical,
        JointKind::Fixed,
        JointKind::RevoluteMimic { axis, mimic: follows(1, -0.5) },
        JointKind::PrismaticMimic { axis, mimic: follows(0, 2.0) },
        JointKind::Locked,
    ];
    for (parent, kind) in kinds.into_iter().enumerate() {
        let ball = Shape::Sphere { radius: 0.1 };
        let ball = Body { shape: ball, pose: Pose::IDENTITY, solid: true };
        bodies.robot.links.push(Link {
            name: format!("link-{parent}"),
            bodies: vec![ball],
            joint: joint(parent as u32, kind),
        });
    }
    bodies.robot.may_touch = vec![(0, 4)];
    let shape = Shape::Mesh(tetrahedron());
    bodies.obstacles.push(Body { shape, pose: Pose::IDENTITY, solid: true });
    // The limit on nodes that is left open goes by the space, which has more degrees of freedom now.
    problem.limits = Limits::left_open(&problem.space());
    problem
}

fn landscape() -> Landscape {
    let term = Term { height: 1.0, centre: [0.0; 2], xx: -1.0, xy: 0.0, yy: -1.0 };
    let energy = Energy::Terms(vec![term]);
    Landscape { min: [-1.0; 2], max: [1.0; 2], energy, highest: Some(0.5), tolerance: 0.01 }
}

#[test]
fn bodies_that_no_file_could_give_are_refused() {
    type Change = fn(&mut Bodies);
    fn mesh(bodies: &mut Bodies) -> &mut Mesh {
        match bodies.obstacles.last_mut().map(|body| &mut body.shape) {
            Some(Shape::Mesh(mesh)) => mesh,
            _ => unreachable!("the last obstacle is a mesh"),
        }
    }
    fn kind(bodies: &mut Bodies, link: usize) -> &mut JointKind {
        &mut bodies.robot.links[link].joint.as_mut().unwrap().kind
    }
    fn mimic(bodies: &mut Bodies, link: usize) -> &mut Mimic {
        match kind(bodies, link) {
            JointKind::RevoluteMimic { mimic, .. } | JointKind::PrismaticMimic { mimic, .. } => {
                mimic
            }
            _ => unreachable!("it follows another"),
        }
    }
    let problem = linkage();
    assert_eq!(again(&problem).unwrap(), problem);
    let index = problem.model.bodies().unwrap().obstacles.len() - 1;
    let cases: &[(Change, &str)] = &[
        (|b| b.bounds.max[1] = b.bounds.min[1], "space.max: in y max"),
        (|b| b.bounds.min[0] = f64::NAN, "space: bounds"),
        (|b| b.bounds.max[2] = f64::INFINITY, "space: bounds"),
        (|b| b.resolution = 0.0, "space.resolution: 0 found"),
        (|b| b.resolution = f64::NAN, "space.resolution: NaN found"),
        (|b| b.resolution = 1e-200, "space.resolution: "),
        (|b| b.rotation_length = -1.0, "space.rotation_length: -1 found"),
        (|b| b.robot.links.clear(), "robot: 0 links found"),
        (|b| b.robot.links[0].joint = joint(0, JointKind::Fixed), "robot: link 0: a joint found"),
        (|b| b.robot.links[2].joint = None, "robot: link 2: no joint found"),
        (|b| b.robot.links[2].joint = joint(2, JointKind::Fixed), "link 2.joint: parent 2 found"),
        (|b| b.robot.links[2].joint = joint(9, JointKind::Fixed), "link 2.joint: parent 9 found"),
        (|b| b.robot.links.iter_mut().for_each(|l| l.bodies.clear()), "robot.bodies: no bodies"),
        (|b| b.robot.may_touch.push((1, 8)), "robot.may_touch: (1, 8) found"),
        (|b| mimic(b, 5).value = 2, "link 5.joint: follows the value 2"),
        (|b| mimic(b, 5).value = 6, "link 5.joint: follows the value 6"),
        (|b| mimic(b, 5).value = u32::MAX, "link 5.joint: follows the value"),
        (
            |b| mimic(b, 5).multiplier = f64::NAN,
            "link 5.joint: follows a value of up to 1, times NaN",
        ),
        (|b| mimic(b, 6).offset = f64::INFINITY, "link 6.joint: follows a value of up to 1"),
        (|b| mimic(b, 5).offset = 100.0, "plus 100: 100.5 found"),
        (
            |b| *kind(b, 1) = JointKind::Revolute { axis: [0.0, 0.0, 1.0], limits: None },
            "link 6.joint: follows a joint that turns on and on",
        ),
        (
            |b| match kind(b, 5) {
                JointKind::RevoluteMimic { axis, .. } => axis[0] = 2.0,
                _ => unreachable!("it is one that turns"),
            },
            "link 5.joint: axis",
        ),
        (|b| b.robot.base.rotation = [1e200; 4], "robot.base: orientation"),
        (|b| b.robot.base.translation[1] = f64::NAN, "robot.base: position"),
        (|b| b.obstacles[3].pose.rotation = [0.0; 4], "obstacles[3]: orientation"),
        (|b| b.obstacles[3].shape = Shape::Sphere { radius: -1.0 }, "obstacles[3].shape: -1"),
        (|b| b.obstacles[3].shape = Shape::Box { size: [1.0, f64::NAN, 1.0] }, "].shape: NaN"),
        (|b| b.obstacles[3].shape = Shape::Point, "obstacles[3].shape: a point cannot be"),
        (|b| mesh(b).vertices[2][0] = f64::INFINITY, "a vertex at"),
        (|b| mesh(b).triangles[1][2] = 4, "a triangle of [0, 1, 4] found"),
        (|b| mesh(b).triangles.clear(), "a mesh without triangles"),
        (|b| mesh(b).vertices.iter_mut().for_each(|v| *v = [1.0; 3]), "a mesh without triangles"),
        (
            |b| b.robot.links[4].joint.as_mut().unwrap().after.rotation[0] = 2.0,
            "link 4.joint.after",
        ),
        (
            |b| *kind(b, 1) = JointKind::Revolute { axis: [0.0; 3], limits: None },
            "link 1.joint: axis",
        ),
        (
            |b| {
                let limits = Range { min: 1.0, max: f64::NAN };
                *kind(b, 2) = JointKind::Prismatic { axis: [1.0, 0.0, 0.0], limits };
            },
            "link 2.joint: limits 1 to NaN",
        ),
        (
            |b| {
                b.robot.motion = BaseJoint::Fixed;
                b.robot.links.truncate(1);
                b.robot.may_touch.clear();
            },
            "robot: nothing moves",
        ),
    ];
    for (change, expected) in cases {
        let mut problem = problem.clone();
        change(problem.model.bodies_mut().unwrap());
        let error = again(&problem).unwrap_err();
        assert!(error.contains(expected), "{error} for {expected}");
    }
    let mut open = problem.clone();
    mesh(open.model.bodies_mut().unwrap()).triangles.pop();
    let error = again(&open).unwrap_err();
    assert!(error.contains(&format!("obstacles[{index}].solid: true found")), "{error}");
}

#[test]
fn landscapes_that_no_file_could_give_are_refused() {
    let with = |landscape: Landscape| {
        let model = ModelKind::Landscape(landscape);
        again(&Problem { model, query: None, ..walls() })
    };
    assert!(with(landscape()).is_ok());
    type Change = fn(&mut Landscape);
    fn term(landscape: &mut Landscape) -> &mut Term {
        match &mut landscape.energy {
            Energy::Terms(terms) => &mut terms[0],
            Energy::MullerBrown => unreachable!("the energy is a sum of terms"),
        }
    }
    let cases: &[(Change, &str)] = &[
        (|l| l.tolerance = f64::NAN, "landscape.tolerance: NaN found"),
        (|l| l.tolerance = 0.0, "landscape.tolerance: 0 found"),
        (|l| l.tolerance = -1.0, "landscape.tolerance: -1 found"),
        (|l| l.tolerance = f64::INFINITY, "landscape.tolerance: inf found"),
        (|l| l.tolerance = 1e-12, "landscape.tolerance: "),
        (|l| l.highest = Some(f64::NAN), "landscape.highest: NaN found"),
        (|l| l.min[0] = f64::NAN, "landscape.min: "),
        (|l| l.max[1] = -1.0, "landscape.max: in y max = -1 found"),
        (|l| l.energy = Energy::Terms(Vec::new()), "landscape.energy: 0 terms found"),
        (|l| term(l).height = f64::INFINITY, "landscape.energy: terms[0]: height inf"),
        (|l| term(l).xy = f64::NAN, "landscape.energy: terms[0]: exponents"),
        (|l| term(l).xx = 1e9, "landscape.energy: terms[0]: exponents"),
    ];
    for (change, expected) in cases {
        let mut landscape = landscape();
        change(&mut landscape);
        let error = with(landscape).unwrap_err();
        assert!(error.contains(expected), "{error} for {expected}");
    }
}

#[test]
fn a_query_of_another_space_is_refused() {
    let mut problem = walls();
    problem.query.as_mut().unwrap().goal.pop();
    assert!(again(&problem).unwrap_err().contains("query: "));
    let mut problem = walls();
    problem.query.as_mut().unwrap().start[0] = f64::NAN;
    assert!(again(&problem).unwrap_err().contains("7 finite numbers expected"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// Damaged bytes are an error, or a problem whose model can be made ready and asked.
    #[test]
    fn damaged_bytes_are_an_error_or_a_problem(
        at in any::<prop::sample::Index>(), bits in 1u8.., more in any::<prop::sample::Index>(), other in any::<u8>(),
    ) {
        let (layout, mut bytes) = linkage().to_bytes();
        let end = bytes.len();
        bytes[at.index(end)] ^= bits;
        bytes[more.index(end)] ^= other;
        if let Ok(problem) = Problem::from_bytes(layout, &bytes) {
            let context = problem.context();
            let mut q = vec![0.25; context.space.len()];
            let scratch = &mut Scratch::new();
            context.model.validity(&q, scratch);
            q.fill(0.0);
            context.model.validity(&q, scratch);
        }
    }
}
