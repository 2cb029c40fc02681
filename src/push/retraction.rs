//! Retraction (L. Zhang, D. Manocha, *An efficient retraction-based RRT planner*, ICRA 2008): a colliding configuration is moved along the normals of
//! its contacts until nothing touches.
//!
//! In the paper a configuration that is already in contact slides over the contact surface, nearer and nearer to the colliding one. Here the colliding configuration itself
//! is moved out: at every step all contacts are linearised by their Jacobian, rotations and joints included, and the shortest motion that separates
//! them all is approached by projecting on each in turn. What is found is then drawn back toward the colliding configuration, to the border of the
//! obstacle.

use super::filter::weights;
use super::{Pushed, Run, Search};
use crate::model::{Contact, Contacts};

/// The most steps for one configuration the first time; as many more each time after that.
const STEPS: u32 = 16;
const MOST_STEPS: u32 = 128;
/// The most contacts that are looked at, the deepest.
const CONTACTS: usize = 48;
/// How often the contacts are projected on, one after another, for one step.
const SWEEPS: u32 = 8;
/// How long a step may be, in steps of the search.
const LONGEST: f64 = 2.0;
/// By how much more than their depth the contacts are separated, as a share of it, and in steps of the search.
const BEYOND: f64 = 0.1;
const BEYOND_STEPS: f64 = 0.02;
/// How often the way back is halved.
const HALVINGS: u32 = 6;

/// Retracts every configuration of a stretch; those that are not valid within the reach are left out.
pub(super) fn push(run: &Run, search: &mut Search) -> Vec<Pushed> {
    let retracted = |(from, q): (usize, &Vec<f64>)| retract(q, search).map(|q| Pushed { from, q });
    run.colliding.iter().enumerate().filter_map(retracted).collect()
}

/// A valid configuration near contact and no farther from the colliding `q` than the reach, in stored form. `None` where there is none to be found by
/// the contacts, or the model has none.
pub fn retract(q: &[f64], search: &mut Search) -> Option<Vec<f64>> {
    let contacts = search.cx.model().contacts()?;
    let steps = STEPS.saturating_mul(search.effort.saturating_add(1)).min(MOST_STEPS);
    let mut at = q.to_vec();
    // Out of bounds nothing is a contact.
    search.cx.space().clamp(&mut at);
    for _ in 0..steps {
        if search.accepts(q, &at) {
            return Some(back(q, at, search));
        }
        at = step(&at, contacts, search)?;
        if search.cx.space().distance(q, &at) > search.reach {
            return None;
        }
    }
    None
}

/// The configuration after one step out of all contacts; `None` where nothing touches, so that something else is wrong, or nothing moves them apart.
fn step(at: &[f64], contacts: &dyn Contacts, search: &mut Search) -> Option<Vec<f64>> {
    let space = search.cx.space();
    let weights = weights(space);
    let found = contacts.contacts(at, CONTACTS, search.scratch);
    // In the metric a number of weight w is as long as w times what it is; what has no weight stays.
    let rows: Vec<(Vec<f64>, f64)> =
        found.iter().map(|contact| row(contact, &weights, search.step)).collect();
    let mut by = vec![0.0; weights.len()];
    for _ in 0..SWEEPS {
        for (rates, wanted) in &rows {
            let square: f64 = rates.iter().map(|rate| rate * rate).sum();
            let reached: f64 = rates.iter().zip(&by).map(|(rate, by)| rate * by).sum();
            if square > 0.0 && reached < *wanted {
                let share = (wanted - reached) / square;
                by.iter_mut().zip(rates).for_each(|(by, rate)| *by += share * rate);
            }
        }
    }
    let length = by.iter().map(|by| by * by).sum::<f64>().sqrt();
    // Written so that NaN fails it.
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let shorter = (LONGEST * search.step / length).min(1.0);
    let by: Vec<f64> = by
        .iter()
        .zip(&weights)
        .map(|(by, weight)| if *weight > 0.0 { shorter * by / weight } else { 0.0 })
        .collect();
    let mut moved = at.to_vec();
    space.moved(at, &by, &mut moved);
    space.clamp(&mut moved);
    (moved != at).then_some(moved)
}

/// How fast a contact opens, per length in the metric of every number, and how far it is to open.
fn row(contact: &Contact, weights: &[f64], step: f64) -> (Vec<f64>, f64) {
    let per_length = |(rate, weight): (&f64, &f64)| if *weight > 0.0 { rate / weight } else { 0.0 };
    let rates = contact.rates.iter().zip(weights).map(per_length).collect();
    (rates, contact.depth * (1.0 + BEYOND) + BEYOND_STEPS * step)
}

/// The valid configuration nearest to the colliding `q` that halving the straight way from the valid `at` to it finds.
fn back(q: &[f64], mut at: Vec<f64>, search: &mut Search) -> Vec<f64> {
    let valid = at.clone();
    let (mut near, mut far) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = (near + far) / 2.0;
        let mut between = q.to_vec();
        search.cx.space().interpolate(q, &valid, middle, &mut between);
        let is_valid =
            search.cx.space().canonicalize(&mut between).is_ok() && search.accepts(q, &between);
        if is_valid {
            (far, at) = (middle, between);
        } else {
            near = middle;
        }
    }
    at
}
