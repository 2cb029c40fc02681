//! A linkage with a joint more.

use crate::model::bodies::robot::{Joint, JointKind, Limits, Link, Mimic, Robot};
use crate::model::bodies::shapes::unit;
use crate::model::relaxation::{CannotRelax, ExtraJoint, ExtraJointKind};
use crate::scene::Pose;

/// What the name of the link between the two joints begins with.
const NAME: &str = "extra";

/// The robot with a link without bodies between the link that is asked for and the one that it hangs on. The extra joint moves the new
/// link, and the link's own joint, whose frame the new link is, moves the link as before. Which links must not touch stays as it was.
/// Also where in a configuration the extra joint's value stands.
///
/// # Errors
/// There is no such link, or it is the base; the axis has no direction.
pub(super) fn with_joint(
    robot: &Robot,
    asked: &ExtraJoint,
    level: f64,
) -> Result<(Robot, usize), CannotRelax> {
    let Some(at) = robot.links.iter().position(|link| link.name == asked.link).filter(|at| *at > 0)
    else {
        let known: Vec<&str> = robot.links[1..].iter().map(|link| &*link.name).collect();
        let known = if known.is_empty() {
            "none, as the robot has one link".to_owned()
        } else {
            known.join(", ")
        };
        let message =
            format!("`{}` found; a link other than the base expected: {known}", asked.link);
        return Err(CannotRelax::new("link", message));
    };
    let kind = kind_of(&asked.kind, 1.0 - level)?;
    let own = robot.links[at].joint.as_ref().expect("every link but the base hangs on a joint");
    let name = unique_name(robot);
    let joint = Joint {
        name: name.clone(),
        parent: own.parent,
        kind,
        before: own.before,
        after: Pose::IDENTITY,
    };
    let before_it = robot.links[..at].iter().filter_map(|link| link.joint.as_ref());
    // Counted from the first value after the base's.
    let value: usize = before_it.map(|joint| joint.kind.values()).sum();
    let moved = |link: u32| if link as usize >= at { link + 1 } else { link };
    let mut links = robot.links.clone();
    for (index, link) in links.iter_mut().enumerate() {
        let Some(joint) = &mut link.joint else { continue };
        joint.parent = moved(joint.parent);
        if let JointKind::RevoluteMimic { mimic, .. } | JointKind::PrismaticMimic { mimic, .. } =
            &mut joint.kind
            && mimic.value as usize >= value
        {
            *mimic = Mimic { value: mimic.value + 1, ..*mimic };
        }
        if index == at {
            (joint.parent, joint.before) = (at as u32, Pose::IDENTITY);
        }
    }
    links.insert(at, Link { name, bodies: Vec::new(), joint: Some(joint) });
    let mut padding = robot.padding.clone();
    if !padding.is_empty() {
        padding.insert(at, 0.0);
    }
    let may_touch = robot.may_touch.iter().map(|(one, other)| (moved(*one), moved(*other)));
    let mut longer = Robot { links, padding, may_touch: may_touch.collect(), ..robot.clone() };
    // A joint more separates links that were neighbours.
    let had: Vec<(usize, usize)> = robot
        .self_pairs()
        .map(|(one, other)| (moved(one as u32) as usize, moved(other as u32) as usize))
        .collect();
    let new = longer.self_pairs().filter(|pair| !had.contains(pair));
    let new: Vec<(u32, u32)> = new.map(|(one, other)| (one as u32, other as u32)).collect();
    longer.may_touch.extend(new);
    Ok((longer, robot.motion.values() + value))
}

/// How the joint moves where `share` of its range is left.
fn kind_of(kind: &ExtraJointKind, share: f64) -> Result<JointKind, CannotRelax> {
    let (ExtraJointKind::Prismatic { axis, .. } | ExtraJointKind::Revolute { axis, .. }) = kind;
    let Some(axis) = unit(*axis) else {
        return Err(CannotRelax::new("kind", format!("axis {axis:?} found; a direction expected")));
    };
    let limits = |[min, max]: [f64; 2], per_unit: f64| Limits {
        min: min * share * per_unit,
        max: max * share * per_unit,
    };
    Ok(match kind {
        ExtraJointKind::Prismatic { range, .. } => {
            JointKind::Prismatic { axis, limits: limits(*range, 1.0) }
        }
        ExtraJointKind::Revolute { degrees, .. } => {
            let limits = limits(*degrees, std::f64::consts::PI / 180.0);
            JointKind::Revolute { axis, limits: Some(limits) }
        }
    })
}

/// A name that no link and no joint has.
fn unique_name(robot: &Robot) -> String {
    let is_taken = |name: &str| {
        robot.links.iter().any(|link| {
            link.name == name || link.joint.as_ref().is_some_and(|joint| joint.name == name)
        })
    };
    let numbered = (2u32..).map(|number| format!("{NAME}-{number}"));
    let mut names = std::iter::once(NAME.to_owned()).chain(numbered);
    names.find(|name| !is_taken(name)).expect("there are more names than links")
}
