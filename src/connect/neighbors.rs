use super::candidates::CandidatePairs;
use super::{Among, JoinInput, Within, connect_pairs, default_planners};
use crate::context::Context;
use crate::finder::FinderKind;
use crate::local::{self, Planner};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Configs, Edge};
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Each milestone with its neighbours by any neighbour finder, within a set or among sets. All pairs are tried and
/// all successes kept: within a set in ascending order from the lower to the higher id, among sets each new
/// milestone in order with its neighbours, nearest first, from the old one to the new.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Neighbors {
    /// The neighbour finder.
    #[serde(default)]
    pub finder: FinderKind,
    /// Local planners, tried in this order until one succeeds.
    #[serde(default = "default_planners")]
    pub planners: Vec<Planner>,
}

impl Default for Neighbors {
    fn default() -> Neighbors {
        Neighbors { finder: FinderKind::default(), planners: default_planners() }
    }
}

impl Neighbors {
    fn complaint(&self) -> Option<Complaint> {
        self.finder.method().complaint().or_else(|| local::complaint(&self.planners))
    }
}

impl Within for Neighbors {
    fn connect(
        &self,
        cx: &Context,
        seed: &Seed,
        configs: &Configs,
        scratch: &mut Scratch,
    ) -> Vec<Edge> {
        let chance = &mut seed.stream(Purpose::Connecting);
        let pairs = self.finder.method().pairs(cx, configs, chance, scratch);
        connect_pairs(cx, &self.planners, configs, &pairs, scratch)
    }

    fn complaint(&self) -> Option<Complaint> {
        self.complaint()
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.finder.method().suits(cx)
    }
}

impl Among for Neighbors {
    fn connect(&self, cx: &Context, input: &JoinInput, scratch: &mut Scratch) -> Vec<Edge> {
        let Some(candidates) = CandidatePairs::new(input) else { return Vec::new() };
        let chance = &mut input.seed.stream(Purpose::Joining);
        let pairs = candidates.found(cx, self.finder.method(), chance, scratch).into_iter();
        pairs.filter_map(|pair| candidates.connect(cx, &self.planners, pair, scratch)).collect()
    }

    fn complaint(&self) -> Option<Complaint> {
        self.complaint()
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.finder.method().suits(cx)
    }
}
