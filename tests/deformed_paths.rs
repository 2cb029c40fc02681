//! Paths of deformable robots through roadmaps, from problem files to frames, judged by what shares no code with the library.

use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::distance;
use parry3d_f64::shape::{Cuboid, Triangle};
use roadmill::deformation::{
    Between, DeformedPath, DeformingAnswer, NoDeformedPath, PreparedRobot, Refusal, deform_path,
    deform_query,
};
use roadmill::model::deformable::{
    BoundingBoxSettings, Deformable, DeformationMethod, DeformationSettings,
};
use roadmill::model::{ModelKind, Scratch};
use roadmill::problem::Problem;
use roadmill::query::Attachment;
use roadmill::scene::{Body, Shape};
use roadmill::space::Configs;
use roadmill::{Build, Built, Cancel};
use std::path::Path;

/// A soft ball and an opening a fifth too small for it.
fn squeeze() -> Built {
    let problem = Problem::load("problems/squeeze.toml".as_ref()).unwrap();
    Build::new(problem).threads(2).run().unwrap()
}

fn description(problem: &Problem) -> &Deformable {
    let ModelKind::Deformable(description) = problem.model() else { panic!("not deformable") };
    description
}

/// The query of a problem, with its settings changed.
fn ask(
    built: &Built,
    change: impl FnOnce(&mut DeformationSettings),
) -> (PreparedRobot, DeformingAnswer) {
    let description = description(built.problem());
    let mut settings = description.deformation().clone();
    change(&mut settings);
    let prepared = PreparedRobot::new(description, settings).unwrap();
    let ends = built.problem().query().unwrap();
    let (attachment, scratch) = (Attachment::default(), &mut Scratch::new());
    let (cx, cancel) = (built.context(), Cancel::new());
    let robot = prepared.robot();
    let answer = deform_query(cx, built.roadmap(), ends, &attachment, robot, &cancel, scratch);
    (prepared, answer)
}

/// The least distance between a surface and boxes that stand upright, as far as it is below `clearance`.
fn least_distance(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
    boxes: &[Body],
    clearance: f64,
) -> f64 {
    let mut least = clearance;
    for body in boxes {
        let Shape::Box { size } = body.shape else { panic!("boxes expected") };
        let (half, middle) = (size.map(|edge| edge / 2.0), body.pose.translation);
        for corners in triangles {
            let corners = corners.map(|corner| vertices[corner as usize]);
            let is_far = (0..3).any(|axis| {
                let of = corners.map(|corner| corner[axis] - middle[axis]);
                of.iter().all(|value| *value > half[axis] + clearance)
                    || of.iter().all(|value| *value < -half[axis] - clearance)
            });
            if !is_far {
                let [a, b, c] = corners.map(Vector::from_array);
                let place = Pose::from_translation(Vector::from_array(middle));
                let cuboid = Cuboid::new(Vector::from_array(half));
                let triangle = Triangle::new(a, b, c);
                let found = distance(&Pose::IDENTITY, &triangle, &place, &cuboid).unwrap();
                least = least.min(found.distance);
            }
        }
    }
    least
}

/// The least distance from obstacles along a path, at so many steps from one frame to the next.
fn least_along(path: &DeformedPath, robot: &PreparedRobot, boxes: &[Body], steps: u32) -> f64 {
    let (triangles, mut least) = (robot.body().triangles(), f64::INFINITY);
    for pair in path.frames.windows(2) {
        let (from, to) = (pair[0].in_world(), pair[1].in_world());
        for step in 0..=steps {
            let share = f64::from(step) / f64::from(steps);
            let between = |(a, b): (&[f64; 3], &[f64; 3])| {
                [0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * share)
            };
            let vertices: Vec<[f64; 3]> = from.iter().zip(&to).map(between).collect();
            least = least.min(least_distance(&vertices, triangles, boxes, 0.1));
        }
    }
    least
}

#[test]
fn a_soft_ball_gets_through_an_opening_that_is_too_small_and_is_free_at_20_times_finer_steps() {
    let built = squeeze();
    let (robot, answer) = ask(&built, |settings| settings.clearance = 0.02);
    let path = answer.path.as_ref().unwrap();
    assert!(answer.deformations.tried > 0 && path.highest_energy() > 0.0);
    let [least, greatest] = path.volumes();
    assert!(least < 0.99 && greatest < 1.5, "{least} {greatest}");
    let boxes = description(built.problem()).bodies().obstacles();
    // At the frames it keeps the clearance, between them what is promised.
    let Between::Proved { clearance } = path.between else { panic!("a clearance was asked for") };
    assert!(clearance >= 0.02 / 20.0);
    let at_frames = least_along(path, &robot, boxes, 1);
    let between = least_along(path, &robot, boxes, 20);
    assert!(at_frames >= 0.02 - 1e-9, "{at_frames}");
    assert!(between >= clearance - 1e-9 && between <= at_frames, "{between} {clearance}");
    // The same again, to the bit; and so is the path once more by its own configurations.
    assert_eq!(ask(&built, |settings| settings.clearance = 0.02).1, answer);
    let mut configs = Configs::new(3);
    let turns = path.frames.windows(2).filter(|pair| pair[0].edge != pair[1].edge);
    let ends = [&path.frames[0], &path.frames[path.frames.len() - 1]];
    configs.push(&ends[0].configuration);
    turns.for_each(|pair| configs.push(&pair[0].configuration));
    configs.push(&ends[1].configuration);
    let again = deform_path(&configs, robot.robot(), &Cancel::new()).path.unwrap();
    assert_eq!(again.edges, path.edges);
    assert_eq!(again.frames[0], path.frames[0]);
    assert!(again.highest_energy() > 0.0);
}

#[test]
fn what_cannot_pass_is_refused() {
    let built = squeeze();
    // A rigid material: the ball is as large as ever, and every way through the wall is tried.
    let rigid = BoundingBoxSettings {
        lattice: [5; 3],
        least: [1.0; 3],
        greatest: [1.0; 3],
        shear: 0.0,
        ..BoundingBoxSettings::default()
    };
    let method = DeformationMethod::BoundingBox(rigid);
    let (_, answer) = ask(&built, |settings| settings.method = method);
    assert_eq!(answer.path, Err(NoDeformedPath::Refused));
    assert_eq!(answer.searches, answer.removed.len() as u64 + 1);
    assert!(answer.deformations.failed > 0);
    // A soft one, of which next to no energy is accepted.
    let (_, answer) = ask(&built, |settings| settings.highest_energy = 1e-3);
    assert_eq!(answer.path, Err(NoDeformedPath::Refused));
    let is_energy = |refusal| matches!(refusal, Refusal::Energy(energy) if energy > 1e-3);
    assert!(answer.removed.iter().any(|edge| is_energy(edge.refusal)));
}

#[test]
fn a_rod_longer_than_the_room_is_refused_at_the_start_and_a_soft_one_is_bent_into_it() {
    let problem = |least: f64| {
        let text = format!(
            "[space]\nmotion = \"translation-3d\"\nmin = [0, 0, 0]\nmax = [2, 2, 2]\nbounds = \"body\"\n\
             [robot]\nbodies = [{{ shape = {{ box = {{ size = [2.4, 0.2, 0.2] }} }} }}]\n\
             [[obstacles]]\nshape = {{ sphere = {{ radius = 0.1 }} }}\nposition = [1.0, 0.2, 1.0]\n\
             [deformable]\nfeasibility = {{ scales = [1.0, 0.5] }}\n\
             method = {{ bounding-box = {{ lattice = [9, 3, 3], least = {least} }} }}\n\
             [query]\nstart = [1.0, 1.0, 1.0]\ngoal = [1.0, 1.5, 1.0]\n"
        );
        Problem::parse(Path::new("rod.toml"), &text).unwrap()
    };
    let answer = |least: f64| {
        let built = Build::new(problem(least)).threads(1).run().unwrap();
        let own = description(built.problem()).deformation().method.clone();
        ask(&built, |settings| settings.method = own).1
    };
    // Six fifths of the room's length, of which 0.95 is more than it has.
    let refused = answer(0.95).path.unwrap_err();
    assert!(matches!(refused, NoDeformedPath::Start(_)), "{refused}");
    let path = answer(0.5).path.unwrap();
    for frame in &path.frames {
        let inside = |vertex: &[f64; 3]| vertex.iter().all(|value| (0.0..=2.0).contains(value));
        assert!(frame.in_world().iter().all(inside));
    }
}
