use super::scaling::centroid;
use super::*;
use crate::model::bodies::robot::JointKind;
use crate::model::relaxation::*;
use crate::model::{Description, Scratch, Validity};
use crate::problem::Problem;
use crate::scene::{Body, Mesh, Pose, Shape, box_surface};
use crate::seed::{Purpose, Seed};
use proptest::prelude::*;
use std::path::Path;

/// A bar in 3D that has to get past a wall.
const BAR: &str = r#"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [8.0, 4.0, 4.0]
bounds = "body"
[robot]
bodies = [
    { shape = { box = { size = [1.0, 0.25, 0.25] } }, position = [0.5, 0.0, 0.0] },
    { shape = { sphere = { radius = 0.2 } }, position = [1.0, 0.0, 0.0] },
]
padding = 0.1
[[obstacles]]
shape = { box = { size = [0.2, 2.6, 4.0] } }
position = [2.0, 2.7, 2.0]
[[obstacles]]
shape = { cylinder = { radius = 0.6, height = 4.0 } }
position = [6.0, 2.0, 2.0]
"#;

/// An arm of three links that stands on a base which has a body, too.
const ARM: &str = r#"
[space]
motion = "fixed"
resolution = 0.05
[robot]
bodies = [{ shape = { box = { size = [0.4, 0.4, 0.4] } } }]
may_touch = [["base", "fore"]]
[[robot.links]]
name = "upper"
bodies = [{ shape = { box = { size = [1.0, 0.1, 0.1] } }, position = [0.5, 0.0, 0.0] }]
joint = { kind = { revolute = { axis = [0, 0, 1], degrees = [-90, 90] } } }
[[robot.links]]
name = "fore"
bodies = [{ shape = { box = { size = [1.0, 0.1, 0.1] } }, position = [0.5, 0.0, 0.0] }]
joint = { kind = { revolute = { axis = [0, 0, 1], degrees = [-90, 90] } }, before = { position = [1.0, 0.0, 0.0] } }
[[robot.links]]
name = "hand"
bodies = [{ shape = { box = { size = [0.3, 0.1, 0.1] } } }]
joint = { kind = { revolute = { axis = [1, 0, 0] } }, mimic = { link = "fore", multiplier = 2.0 }, before = { position = [1.0, 0.0, 0.0] } }
[[obstacles]]
shape = { sphere = { radius = 0.3 } }
position = [1.2, 0.8, 0.0]
"#;

fn bodies(text: &str) -> Bodies {
    let problem = Problem::parse(Path::new("it.toml"), text);
    problem.unwrap_or_else(|error| panic!("{error}")).model().bodies().unwrap().clone()
}

fn at(bodies: &Bodies, relaxation: &Relaxation, level: f64) -> (Bodies, RelaxedModel) {
    let relaxed = bodies.relaxed(relaxation, level).unwrap_or_else(|error| panic!("{error:?}"));
    (relaxed.model.bodies().unwrap().clone(), relaxed)
}

fn scale_robot(least: f64, centre: ScaleCentre, axes: ScaleAxes) -> Relaxation {
    Relaxation::ScaleRobot(ScaleRobot { least, centre, axes })
}

#[test]
fn a_scaled_robot_has_its_links_scaled_and_all_else_as_it_was() {
    let bar = bodies(BAR);
    let about = ScaleCentre::Point([1.0, 0.0, 0.0]);
    let (half, _) = at(&bar, &scale_robot(0.5, about, ScaleAxes::All), 0.0);
    let link = &half.robot.links[0];
    assert_eq!(link.bodies[0].shape, Shape::Box { size: [0.5, 0.125, 0.125] });
    assert_eq!(link.bodies[0].pose.translation, [0.75, 0.0, 0.0]);
    assert_eq!(link.bodies[1].shape, Shape::Sphere { radius: 0.1 });
    assert_eq!(link.bodies[1].pose.translation, [1.0, 0.0, 0.0]);
    assert_eq!(half.robot.padding, [0.05]);
    assert_eq!((half.bounds, half.resolution), (bar.bounds, bar.resolution));
    assert_eq!((half.rotation_length, &half.obstacles), (bar.rotation_length, &bar.obstacles));
    // The factor goes to 1 in a straight line.
    let (three_quarters, _) = at(&bar, &scale_robot(0.5, about, ScaleAxes::All), 0.5);
    let shape = &three_quarters.robot.links[0].bodies[1].shape;
    assert_eq!(*shape, Shape::Sphere { radius: 0.2 * 0.75 });
}

#[test]
fn along_some_axes_boxes_become_meshes_and_round_shapes_are_refused() {
    let mut bar = bodies(BAR);
    let flat =
        scale_robot(0.5, ScaleCentre::Point([0.0; 3]), ScaleAxes::Some([true, false, false]));
    let refused = bar.relaxed(&flat, 0.0).unwrap_err();
    assert_eq!(refused.key, "axes");
    assert!(refused.message.contains("a sphere found"), "{}", refused.message);
    bar.robot.links[0].bodies.truncate(1);
    let (made, _) = at(&bar, &flat, 0.0);
    let Shape::Mesh(mesh) = &made.robot.links[0].bodies[0].shape else { panic!("a mesh") };
    assert!(mesh.is_closed());
    assert_eq!(mesh.bounding_box(), ([0.0, -0.125, -0.125], [0.5, 0.125, 0.125]));
    // What is not scaled along all axes keeps its padding.
    assert_eq!(made.robot.padding, bar.robot.padding);
}

#[test]
fn obstacles_are_scaled_one_by_one() {
    let bar = bodies(BAR);
    let asked = |obstacles: Option<Vec<usize>>, factor: f64| {
        Relaxation::ScaleObstacles(ScaleObstacles {
            factor,
            obstacles,
            centre: ScaleCentre::Centroid,
            axes: ScaleAxes::All,
        })
    };
    let (made, _) = at(&bar, &asked(Some(vec![1]), 0.5), 0.0);
    assert_eq!(made.obstacles[0], bar.obstacles[0]);
    assert_eq!(made.obstacles[1].shape, Shape::Cylinder { radius: 0.3, height: 2.0 });
    assert_eq!(made.obstacles[1].pose, bar.obstacles[1].pose);
    assert_eq!(made.robot, bar.robot);
    let (made, _) = at(&bar, &asked(None, 2.0), 0.5);
    assert_eq!(made.obstacles[0].shape, Shape::Box { size: [0.2 * 1.5, 2.6 * 1.5, 4.0 * 1.5] });
    let refused = bar.relaxed(&asked(Some(vec![0, 2]), 0.5), 0.0).unwrap_err();
    let said = "2 found; numbers from 0 to 1 expected";
    assert_eq!((refused.key, &*refused.message), ("obstacles", said));
    // What would be larger than a scene may be.
    let far = bodies(&BAR.replace("size = [0.2, 2.6, 4.0]", "size = [0.2, 9e29, 4.0]"));
    let refused = far.relaxed(&asked(None, 1000.0), 0.0).unwrap_err();
    assert!(refused.message.starts_with("at level 0 obstacles[0]"), "{}", refused.message);
}

#[test]
fn a_centroid_is_that_of_the_surface() {
    let (corners, triangles) = box_surface([2.0, 4.0, 6.0]);
    let shape = Shape::Mesh(Mesh { vertices: corners.to_vec(), triangles });
    let pose = Pose { translation: [1.0, 2.0, 3.0], ..Pose::IDENTITY };
    let mesh = Body { shape, pose, solid: true };
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-12);
    assert!(near(centroid(std::slice::from_ref(&mesh)), [1.0, 2.0, 3.0]));
    // A box of the same surface beside it: half way between the two.
    let beside = Body {
        shape: Shape::Box { size: [2.0, 4.0, 6.0] },
        pose: Pose { translation: [3.0, 2.0, 3.0], ..Pose::IDENTITY },
        solid: true,
    };
    assert!(near(centroid(&[mesh, beside]), [2.0, 2.0, 3.0]));
    let point = Body { shape: Shape::Point, pose, solid: true };
    assert!(near(centroid(&[point]), [1.0, 2.0, 3.0]));
    assert!(near(centroid(&[]), [0.0; 3]));
}

#[test]
fn an_extra_joint_moves_a_link_and_leaves_which_links_may_touch() {
    let arm = bodies(ARM);
    let kind = ExtraJointKind::Prismatic { axis: [0.0, 0.0, 2.0], range: [-1.0, 2.0] };
    let asked = Relaxation::ExtraJoint(ExtraJoint { link: "fore".to_owned(), kind });
    let (longer, relaxed) = at(&arm, &asked, 0.25);
    assert_eq!(longer.space().form(), "upper extra fore");
    assert_eq!(relaxed.extra_value, Some(1));
    let extra = longer.robot.links[2].joint.as_ref().unwrap();
    let JointKind::Prismatic { axis, limits } = extra.kind else { panic!("a slide") };
    assert_eq!((axis, limits.min, limits.max), ([0.0, 0.0, 1.0], -0.75, 1.5));
    // At 0 every link is where it was, also the hand, whose joint follows another.
    let q = [0.3, -0.7];
    let lifted = relaxed.lifted(&q);
    assert_eq!((lifted.clone(), relaxed.dropped(&lifted)), (vec![0.3, 0.0, -0.7], q.to_vec()));
    let places = |robot: &crate::model::bodies::robot::Robot, q: &[f64]| {
        let mut poses = Vec::new();
        robot.link_poses(q, &mut poses);
        let has_bodies =
            |(link, _): &(&crate::model::bodies::robot::Link, Pose)| !link.bodies.is_empty();
        let placed = robot.links.iter().zip(poses).filter(has_bodies);
        placed.map(|(_, pose)| pose.translation).collect::<Vec<_>>()
    };
    for (was, is) in places(&arm.robot, &q).iter().zip(places(&longer.robot, &lifted)) {
        assert!((0..3).all(|axis| (was[axis] - is[axis]).abs() < 1e-12), "{was:?} {is:?}");
    }
    let up = places(&longer.robot, &[0.3, 0.5, -0.7]);
    assert!((up[2][2] - 0.5).abs() < 1e-12 && up[1][2].abs() < 1e-12);
    // Neighbours stay neighbours.
    let names = |robot: &crate::model::bodies::robot::Robot| {
        let name = |link: usize| robot.links[link].name.clone();
        robot.self_pairs().map(|(a, b)| [name(a), name(b)]).collect::<Vec<_>>()
    };
    assert_eq!(names(&arm.robot), names(&longer.robot));
    let base = ExtraJoint { link: "base".to_owned(), kind };
    let refused = arm.relaxed(&Relaxation::ExtraJoint(base), 0.0).unwrap_err();
    assert_eq!(refused.key, "link");
    assert!(refused.message.contains("upper, fore, hand"), "{}", refused.message);
}

#[test]
fn what_bodies_do_not_know_is_refused() {
    let energy = Relaxation::Energy(HigherEnergy { highest: 1.0 });
    let refused = bodies(BAR).relaxed(&energy, 0.0).unwrap_err();
    assert!(refused.message.starts_with("energy found, which a model of bodies"));
}

/// A sound relaxation of a robot in 3D by what cannot make anything harder than it was.
fn relaxations() -> impl Strategy<Value = Relaxation> {
    prop_oneof![
        (0.05..1.0f64).prop_map(|least| scale_robot(
            least,
            ScaleCentre::Point([0.5, 0.0, 0.0]),
            ScaleAxes::All
        )),
        (0.01..0.5f64).prop_map(|depth| Relaxation::Penetration(Penetration { depth })),
        (0.05..1.0f64).prop_map(|factor| Relaxation::ScaleObstacles(ScaleObstacles {
            factor,
            obstacles: None,
            centre: ScaleCentre::Centroid,
            axes: ScaleAxes::All,
        })),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Convex shapes that are scaled about a point inside only lose points, and bodies that may overlap only gain configurations: what is
    /// valid for the problem is valid at every level of it, and what is valid at a level is at every lower one of scaled shapes.
    #[test]
    fn what_is_valid_stays_valid_where_constraints_are_relaxed(
        relaxation in relaxations(),
        level in 0.0..1.0f64,
        number in 0..1000u64,
    ) {
        let mut bar = bodies(BAR);
        // One convex body, so that its scaled versions lie within one another.
        bar.robot.links[0].bodies.truncate(1);
        let (relaxed, _) = at(&bar, &relaxation, level);
        let (model, own) = (relaxed.prepare(), bar.prepare());
        let (space, scratch) = (bar.space(), &mut Scratch::new());
        let mut stream = Seed::of_calibration(number, "relaxed").stream(Purpose::Sampling);
        let mut q = vec![0.0; space.len()];
        for _ in 0..100 {
            space.sample_uniform(&mut stream, &mut q);
            if own.is_valid(&q, scratch) {
                prop_assert!(model.is_valid(&q, scratch), "{q:?}");
            }
        }
    }

    /// What is found valid although it overlaps is within the depth of what is valid for the bodies themselves, by the metric; bounds
    /// hold as ever; and a motion that is found valid is so at its steps.
    #[test]
    fn penetration_is_at_most_as_deep_as_is_said(depth in 0.05..1.0f64, level in 0.0..0.9f64, number in 0..1000u64) {
        let bar = bodies(BAR);
        let asked = Relaxation::Penetration(Penetration { depth });
        let (relaxed, _) = at(&bar, &asked, level);
        let (model, own) = (relaxed.prepare(), bar.prepare());
        let (space, scratch) = (bar.space(), &mut Scratch::new());
        let mut stream = Seed::of_calibration(number, "depth").stream(Purpose::Sampling);
        let (mut q, mut moved) = (vec![0.0; space.len()], vec![0.0; space.len()]);
        let allowed = depth * (1.0 - level);
        let mut last: Option<Vec<f64>> = None;
        for _ in 0..60 {
            space.sample_uniform(&mut stream, &mut q);
            let found = model.validity(&q, scratch);
            if own.validity(&q, scratch) == Validity::OutOfBounds {
                prop_assert_eq!(found, Validity::OutOfBounds);
            }
            if found != Validity::Valid {
                continue;
            }
            // Among the motions that are tried is one that leads to a valid configuration, and none is longer than that.
            let motions = super::penetration::motions(&space, allowed);
            let frees = |by: &Vec<f64>| {
                space.moved(&q, by, &mut moved);
                own.is_valid(&moved, scratch) && space.distance(&q, &moved) <= allowed * (1.0 + 1e-9)
            };
            prop_assert!(own.is_valid(&q, &mut Scratch::new()) || motions.iter().any(frees));
            if let Some(before) = &last
                && model.motion(before, &q, 1, scratch).is_some()
            {
                let mut between = vec![0.0; space.len()];
                for step in 1..50 {
                    space.interpolate(before, &q, f64::from(step) / 50.0, &mut between);
                    // Steps of the motion lie elsewhere: what is near a valid step is within the resolution more of it.
                    prop_assert!(model.validity(&between, scratch) != Validity::OutOfBounds);
                }
            }
            last = Some(q.clone());
        }
    }
}

/// Every relaxed description is sound, is read back from its bytes and from the file that it is written as, and says what differs.
#[test]
fn relaxed_bodies_are_descriptions_as_any() {
    let arm = bodies(ARM);
    let kind = ExtraJointKind::Revolute { axis: [0.0, 1.0, 0.0], degrees: [-20.0, 20.0] };
    for (relaxation, differs) in [
        (
            scale_robot(0.3, ScaleCentre::Centroid, ScaleAxes::Some([false, true, true])),
            "the robot",
        ),
        (Relaxation::ExtraJoint(ExtraJoint { link: "upper".to_owned(), kind }), "the robot"),
        (Relaxation::Penetration(Penetration { depth: 0.25 }), "what is promised of edges"),
    ] {
        let (_, relaxed) = at(&arm, &relaxation, 0.5);
        assert_eq!(arm.difference(&relaxed.model), Some(differs));
        let builder = Problem::builder("it", relaxed.model.to_spec());
        let problem = builder.build().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(*problem.model(), relaxed.model);
        let folder = tempfile::tempdir().unwrap();
        let written = problem.to_toml("files");
        std::fs::create_dir(folder.path().join("files")).unwrap();
        for (name, contents) in &written.files {
            std::fs::write(folder.path().join("files").join(name), contents).unwrap();
        }
        let file = folder.path().join("it.toml");
        std::fs::write(&file, &written.text).unwrap();
        let read = Problem::load(&file).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(read.digest(), problem.digest());
        let (layout, bytes) = problem.to_bytes();
        assert_eq!(*Problem::from_bytes(layout, &bytes).unwrap().model(), relaxed.model);
    }
}

/// A cube whose triangles are wound at random loses as much on every side as a box does: which side is inside is told by rays.
#[test]
fn a_thinner_mesh_is_moved_inward_however_it_is_wound() {
    let mut problem =
        Problem::parse(Path::new("bar.toml"), BAR).unwrap().model().bodies().unwrap().clone();
    let (vertices, mut triangles) = box_surface([2.0, 4.0, 6.0]);
    triangles.iter_mut().step_by(3).for_each(|corners| corners.swap(0, 1));
    let mesh = Shape::Mesh(Mesh { vertices: vertices.to_vec(), triangles: triangles.clone() });
    problem.robot.links[0].bodies[0].shape = mesh;
    let thin = |by| Relaxation::ThinRobot(ThinRobot { by });
    let (half, _) = at(&problem, &thin(0.1), 0.5);
    let Shape::Mesh(mesh) = &half.robot.links[0].bodies[0].shape else {
        panic!("a mesh stays one")
    };
    assert_eq!(mesh.triangles, triangles);
    for (old, new) in vertices.iter().zip(&mesh.vertices) {
        // The mean of three normals that are at right angles.
        let inward = 0.05 / f64::sqrt(3.0);
        for axis in 0..3 {
            assert!(
                (new[axis] - old[axis] + inward * old[axis].signum()).abs() < 1e-3,
                "{old:?} {new:?}"
            );
            assert!(new[axis].abs() < old[axis].abs());
        }
    }
    let (bar, _) = at(&bodies(BAR), &thin(0.1), 0.5);
    let link = &bar.robot.links[0];
    assert_eq!(link.bodies[0].shape, Shape::Box { size: [0.9, 0.15, 0.15] });
    assert_eq!(link.bodies[1].shape, Shape::Sphere { radius: 0.15000000000000002 });
    let error = bodies(BAR).relaxed(&thin(0.2), 0.0).unwrap_err();
    assert!(error.key == "by" && error.message.contains("leaves nothing of a box"), "{error:?}");
}
