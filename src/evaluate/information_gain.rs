use super::{Evaluator, Verdict, complaint_of_change};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{Asked, Scratch};
use crate::numbers::NodeId;
use crate::roadmap::Roadmap;
use crate::space::Space;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The last rounds told hardly anything new: TR05-007 §5, *"Such an evaluator would report that the
/// roadmap is sufficient if the information gain from the previous set of samples is below a
/// threshold."*
///
/// A new node tells something new in two ways: it lies where the roadmap did not reach, or it unites
/// parts of the roadmap that were apart (M. Morales, R. Pearce, N. M. Amato, *Analysis of the
/// evolution of C-space models built through incremental exploration*, 2007, call these *cc-create*
/// and *cc-merge*). So two shares are measured, from the roadmap's own history: of the nodes of the
/// last rounds those that are in a component without earlier nodes, *unreached*; and of all pairs of
/// earlier nodes those that the last rounds connected, *united*. The value is the larger one. That
/// a new node widens a component counts as nothing new: to tell which one does would take validity
/// checks of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct InformationGain {
    /// How many of the last rounds are judged together.
    #[serde(default = "default_rounds")]
    pub rounds: u32,
    /// The largest percentage at which the criterion is satisfied.
    #[serde(default = "default_percent")]
    pub percent: f64,
}

impl Default for InformationGain {
    fn default() -> InformationGain {
        InformationGain { rounds: default_rounds(), percent: default_percent() }
    }
}

fn default_rounds() -> u32 {
    1
}

fn default_percent() -> f64 {
    5.0
}

impl InformationGain {
    /// The two shares, *unreached* and *united*.
    fn shares(&self, space: &Space, roadmap: &Roadmap) -> [f64; 2] {
        let before = roadmap.rounds().iter().rev().nth(self.rounds as usize);
        before.filter(|before| before.nodes > 0).map_or([1.0, 1.0], |before| {
            let old = roadmap.components_at(space, *before);
            let mut old_nodes: BTreeMap<NodeId, u64> = BTreeMap::new();
            for component in old.iter() {
                let now = roadmap.components().of_node(component.name).name;
                *old_nodes.entry(now).or_default() += component.members.len() as u64;
            }
            let all_nodes = roadmap.configs().len();
            let new = NodeId::each(NodeId(before.nodes as u32)..NodeId(all_nodes as u32));
            let all = (all_nodes - before.nodes) as f64;
            let name = |node: NodeId| roadmap.components().of_node(node).name;
            let unreached = new.filter(|node| !old_nodes.contains_key(&name(*node))).count();

            let pairs = |nodes: u64| u128::from(nodes) * u128::from(nodes.saturating_sub(1)) / 2;
            let connected_before: u128 =
                old.iter().map(|component| pairs(component.members.len() as u64)).sum();
            let connected_now: u128 = old_nodes.values().map(|nodes| pairs(*nodes)).sum();
            let united = (connected_now - connected_before) as f64;
            [unreached as f64 / all, united / pairs(before.nodes as u64).max(1) as f64]
        })
    }
}

impl Evaluator for InformationGain {
    fn name(&self) -> &'static str {
        "information-gain"
    }

    fn measures(&self) -> &'static [&'static str] {
        &["unreached", "united"]
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        _scratch: &mut Scratch,
    ) -> Verdict {
        let shares = self.shares(&cx.space, roadmap);
        Verdict {
            measures: shares.to_vec(),
            ..Verdict::at_most(self.percent / 100.0, shares[0].max(shares[1]), Asked::default())
        }
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.rounds == 0 {
            return Some(Complaint::new("rounds", "0", "at least 1"));
        }
        complaint_of_change(self.percent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::tests::{grow, hand_made};

    #[test]
    fn new_regions_and_mergers_tell_something_and_growth_does_not() {
        let (space, mut roadmap) = hand_made();
        let mut shares = |rounds, nodes: &[[f64; 2]], joins: &[(u32, u32)]| {
            grow(&space, &mut roadmap, nodes, joins);
            InformationGain { rounds, percent: 5.0 }.shares(&space, &roadmap)
        };
        let q = [1.0, 1.0];
        assert_eq!(shares(1, &[q, q, q, q], &[(0, 1), (1, 2)]), [1.0, 1.0]);
        // One of two new nodes joins the component of three.
        assert_eq!(shares(1, &[q, q], &[(0, 4)]), [0.5, 0.0]);
        // Components of 4, 1 and 1 nodes: the new node unites the latter two, one pair of 15.
        assert_eq!(shares(1, &[q], &[(3, 6), (5, 6)]), [0.0, 1.0 / 15.0]);
        // Together with the round before nodes 4, 5 and 6 came to {0, 1, 2} and {3}, and reached both.
        grow(&space, &mut roadmap, &[q], &[(0, 7), (6, 7)]);
        let together = |rounds| InformationGain { rounds, percent: 5.0 }.shares(&space, &roadmap);
        assert_eq!(together(1), [0.0, 12.0 / 21.0]);
        assert_eq!(together(3), [0.0, 3.0 / 6.0]);
        assert_eq!(together(4), [1.0, 1.0]);
    }
}
