//! Joints that are held at a value.

use super::{JointKind, Link, Mimic};
use crate::scene::Pose;
use crate::space::stored_form;

/// Holds joints at values: `values` has, for every link, the value at which its joint is held, or `None`. A spherical
/// joint is held where it does not turn, whatever its number. Joints that follow a locked one are locked with it, and
/// configurations are the shorter for every value that goes.
pub(in crate::model::bodies) fn lock(links: &mut [Link], values: &[Option<f64>]) {
    // Of each value of a configuration: where it is held, or else its index among those that stay.
    let mut states: Vec<Result<f64, u32>> = Vec::new();
    let mut kept = 0;
    for (link, value) in links.iter().zip(values) {
        let Some(joint) = &link.joint else { continue };
        for _ in 0..joint.kind.values() {
            states.push(match value {
                Some(value) => Ok(*value),
                None => Err(kept),
            });
            kept += u32::from(value.is_none());
        }
    }
    for (link, value) in links.iter_mut().zip(values) {
        let Some(joint) = &mut link.joint else { continue };
        let held = match &mut joint.kind {
            JointKind::Fixed | JointKind::Locked => None,
            JointKind::Revolute { .. } | JointKind::Prismatic { .. } => *value,
            JointKind::Spherical => value.map(|_| 0.0),
            JointKind::RevoluteMimic { mimic, .. } | JointKind::PrismaticMimic { mimic, .. } => {
                let Mimic { value, multiplier, offset } = mimic;
                match states[*value as usize] {
                    Ok(held) => Some(*multiplier * held + *offset),
                    Err(index) => {
                        *value = index;
                        None
                    }
                }
            }
        };
        let Some(held) = held else { continue };
        let values: &[f64] = match joint.kind {
            JointKind::Spherical => &[1.0, 0.0, 0.0, 0.0],
            _ => &[held],
        };
        joint.before = joint.pose(values);
        // In the form that a file gives rotations, so that what is written can be read again to the bit.
        if let Some(rotation) = stored_form(joint.before.rotation) {
            joint.before.rotation = rotation;
        }
        joint.after = Pose::IDENTITY;
        joint.kind = JointKind::Locked;
    }
}
