//! Which joints of a robot are locked, and where.

use super::robot::{JointKind, Limits, Link, TURN_MAX, lock};
use crate::scene::LENGTH_MAX;
use crate::source::Step::{self, Index, Key};
use crate::source::{NamedState, fitting, state_of};
use std::collections::{BTreeMap, BTreeSet};

/// What is asked for.
pub(super) struct Locks<'a> {
    /// Joints by name, each with the value at which it is locked.
    pub lock: &'a BTreeMap<String, f64>,
    /// Names of states at which joints outside of the group are locked. Of several that name a joint the first counts.
    pub rest: &'a [String],
    /// The links whose joints may move; `None` for all.
    pub group: Option<&'a BTreeSet<usize>>,
}

/// Locks the joints that `lock` names, and those outside of the group: where `rest` says, or else at 0 or the value within
/// the limits that is nearest to 0.
///
/// # Errors
/// The place in the table of the robot, what was found and what is expected.
pub(super) fn lock_joints<'a>(
    links: &mut [Link],
    locks: &Locks<'a>,
    states: &[NamedState],
    notes: &mut Vec<String>,
) -> Result<(), (Vec<Step<'a>>, String)> {
    let mut values: Vec<Option<f64>> = vec![None; links.len()];
    for (name, value) in locks.lock {
        let place = || vec![Key("lock"), Key(name)];
        let mut found = false;
        for (link, held) in links.iter().zip(&mut values) {
            let Some(joint) = link.joint.as_ref() else { continue };
            if joint.name != *name && joint.name != fitting(name) {
                continue;
            }
            found = true;
            let range = range_of(&joint.kind).map_err(|message| (place(), message))?;
            if !(range.min <= *value && *value <= range.max) {
                let Limits { min, max } = range;
                let message = format!("{value} found; a value from {min} to {max} expected");
                return Err((place(), message));
            }
            *held = Some(*value);
        }
        if !found {
            let message = format!("`{name}` found; the name of a joint expected");
            return Err((place(), message));
        }
    }
    let mut resting = Vec::new();
    for (index, name) in locks.rest.iter().enumerate() {
        let state =
            state_of(states, name).map_err(|message| (vec![Key("rest"), Index(index)], message))?;
        resting.push(state);
    }
    if let Some(group) = locks.group {
        let mut told = Vec::new();
        for (index, (link, held)) in links.iter().zip(&mut values).enumerate() {
            let Some(joint) = link.joint.as_ref() else { continue };
            if group.contains(&index) || held.is_some() || joint.kind.values() == 0 {
                continue;
            }
            let said = resting.iter().find_map(|state| state.values.get(&joint.name)).copied();
            let value = range_of(&joint.kind)
                .map_or(0.0, |range| said.unwrap_or(0.0).clamp(range.min, range.max));
            if let Some(said) = said.filter(|said| *said != value) {
                let name = &joint.name;
                notes.push(format!("joint `{name}` rests at {value} instead of {said}, its limit"));
            }
            told.push(format!("{} = {value}", joint.name));
            *held = Some(value);
        }
        if !told.is_empty() {
            notes.push(format!("locked, as they are not in the group: {}", told.join(", ")));
        }
    }
    lock(links, &values);
    Ok(())
}

/// The values at which a joint may be locked.
fn range_of(kind: &JointKind) -> Result<Limits, String> {
    let symmetric = |most: f64| Limits { min: -most, max: most };
    match kind {
        JointKind::Revolute { limits, .. } => Ok(limits.unwrap_or(symmetric(TURN_MAX))),
        JointKind::Prismatic { limits, .. } => {
            Ok(Limits { min: limits.min.max(-LENGTH_MAX), max: limits.max.min(LENGTH_MAX) })
        }
        JointKind::Fixed | JointKind::Locked => {
            Err("a joint that does not move found; one that moves expected".to_owned())
        }
        JointKind::Spherical => {
            Err("a spherical joint found; one with a single value expected".to_owned())
        }
        JointKind::RevoluteMimic { .. } | JointKind::PrismaticMimic { .. } => {
            Err("a joint that follows another found; the other expected".to_owned())
        }
    }
}
