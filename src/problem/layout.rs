//! The bytes of a problem, which ledgers keep and worker processes are given.
//!
//! A layout never changes: a ledger of years ago must stay readable, and its problem's digest what it was. A
//! problem that the first layout can say, one of bodies whose sets are all sampled, has it; every other
//! problem has the second. New models, generators and other methods come as new variants at the end of their enums,
//! which changes the bytes of no problem without them. A problem with a validity function has the third layout.

use super::{EarlierSchedule, Limits, Problem};
use crate::BITS_VERSION;
use crate::connect::{AmongKind, WithinKind};
use crate::context::Ends;
use crate::digest::{Digest, SourceFile};
use crate::evaluate::EvaluatorKind;
use crate::generator::{GeneratorKind, Sample};
use crate::model::bodies::Bodies;
use crate::model::{ModelKind, ValidityFunction};
use crate::numbers::StrategyIndex;
use crate::sampler::SamplerKind;
use crate::schedule::Adaptive;
use crate::strategy::Strategy;
use crate::wire::{self, WireError};
use bincode::de::Decoder;
use bincode::enc::Encoder;
use bincode::error::{DecodeError, EncodeError};
use bincode::{Decode, Encode};

/// How a problem's bytes are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Encode, Decode)]
pub enum Layout {
    /// Bodies, and strategies that sample.
    First,
    /// Any model and any strategy.
    Second,
    /// The same, and a validity function.
    Third,
}

/// A strategy in the first layout.
#[derive(Encode, Decode)]
struct FirstStrategy {
    label: String,
    nodes: u32,
    sampler: SamplerKind,
    within: WithinKind,
    among: AmongKind,
}

/// A problem in the first layout.
#[derive(Encode, Decode)]
struct FirstProblem {
    name: String,
    seed: u64,
    bodies: Bodies,
    rest: Rest<FirstStrategy>,
}

/// A strategy in the second layout.
#[derive(Encode, Decode)]
struct SecondStrategy {
    label: String,
    nodes: u32,
    generator: GeneratorKind,
    among: AmongKind,
}

/// A problem in the second layout.
#[derive(Encode, Decode)]
struct SecondProblem {
    name: String,
    seed: u64,
    model: ModelKind,
    rest: Rest<SecondStrategy>,
}

/// A problem in the third layout.
#[derive(Encode, Decode)]
struct ThirdProblem {
    second: SecondProblem,
    /// The identity of the validity function.
    function: String,
}

/// What all layouts end with.
#[derive(Encode, Decode)]
struct Rest<S> {
    query: QueryBytes,
    strategies: Vec<S>,
    schedule: Vec<StrategyIndex>,
    adaptive: Option<Adaptive>,
    sets_per_round: u32,
    evaluators: Vec<EvaluatorKind>,
    limits: Limits,
    notes: Vec<String>,
    sources: Vec<SourceFile>,
    earlier: Vec<EarlierSchedule>,
}

/// A query in its bytes: those of an `Option` of start and goal, as before there could be several goals; of a query with
/// several the number that says whether there is one is 2, and the other goals follow.
struct QueryBytes(Option<Ends>);

impl Encode for QueryBytes {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        match &self.0 {
            None => 0u8.encode(encoder),
            Some(Ends { start, goal, other_goals }) if other_goals.is_empty() => {
                (1u8, start, goal).encode(encoder)
            }
            Some(Ends { start, goal, other_goals }) => {
                (2u8, start, goal, other_goals).encode(encoder)
            }
        }
    }
}

impl<Context> Decode<Context> for QueryBytes {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<QueryBytes, DecodeError> {
        let count = u8::decode(decoder)?;
        if count == 0 {
            return Ok(QueryBytes(None));
        }
        let (start, goal) = Decode::decode(decoder)?;
        let other_goals = match count {
            1 => Vec::new(),
            2 => Decode::decode(decoder)?,
            other => {
                let message = format!("a query of kind {other} found; 0, 1 or 2 expected");
                return Err(DecodeError::OtherString(message));
            }
        };
        Ok(QueryBytes(Some(Ends { start, goal, other_goals })))
    }
}

bincode::impl_borrow_decode!(QueryBytes);

impl From<FirstStrategy> for Strategy {
    fn from(first: FirstStrategy) -> Strategy {
        let FirstStrategy { label, nodes, sampler, within, among } = first;
        Strategy {
            label,
            nodes,
            generator: GeneratorKind::Sample(Sample { sampler, within }),
            among,
        }
    }
}

impl From<SecondStrategy> for Strategy {
    fn from(second: SecondStrategy) -> Strategy {
        let SecondStrategy { label, nodes, generator, among } = second;
        Strategy { label, nodes, generator, among }
    }
}

/// The strategies in the first layout, if it can say them.
fn first_strategies(strategies: &[Strategy]) -> Option<Vec<FirstStrategy>> {
    let first = |strategy: &Strategy| {
        let Sample { sampler, within } = strategy.generator.as_sample()?.clone();
        let Strategy { label, nodes, among, .. } = strategy.clone();
        Some(FirstStrategy { label, nodes, sampler, within, among })
    };
    strategies.iter().map(first).collect()
}

fn second_strategies(strategies: &[Strategy]) -> Vec<SecondStrategy> {
    let second = |Strategy { label, nodes, generator, among }| SecondStrategy {
        label,
        nodes,
        generator,
        among,
    };
    strategies.iter().cloned().map(second).collect()
}

impl<S> Rest<S> {
    fn of(problem: &Problem, strategies: Vec<S>) -> Rest<S> {
        Rest {
            query: QueryBytes(problem.query.clone()),
            strategies,
            schedule: problem.schedule.clone(),
            adaptive: problem.adaptive,
            sets_per_round: problem.sets_per_round,
            evaluators: problem.evaluators.clone(),
            limits: problem.limits,
            notes: problem.notes.clone(),
            sources: problem.sources.clone(),
            earlier: problem.earlier.clone(),
        }
    }

    /// The problem, if its model is one that a problem file could give: nothing can be asked of any other, not even its space.
    fn with(self, name: String, seed: u64, model: ModelKind) -> Result<Problem, WireError>
    where
        Strategy: From<S>,
    {
        model.description().sound().map_err(WireError::unsound)?;
        let nodes_are_given = !self.limits.leaves_nodes_open(&model.description().space());
        Ok(Problem {
            name,
            seed,
            model,
            function: None,
            query: self.query.0,
            strategies: self.strategies.into_iter().map(Strategy::from).collect(),
            schedule: self.schedule,
            adaptive: self.adaptive,
            sets_per_round: self.sets_per_round,
            evaluators: self.evaluators,
            limits: self.limits,
            nodes_are_given,
            notes: self.notes,
            sources: self.sources,
            earlier: self.earlier,
            relaxation: None,
        })
    }
}

/// What the first layout has to say a problem: its model and its strategies, if it can.
fn first(problem: &Problem) -> Option<(&Bodies, Vec<FirstStrategy>)> {
    if problem.function.is_some() {
        return None;
    }
    Some((problem.model.bodies()?, first_strategies(&problem.strategies)?))
}

impl Problem {
    /// The problem's bytes, and how they are laid out.
    pub fn to_bytes(&self) -> (Layout, Vec<u8>) {
        let (name, seed) = (self.name.clone(), self.seed);
        match first(self) {
            Some((bodies, strategies)) => {
                let (bodies, rest) = (bodies.clone(), Rest::of(self, strategies));
                (Layout::First, wire::encode(&FirstProblem { name, seed, bodies, rest }))
            }
            None => {
                let strategies = second_strategies(&self.strategies);
                let (model, rest) = (self.model.clone(), Rest::of(self, strategies));
                let second = SecondProblem { name, seed, model, rest };
                match &self.function {
                    None => (Layout::Second, wire::encode(&second)),
                    Some(function) => {
                        let function = function.identity().to_owned();
                        (Layout::Third, wire::encode(&ThirdProblem { second, function }))
                    }
                }
            }
        }
    }

    /// The problem that bytes stand for. What it is planned for has been checked as that of a problem file is; see
    /// [`Problem::schedule_is_sound`] for the rest.
    ///
    /// # Errors
    /// When they are those of no problem, or of one that no file could give.
    pub fn from_bytes(layout: Layout, bytes: &[u8]) -> Result<Problem, WireError> {
        let problem = match layout {
            Layout::First => {
                let FirstProblem { name, seed, bodies, rest } = wire::decode(bytes)?;
                rest.with(name, seed, ModelKind::Bodies(bodies))?
            }
            Layout::Second => {
                let SecondProblem { name, seed, model, rest } = wire::decode(bytes)?;
                rest.with(name, seed, model)?
            }
            Layout::Third => {
                let ThirdProblem { second, function } = wire::decode(bytes)?;
                let SecondProblem { name, seed, model, rest } = second;
                let function = ValidityFunction::absent(function).map_err(WireError::unsound)?;
                let problem = rest.with(name, seed, model)?;
                problem.expect_function_suits().map_err(WireError::unsound)?;
                Problem { function: Some(function), ..problem }
            }
        };
        let dofs = problem.space().len();
        let fits = |q: &[f64]| q.len() == dofs && q.iter().all(|value| value.is_finite());
        match &problem.query {
            Some(ends) if !ends.all().all(fits) => {
                let expected = format!("configurations of {dofs} finite numbers expected");
                Err(WireError::unsound(format!("query: {ends:?} found; {expected}")))
            }
            _ => Ok(problem),
        }
    }
}

/// The layout, then the bytes as a list. This is how a problem is sent to other processes, which cannot have a validity function.
impl Encode for Problem {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        self.to_bytes().encode(encoder)
    }
}

impl<Context> Decode<Context> for Problem {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Problem, DecodeError> {
        let (layout, bytes): (Layout, Vec<u8>) = Decode::decode(decoder)?;
        if layout == Layout::Third {
            // Whoever works on a problem that was sent here would find nothing valid.
            return Err(DecodeError::Other(
                "a problem with a validity function, which cannot be sent",
            ));
        }
        let problem = Problem::from_bytes(layout, &bytes);
        problem.map_err(|error| DecodeError::OtherString(error.to_string()))
    }
}
bincode::impl_borrow_decode!(Problem);

/// See [`Problem::digest`].
pub(super) fn digest(problem: &Problem) -> Digest {
    let schedule = (&problem.schedule, problem.adaptive, problem.sets_per_round, &problem.earlier);
    let bytes = match first(problem) {
        Some((bodies, strategies)) => {
            wire::encode(&(BITS_VERSION, problem.seed, bodies, strategies, schedule))
        }
        None => {
            let strategies = second_strategies(&problem.strategies);
            // No first layout begins with these texts.
            let name = match problem.function {
                None => "roadmill problem 2",
                Some(_) => "roadmill problem 3",
            };
            let whole = (name, BITS_VERSION, problem.seed, &problem.model, strategies, schedule);
            let reads = |strategy: &Strategy| strategy.generator.method().reads_query();
            // Where no strategy reads it, the query determines no set.
            let mut bytes = match problem.strategies.iter().any(reads) {
                true => wire::encode(&(whole, QueryBytes(problem.query.clone()))),
                false => wire::encode(&whole),
            };
            if let Some(function) = &problem.function {
                bytes.extend(wire::encode(&function.identity().to_owned()));
            }
            bytes
        }
    };
    Digest::of(&bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_several_goals_change_the_bytes_of_a_query() {
        let (start, goal) = (vec![1.0, 2.0], vec![3.0, -4.0]);
        let bytes = |query: Option<Ends>| wire::encode(&QueryBytes(query));
        let none: Option<(Vec<f64>, Vec<f64>)> = None;
        assert_eq!(bytes(None), wire::encode(&none));
        let one = Ends::new(start.clone(), goal.clone());
        assert_eq!(bytes(Some(one.clone())), wire::encode(&Some((&start, &goal))));
        let several = Ends { other_goals: vec![vec![5.0, 6.0], vec![7.0, 8.0]], ..one.clone() };
        for query in [None, Some(one), Some(several)] {
            let read: QueryBytes = wire::decode(&bytes(query.clone())).unwrap();
            assert_eq!(read.0, query);
        }
        assert!(wire::decode::<QueryBytes>(&wire::encode(&(3u8, &start, &goal))).is_err());
    }
}
