//! Ends of a query that are given by the pose of a link: which of the configurations found there are taken.

use super::{ConfigurationSpec, Problem};
use crate::context::{Context, Ends};
use crate::internal::plain::plain;
use crate::model::{PoseFound, PoseGoal, Scratch};
use crate::seed::Seed;
use crate::source::Step::{self, Key};
use crate::source::{ProblemError, Source, link_of_hand};
use serde::Deserialize;

/// A pose of a link as a problem asks for it: `start` or `goal` of a `[query]` with the key `pose`. What is left out has the
/// defaults of [`PoseGoal`].
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseSpec {
    link: Option<String>,
    position: [f64; 3],
    orientation: Option<[f64; 4]>,
    position_tolerance: Option<f64>,
    orientation_tolerance: Option<f64>,
}

impl PoseSpec {
    /// The origin of a link at a position in the world's frame, lengths, however it is turned.
    pub fn new(link: impl Into<String>, position: [f64; 3]) -> PoseSpec {
        PoseSpec { link: Some(link.into()), ..PoseSpec::of_end_effector(position) }
    }

    /// The origin of the link on which the SRDF mounts the end effector of the robot, or of the group that moves: as of
    /// [`PoseSpec::new`]. There must be one such end effector.
    pub fn of_end_effector(position: [f64; 3]) -> PoseSpec {
        PoseSpec {
            link: None,
            position,
            orientation: None,
            position_tolerance: None,
            orientation_tolerance: None,
        }
    }

    /// Turned in the world's frame by a quaternion `w x y z` of any length but zero.
    pub fn orientation(self, orientation: [f64; 4]) -> PoseSpec {
        PoseSpec { orientation: Some(orientation), ..self }
    }

    /// How far from the position the origin may be, a length.
    pub fn position_tolerance(self, length: f64) -> PoseSpec {
        PoseSpec { position_tolerance: Some(length), ..self }
    }

    /// By which angle the link may be turned from the orientation, radians.
    pub fn orientation_tolerance(self, angle: f64) -> PoseSpec {
        PoseSpec { orientation_tolerance: Some(angle), ..self }
    }

    fn goal(&self, link: &str) -> PoseGoal {
        PoseGoal {
            link: link.to_owned(),
            position: self.position,
            rotation: self.orientation,
            position_tolerance: self.position_tolerance,
            orientation_tolerance: self.orientation_tolerance,
        }
    }
}

/// The ends of a query: valid configurations in stored form. Of an end given by a pose it is the configuration nearest to
/// the other end, among those found; notes say how many there were.
pub(super) fn ends_of(
    source: &Source,
    cx: &Context,
    problem: &mut Problem,
    asked: [(&'static str, &ConfigurationSpec); 2],
) -> Result<Ends, ProblemError> {
    let mut found = Vec::new();
    for (key, spec) in asked {
        found.push(configurations_of(source, cx, problem, key, spec)?);
    }
    let mut best: Option<(f64, usize, usize)> = None;
    for (i, start) in found[0].iter().enumerate() {
        for (j, goal) in found[1].iter().enumerate() {
            let distance = cx.space.distance(start, goal);
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, i, j));
            }
        }
    }
    let (_, i, j) = best.expect("each end has a configuration");
    Ok(Ends { start: found[0][i].clone(), goal: found[1][j].clone() })
}

/// The configurations that an end may be, at least one.
fn configurations_of(
    source: &Source,
    cx: &Context,
    problem: &mut Problem,
    key: &'static str,
    spec: &ConfigurationSpec,
) -> Result<Vec<Vec<f64>>, ProblemError> {
    let fail = |place: &[Step], message| {
        Err(source.error(&[&[Key("query"), Key(key)], place].concat(), message))
    };
    let ConfigurationSpec::Pose(pose) = spec else {
        let mut q = match spec.values(&cx.space, &source.states.borrow()) {
            Ok(q) => q,
            Err((place, message)) => return fail(&place, message),
        };
        return match cx.accept(&mut q) {
            Ok(()) => Ok(vec![q]),
            Err(message) => fail(&[], message),
        };
    };
    let hands = source.hands.borrow();
    let link = match &pose.link {
        Some(link) => link,
        None => match link_of_hand(&hands) {
            Ok(link) => link,
            Err(message) => return fail(&[Key("pose")], message),
        },
    };
    let seed = Seed::of_evaluator(problem.seed, &format!("query.{key}.pose"));
    let (mut refused, scratch) = (None, &mut Scratch::new());
    let mut accept = |q: &mut [f64]| {
        let is_valid = cx.stored(q).is_ok() && cx.model.is_valid(q, scratch);
        if !is_valid {
            refused = Some(q.to_vec());
        }
        is_valid
    };
    let description = problem.model.description();
    let found = match description.configurations_at(&pose.goal(link), &seed, &mut accept) {
        Ok(found) => found,
        Err((own, message)) => return fail(&[Key("pose"), Key(own)], message),
    };
    let PoseFound { configurations, starts, reached, tolerances, nearest } = found;
    let [length, angle] = tolerances;
    let and_angle = |angle: f64| match pose.orientation {
        Some(_) => format!(" and {angle:.3e} rad"),
        None => String::new(),
    };
    if reached == 0 {
        let message = format!(
            "`{link}` comes no nearer to the pose than {:.3e}{} from {starts} starts; at most {length:e}{} \
             expected",
            nearest[0],
            and_angle(nearest[1]),
            and_angle(angle)
        );
        return fail(&[Key("pose")], message);
    }
    if configurations.is_empty() {
        let why = refused.map_or_else(Vec::new, |q| cx.model.reasons(&q, true));
        let why =
            why.first().map_or(String::new(), |reason| format!(", the last one since {reason}"));
        let message = format!(
            "`{link}` comes to the pose from {reached} of {starts} starts, but no configuration found is \
             valid{why}; a pose with a valid one expected"
        );
        return fail(&[Key("pose")], message);
    }
    let count = configurations.len();
    let note = format!(
        "query.{key}: {count} valid configurations found at which `{link}` is within {length:e}{} of the \
         pose, from {starts} starts; the one nearest to the other end is taken",
        and_angle(angle)
    );
    problem.notes.push(plain(&note).into_owned());
    Ok(configurations)
}
