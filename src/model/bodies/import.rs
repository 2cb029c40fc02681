//! Scenes of other programs as problems, with the defaults that a problem file would have.

use super::Bodies;
use super::foreign::{
    Base, ForeignBody, ForeignJoint, ForeignJointKind, ForeignLink, ForeignScene, SceneKind,
    SceneOptions, read_ompl, read_parasol,
};
use super::linkage::{fitting_names, moves};
use super::locks::{Locks, lock_joints};
use super::resolve::{
    bounds_of_reach, default_resolution, default_rotation_length, diagonal_of, too_far,
};
use super::robot::{Joint, JointKind, LINKS_MAX, Limits, Link, Robot};
use super::robot_files::{ReadRobot, RobotFiles, read_robot};
use super::validity::{Bounds, MotionChecking};
use crate::digest::SourceFile;
use crate::model::{ForeignProblem, ModelKind};
use crate::scene::{Body, Pose};
use crate::source::{ProblemError, fitting_name};
use crate::space::BaseJoint;
use std::collections::BTreeMap;
use std::path::Path;

/// Reads a scene of OMPL.app or Parasol, or a robot in URDF, told apart by the extension; `None` for any
/// other file.
pub fn import(path: &Path, options: &SceneOptions) -> Option<Result<ForeignProblem, ProblemError>> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let (kind, what) = match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("cfg") => (SceneKind::Ompl, "an OMPL.app scene"),
        Some("env") => (SceneKind::Parasol, "a Parasol scene"),
        Some("urdf") => (SceneKind::Urdf, "a URDF, whose import can be edited,"),
        _ => (SceneKind::Problem, "a problem file, which says such things itself,"),
    };
    if let Some(option) = options.misplaced(kind) {
        let message = format!("{option} found; {what} leaves no room for it");
        return Some(Err(ProblemError::file(path, message)));
    }
    let scene = match kind {
        SceneKind::Ompl => read_ompl(path, options),
        SceneKind::Parasol => read_parasol(path, options),
        SceneKind::Urdf => return Some(from_urdf(path, options)),
        SceneKind::Problem => return None,
    };
    let scene = scene.map_err(|error| ProblemError::pathless(error.to_string()));
    Some(scene.and_then(|scene| from_scene(path, scene)))
}

/// A robot alone, in a box as large as it can reach.
fn from_urdf(path: &Path, options: &SceneOptions) -> Result<ForeignProblem, ProblemError> {
    let files = RobotFiles { urdf: path, srdf: options.srdf, group: options.group };
    let read = read_robot(&files).map_err(|(key, message)| match key {
        "group" => ProblemError::file(path, format!("--group: {message}")),
        // The message names the file.
        _ => ProblemError::pathless(message),
    })?;
    let ReadRobot { mut links, motion, may_touch, states, group, mut notes, sources, .. } = read;
    let locks = Locks { lock: &BTreeMap::new(), rest: &[], group: group.as_ref() };
    lock_joints(&mut links, &locks, &states, &mut notes)
        .map_err(|(_, message)| ProblemError::file(path, message))?;
    let stands = motion == BaseJoint::Fixed;
    let motion = if stands && !links.iter().any(moves) { BaseJoint::Rigid3d } else { motion };
    let robot = Robot { motion, links, may_touch, ..Robot::rigid(motion, Vec::new()) };
    let (bounds, note) =
        bounds_of_reach(&robot).map_err(|message| ProblemError::file(path, message))?;
    notes.push("a robot without a scene: no obstacles, no query".to_owned());
    if motion == BaseJoint::Fixed {
        notes.push("the base stands still at the origin".to_owned());
    } else if stands {
        notes.push("no joint moves, so the robot does".to_owned());
    }
    notes.push(note);
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into());
    finished(
        path,
        Parts { name, bounds, robot, obstacles: Vec::new(), query: None, notes, sources },
    )
}

/// What a problem is made of where the rest takes its defaults.
struct Parts {
    name: String,
    bounds: Bounds,
    robot: Robot,
    obstacles: Vec<Body>,
    query: Option<(Vec<f64>, Vec<f64>)>,
    notes: Vec<String>,
    sources: Vec<SourceFile>,
}

fn from_scene(path: &Path, scene: ForeignScene) -> Result<ForeignProblem, ProblemError> {
    let robot = robot_of(&scene);
    let obstacles = scene.obstacles.into_iter().map(|obstacle| obstacle.body).collect();
    let ForeignScene { name, bounds, query, notes, sources, .. } = scene;
    finished(path, Parts { name, bounds, robot, obstacles, query, notes, sources })
}

fn finished(path: &Path, parts: Parts) -> Result<ForeignProblem, ProblemError> {
    let Parts { name: given, bounds, robot, obstacles, query, mut notes, sources } = parts;
    if robot.bodies().next().is_none() {
        return Err(ProblemError::file(path, "the robot has no bodies; at least one expected"));
    }
    if robot.links.len() > LINKS_MAX {
        let found = robot.links.len();
        let message = format!("{found} links found; at most {LINKS_MAX} expected");
        return Err(ProblemError::file(path, message));
    }
    let diagonal = diagonal_of(&bounds, robot.motion);
    if let Some(message) = too_far(&robot, diagonal) {
        return Err(ProblemError::file(path, message));
    }
    let name = fitting_name(&given);
    if name != given {
        notes.push(format!("name = {name}, as `{given}` does not fit"));
    }
    let resolution = default_resolution(diagonal, &robot, &mut notes);
    let rotation_length = default_rotation_length(&robot, &mut notes);
    let edges = MotionChecking::default();
    let bodies = Bodies { bounds, resolution, edges, rotation_length, robot, obstacles };
    let query = query.map(|(start, goal)| [start, goal]);
    Ok(ForeignProblem { name, model: ModelKind::Bodies(bodies), query, notes, sources })
}

fn robot_of(scene: &ForeignScene) -> Robot {
    let (motion, base) = match scene.base {
        Base::Fixed(pose) => (BaseJoint::Fixed, pose),
        Base::Moving(motion) => (motion, Pose::IDENTITY),
    };
    let links = fitting_names(scene.links.iter().map(link_of).collect());
    Robot {
        motion,
        base,
        links,
        may_touch: scene.may_touch.iter().map(|(a, b)| (*a as u32, *b as u32)).collect(),
        padding: Vec::new(),
    }
}

fn link_of(link: &ForeignLink) -> Link {
    let body = |body: &ForeignBody| -> Body { body.body.clone() };
    let joint = |joint: &ForeignJoint| Joint {
        name: joint.name.clone(),
        parent: joint.parent as u32,
        kind: match joint.kind {
            ForeignJointKind::Fixed => JointKind::Fixed,
            ForeignJointKind::Revolute { axis, min, max } => {
                JointKind::Revolute { axis, limits: Some(Limits { min, max }) }
            }
        },
        before: joint.before,
        after: joint.after,
    };
    Link {
        name: link.name.clone(),
        bodies: link.bodies.iter().map(body).collect(),
        joint: link.joint.as_ref().map(joint),
    }
}
