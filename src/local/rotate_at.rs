use super::LocalPlanner;
use crate::context::Context;
use crate::roadmap::Configs;

/// Rotate-at-s (N. M. Amato, O. B. Bayazit, L. K. Dale, C. Jones, D. Vallejo, *Choosing good distance
/// metrics and local planners for probabilistic roadmap methods*, 2000): translate from a towards b as
/// one stands at a until the share `s` of the way, there turn and bend into what one is at b, then
/// translate the rest. What does not translate has nothing to be kept apart from, and goes straight.
pub(super) struct RotateAt {
    /// The share of the way, in `[0, 1]`.
    pub s: f64,
}

impl LocalPlanner for RotateAt {
    fn turns(&self, cx: &Context, a: &[f64], b: &[f64], out: &mut Configs) {
        let translations = cx.space.translations();
        if translations == 0 || translations == a.len() {
            return;
        }
        let mut there = vec![0.0; a.len()];
        cx.space.interpolate(a, b, self.s, &mut there);
        for end in [a, b] {
            there[translations..].copy_from_slice(&end[translations..]);
            out.push(&there);
        }
    }
}
