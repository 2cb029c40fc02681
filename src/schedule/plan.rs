use super::Adaptive;
use super::history::History;
use crate::numbers::{Ordinal, RoundNumber, SetName, SetNumber, StrategyIndex};
use crate::problem::Problem;
use crate::roadmap::Round;
use std::ops::Range;

/// Which set comes when: all sets stand in one sequence, a schedule over the strategies repeats along
/// it, and every `sets_per_round` sets make a round. A build that was continued with another schedule
/// has several phases; ordinals count on through all of them.
///
/// Where the schedule adapts it is known up to the end of the round that comes next, and the plan
/// has to be told of every round ([`Plan::observe`]).
#[derive(Clone, Debug)]
pub struct Plan {
    /// In order; the last has no end.
    phases: Vec<Phase>,
    /// Of a plan with a phase that adapts: what has come of the rounds so far.
    observed: Option<Observed>,
}

#[derive(Clone, Debug)]
struct Observed {
    /// The round after those observed.
    round: RoundNumber,
    history: History,
    /// Per strategy: how many sets it has had.
    used: Vec<u64>,
    next: NextRound,
}

/// The round that comes next.
#[derive(Clone, Debug)]
struct NextRound {
    first_set: SetNumber,
    /// Its sets, in order, where the schedule adapts; else none.
    chosen: Vec<SetName>,
}

/// Where a phase begins.
#[derive(Clone, Debug)]
struct Start {
    round: RoundNumber,
    set: SetNumber,
    /// Per strategy: how many sets it had in earlier phases.
    used: Vec<u64>,
}

#[derive(Clone, Debug)]
struct Phase {
    start: Start,
    sets_per_round: u64,
    schedule: Vec<StrategyIndex>,
    /// Whether the schedule is only what is chosen from.
    adaptive: Option<Adaptive>,
    /// Per position in the schedule: how often its strategy came before it there.
    before: Vec<u64>,
    /// Per strategy: how often it comes in the schedule.
    per_cycle: Vec<u64>,
}

impl Phase {
    fn new(
        start: Start,
        schedule: &[StrategyIndex],
        adaptive: Option<Adaptive>,
        sets_per_round: u32,
    ) -> Phase {
        let mut per_cycle = vec![0; start.used.len()];
        let mut before = Vec::new();
        for strategy in schedule {
            before.push(per_cycle[strategy.index()]);
            per_cycle[strategy.index()] += 1;
        }
        Phase {
            start,
            sets_per_round: u64::from(sets_per_round),
            schedule: schedule.to_vec(),
            adaptive,
            before,
            per_cycle,
        }
    }

    /// Where the phase that follows after `rounds` rounds begins.
    fn after(&self, rounds: u64) -> Start {
        let sets = rounds * self.sets_per_round;
        Start {
            round: self.start.round + rounds,
            set: self.start.set + sets,
            used: self.used_until(sets),
        }
    }

    /// How many sets each strategy has had before the set `within` of the phase.
    fn used_until(&self, within: u64) -> Vec<u64> {
        let length = self.schedule.len() as u64;
        let mut used = self.start.used.clone();
        for (strategy, used) in used.iter_mut().enumerate() {
            *used += within / length * self.per_cycle[strategy];
        }
        for strategy in &self.schedule[..(within % length) as usize] {
            used[strategy.index()] += 1;
        }
        used
    }

    /// The first set of a round of the phase.
    fn first_set_of(&self, round: RoundNumber) -> SetNumber {
        self.start.set + round.since(self.start.round) * self.sets_per_round
    }
}

impl Plan {
    /// The plan of a problem.
    pub fn new(problem: &Problem) -> Plan {
        let mut phases = Vec::new();
        let strategies = problem.strategies.len();
        let (round, set) = (RoundNumber(0), SetNumber(0));
        let mut start = Start { round, set, used: vec![0; strategies] };
        for earlier in &problem.earlier {
            let phase =
                Phase::new(start, &earlier.schedule, earlier.adaptive, earlier.sets_per_round);
            start = phase.after(earlier.rounds);
            phases.push(phase);
        }
        phases.push(Phase::new(start, &problem.schedule, problem.adaptive, problem.sets_per_round));
        let adapts = phases.iter().any(|phase| phase.adaptive.is_some());
        let observed = adapts.then(|| Observed {
            round,
            history: History::new(strategies),
            used: vec![0; strategies],
            next: NextRound { first_set: set, chosen: Vec::new() },
        });
        let mut plan = Plan { phases, observed };
        plan.choose();
        plan
    }

    /// Takes note of the round that comes next in the ledger.
    pub fn observe(&mut self, round: &Round) {
        let Some(observed) = &mut self.observed else { return };
        observed.history.observe(round);
        observed.round = observed.round.next();
        for set in &round.sets {
            observed.used[set.strategy.index()] += 1;
        }
        self.choose();
    }

    /// Chooses the sets of the round after those observed, if that is for the plan to do.
    fn choose(&mut self) {
        let Some(observed) = &mut self.observed else { return };
        let round = observed.round;
        let index = self.phases.partition_point(|phase| phase.start.round <= round).max(1) - 1;
        let phase = &mut self.phases[index];
        if phase.start.round == round {
            phase.start.used.clone_from(&observed.used);
        }
        observed.next = NextRound { first_set: phase.first_set_of(round), chosen: Vec::new() };
        if let Some(adaptive) = phase.adaptive {
            let past = observed.history.yields();
            let mut used = observed.used.clone();
            for strategy in adaptive.round(past, &phase.schedule, phase.sets_per_round) {
                let used = &mut used[strategy.index()];
                observed.next.chosen.push(SetName { strategy, ordinal: Ordinal(*used) });
                *used += 1;
            }
        }
    }

    /// The set before which it is known which set comes when.
    pub fn known_until(&self) -> SetNumber {
        const NO_END: SetNumber = SetNumber(u64::MAX);
        let Some(observed) = &self.observed else { return NO_END };
        let first = observed.next.first_set;
        let phase = self.phase(|phase| phase.start.set <= first);
        if phase.adaptive.is_some() {
            return first + phase.sets_per_round;
        }
        let next = self.phases.iter().find(|phase| phase.start.set > first);
        next.map_or(NO_END, |phase| phase.start.set)
    }

    fn phase(&self, is_before: impl Fn(&Phase) -> bool) -> &Phase {
        // The first begins with the first set of the first round, which nothing is before.
        &self.phases[self.phases.partition_point(is_before).max(1) - 1]
    }

    /// The name of the set `number`. `None` where it is not known yet, or no longer.
    pub fn name_of(&self, number: SetNumber) -> Option<SetName> {
        if number >= self.known_until() {
            return None;
        }
        let phase = self.phase(|phase| phase.start.set <= number);
        if phase.adaptive.is_some() {
            let NextRound { first_set, chosen } = &self.observed.as_ref()?.next;
            return chosen.get(number.0.checked_sub(first_set.0)? as usize).copied();
        }
        let length = phase.schedule.len() as u64;
        let within = number.since(phase.start.set);
        let (cycle, within) = (within / length, (within % length) as usize);
        let strategy = phase.schedule[within];
        let of_cycles = cycle * phase.per_cycle[strategy.index()];
        let ordinal = phase.start.used[strategy.index()] + of_cycles + phase.before[within];
        Some(SetName { strategy, ordinal: Ordinal(ordinal) })
    }

    /// The round to which a set belongs.
    pub fn round_of(&self, number: SetNumber) -> RoundNumber {
        let phase = self.phase(|phase| phase.start.set <= number);
        phase.start.round + number.since(phase.start.set) / phase.sets_per_round
    }

    /// The first set of the round to which a set belongs.
    pub fn round_start(&self, number: SetNumber) -> SetNumber {
        self.sets_of(self.round_of(number)).start
    }

    /// The sets of a round.
    pub fn sets_of(&self, round: RoundNumber) -> Range<SetNumber> {
        let phase = self.phase(|phase| phase.start.round <= round);
        let first = phase.first_set_of(round);
        first..first + phase.sets_per_round
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ordinal_of_every_strategy_comes_once_and_in_order_through_all_phases() {
        let schedule =
            |listed: &[u32]| listed.iter().copied().map(StrategyIndex).collect::<Vec<_>>();
        let start = Start { round: RoundNumber(0), set: SetNumber(0), used: vec![0; 3] };
        let first = Phase::new(start, &schedule(&[0, 1, 0, 2]), None, 3);
        // Five rounds, three whole cycles and three sets of the next.
        let start = first.after(5);
        assert_eq!((start.round, start.set), (RoundNumber(5), SetNumber(15)));
        assert_eq!(start.used, [8, 4, 3]);
        let second = Phase::new(start, &schedule(&[2, 1]), None, 4);
        let plan = Plan { phases: vec![first, second], observed: None };
        let mut next = [Ordinal(0); 3];
        let mut rounds = Vec::new();
        for number in SetNumber::each(SetNumber(0)..SetNumber(60)) {
            let SetName { strategy, ordinal } = plan.name_of(number).unwrap();
            let expected = match number.0 {
                0..15 => [0, 1, 0, 2][number.index() % 4],
                _ => [2, 1][(number.index() - 15) % 2],
            };
            assert_eq!(strategy, StrategyIndex(expected));
            assert_eq!(ordinal, next[strategy.index()]);
            next[strategy.index()] = ordinal.next();
            rounds.push(plan.round_of(number).0);
            assert!(plan.sets_of(plan.round_of(number)).contains(&number));
        }
        assert_eq!(rounds[..17], [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5]);
        assert_eq!(plan.sets_of(RoundNumber(4)), SetNumber(12)..SetNumber(15));
        assert_eq!(plan.sets_of(RoundNumber(6)), SetNumber(19)..SetNumber(23));
    }
}
