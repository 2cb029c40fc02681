use crate::problem::Problem;
use std::ops::Range;

/// Which set comes where: sets stand in one sequence of *places*, a schedule over the strategies
/// repeats along it, and every `sets_per_round` places make a round.
#[derive(Clone, Debug)]
pub struct Plan {
    schedule: Vec<u32>,
    /// Per place of the schedule: how often its strategy came before it there.
    before: Vec<u64>,
    /// Per strategy: how often it comes in the schedule.
    per_cycle: Vec<u64>,
    sets_per_round: u64,
}

impl Plan {
    /// The plan of a problem.
    pub fn new(problem: &Problem) -> Plan {
        let mut per_cycle = vec![0; problem.strategies.len()];
        let mut before = Vec::new();
        for strategy in &problem.schedule {
            before.push(per_cycle[*strategy as usize]);
            per_cycle[*strategy as usize] += 1;
        }
        Plan {
            schedule: problem.schedule.clone(),
            before,
            per_cycle,
            sets_per_round: u64::from(problem.sets_per_round),
        }
    }

    /// The strategy of the set at `place`, and the set's ordinal within it.
    pub fn set_at(&self, place: u64) -> (u32, u64) {
        let length = self.schedule.len() as u64;
        let (cycle, within) = (place / length, (place % length) as usize);
        let strategy = self.schedule[within];
        (strategy, cycle * self.per_cycle[strategy as usize] + self.before[within])
    }

    /// The round to which `place` belongs.
    pub fn round_of(&self, place: u64) -> u64 {
        place / self.sets_per_round
    }

    /// The places of a round.
    pub fn places_of(&self, round: u64) -> Range<u64> {
        round * self.sets_per_round..(round + 1) * self.sets_per_round
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ordinal_of_every_strategy_comes_once_and_in_order() {
        let plan = Plan {
            schedule: vec![0, 1, 0, 2],
            before: vec![0, 0, 1, 0],
            per_cycle: vec![2, 1, 1],
            sets_per_round: 3,
        };
        let mut next = [0; 3];
        for place in 0..40 {
            let (strategy, ordinal) = plan.set_at(place);
            assert_eq!(strategy, [0, 1, 0, 2][place as usize % 4]);
            assert_eq!(ordinal, next[strategy as usize]);
            next[strategy as usize] += 1;
            assert!(plan.places_of(plan.round_of(place)).contains(&place));
        }
    }
}
