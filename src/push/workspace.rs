//! The workspace-assisted push (O. B. Bayazit 2003, chapter IV D 1): the robot is translated as the obstacles suggest.
//!
//! The dissertation takes its directions from the closest pairs of vertices of robot and obstacles. Here they are the normals of the contacts, which
//! the model knows, and which lead out of the obstacle where such a pair may lead along it or into it.

use super::{Pushed, Run, Search};
use crate::space::Space;

/// How many contacts give directions the first time (the dissertation: *m*), and how many more each time after that.
const CONTACTS: u32 = 6;
const MORE_CONTACTS: u32 = 6;
const MOST_CONTACTS: u32 = 60;
/// Directions whose cosine is greater are one.
const ALIKE: f64 = 0.95;

/// Translates every configuration of a stretch along the normals of its deepest contacts, those that are alike once, to the first valid configuration along
/// each. It fails where the robot has to turn.
pub(super) fn push(run: &Run, search: &mut Search) -> Vec<Pushed> {
    let (Some(contacts), axes @ 1..) =
        (search.cx.model().contacts(), search.cx.space().translations())
    else {
        return Vec::new();
    };
    let most = CONTACTS.saturating_add(search.effort.saturating_mul(MORE_CONTACTS));
    let most = most.min(MOST_CONTACTS) as usize;
    let mut found = Vec::new();
    for (from, q) in run.colliding.iter().enumerate() {
        let mut directions: Vec<[f64; 3]> = Vec::new();
        for contact in contacts.contacts(q, most, search.scratch) {
            let Some(direction) = within(contact.normal, axes) else { continue };
            let cosine = |other: &[f64; 3]| (0..3).map(|i| other[i] * direction[i]).sum::<f64>();
            if directions.iter().all(|other| cosine(other) <= ALIKE) {
                directions.push(direction);
            }
        }
        for direction in directions {
            if let Some(q) = translated(q, direction, search) {
                found.push(Pushed { from, q });
            }
        }
    }
    found
}

/// What a unit vector has of the axes along which the base moves, as a unit vector.
fn within(normal: [f64; 3], axes: usize) -> Option<[f64; 3]> {
    let own: Vec<f64> = (0..3).map(|i| if i < axes { normal[i] } else { 0.0 }).collect();
    let length = own.iter().map(|value| value * value).sum::<f64>().sqrt();
    (length > 1e-6).then(|| [own[0] / length, own[1] / length, own[2] / length])
}

fn translated(q: &[f64], direction: [f64; 3], search: &mut Search) -> Option<Vec<f64>> {
    let space: &Space = search.cx.space();
    let mut to = q.to_vec();
    for axis in 0..space.translations() {
        to[axis] += search.step * direction[axis];
    }
    let direction = space.displacement(q, &to);
    search.first_valid(q, &direction)
}
