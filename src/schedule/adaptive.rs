use crate::numbers::StrategyIndex;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Sets go to the strategies that united most components of the roadmap for their effort:
/// TR05-007 §3.1, *"adding independent roadmap components at run-time can allow map generation
/// strategies to adapt as areas of C-space are characterized"*.
///
/// A strategy's worth is (1 + united) / effort over the last `rounds` rounds. *United* counts the joining
/// edges of its sets that connected two components which both had nodes before the round, in
/// the order of the fold; *effort* is the configurations and motions whose validity its sets asked for,
/// to be made and to be joined. The sets of the next round are given out one after the other to the strategy of
/// the largest worth, each counted at once with a set of the strategy's average effort, so that equals
/// take turns and a strategy that unites nothing still comes now and then. One that has no set in the
/// last `rounds` rounds comes first. Ties go to the one listed first.
///
/// The schedule of a round follows from the ledger up to the round before and from nothing else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Adaptive {
    /// How many of the last rounds count.
    #[serde(default = "default_rounds")]
    pub rounds: u32,
}

impl Default for Adaptive {
    fn default() -> Adaptive {
        Adaptive { rounds: default_rounds() }
    }
}

fn default_rounds() -> u32 {
    10
}

/// What the sets of a strategy came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Yield {
    /// How many sets.
    pub sets: u64,
    /// How often they united components that were there before their round.
    pub united: u64,
    /// Configurations and motions asked for.
    pub effort: u64,
}

impl Adaptive {
    /// The strategies of a round's `sets`, in order, among those `listed`. `past` holds what every
    /// strategy came to in each round before, oldest first.
    pub fn round(
        &self,
        past: &[Vec<Yield>],
        listed: &[StrategyIndex],
        sets: u64,
    ) -> Vec<StrategyIndex> {
        let recent = &past[past.len().saturating_sub(self.rounds as usize)..];
        let mut worths: Vec<(StrategyIndex, Worth)> = Vec::new();
        for strategy in listed {
            if worths.iter().all(|(known, _)| known != strategy) {
                let yields = recent.iter().filter_map(|round| round.get(strategy.index()));
                worths.push((*strategy, Worth::of(yields)));
            }
        }
        // What is not known of a strategy is taken to be as dear as the dearest.
        let dearest = worths.iter().filter_map(|(_, worth)| worth.per_set).max().unwrap_or(1);
        let mut schedule = Vec::new();
        for _ in 0..sets {
            let mut best: Option<&mut (StrategyIndex, Worth)> = None;
            for candidate in &mut worths {
                if best.as_ref().is_none_or(|best| candidate.1.exceeds(&best.1)) {
                    best = Some(candidate);
                }
            }
            let Some((strategy, worth)) = best else { break };
            worth.effort += worth.per_set.unwrap_or(dearest);
            schedule.push(*strategy);
        }
        schedule
    }
}

/// The worth of a strategy as a fraction; without effort it exceeds all others.
#[derive(Clone, Copy, Debug)]
struct Worth {
    united: u128,
    effort: u128,
    per_set: Option<u128>,
}

impl Worth {
    fn of<'a>(yields: impl Iterator<Item = &'a Yield>) -> Worth {
        let (mut sets, mut united, mut effort) = (0u128, 0u128, 0u128);
        for each in yields {
            sets += u128::from(each.sets);
            united += u128::from(each.united);
            effort += u128::from(each.effort);
        }
        let per_set = (sets > 0).then(|| (effort / sets.max(1)).max(1));
        // A strategy with sets is known, however little effort they took.
        Worth { united, effort: effort.max(u128::from(sets > 0)), per_set }
    }

    fn exceeds(&self, other: &Worth) -> bool {
        (1 + self.united) * other.effort > (1 + other.united) * self.effort
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One per strategy, given as sets, united and effort.
    fn yields(of: &[[u64; 3]]) -> Vec<Yield> {
        of.iter()
            .map(|[sets, united, effort]| Yield { sets: *sets, united: *united, effort: *effort })
            .collect()
    }

    /// The schedule of a round, as bare indices.
    fn round(adaptive: Adaptive, past: &[Vec<Yield>], listed: &[u32], sets: u64) -> Vec<u32> {
        let listed: Vec<_> = listed.iter().copied().map(StrategyIndex).collect();
        adaptive.round(past, &listed, sets).into_iter().map(|strategy| strategy.0).collect()
    }

    #[test]
    fn unknown_strategies_come_first_and_in_turn() {
        let adaptive = Adaptive { rounds: 2 };
        assert_eq!(round(adaptive, &[], &[0, 1, 2], 7), [0, 1, 2, 0, 1, 2, 0]);
        let known = yields(&[[2, 50, 100], [0, 0, 0], [1, 0, 100]]);
        assert_eq!(round(adaptive, std::slice::from_ref(&known), &[0, 1, 2], 3), [1, 0, 0]);
        // What is not listed gets no set, and what was long ago is forgotten.
        assert_eq!(round(adaptive, std::slice::from_ref(&known), &[2], 2), [2, 2]);
        let later = yields(&[[0, 0, 0], [1, 0, 10], [1, 0, 10]]);
        assert_eq!(round(adaptive, &[known, later.clone(), later], &[0, 1, 2], 1), [0]);
    }

    #[test]
    fn sets_go_where_most_is_united_for_the_cost() {
        let adaptive = Adaptive { rounds: 5 };
        // 9 + 1 for 100 against 1 for 100: ten sets of the first to one of the second.
        let past = [yields(&[[1, 9, 100], [1, 0, 100]])];
        let schedule = round(adaptive, &past, &[0, 1], 11);
        assert_eq!(schedule.iter().filter(|strategy| **strategy == 1).count(), 1);
        // As much for half of the effort is worth twice as much.
        let past = [yields(&[[1, 1, 200], [1, 1, 100]])];
        assert_eq!(round(adaptive, &past, &[0, 1], 6), [1, 0, 1, 1, 0, 1]);
    }
}
