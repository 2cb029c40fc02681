//! How near to links obstacles are already in the way.

use super::robot::{Link, Robot};
use super::spec::{ALL_OTHERS, PaddingSpec};
use crate::scene::LENGTH_MAX;
use crate::source::Step::{self, Key};
use crate::source::fitting;
use std::collections::BTreeMap;

/// The padding of each of `count` links, given their indices by name; none where all are zero.
///
/// # Errors
/// The place in the table of the robot, what was found and what is expected.
pub(super) fn padding_of<'s>(
    spec: &'s PaddingSpec,
    index_of: &BTreeMap<String, usize>,
    count: usize,
) -> Result<Vec<f64>, (Vec<Step<'s>>, String)> {
    let checked = |place: Vec<Step<'s>>, length: f64| {
        if (0.0..=LENGTH_MAX).contains(&length) {
            return Ok(length);
        }
        let expected = format!("a length from 0 to {LENGTH_MAX:e} expected");
        Err((place, format!("{length} found; {expected}")))
    };
    let mut padding = vec![0.0; count];
    match spec {
        PaddingSpec::Same(length) => padding.fill(checked(vec![Key("padding")], *length)?),
        PaddingSpec::ByLink(by_link) => {
            let place = |name: &'s str| vec![Key("padding"), Key(name)];
            if let Some((name, length)) = by_link.get_key_value(ALL_OTHERS) {
                padding.fill(checked(place(name), *length)?);
            }
            for (name, length) in by_link.iter().filter(|(name, _)| *name != ALL_OTHERS) {
                let index = index_of.get(name).or_else(|| index_of.get(&fitting(name)));
                let index = index.ok_or_else(|| {
                    let expected = "the name of a link, or \"*\" for all others, expected";
                    (place(name), format!("`{name}` found; {expected}"))
                })?;
                padding[*index] = checked(place(name), *length)?;
            }
        }
    }
    Ok(if padding.iter().all(|length| *length == 0.0) { Vec::new() } else { padding })
}

/// What asks for the padding of a robot, if it has any.
pub(super) fn spec_of_padding(robot: &Robot) -> Option<PaddingSpec> {
    let first = robot.padding.first()?;
    if robot.padding.iter().all(|length| length == first) {
        return Some(PaddingSpec::Same(*first));
    }
    let named = |(link, length): (&Link, &f64)| (link.name.clone(), *length);
    let by_link = robot.links.iter().zip(&robot.padding).filter(|(_, length)| **length != 0.0);
    Some(PaddingSpec::ByLink(by_link.map(named).collect()))
}
