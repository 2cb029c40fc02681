use super::LocalPlanner;
use crate::context::Context;
use crate::roadmap::Configs;

/// Straight in the configuration space: every degree of freedom changes at constant speed, angles
/// and rotations by the shortest turn (Kavraki et al. 1996; TR05-007 §4.1). Tag 0.
pub(super) struct StraightLine;

impl LocalPlanner for StraightLine {
    fn turns(&self, _: &Context, _: &[f64], _: &[f64], _: &mut Configs) {}

    fn tag(&self) -> u8 {
        0
    }

    fn name(&self) -> String {
        "straight-line".to_owned()
    }

    fn of_tag(tag: u8) -> Option<StraightLine> {
        (tag == 0).then_some(StraightLine)
    }
}
