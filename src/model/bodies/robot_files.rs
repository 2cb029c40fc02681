//! A robot's files taken together: the links of a URDF, and what an SRDF says of them.

use super::foreign::{Srdf, UrdfRobot, VirtualKind, read_srdf, read_urdf};
use super::linkage::fitting_names;
use super::robot::Link;
use crate::digest::SourceFile;
use crate::source::{Hand, NamedState, fitting};
use crate::space::BaseJoint;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Which files, and what of them.
pub(super) struct RobotFiles<'a> {
    pub urdf: &'a Path,
    pub srdf: Option<&'a Path>,
    /// The SRDF's group of joints that move.
    pub group: Option<&'a str>,
}

/// What the files say. Links and joints have names that fit.
pub(super) struct ReadRobot {
    pub links: Vec<Link>,
    /// How the base moves.
    pub motion: BaseJoint,
    /// Pairs of links, the lower index first, that may touch.
    pub may_touch: Vec<(u32, u32)>,
    pub states: Vec<NamedState>,
    /// The end effectors of the group, or of the robot where no group is chosen.
    pub hands: Vec<Hand>,
    /// The links whose joints are those of the group; `None` where none is chosen.
    pub group: Option<BTreeSet<usize>>,
    pub notes: Vec<String>,
    pub sources: Vec<SourceFile>,
}

/// Reads the files.
///
/// # Errors
/// The key that is wrong, `urdf`, `srdf` or `group`, and what was found and what is expected.
pub(super) fn read_robot(files: &RobotFiles) -> Result<ReadRobot, (&'static str, String)> {
    let UrdfRobot { links, base: mut motion, mut notes, mut sources } =
        read_urdf(files.urdf).map_err(|error| ("urdf", error.to_string()))?;
    let (mut may_touch, mut states, mut group) = (Vec::new(), Vec::new(), None);
    // The end effectors by name, and the indices of the links on which they are mounted.
    let mut mounted = Vec::new();
    match (files.srdf, files.group) {
        (None, None) => {}
        (None, Some(name)) => {
            let message =
                format!("`{name}` found without an SRDF; srdf, a file, expected beside it");
            return Err(("group", message));
        }
        (Some(path), name) => {
            let srdf = read_srdf(path).map_err(|error| ("srdf", error.to_string()))?;
            sources.push(srdf.source.clone());
            may_touch = disabled_pairs(&srdf, &links, &mut notes);
            let joints = name.map(|name| joints_of(&srdf, name, &links, &mut notes)).transpose()?;
            states = named_states(&srdf, name);
            motion = match &joints {
                // The virtual joint is one like others: outside of the group it is locked.
                Some((_, has_base)) if !has_base => BaseJoint::Fixed,
                _ => virtual_motion(&srdf, &links, &mut notes).unwrap_or(motion),
            };
            mounted = mounted_hands(&srdf, name, joints.as_ref(), &links);
            group = joints.map(|(links, _)| links);
        }
    }
    let links = fitting_names(links);
    let hand = |(name, link): (String, usize)| Hand { name, link: links[link].name.clone() };
    let hands = mounted.into_iter().map(hand).collect();
    Ok(ReadRobot { links, motion, may_touch, states, hands, group, notes, sources })
}

/// The links whose joints the group has, and whether it moves the base.
fn joints_of(
    srdf: &Srdf,
    name: &str,
    links: &[Link],
    notes: &mut Vec<String>,
) -> Result<(BTreeSet<usize>, bool), (&'static str, String)> {
    let Some(joints) = srdf.joints_of(name, links) else {
        let listed: Vec<&str> = srdf.groups.iter().map(|group| group.name.as_str()).collect();
        let listed = if listed.is_empty() { "it has none".to_owned() } else { listed.join(", ") };
        let message = format!("`{name}` found; a group of the SRDF expected: {listed}");
        return Err(("group", message));
    };
    let joints = joints.map_err(|error| ("srdf", error.to_string()))?;
    let unknown = (!joints.unknown.is_empty()).then(|| {
        let (path, unknown) = (srdf.path.display(), joints.unknown.join(", "));
        format!("{path}: group `{name}`: {unknown} left out, which the robot does not have")
    });
    let has_moving = joints.links.iter().any(|link| has_values(&links[*link]));
    if !joints.has_base && !has_moving {
        let why = unknown.map_or_else(String::new, |unknown| format!(" ({unknown})"));
        let message =
            format!("`{name}` found, a group without a joint that moves; one with expected{why}");
        return Err(("group", message));
    }
    notes.extend(unknown);
    Ok((joints.links, joints.has_base))
}

/// Whether the joint of a link has values of its own in a configuration.
fn has_values(link: &Link) -> bool {
    link.joint.as_ref().is_some_and(|joint| joint.kind.values() > 0)
}

/// The end effectors by name, each with the index of the link on which it is mounted: of a group (`name`, with its joints)
/// those that extend it by the file's word or, where the file does not say which group they extend, those that it moves.
fn mounted_hands(
    srdf: &Srdf,
    name: Option<&str>,
    joints: Option<&(BTreeSet<usize>, bool)>,
    links: &[Link],
) -> Vec<(String, usize)> {
    let is_moved = |link: usize| {
        let Some((group, has_base)) = joints else { return true };
        let parent = |link: &usize| links[*link].joint.as_ref().map(|joint| joint.parent as usize);
        let mut carriers = std::iter::successors(Some(link), parent);
        *has_base || carriers.any(|link| group.contains(&link) && has_values(&links[link]))
    };
    let mounted = srdf.end_effectors.iter().filter_map(|hand| {
        let link = links.iter().position(|link| link.name == hand.parent_link)?;
        let extends = match (&hand.parent_group, name) {
            (Some(extended), Some(name)) => extended == name,
            _ => is_moved(link),
        };
        extends.then(|| (hand.name.clone(), link))
    });
    mounted.collect()
}

/// The pairs of links that may touch.
fn disabled_pairs(srdf: &Srdf, links: &[Link], notes: &mut Vec<String>) -> Vec<(u32, u32)> {
    let index_of: BTreeMap<&str, u32> =
        links.iter().enumerate().map(|(index, link)| (link.name.as_str(), index as u32)).collect();
    let mut pairs = BTreeSet::new();
    let mut unknown = 0;
    for [one, other] in &srdf.disabled {
        match (index_of.get(one.as_str()), index_of.get(other.as_str())) {
            (Some(one), Some(other)) if one != other => {
                pairs.insert((*one.min(other), *one.max(other)));
            }
            (Some(_), Some(_)) => {}
            _ => unknown += 1,
        }
    }
    let count = pairs.len();
    let mut note = format!("by the SRDF {count} pairs of links may touch");
    if unknown > 0 {
        note += &format!("; {unknown} more name links that the robot does not have");
    }
    notes.push(note);
    pairs.into_iter().collect()
}

/// The SRDF's states, with names of joints that fit. Values of joints with several, such as those of the base, are left
/// out.
fn named_states(srdf: &Srdf, group: Option<&str>) -> Vec<NamedState> {
    let state = |state: &super::foreign::GroupState| NamedState {
        name: state.name.clone(),
        group: state.group.clone(),
        is_planned: group == Some(state.group.as_str()),
        values: state
            .joints
            .iter()
            .filter_map(|(joint, values)| match values[..] {
                [value] => Some((fitting(joint), value)),
                _ => None,
            })
            .collect(),
    };
    srdf.states.iter().map(state).collect()
}

/// How the root moves by a virtual joint of the SRDF, if it has one.
fn virtual_motion(srdf: &Srdf, links: &[Link], notes: &mut Vec<String>) -> Option<BaseJoint> {
    let root = &links[0].name;
    let joint = srdf.virtual_joints.iter().find(|joint| joint.child == *root)?;
    let (motion, what) = match joint.kind {
        VirtualKind::Fixed => (BaseJoint::Fixed, "stands still"),
        VirtualKind::Planar => (BaseJoint::Rigid2d, "moves in the plane"),
        VirtualKind::Floating => (BaseJoint::Rigid3d, "moves in space"),
    };
    notes.push(format!("the base {what}, by the SRDF's virtual joint `{}`", joint.name));
    Some(motion)
}
