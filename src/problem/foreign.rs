//! Scenes of other programs as problems, with the defaults that a problem file would have.

use super::error::ProblemError;
use super::resolve::{default_resolution, default_rotation_length, diagonal_of};
use super::{DEFAULT_SEED, Problem, building};
use crate::context::Ends;
use crate::evaluate::{EvaluatorKind, Query};
use crate::foreign::{
    Base, ForeignBody, ForeignJoint, ForeignJointKind, ForeignLink, ForeignScene, read_ompl,
    read_parasol,
};
use crate::robot::{Joint, JointKind, Limits, Link, Robot};
use crate::scene::{Body, Pose};
use crate::space::Motion;
use std::path::Path;

/// Files that stand beside a Parasol `.env`; what is not given is looked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Companions<'a> {
    /// The `.robot` file.
    pub robot: Option<&'a Path>,
    /// The `.query` file.
    pub query: Option<&'a Path>,
}

/// Reads a scene of OMPL.app or Parasol, told apart by its extension; `None` for any other file.
pub(super) fn load(path: &Path, companions: Companions) -> Option<Result<Problem, ProblemError>> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let scene = match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("cfg") => read_ompl(path),
        Some("env") => read_parasol(path, companions.robot, companions.query),
        _ => return None,
    };
    let scene = scene.map_err(|error| ProblemError::foreign(error.to_string()));
    Some(scene.and_then(|scene| from_scene(path, scene)))
}

fn from_scene(path: &Path, scene: ForeignScene) -> Result<Problem, ProblemError> {
    let mut notes = scene.notes.clone();
    let robot = robot_of(&scene);
    if robot.bodies().next().is_none() {
        return Err(ProblemError::file(path, "the robot has no bodies; at least one expected"));
    }
    let resolution =
        default_resolution(diagonal_of(&scene.bounds, robot.motion), &robot, &mut notes);
    let rotation_length = default_rotation_length(&robot, &mut notes);
    let (strategies, schedule, sets_per_round) = building::defaults();
    let mut problem = Problem {
        name: scene.name,
        seed: DEFAULT_SEED,
        bounds: scene.bounds,
        resolution,
        rotation_length,
        robot,
        obstacles: scene.obstacles.into_iter().map(|obstacle| obstacle.body).collect(),
        query: None,
        strategies,
        schedule,
        adaptive: None,
        sets_per_round,
        evaluators: Vec::new(),
        limits: building::default_limits(),
        notes,
        sources: scene.sources,
        earlier: Vec::new(),
    };
    if let Some((mut start, mut goal)) = scene.query {
        let cx = problem.context();
        for (name, q) in [("start", &mut start), ("goal", &mut goal)] {
            cx.settle(q).map_err(|error| ProblemError::file(path, format!("{name}: {error}")))?;
        }
        problem.query = Some(Ends { start, goal });
        problem.evaluators = vec![EvaluatorKind::Query(Query::default())];
    }
    Ok(problem)
}

fn robot_of(scene: &ForeignScene) -> Robot {
    let (motion, base) = match scene.base {
        Base::Fixed(pose) => (Motion::Fixed, pose),
        Base::Moving(motion) => (motion, Pose::IDENTITY),
    };
    Robot {
        motion,
        base,
        links: scene.links.iter().map(link_of).collect(),
        may_touch: scene.may_touch.iter().map(|(a, b)| (*a as u32, *b as u32)).collect(),
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
