use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::scene::LENGTH_MAX;
use crate::space::Space;

/// The step of a problem that names none, as a share of the largest distance in the space: that of OMPL's planners
/// (I. A. Şucan, M. Moll, L. E. Kavraki, *The Open Motion Planning Library*, 2012; `range` in its documentation).
const STEP_SHARE: f64 = 0.2;

/// The most motions tried to get one blocked extension on.
const TRIALS_MAX: u32 = 1000;

pub(in crate::generator) fn default_goal_bias() -> f64 {
    0.05
}

pub(in crate::generator) fn default_attempts() -> u64 {
    10_000
}

/// The step of a method that names one or none, in a space.
pub(in crate::generator) fn step_of(step: Option<f64>, space: &Space) -> f64 {
    step.unwrap_or_else(|| STEP_SHARE * space.diameter())
}

/// The step as it becomes part of a problem: always a number, unless all configurations of the space are one.
pub(in crate::generator) fn calibrated(step: Option<f64>, space: &Space) -> Option<f64> {
    step.or_else(|| Some(step_of(None, space)).filter(|step| *step > 0.0))
}

/// Where a tree begins: at the query's start, or, in a problem without a query, at the model's native configuration.
pub(super) fn root(cx: &Context) -> Option<&[f64]> {
    let start = cx.query.as_ref().map(|query| &query.start[..]);
    start.or_else(|| cx.model.native())
}

/// Refuses a problem in which a tree has nowhere to begin.
pub(in crate::generator) fn needs_root(cx: &Context) -> Result<(), String> {
    let Some(root) = root(cx) else {
        return Err("a tree that begins at the start of a query found, but no [query]".to_owned());
    };
    match cx.model.is_valid(root, &mut Scratch::new()) {
        true => Ok(()),
        false => Err("a tree found, but it begins where the configuration is not valid".to_owned()),
    }
}

/// Refuses a problem without a query, where trees are to begin at both its ends.
pub(in crate::generator) fn needs_query(cx: &Context) -> Result<(), String> {
    match cx.query {
        Some(_) => Ok(()),
        None => Err("a tree that begins at the start of a query found, but no [query]".to_owned()),
    }
}

/// What is wrong with the settings that several methods have.
pub(in crate::generator) struct Complaints;

impl Complaints {
    pub fn of_step(step: Option<f64>) -> Option<Complaint> {
        step.and_then(|step| Complaint::of_length("step", step, LENGTH_MAX))
    }

    /// Of methods that get on along obstacles by trial.
    pub fn of_bending(trials: u32, nearby: f64) -> Option<Complaint> {
        let of_trials =
            (trials > TRIALS_MAX).then(|| Complaint::new("trials", trials, "0 to 1000"));
        let is_share = (0.0..1.0).contains(&nearby);
        of_trials.or_else(|| {
            (!is_share).then(|| Complaint::new("nearby", nearby, "at least 0, less than 1"))
        })
    }

    pub fn of_goal_bias(goal_bias: f64) -> Option<Complaint> {
        let is_sound = (0.0..1.0).contains(&goal_bias);
        (!is_sound).then(|| Complaint::new("goal_bias", goal_bias, "at least 0, less than 1"))
    }
}
