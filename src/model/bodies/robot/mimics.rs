//! Joints that follow others, as `<mimic>` says it in URDF: what the other joint's limits become, and what is sound.

use super::{JointKind, Limits, Link, Mimic, Robot, TURN_MAX};
use crate::scene::LENGTH_MAX;
use std::f64::consts::PI;

/// The least and largest value of a joint; `None` inside where it turns on and on, `None` outside of joints that cannot
/// be followed.
type Range = Option<Option<Limits>>;

/// A joint that is to follow another.
pub(in crate::model::bodies) struct Follower {
    /// Index of the link that the joint moves.
    pub link: usize,
    /// Index of the link that the other joint moves.
    pub followed: usize,
    /// What the other joint's value is multiplied by.
    pub multiplier: f64,
    /// What is added.
    pub offset: f64,
}

/// Makes joints follow others. Before, each of `links` has the joint that it would have alone: the limits that a
/// follower has there narrow those of the joint that it follows, so that within the latter's limits every follower is
/// within its own. One that follows a follower follows, in the end, the joint that moves by itself. A joint that turns
/// on and on is given the limits −π and π where a follower could not go on with it. Returns notes.
///
/// # Errors
/// The index of the follower that cannot follow, what was found and what is expected.
pub(in crate::model::bodies) fn couple(
    links: &mut [Link],
    followers: &[Follower],
) -> Result<Vec<String>, (usize, String)> {
    let mut notes = Vec::new();
    let follower_of = |link: usize| followers.iter().find(|follower| follower.link == link);
    // Of each follower: the link whose joint moves by itself, multiplier and offset.
    let mut roots = Vec::new();
    for (index, follower) in followers.iter().enumerate() {
        let Follower { mut followed, mut multiplier, mut offset, .. } = *follower;
        let mut passed = 0;
        while let Some(next) = follower_of(followed) {
            passed += 1;
            if passed > followers.len() || next.link == follower.link {
                let message = "it follows itself; a joint that moves by itself expected";
                return Err((index, message.to_owned()));
            }
            offset += multiplier * next.offset;
            multiplier *= next.multiplier;
            followed = next.followed;
        }
        roots.push((followed, multiplier, offset));
    }
    for (index, (follower, (root, multiplier, offset))) in followers.iter().zip(&roots).enumerate()
    {
        let name = |link: usize| links[link].joint.as_ref().map_or("", |joint| &joint.name);
        let own = range_of(links[follower.link].joint.as_ref().map(|joint| &joint.kind));
        let Some(own) = own else {
            return Err((index, "it is none that turns about or slides along an axis".to_owned()));
        };
        let other = range_of(links[*root].joint.as_ref().map(|joint| &joint.kind));
        let Some(other) = other else {
            let message = format!(
                "`{}` found; a joint that turns about or slides along an axis",
                name(*root)
            );
            return Err((index, format!("{message} expected")));
        };
        if !(multiplier.is_finite() && offset.is_finite()) {
            let message =
                format!("{multiplier} times, plus {offset} found; finite numbers expected");
            return Err((index, message));
        }
        let turns = matches!(
            links[follower.link].joint.as_ref().map(|joint| joint.kind),
            Some(JointKind::Revolute { .. })
        );
        let goes_on = turns && own.is_none() && *multiplier == multiplier.round();
        let narrowed = match (other, own) {
            (None, _) if goes_on => None,
            (other, own) => {
                let range = other.unwrap_or(Limits { min: -PI, max: PI });
                Some(within(range, own, *multiplier, *offset).ok_or_else(|| {
                    let (follower, root) = (name(follower.link), name(*root));
                    let message = format!(
                        "no value of `{root}` from {} to {} found at which `{follower}` is within its \
                         limits; one expected",
                        range.min, range.max
                    );
                    (index, message)
                })?)
            }
        };
        let (limited, other_name) = (other.is_none() && narrowed.is_some(), name(*root).to_owned());
        if let (true, Some(Limits { min, max })) = (limited, narrowed) {
            let follower = name(follower.link);
            notes.push(format!(
                "joint `{other_name}` turns from {min} to {max} instead of on and on, as `{follower}` \
                 follows it"
            ));
        } else if other != narrowed
            && let Some(Limits { min, max }) = narrowed
        {
            let follower = name(follower.link);
            notes.push(format!(
                "joint `{other_name}` moves from {min} to {max}, within which `{follower}`, which \
                 follows it, is within its own limits"
            ));
        }
        if let Some(joint) = &mut links[*root].joint {
            match (&mut joint.kind, narrowed) {
                (JointKind::Revolute { limits, .. }, narrowed) => *limits = narrowed,
                (JointKind::Prismatic { limits, .. }, Some(narrowed)) => *limits = narrowed,
                _ => {}
            }
        }
    }
    // The followers lose their values before any is counted.
    for (follower, (_, multiplier, offset)) in followers.iter().zip(&roots) {
        let Some(joint) = &mut links[follower.link].joint else { continue };
        let mimic = Mimic { value: 0, multiplier: *multiplier, offset: *offset };
        joint.kind = match joint.kind {
            JointKind::Revolute { axis, .. } => JointKind::RevoluteMimic { axis, mimic },
            JointKind::Prismatic { axis, .. } => JointKind::PrismaticMimic { axis, mimic },
            other => other,
        };
    }
    let mut values = Vec::new();
    let mut count = 0;
    for link in links.iter() {
        values.push(count);
        count += link.joint.as_ref().map_or(0, |joint| joint.kind.values() as u32);
    }
    for (follower, (root, ..)) in followers.iter().zip(&roots) {
        if let Some(joint) = &mut links[follower.link].joint
            && let JointKind::RevoluteMimic { mimic, .. } | JointKind::PrismaticMimic { mimic, .. } =
                &mut joint.kind
        {
            mimic.value = values[*root];
        }
    }
    for (index, follower) in followers.iter().enumerate() {
        if let Some(joint) = &links[follower.link].joint
            && let Some(complaint) = complaint_of(&joint.kind, links)
        {
            return Err((index, complaint));
        }
    }
    Ok(notes)
}

/// The values of `range` at which `multiplier · value + offset` is within `own`; `None` if there are none.
fn within(range: Limits, own: Option<Limits>, multiplier: f64, offset: f64) -> Option<Limits> {
    let Some(own) = own else { return Some(range) };
    if multiplier == 0.0 {
        return (own.min <= offset && offset <= own.max).then_some(range);
    }
    let ends = [own.min, own.max].map(|end| (end - offset) / multiplier);
    let (min, max) = (range.min.max(ends[0].min(ends[1])), range.max.min(ends[0].max(ends[1])));
    (min <= max).then_some(Limits { min, max })
}

fn range_of(kind: Option<&JointKind>) -> Range {
    match kind? {
        JointKind::Revolute { limits, .. } => Some(*limits),
        JointKind::Prismatic { limits, .. } => Some(Some(*limits)),
        _ => None,
    }
}

/// The link whose joint has the value of this index as its first.
fn link_of_value(links: &[Link], value: u32) -> Option<usize> {
    let mut at = 0;
    links.iter().position(|link| {
        let count = link.joint.as_ref().map_or(0, |joint| joint.kind.values());
        let own = at;
        at += count;
        own == value as usize && count > 0
    })
}

/// The range of the joint whose value has this index.
fn range_in(links: &[Link], value: u32) -> Range {
    let link = &links[link_of_value(links, value)?];
    range_of(link.joint.as_ref().map(|joint| &joint.kind))
}

/// What is wrong with a joint that follows another, if anything.
fn complaint_of(kind: &JointKind, links: &[Link]) -> Option<String> {
    let (mimic, most) = match kind {
        JointKind::RevoluteMimic { mimic, .. } => (mimic, TURN_MAX),
        JointKind::PrismaticMimic { mimic, .. } => (mimic, LENGTH_MAX),
        _ => return None,
    };
    let Mimic { value, multiplier, offset } = *mimic;
    let Some(range) = range_in(links, value) else {
        let expected = "the index of the value of a revolute or prismatic joint expected";
        return Some(format!("follows the value {value}; {expected}"));
    };
    let turns = matches!(kind, JointKind::RevoluteMimic { .. });
    if range.is_none() && !(turns && multiplier == multiplier.round()) {
        return Some(format!(
            "follows a joint that turns on and on, times {multiplier}; of a joint that turns a whole \
             number expected, of one that slides limits of the other"
        ));
    }
    // The sum of sizes rather than the size of the sum: rounding goes by it.
    let size = mimic.size(size_of(range));
    let most = most * (1.0 + 1e-9);
    (size.is_nan() || size > most).then(|| {
        format!(
            "follows a value of up to {}, times {multiplier}, plus {offset}: {size} found; at most \
             {most:e} expected",
            size_of(range)
        )
    })
}

/// The largest size of a value in a range.
fn size_of(range: Option<Limits>) -> f64 {
    range.map_or(PI, |Limits { min, max }| min.abs().max(max.abs()))
}

/// The first joint that follows another and cannot: the index of its link, what was found and what is expected.
pub(in crate::model::bodies) fn mimic_complaint(links: &[Link]) -> Option<(usize, String)> {
    links.iter().enumerate().find_map(|(index, link)| {
        let joint = link.joint.as_ref()?;
        complaint_of(&joint.kind, links).map(|complaint| (index, complaint))
    })
}

impl Robot {
    /// The index of the link that the joint moves whose value, or first value, has an index, counted from the first value
    /// after the base's.
    pub fn link_of_value(&self, value: u32) -> Option<usize> {
        link_of_value(&self.links, value)
    }

    /// The least and largest value of the joint whose value has an index, counted from the first value after the base's;
    /// `None` inside where it turns on and on, `None` outside of a value that is none of a revolute or prismatic joint.
    pub(super) fn range(&self, value: u32) -> Range {
        range_in(&self.links, value)
    }

    /// The largest size that the value of this index can have.
    pub(super) fn size(&self, value: u32) -> f64 {
        self.range(value).map_or(0.0, size_of)
    }

    /// The indices of the values that joints follow, in the order of these joints.
    pub(super) fn followed(&self) -> Vec<u32> {
        let joints = self.links.iter().filter_map(|link| link.joint.as_ref());
        joints.filter_map(|joint| joint.kind.mimic()).map(|mimic| mimic.value).collect()
    }

    /// Those of them that wrap, in rising order.
    pub(super) fn turning_on(&self) -> Vec<u32> {
        let wraps = |value: &u32| self.range(*value) == Some(None);
        let mut values: Vec<u32> = self.followed().into_iter().filter(wraps).collect();
        values.sort_unstable();
        values.dedup();
        values
    }
}
