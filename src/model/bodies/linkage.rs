//! The robot: its base, its links and their joints.

use super::locks::{Locks, lock_joints};
use super::padding::padding_of;
use super::robot::{Follower, Joint, JointKind, LINKS_MAX, Limits, Link, Robot, TURN_MAX, couple};
use super::robot_files::{ReadRobot, RobotFiles, read_robot};
use super::shapes::{bodies, pose_of, unit};
use super::spec::{AttachSpec, FrameSpec, JointKindSpec, LinkSpec, MimicSpec, RobotSpec};
use crate::scene::{LENGTH_MAX, Pose};
use crate::source::Step::{self, Index, Key};
use crate::source::{ProblemError, Source, fits, fitting};
use crate::space::BaseJoint;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Name of link 0 where the file gives none.
const BASE: &str = "base";
const NAME_EXPECTED: &str = "a name of its own of letters, digits, `-`, `_` and `.` expected";

/// Reads the robot. `motion` says how its base moves; if nothing is said, what its files say.
pub(super) fn robot_of(
    source: &Source,
    spec: &RobotSpec,
    motion: Option<BaseJoint>,
    notes: &mut Vec<String>,
) -> Result<Robot, ProblemError> {
    let mut robot = Robot::rigid(BaseJoint::Fixed, Vec::new());
    let mut group = None;
    match &spec.urdf {
        Some(file) => {
            let read = files_of(source, spec, file)?;
            notes.extend(read.notes);
            read.sources.into_iter().for_each(|file| source.read(file));
            source.states.replace(read.states);
            source.hands.replace(read.hands);
            group = read.group;
            let ReadRobot { links, motion: said, may_touch, .. } = read;
            robot = Robot { motion: motion.unwrap_or(said), links, may_touch, ..robot };
        }
        None => {
            let Some(motion) = motion else {
                let expected = "how the base moves, \"fixed\" or another word, expected";
                return Err(source.error(&[Key("space")], format!("no motion found; {expected}")));
            };
            let only_beside = [("srdf", spec.srdf.is_some()), ("group", spec.group.is_some())];
            if let Some((key, _)) = only_beside.iter().find(|(_, given)| *given) {
                let message = "given without urdf; a urdf that it is about expected";
                return Err(source.error(&[Key("robot"), Key(key)], message.to_owned()));
            }
            robot.motion = motion;
            let place = [Key("robot"), Key("bodies")];
            robot.links[0].bodies = bodies(source, &place, &spec.bodies, notes)?;
            robot.links[0].name = spec.name.clone().unwrap_or_else(|| BASE.to_owned());
        }
    }
    if !fits(&robot.links[0].name) {
        let message = format!("`{}` found; {NAME_EXPECTED}", robot.links[0].name);
        return Err(source.error(&[Key("robot"), Key("name")], message));
    }
    if let Some(base) = &spec.base {
        if robot.motion != BaseJoint::Fixed {
            let message = "given, but the base moves; motion = \"fixed\" expected beside it";
            return Err(source.error(&[Key("robot"), Key("base")], message.to_owned()));
        }
        robot.base = frame(source, &[Key("robot"), Key("base")], base)?;
    }
    // The base, or the links of a URDF, stand beside the others.
    let found = robot.links.len() + spec.attach.len() + spec.links.len();
    if found > LINKS_MAX {
        let message = format!("{found} found; at most {LINKS_MAX} expected");
        return Err(source.error(&[Key("robot"), Key("links")], message));
    }
    let mut index_of: BTreeMap<String, usize> = BTreeMap::new();
    for (index, link) in robot.links.iter().enumerate() {
        index_of.insert(link.name.clone(), index);
    }
    for (index, link) in spec.links.iter().enumerate() {
        let link = link_of(source, &index_of, index, link, notes)?;
        index_of.insert(link.name.clone(), robot.links.len());
        robot.links.push(link);
    }
    couple_links(source, spec, &index_of, &mut robot.links, notes)?;
    for (index, attached) in spec.attach.iter().enumerate() {
        let link = attached_link(source, &index_of, index, attached, notes)?;
        index_of.insert(link.name.clone(), robot.links.len());
        robot.links.push(link);
    }
    let locks = Locks { lock: &spec.lock, rest: &spec.rest, group: group.as_ref() };
    lock_joints(&mut robot.links, &locks, &source.states.borrow(), notes).map_err(
        |(place, message)| source.error(&[&[Key("robot")], &place[..]].concat(), message),
    )?;
    if robot.motion == BaseJoint::Fixed && robot.links.iter().all(|link| !moves(link)) {
        let message = "nothing moves: a moving base or a moving joint expected".to_owned();
        return Err(source.error(&[Key("robot")], message));
    }
    for (index, names) in spec.may_touch.iter().enumerate() {
        let mut pair = Vec::new();
        for name in names {
            let place = [Key("robot"), Key("may_touch"), Index(index)];
            let link = index_of.get(name).ok_or_else(|| {
                source.error(&place, format!("`{name}` found; the name of a link expected"))
            })?;
            pair.push(*link as u32);
        }
        robot.may_touch.push((pair[0].min(pair[1]), pair[0].max(pair[1])));
    }
    if let Some(padding) = &spec.padding {
        robot.padding =
            padding_of(padding, &index_of, robot.links.len()).map_err(|(place, message)| {
                source.error(&[&[Key("robot")], &place[..]].concat(), message)
            })?;
    }
    Ok(robot)
}

/// Reads the files of a robot, which take the place of all that the robot's spec could say of its links.
fn files_of(source: &Source, spec: &RobotSpec, file: &Path) -> Result<ReadRobot, ProblemError> {
    let others = [
        ("name", spec.name.is_some()),
        ("bodies", !spec.bodies.is_empty()),
        ("links", !spec.links.is_empty()),
    ];
    if let Some((key, _)) = others.iter().find(|(_, given)| *given) {
        let message = "given beside urdf, which says it; one of the two expected";
        return Err(source.error(&[Key("robot"), Key(key)], message.to_owned()));
    }
    let urdf = source.folder.join(file);
    let srdf = spec.srdf.as_ref().map(|file| source.folder.join(file));
    let files = RobotFiles { urdf: &urdf, srdf: srdf.as_deref(), group: spec.group.as_deref() };
    read_robot(&files).map_err(|(key, message)| source.error(&[Key("robot"), Key(key)], message))
}

/// Makes the joints that say so follow those of other links.
fn couple_links(
    source: &Source,
    spec: &RobotSpec,
    index_of: &BTreeMap<String, usize>,
    links: &mut [Link],
    notes: &mut Vec<String>,
) -> Result<(), ProblemError> {
    let place = |index: usize, rest: &[Step<'static>]| {
        [&[Key("robot"), Key("links"), Index(index), Key("joint"), Key("mimic")], rest].concat()
    };
    let mut followers = Vec::new();
    let mut indices = Vec::new();
    for (index, link) in spec.links.iter().enumerate() {
        let Some(MimicSpec { link: followed, multiplier, offset }) = &link.joint.mimic else {
            continue;
        };
        let followed = *index_of.get(followed).ok_or_else(|| {
            let message = format!("`{followed}` found; the name of a link expected");
            source.error(&place(index, &[Key("link")]), message)
        })?;
        let (multiplier, offset) = (*multiplier, *offset);
        // The base does not stand among the links of the file.
        followers.push(Follower { link: index + 1, followed, multiplier, offset });
        indices.push(index);
    }
    let told = couple(links, &followers)
        .map_err(|(index, message)| source.error(&place(indices[index], &[]), message))?;
    notes.extend(told);
    Ok(())
}

/// The links with names that fit and that no two have: where one is taken, the first of `NAME-2`, `NAME-3`, …
/// that is not.
pub(super) fn fitting_names(mut links: Vec<Link>) -> Vec<Link> {
    let mut taken: BTreeSet<String> = BTreeSet::new();
    // For each name of which several links have made one of their own: the first number not tried. Names stay
    // taken, so that the numbers before it need not be tried again.
    let mut next_count: BTreeMap<String, u64> = BTreeMap::new();
    for link in &mut links {
        let fits_alone = fitting(&link.name);
        let mut name = if fits_alone.is_empty() { "link".to_owned() } else { fits_alone.clone() };
        while taken.contains(&name) {
            let count = next_count.entry(fits_alone.clone()).or_insert(2);
            name = format!("{fits_alone}-{count}");
            *count += 1;
        }
        taken.insert(name.clone());
        link.name = name;
        if let Some(joint) = &mut link.joint {
            joint.name = fitting(&joint.name);
        }
    }
    links
}

pub(super) fn moves(link: &Link) -> bool {
    link.joint.as_ref().is_some_and(|joint| joint.kind.moves())
}

/// Reads a link, given the indices of the links before it by their names.
fn link_of(
    source: &Source,
    index_of: &BTreeMap<String, usize>,
    index: usize,
    spec: &LinkSpec,
    notes: &mut Vec<String>,
) -> Result<Link, ProblemError> {
    let place = [Key("robot"), Key("links"), Index(index)];
    let at = |keys: &[Step<'static>]| [&place[..], keys].concat();
    if !fits(&spec.name) || index_of.contains_key(&spec.name) {
        let message = format!("`{}` found; {NAME_EXPECTED}", spec.name);
        return Err(source.error(&at(&[Key("name")]), message));
    }
    let joint = &spec.joint;
    let parent = match &joint.parent {
        // The link before it. The base, link 0, does not stand among the `links`.
        None => index,
        Some(name) => *index_of.get(name).ok_or_else(|| {
            // This is what keeps the links a tree.
            let message = format!("`{name}` found; the name of a link before this one expected");
            source.error(&at(&[Key("joint"), Key("parent")]), message)
        })?,
    };
    let kind = kind_of(&joint.kind, joint.mimic.is_some())
        .map_err(|message| source.error(&at(&[Key("joint"), Key("kind")]), message))?;
    Ok(Link {
        name: spec.name.clone(),
        bodies: bodies(source, &at(&[Key("bodies")]), &spec.bodies, notes)?,
        joint: Some(Joint {
            name: joint.name.clone().unwrap_or_else(|| spec.name.clone()),
            parent: parent as u32,
            kind,
            before: frame(source, &at(&[Key("joint"), Key("before")]), &joint.before)?,
            after: frame(source, &at(&[Key("joint"), Key("after")]), &joint.after)?,
        }),
    })
}

/// The link that attached bodies become, given the indices of the links before it by their names.
fn attached_link(
    source: &Source,
    index_of: &BTreeMap<String, usize>,
    index: usize,
    spec: &AttachSpec,
    notes: &mut Vec<String>,
) -> Result<Link, ProblemError> {
    let at = |key| [Key("robot"), Key("attach"), Index(index), Key(key)];
    if !fits(&spec.name) || index_of.contains_key(&spec.name) {
        let message = format!("`{}` found; {NAME_EXPECTED}", spec.name);
        return Err(source.error(&at("name"), message));
    }
    let link = &spec.link;
    let parent = index_of.get(link).or_else(|| index_of.get(&fitting(link))).ok_or_else(|| {
        source.error(&at("link"), format!("`{link}` found; the name of a link expected"))
    })?;
    let (before, after) = (Pose::IDENTITY, Pose::IDENTITY);
    let (parent, kind) = (*parent as u32, JointKind::Locked);
    Ok(Link {
        name: spec.name.clone(),
        bodies: bodies(source, &at("bodies"), &spec.bodies, notes)?,
        joint: Some(Joint { name: spec.name.clone(), parent, kind, before, after }),
    })
}

/// How a joint moves alone; of one that follows another limits are those of its own value.
fn kind_of(spec: &JointKindSpec, follows: bool) -> Result<JointKind, String> {
    let direction = |axis: &[f64; 3]| {
        unit(*axis).ok_or_else(|| format!("axis {axis:?} found; a direction expected"))
    };
    let limits = |[min, max]: [f64; 2], most: f64| {
        // Written so that NaN fails it.
        if min <= max && -most <= min && max <= most {
            Ok(Limits { min, max })
        } else {
            Err(format!(
                "{min} to {max} found; a least and a largest value within ±{most:e} expected"
            ))
        }
    };
    Ok(match spec {
        JointKindSpec::Fixed {} => JointKind::Fixed,
        JointKindSpec::Spherical {} => JointKind::Spherical,
        JointKindSpec::Revolute { axis, degrees, radians } => {
            let limits = match (degrees, radians) {
                (Some(_), Some(_)) => {
                    return Err("degrees and radians found; one of the two expected".to_owned());
                }
                (None, None) => None,
                (None, Some(radians)) => Some(limits(*radians, TURN_MAX)?),
                (Some(degrees), None) => {
                    let Limits { min, max } = limits(*degrees, 3600.0)?;
                    let radians = |degrees: f64| degrees / 180.0 * std::f64::consts::PI;
                    Some(Limits { min: radians(min), max: radians(max) })
                }
            };
            JointKind::Revolute { axis: direction(axis)?, limits }
        }
        JointKindSpec::Locked {} => JointKind::Locked,
        JointKindSpec::Prismatic { axis, range } => {
            let limits = match range {
                Some(range) => limits(*range, LENGTH_MAX)?,
                None if follows => Limits { min: -LENGTH_MAX, max: LENGTH_MAX },
                None => {
                    let expected = "range = [least, largest] expected";
                    return Err(format!("a prismatic joint without range found; {expected}"));
                }
            };
            JointKind::Prismatic { axis: direction(axis)?, limits }
        }
    })
}

fn frame(source: &Source, place: &[Step], spec: &FrameSpec) -> Result<Pose, ProblemError> {
    pose_of(spec).map_err(|(key, message)| source.error(&[place, &[Key(key)]].concat(), message))
}
