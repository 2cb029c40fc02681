use super::Adaptive;
use super::history::History;
use crate::problem::Problem;
use crate::roadmap::Round;
use std::ops::Range;

/// Which set comes where: sets stand in one sequence of *places*, a schedule over the strategies
/// repeats along it, and every `sets_per_round` places make a round. A build that was continued with
/// another schedule has several phases; ordinals count on through all of them.
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
    rounds: u64,
    history: History,
    /// Per strategy: its sets.
    used: Vec<u64>,
    /// The first place of the next round and, if it is chosen, its sets' strategies and ordinals.
    next: (u64, Vec<(u32, u64)>),
}

#[derive(Clone, Debug)]
struct Phase {
    first_round: u64,
    first_place: u64,
    sets_per_round: u64,
    schedule: Vec<u32>,
    /// Whether the schedule is only what is chosen from.
    adaptive: Option<Adaptive>,
    /// Per place of the schedule: how often its strategy came before it there.
    before: Vec<u64>,
    /// Per strategy: how often it comes in the schedule.
    per_cycle: Vec<u64>,
    /// Per strategy: its sets in earlier phases.
    used: Vec<u64>,
}

impl Phase {
    /// How many sets of each strategy have come before the place `within` of the phase.
    fn used_until(&self, within: u64) -> Vec<u64> {
        let length = self.schedule.len() as u64;
        let mut used = self.used.clone();
        for (strategy, used) in used.iter_mut().enumerate() {
            *used += within / length * self.per_cycle[strategy];
        }
        for strategy in &self.schedule[..(within % length) as usize] {
            used[*strategy as usize] += 1;
        }
        used
    }
}

impl Plan {
    /// The plan of a problem.
    pub fn new(problem: &Problem) -> Plan {
        let mut plan = Plan { phases: Vec::new(), observed: None };
        let strategies = problem.strategies.len();
        let mut start = (0, 0, vec![0; strategies]);
        for earlier in &problem.earlier {
            plan.push(start, &earlier.schedule, earlier.adaptive, earlier.sets_per_round);
            let phase = &plan.phases[plan.phases.len() - 1];
            let places = earlier.rounds * phase.sets_per_round;
            let round = phase.first_round + earlier.rounds;
            start = (round, phase.first_place + places, phase.used_until(places));
        }
        plan.push(start, &problem.schedule, problem.adaptive, problem.sets_per_round);
        if plan.phases.iter().any(|phase| phase.adaptive.is_some()) {
            plan.observed = Some(Observed {
                rounds: 0,
                history: History::new(strategies),
                used: vec![0; strategies],
                next: (0, Vec::new()),
            });
            plan.choose();
        }
        plan
    }

    /// Takes note of the round that comes next in the ledger.
    pub fn observe(&mut self, round: &Round) {
        let Some(observed) = &mut self.observed else { return };
        observed.history.observe(round);
        observed.rounds += 1;
        for set in &round.sets {
            observed.used[set.strategy as usize] += 1;
        }
        self.choose();
    }

    /// Chooses the sets of the round after those observed, if that is for the plan to do.
    fn choose(&mut self) {
        let Some(observed) = &mut self.observed else { return };
        let round = observed.rounds;
        let index = self.phases.partition_point(|phase| phase.first_round <= round).max(1) - 1;
        let phase = &mut self.phases[index];
        if phase.first_round == round {
            phase.used.clone_from(&observed.used);
        }
        let first = phase.first_place + (round - phase.first_round) * phase.sets_per_round;
        observed.next = (first, Vec::new());
        if let Some(adaptive) = phase.adaptive {
            let past = observed.history.yields();
            let mut used = observed.used.clone();
            for strategy in adaptive.round(past, &phase.schedule, phase.sets_per_round) {
                let used = &mut used[strategy as usize];
                observed.next.1.push((strategy, *used));
                *used += 1;
            }
        }
    }

    /// The place up to which it is known which set comes where.
    pub fn known_until(&self) -> u64 {
        let Some(observed) = &self.observed else { return u64::MAX };
        let first = observed.next.0;
        let phase = self.phase(|phase| phase.first_place <= first);
        if phase.adaptive.is_some() {
            return first + phase.sets_per_round;
        }
        let next = self.phases.iter().find(|phase| phase.first_place > first);
        next.map_or(u64::MAX, |phase| phase.first_place)
    }

    fn push(
        &mut self,
        (first_round, first_place, used): (u64, u64, Vec<u64>),
        schedule: &[u32],
        adaptive: Option<Adaptive>,
        sets_per_round: u32,
    ) {
        let mut per_cycle = vec![0; used.len()];
        let mut before = Vec::new();
        for strategy in schedule {
            before.push(per_cycle[*strategy as usize]);
            per_cycle[*strategy as usize] += 1;
        }
        self.phases.push(Phase {
            first_round,
            first_place,
            sets_per_round: u64::from(sets_per_round),
            schedule: schedule.to_vec(),
            adaptive,
            before,
            per_cycle,
            used,
        });
    }

    fn phase(&self, is_before: impl Fn(&Phase) -> bool) -> &Phase {
        // The first begins at the first place of the first round, which nothing is before.
        &self.phases[self.phases.partition_point(is_before).max(1) - 1]
    }

    /// The strategy of the set at `place`, and the set's ordinal within it. `None` where that is
    /// not known yet, or no longer.
    pub fn set_at(&self, place: u64) -> Option<(u32, u64)> {
        if place >= self.known_until() {
            return None;
        }
        let phase = self.phase(|phase| phase.first_place <= place);
        if phase.adaptive.is_some() {
            let (first, sets) = &self.observed.as_ref()?.next;
            return sets.get(usize::try_from(place.checked_sub(*first)?).ok()?).copied();
        }
        let length = phase.schedule.len() as u64;
        let within = place - phase.first_place;
        let (cycle, within) = (within / length, (within % length) as usize);
        let strategy = phase.schedule[within] as usize;
        let ordinal = phase.used[strategy] + cycle * phase.per_cycle[strategy];
        Some((strategy as u32, ordinal + phase.before[within]))
    }

    /// The round to which `place` belongs.
    pub fn round_of(&self, place: u64) -> u64 {
        let phase = self.phase(|phase| phase.first_place <= place);
        phase.first_round + (place - phase.first_place) / phase.sets_per_round
    }

    /// The first place of the round to which `place` belongs.
    pub fn round_start(&self, place: u64) -> u64 {
        self.places_of(self.round_of(place)).start
    }

    /// The places of a round.
    pub fn places_of(&self, round: u64) -> Range<u64> {
        let phase = self.phase(|phase| phase.first_round <= round);
        let first = phase.first_place + (round - phase.first_round) * phase.sets_per_round;
        first..first + phase.sets_per_round
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ordinal_of_every_strategy_comes_once_and_in_order_through_all_phases() {
        let mut plan = Plan { phases: Vec::new(), observed: None };
        plan.push((0, 0, vec![0; 3]), &[0, 1, 0, 2], None, 3);
        // Five rounds, three whole cycles and three places of the next.
        let used = plan.phases[0].used_until(15);
        assert_eq!(used, [8, 4, 3]);
        plan.push((5, 15, used), &[2, 1], None, 4);
        let mut next = [0; 3];
        let mut rounds = Vec::new();
        for place in 0..60 {
            let (strategy, ordinal) = plan.set_at(place).unwrap();
            let expected = match place {
                0..15 => [0, 1, 0, 2][place as usize % 4],
                _ => [2, 1][(place as usize - 15) % 2],
            };
            assert_eq!(strategy, expected);
            assert_eq!(ordinal, next[strategy as usize]);
            next[strategy as usize] += 1;
            rounds.push(plan.round_of(place));
            assert!(plan.places_of(plan.round_of(place)).contains(&place));
        }
        assert_eq!(rounds[..17], [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5]);
        assert_eq!((plan.places_of(4), plan.places_of(6)), (12..15, 19..23));
    }
}
