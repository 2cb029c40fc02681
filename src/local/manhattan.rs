use super::LocalPlanner;
use crate::context::Context;
use crate::roadmap::Configs;
use crate::space::FactorKind;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// One degree of freedom after the other, in their order, a rotation as one: the way of a shortest path in the
/// Manhattan metric (N. M. Amato, O. B. Bayazit, L. K. Dale, C. Jones, D. Vallejo 2000 compare metrics for
/// choosing what to connect). A linkage moves joint by joint, and its links nearest to the base first. Degrees of
/// freedom that do not change make no turn. Tag 102.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Manhattan {}

const TAG: u8 = 102;

impl LocalPlanner for Manhattan {
    fn turns(&self, cx: &Context, a: &[f64], b: &[f64], out: &mut Configs) {
        let changes = cx.space.factors().iter().map(|part| {
            let values = if part.kind == FactorKind::Rotation { 4 } else { 1 };
            part.at..part.at + values
        });
        let mut there = a.to_vec();
        for values in changes.filter(|values| a[values.clone()] != b[values.clone()]) {
            if there != a {
                out.push(&there);
            }
            there[values.clone()].copy_from_slice(&b[values]);
        }
    }

    fn tag(&self) -> u8 {
        TAG
    }

    fn name(&self) -> String {
        "manhattan".to_owned()
    }

    fn of_tag(tag: u8) -> Option<Manhattan> {
        (tag == TAG).then_some(Manhattan {})
    }
}
