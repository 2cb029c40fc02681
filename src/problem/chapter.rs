//! Going on with a build that was begun under another problem: other criteria, other limits, further
//! strategies. What is there already stays what it was.

use super::Problem;
use crate::model::ValidityFunction;
use crate::numbers::StrategyIndex;
use crate::schedule::Adaptive;
use crate::strategy::Strategy;
use bincode::{Decode, Encode};

/// How the sets of some rounds were scheduled, before another schedule took over.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct EarlierSchedule {
    /// How many rounds.
    pub rounds: u64,
    /// As [`Problem::schedule`].
    pub schedule: Vec<StrategyIndex>,
    /// As [`Problem::adaptive`].
    pub adaptive: Option<Adaptive>,
    /// As [`Problem::sets_per_round`].
    pub sets_per_round: u32,
}

/// Rounds and sets beyond this are nonsense that a damaged or hostile file could hold.
const COUNT_MAX: u64 = 1 << 40;

impl Problem {
    /// This problem continued as `changed` says, after `rounds` rounds: its query, criteria and limits,
    /// and from the next round on its schedule. Strategies are told apart by their labels; those that
    /// `changed` does not name keep their sets and get no more.
    ///
    /// # Errors
    /// Says what differs that must not: anything that determines the sets that are there.
    pub fn continued(&self, changed: &Problem, rounds: u64) -> Result<Problem, String> {
        if let Some(difference) = self.scene_difference(changed) {
            return Err(difference);
        }
        if self.query != changed.query {
            self.expect_strategies_for(changed)?;
        }
        let mut strategies = self.strategies.clone();
        let mut index = Vec::new();
        for strategy in &changed.strategies {
            let known = strategies.iter().position(|known| known.label == strategy.label);
            if known.is_some_and(|known| strategies[known] != *strategy) {
                return Err(format!(
                    "the strategy `{}` is not what it was; one with a label of its own expected",
                    strategy.label
                ));
            }
            index.push(StrategyIndex(known.unwrap_or(strategies.len()) as u32));
            if known.is_none() {
                strategies.push(strategy.clone());
            }
        }
        let schedule: Vec<StrategyIndex> =
            changed.schedule.iter().map(|strategy| index[strategy.index()]).collect();
        let mut earlier = self.earlier.clone();
        let present = (&self.schedule, self.adaptive, self.sets_per_round);
        if (&schedule, changed.adaptive, changed.sets_per_round) != present {
            let before: u64 = earlier.iter().map(|earlier| earlier.rounds).sum();
            if rounds > before {
                earlier.push(EarlierSchedule {
                    rounds: rounds - before,
                    schedule: self.schedule.clone(),
                    adaptive: self.adaptive,
                    sets_per_round: self.sets_per_round,
                });
            }
        }
        Ok(Problem {
            query: changed.query.clone(),
            strategies,
            schedule,
            adaptive: changed.adaptive,
            sets_per_round: changed.sets_per_round,
            evaluators: changed.evaluators.clone(),
            limits: changed.limits,
            nodes_are_given: changed.nodes_are_given,
            notes: changed.notes.clone(),
            sources: changed.sources.clone(),
            earlier,
            ..self.clone()
        })
    }

    /// Refuses strategies that would go on about the ends of another query: the first set of a label places the ends, and the others
    /// grow from there. Sets that are there were made under the query of their chapter, and are made again under it.
    fn expect_strategies_for(&self, changed: &Problem) -> Result<(), String> {
        let about_ends = |known: &&Strategy| known.generator.method().reads_query();
        let mut of_before = self.strategies.iter().filter(about_ends);
        let is_named =
            |known: &&Strategy| changed.strategies.iter().any(|new| new.label == known.label);
        if let Some(known) = of_before.clone().find(is_named) {
            return Err(format!(
                "the strategy `{}` works about the ends of the query, which are not what they were; one with a label of its own \
                 expected, or the same query, or `roadmill replan`, which takes the roadmap over into a run of its own",
                known.label
            ));
        }
        match of_before.next() {
            Some(known) if changed.query.is_none() => Err(format!(
                "no [query] found, but the strategy `{}` has sets about the ends of one; another query expected",
                known.label
            )),
            _ => Ok(()),
        }
    }

    /// What, of all that determines a set beside its strategy, differs in `other`.
    pub fn scene_difference(&self, other: &Problem) -> Option<String> {
        // Without `..`: whoever adds a field has to say here on which side it is.
        let Problem {
            seed,
            model,
            function,
            name: _,
            query: _,
            strategies: _,
            schedule: _,
            adaptive: _,
            sets_per_round: _,
            evaluators: _,
            limits: _,
            nodes_are_given: _,
            notes: _,
            sources: _,
            earlier: _,
            relaxation: _,
        } = self;
        if *seed != other.seed {
            return Some(format!("the seed is {}, {seed} expected", other.seed));
        }
        if *function != other.function {
            let name = |function: &Option<ValidityFunction>| match function {
                Some(function) => format!("the validity function `{}`", function.identity()),
                None => "no validity function".to_owned(),
            };
            let (found, expected) = (name(&other.function), name(function));
            return Some(format!("{found} found, {expected} expected"));
        }
        let what = model.description().difference(&other.model)?;
        // A changed mesh shows in the file that it comes from.
        let file = other.other_sources().iter().find(|file| !self.sources.contains(file));
        let file = file.map_or_else(String::new, |file| format!(" ({} has changed)", file.path));
        Some(format!("{what} is not what it was{file}"))
    }

    /// Whether sets, rounds, strategies and the roadmaps they read fit together, as they do in every problem that was read
    /// from a file: what decoded bytes must show.
    pub fn schedule_is_sound(&self) -> bool {
        let fits = |schedule: &[StrategyIndex], sets_per_round: u32| {
            let known = |strategy: &StrategyIndex| strategy.index() < self.strategies.len();
            !schedule.is_empty() && sets_per_round > 0 && schedule.iter().all(known)
        };
        let sets = self.earlier.iter().try_fold(0u64, |sets, earlier| {
            let own = earlier.rounds.checked_mul(u64::from(earlier.sets_per_round))?;
            sets.checked_add(own).filter(|sets| *sets < COUNT_MAX)
        });
        let dofs = self.space().len();
        let parents = self.strategies.iter().filter_map(|known| known.generator.method().parent());
        fits(&self.schedule, self.sets_per_round)
            && parents.into_iter().all(|parent| parent.roadmap().dofs() == dofs)
            && sets.is_some()
            && self.earlier.iter().all(|e| e.rounds > 0 && fits(&e.schedule, e.sets_per_round))
    }
}
