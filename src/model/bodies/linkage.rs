//! The robot: its base, its links and their joints.

use super::foreign::read_urdf;
use super::robot::{Joint, JointKind, LINKS_MAX, Limits, Link, Robot, TURN_MAX};
use super::shapes::{bodies, pose_of, unit};
use super::tables::{FrameTable, JointKindTable, LinkTable, RobotTable};
use crate::scene::{LENGTH_MAX, Pose};
use crate::source;
use crate::source::Step::{self, Index, Key};
use crate::source::{ProblemError, Source, fits};
use crate::space::BaseJoint;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Name of link 0 where the file gives none.
const BASE: &str = "base";
const NAME_EXPECTED: &str = "a name of its own of letters, digits, `-`, `_` and `.` expected";

/// Reads the robot.
pub(super) fn robot_of(
    source: &Source,
    table: &RobotTable,
    motion: BaseJoint,
    notes: &mut Vec<String>,
) -> Result<Robot, ProblemError> {
    let mut robot = Robot::rigid(motion, Vec::new());
    match &table.urdf {
        Some(file) => robot.links = urdf_links(source, table, file, notes)?,
        None => {
            let place = [Key("robot"), Key("bodies")];
            robot.links[0].bodies = bodies(source, &place, &table.bodies, notes)?;
            robot.links[0].name = table.name.clone().unwrap_or_else(|| BASE.to_owned());
        }
    }
    if !fits(&robot.links[0].name) {
        let message = format!("`{}` found; {NAME_EXPECTED}", robot.links[0].name);
        return Err(source.error(&[Key("robot"), Key("name")], message));
    }
    if let Some(base) = &table.base {
        if motion != BaseJoint::Fixed {
            let message = "given, but the base moves; motion = \"fixed\" expected beside it";
            return Err(source.error(&[Key("robot"), Key("base")], message.to_owned()));
        }
        robot.base = frame(source, &[Key("robot"), Key("base")], base)?;
    }
    if table.links.len().max(robot.links.len()) > LINKS_MAX {
        let found = table.links.len().max(robot.links.len());
        let message = format!("{found} found; at most {LINKS_MAX} expected");
        return Err(source.error(&[Key("robot"), Key("links")], message));
    }
    let mut index_of: BTreeMap<String, usize> = BTreeMap::new();
    for (index, link) in robot.links.iter().enumerate() {
        index_of.insert(link.name.clone(), index);
    }
    for (index, link) in table.links.iter().enumerate() {
        let link = link_of(source, &index_of, index, link, notes)?;
        index_of.insert(link.name.clone(), robot.links.len());
        robot.links.push(link);
    }
    if motion == BaseJoint::Fixed && robot.links.iter().all(|link| !moves(link)) {
        let message = "nothing moves: a moving base or a moving joint expected".to_owned();
        return Err(source.error(&[Key("robot")], message));
    }
    for (index, names) in table.may_touch.iter().enumerate() {
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
    Ok(robot)
}

/// The links of a URDF, which takes the place of all that the table could say of them.
fn urdf_links(
    source: &Source,
    table: &RobotTable,
    file: &Path,
    notes: &mut Vec<String>,
) -> Result<Vec<Link>, ProblemError> {
    let others = [
        ("name", table.name.is_some()),
        ("bodies", !table.bodies.is_empty()),
        ("links", !table.links.is_empty()),
    ];
    if let Some((key, _)) = others.iter().find(|(_, given)| *given) {
        let message = "given beside urdf, which says it; one of the two expected";
        return Err(source.error(&[Key("robot"), Key(key)], message.to_owned()));
    }
    let folder = source.path.parent().unwrap_or(Path::new(""));
    let robot = read_urdf(&folder.join(file))
        .map_err(|error| source.error(&[Key("robot"), Key("urdf")], error.to_string()))?;
    notes.extend(robot.notes);
    robot.sources.into_iter().for_each(|file| source.read(file));
    Ok(fitting_names(robot.links))
}

/// The links with names that fit and that no two have: where one is taken, the first of `NAME-2`, `NAME-3`, …
/// that is not.
pub(super) fn fitting_names(mut links: Vec<Link>) -> Vec<Link> {
    let mut taken: BTreeSet<String> = BTreeSet::new();
    // For each name of which several links have made one of their own: the first number not tried. Names stay
    // taken, so that the numbers before it need not be tried again.
    let mut next_count: BTreeMap<String, u64> = BTreeMap::new();
    for link in &mut links {
        let fitting = source::fitting(&link.name);
        let mut name = if fitting.is_empty() { "link".to_owned() } else { fitting.clone() };
        while taken.contains(&name) {
            let count = next_count.entry(fitting.clone()).or_insert(2);
            name = format!("{fitting}-{count}");
            *count += 1;
        }
        taken.insert(name.clone());
        link.name = name;
        if let Some(joint) = &mut link.joint {
            joint.name = source::fitting(&joint.name);
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
    table: &LinkTable,
    notes: &mut Vec<String>,
) -> Result<Link, ProblemError> {
    let place = [Key("robot"), Key("links"), Index(index)];
    let at = |keys: &[Step<'static>]| [&place[..], keys].concat();
    if !fits(&table.name) || index_of.contains_key(&table.name) {
        let message = format!("`{}` found; {NAME_EXPECTED}", table.name);
        return Err(source.error(&at(&[Key("name")]), message));
    }
    let joint = &table.joint;
    let parent = match &joint.parent {
        // The link before it. The base, link 0, does not stand among the tables.
        None => index,
        Some(name) => *index_of.get(name).ok_or_else(|| {
            // This is what keeps the links a tree.
            let message = format!("`{name}` found; the name of a link before this one expected");
            source.error(&at(&[Key("joint"), Key("parent")]), message)
        })?,
    };
    let kind = kind_of(&joint.kind)
        .map_err(|message| source.error(&at(&[Key("joint"), Key("kind")]), message))?;
    Ok(Link {
        name: table.name.clone(),
        bodies: bodies(source, &at(&[Key("bodies")]), &table.bodies, notes)?,
        joint: Some(Joint {
            name: joint.name.clone().unwrap_or_else(|| table.name.clone()),
            parent: parent as u32,
            kind,
            before: frame(source, &at(&[Key("joint"), Key("before")]), &joint.before)?,
            after: frame(source, &at(&[Key("joint"), Key("after")]), &joint.after)?,
        }),
    })
}

fn kind_of(table: &JointKindTable) -> Result<JointKind, String> {
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
    Ok(match table {
        JointKindTable::Fixed {} => JointKind::Fixed,
        JointKindTable::Spherical {} => JointKind::Spherical,
        JointKindTable::Revolute { axis, degrees, radians } => {
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
        JointKindTable::Prismatic { axis, range } => {
            JointKind::Prismatic { axis: direction(axis)?, limits: limits(*range, LENGTH_MAX)? }
        }
    })
}

fn frame(source: &Source, place: &[Step], table: &FrameTable) -> Result<Pose, ProblemError> {
    pose_of(&table.position, &table.orientation, &table.turn)
        .map_err(|(key, message)| source.error(&[place, &[Key(key)]].concat(), message))
}
