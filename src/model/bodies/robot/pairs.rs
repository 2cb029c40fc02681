//! Which pairs of links must not touch one another.

use super::{JointKind, Robot};

/// The links that are fixed to one another, as one rigid part of the robot. A joint that moves, or could if it were not
/// locked, separates two parts.
#[derive(Clone, Copy)]
struct Part {
    /// Index of the part that moves this one; `None` of the part that the base belongs to.
    parent: Option<usize>,
    /// Whether no link of the part has a body.
    is_empty: bool,
}

/// The parts of a robot.
struct Parts {
    parts: Vec<Part>,
    /// Per link: index of its part.
    of_links: Vec<usize>,
    /// Per link: index of the first link of those that never move against it. They are the link's part, and the parts that
    /// locked joints hold.
    held: Vec<usize>,
}

impl Parts {
    fn new(robot: &Robot) -> Parts {
        let mut parts: Vec<Part> = Vec::new();
        let mut of_links: Vec<usize> = Vec::new();
        let mut held: Vec<usize> = Vec::new();
        for (index, link) in robot.links.iter().enumerate() {
            held.push(match &link.joint {
                Some(joint) if !joint.kind.moves() => held[joint.parent as usize],
                _ => index,
            });
            let parent = link.joint.as_ref().map(|joint| of_links[joint.parent as usize]);
            let part = match (&link.joint, parent) {
                (Some(joint), Some(parent)) if joint.kind == JointKind::Fixed => parent,
                _ => {
                    parts.push(Part { parent, is_empty: true });
                    parts.len() - 1
                }
            };
            parts[part].is_empty &= link.bodies.is_empty();
            of_links.push(part);
        }
        Parts { parts, of_links, held }
    }

    /// Whether two parts are neighbours: one of them moves the other, at most one part without bodies being between.
    fn are_neighbors(&self, one: usize, other: usize) -> bool {
        self.is_moved_by(one, other) || self.is_moved_by(other, one)
    }

    fn is_moved_by(&self, child: usize, mover: usize) -> bool {
        let Some(parent) = self.parts[child].parent else { return false };
        let Part { parent: above, is_empty } = self.parts[parent];
        parent == mover || is_empty && above == Some(mover)
    }
}

impl Robot {
    /// The pairs of links with bodies, the lower index first, that must not touch: all but links that never move against
    /// one another, neighbours, and those that may ([`Robot::may_touch`]). Neighbours are two links with one joint that
    /// moves, or is locked, between them, or with two, one after the other, and nothing but links without bodies between
    /// these two joints.
    pub fn self_pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let parts = Parts::new(self);
        let has_bodies = |link: &usize| !self.links[*link].bodies.is_empty();
        let solid: Vec<usize> = (0..self.links.len()).filter(has_bodies).collect();
        let mut may_touch = self.may_touch.clone();
        may_touch.sort_unstable();
        let count = solid.len();
        let pairs = (0..count).flat_map(move |high| (0..high).map(move |low| (low, high)));
        pairs.map(move |(low, high)| (solid[low], solid[high])).filter(move |(low, high)| {
            let [one, other] = [low, high].map(|link| parts.of_links[*link]);
            let still = parts.held[*low] == parts.held[*high];
            let exempt = still || parts.are_neighbors(one, other);
            !exempt && may_touch.binary_search(&(*low as u32, *high as u32)).is_err()
        })
    }
}
