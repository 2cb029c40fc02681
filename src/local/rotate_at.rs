use super::LocalPlanner;
use crate::context::Context;
use crate::methods::Complaint;
use crate::roadmap::Configs;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The tag of the planner that turns at the first end.
const FIRST_TAG: u8 = 1;
const PERCENT_MAX: u8 = 100;

/// Rotate-at-s (N. M. Amato, O. B. Bayazit, L. K. Dale, C. Jones, D. Vallejo, *Choosing good distance
/// metrics and local planners for probabilistic roadmap methods*, 2000): translate from a towards b as
/// one stands at a until the share of the way that `percent` says, there turn and bend into what one is at b, then
/// translate the rest. What does not translate has nothing to be kept apart from, and goes straight.
/// Tags 1 to 101.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct RotateAt {
    /// Where it turns, in hundredths of the way from the first end to the second: 0 to 100.
    pub percent: u8,
}

impl LocalPlanner for RotateAt {
    fn turns(&self, cx: &Context, a: &[f64], b: &[f64], out: &mut Configs) {
        let translations = cx.space.translations();
        if translations == 0 || translations == a.len() {
            return;
        }
        let mut there = vec![0.0; a.len()];
        let share = f64::from(self.percent) / 100.0;
        cx.space.interpolate(a, b, share, &mut there);
        for end in [a, b] {
            there[translations..].copy_from_slice(&end[translations..]);
            out.push(&there);
        }
    }

    fn tag(&self) -> u8 {
        FIRST_TAG.saturating_add(self.percent)
    }

    fn name(&self) -> String {
        format!("rotate-at-{}", self.percent)
    }

    fn of_tag(tag: u8) -> Option<RotateAt> {
        let percent = tag.checked_sub(FIRST_TAG).filter(|percent| *percent <= PERCENT_MAX)?;
        Some(RotateAt { percent })
    }

    fn complaint(&self) -> Option<Complaint> {
        let fits = self.percent <= PERCENT_MAX;
        (!fits).then(|| Complaint::new("percent", self.percent, "0 to 100"))
    }
}
