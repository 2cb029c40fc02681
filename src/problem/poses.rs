//! Ends of a query that are given by the pose of a link: which of the configurations found there are taken.

use super::file::QueryTable;
use super::goals::GOALS_MAX;
use super::{ConfigurationSpec, Problem};
use crate::context::{Context, Ends};
use crate::internal::plain::plain;
use crate::model::{PoseFound, PoseGoal, Scratch};
use crate::seed::Seed;
use crate::source::Step::{self, Key};
use crate::source::{ProblemError, Source, link_of_hand, place_of};
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
    #[serde(default)]
    all: bool,
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
            all: false,
        }
    }

    /// Makes all configurations found goals of the query, rather than the one nearest to its start. Of a goal alone.
    pub fn all(self) -> PoseSpec {
        PoseSpec { all: true, ..self }
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
/// the other end, among those found, or, of a goal, all of them; notes say how many there were.
pub(super) fn ends_of(
    source: &Source,
    cx: &Context,
    problem: &mut Problem,
    query: &QueryTable,
) -> Result<Ends, ProblemError> {
    let place = [Key("query"), Key("start")];
    if takes_all(&query.start) {
        let message = "true found; a path begins at one configuration, so that all is for goals";
        let place = [&place[..], &[Key("pose"), Key("all")]].concat();
        return Err(source.error(&place, message.to_owned()));
    }
    let starts = configurations_of(source, cx, problem, &place, &query.start)?;
    let mut found = Vec::new();
    for (place, spec) in query.goal.each() {
        found.push((takes_all(spec), configurations_of(source, cx, problem, &place, spec)?));
    }
    let mut best: Option<(f64, &Vec<f64>)> = None;
    for start in &starts {
        for goal in found.iter().flat_map(|(_, goals)| goals) {
            let distance = cx.space.distance(start, goal);
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, start));
            }
        }
    }
    let (_, start) = best.expect("each end has a configuration");
    let mut goals: Vec<Vec<f64>> = Vec::new();
    for (all, mut configurations) in found {
        if !all {
            let distance = |q: &Vec<f64>| cx.space.distance(start, q);
            let nearest = |a: &Vec<f64>, b: &Vec<f64>| distance(a).total_cmp(&distance(b));
            configurations = configurations.into_iter().min_by(nearest).into_iter().collect();
        }
        for q in configurations {
            if !goals.contains(&q) {
                goals.push(q);
            }
        }
    }
    if goals.len() > GOALS_MAX {
        let message = format!("{} goals found; at most {GOALS_MAX} expected", goals.len());
        return Err(source.error(&[Key("query"), Key("goal")], message));
    }
    let goal = goals.remove(0);
    Ok(Ends { start: start.clone(), goal, other_goals: goals })
}

/// Whether all configurations at a pose are goals.
fn takes_all(spec: &ConfigurationSpec) -> bool {
    matches!(spec, ConfigurationSpec::Pose(PoseSpec { all: true, .. }))
}

/// The configurations that the end at a place of the file may be, at least one.
fn configurations_of(
    source: &Source,
    cx: &Context,
    problem: &mut Problem,
    end: &[Step],
    spec: &ConfigurationSpec,
) -> Result<Vec<Vec<f64>>, ProblemError> {
    let key = place_of(end);
    let fail = |place: &[Step], message| Err(source.error(&[end, place].concat(), message));
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
    let seed = Seed::of_evaluator(problem.seed, &format!("{key}.pose"));
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
        "{key}: {count} valid configurations found at which `{link}` is within {length:e}{} of the \
         pose, from {starts} starts; {}",
        and_angle(angle),
        if pose.all { "all are goals" } else { "the one nearest to the other end is taken" }
    );
    problem.notes.push(plain(&note).into_owned());
    Ok(configurations)
}
