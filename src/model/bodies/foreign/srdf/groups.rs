//! Which joints a group of an SRDF has.

use super::{Group, Member, Srdf};
use crate::model::bodies::foreign::ForeignError;
use crate::model::bodies::robot::Link;
use std::collections::BTreeSet;

/// The joints of a group.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::model::bodies) struct GroupJoints {
    /// Indices of the links that they move.
    pub links: BTreeSet<usize>,
    /// Whether the virtual joint that moves the base is one of them.
    pub has_base: bool,
    /// What the group names and the robot does not have, each with its line of the file.
    pub unknown: Vec<String>,
}

/// The most groups within one another.
const DEPTH_MAX: usize = 64;

/// Groups on the way through groups within groups.
struct Walk<'a> {
    /// Those that the one at hand is listed in, the outermost first.
    open: Vec<&'a str>,
    /// Those whose members have been added, or are being added.
    done: BTreeSet<&'a str>,
}

impl Srdf {
    /// The joints of the group `name` of the robot with these links, named as in its URDF; `None` if there is no such
    /// group. Fixed joints count, too: they are what a chain passes.
    ///
    /// # Errors
    /// Names file and line: a chain between links of which the first does not carry the second, or groups within one
    /// another without end.
    pub(in crate::model::bodies) fn joints_of(
        &self,
        name: &str,
        links: &[Link],
    ) -> Option<Result<GroupJoints, ForeignError>> {
        let group = self.groups.iter().find(|group| group.name == name)?;
        let mut joints = GroupJoints::default();
        let mut walk = Walk { open: vec![name], done: BTreeSet::new() };
        Some(self.add(group, links, &mut walk, &mut joints).map(|()| joints))
    }

    fn add<'a>(
        &'a self,
        group: &'a Group,
        links: &[Link],
        walk: &mut Walk<'a>,
        joints: &mut GroupJoints,
    ) -> Result<(), ForeignError> {
        let link_of = |name: &str| links.iter().position(|link| link.name == name);
        for (line, member) in &group.members {
            let lost = |what: &str, name: &str| format!("{what} `{name}` (line {line})");
            let error = |message: String| {
                let message = format!("group `{}`: {message}", group.name);
                Err(ForeignError::line(&self.path, *line, message))
            };
            match member {
                Member::Joint(name) => {
                    let moves =
                        |link: &Link| link.joint.as_ref().is_some_and(|joint| joint.name == *name);
                    let found = links.iter().position(moves);
                    let is_virtual = self.virtual_joints.iter().any(|joint| joint.name == *name);
                    joints.has_base |= is_virtual;
                    match found {
                        Some(link) => _ = joints.links.insert(link),
                        None if is_virtual => {}
                        None => joints.unknown.push(lost("joint", name)),
                    }
                }
                Member::Link(name) => match link_of(name) {
                    Some(link) => _ = joints.links.insert(link),
                    None => joints.unknown.push(lost("link", name)),
                },
                Member::Chain { base, tip } => {
                    let (first, last) = match (link_of(base), link_of(tip)) {
                        (Some(first), Some(last)) => (first, last),
                        (first, _) => {
                            let (end, name) =
                                if first.is_none() { ("base", base) } else { ("tip", tip) };
                            joints.unknown.push(lost(&format!("{end} link"), name));
                            continue;
                        }
                    };
                    let mut link = last;
                    while link != first {
                        let Some(joint) = &links[link].joint else {
                            return error(format!(
                                "a chain from `{base}` to `{tip}` found, of which the first does \
                                 not carry the second; a link and one that hangs on it expected"
                            ));
                        };
                        joints.links.insert(link);
                        link = joint.parent as usize;
                    }
                }
                Member::Group(name) => {
                    let Some(inner) = self.groups.iter().find(|group| group.name == *name) else {
                        joints.unknown.push(lost("group", name));
                        continue;
                    };
                    if walk.open.contains(&name.as_str()) {
                        return error(format!("`{name}` found within itself"));
                    }
                    if walk.open.len() >= DEPTH_MAX {
                        return error(format!(
                            "`{name}` found within {DEPTH_MAX} groups; fewer within one another expected"
                        ));
                    }
                    // A group that is listed again has nothing to add.
                    if walk.done.insert(name) {
                        walk.open.push(name);
                        self.add(inner, links, walk, joints)?;
                        walk.open.pop();
                    }
                }
            }
        }
        Ok(())
    }
}
