//! How the roadmap is built: strategies, schedule, limits and evaluators.

use super::Limits;
use super::file::{File, PolicyTable, ScheduleTable, StrategyTable};
use crate::connect::WithinKind;
use crate::evaluate::{self, EvaluatorKind};
use crate::generator::{GeneratorKind, Sample};
use crate::sampler::SamplerKind;
use crate::schedule::Adaptive;
use crate::source::ProblemError;
use crate::source::Source;
use crate::source::Step::{Index, Key};
use crate::space::Space;
use crate::strategy::Strategy;

const SET_NODES_MAX: u64 = 1_000_000;
const SETS_PER_ROUND_MAX: u64 = 1_000_000;
const DEFAULT_SETS_PER_ROUND: u64 = 5;

pub(super) fn strategies_of(
    source: &Source,
    file: &File,
) -> Result<(Vec<Strategy>, Vec<u32>, u32), ProblemError> {
    let default = [StrategyTable::uniform()];
    let tables = if file.strategies.is_empty() { &default[..] } else { &file.strategies };
    let mut strategies: Vec<Strategy> = Vec::new();
    for (index, table) in tables.iter().enumerate() {
        let fail = |keys: &[&str], message: String| {
            let mut place = vec![Key("strategies"), Index(index)];
            place.extend(keys.iter().map(|key| Key(key)));
            Err(source.error(&place, message))
        };
        if table.label.is_empty() || table.label.len() > 100 {
            return fail(&["label"], "1 to 100 bytes expected".to_owned());
        }
        if strategies.iter().any(|other| other.label == table.label) {
            let message = format!("`{}` found twice; labels of their own expected", table.label);
            return fail(&["label"], message);
        }
        if !(1..=SET_NODES_MAX).contains(&table.nodes) {
            let message = format!("{} found; 1 to {SET_NODES_MAX} expected", table.nodes);
            return fail(&["nodes"], message);
        }
        let generator = match table.generator() {
            Ok(generator) => generator,
            Err((key, message)) => return fail(&[key], message.to_owned()),
        };
        let complaints = match generator.as_sample() {
            // The keys of the short form.
            Some(Sample { sampler, within }) if table.generator.is_none() => vec![
                ("sampler", sampler.method().complaint()),
                ("within", within.method().complaint()),
            ],
            _ => vec![("generator", generator.method().complaint())],
        };
        let among = ("among", table.among.method().complaint());
        for (role, complaint) in complaints.into_iter().chain([among]) {
            if let Some((key, found, expected)) = complaint {
                return fail(&[role], format!("{key} = {found} found; {expected} expected"));
            }
        }
        strategies.push(Strategy {
            label: table.label.clone(),
            nodes: table.nodes as u32,
            generator,
            among: table.among.clone(),
        });
    }

    let place = [Key("img"), Key("schedule")];
    let schedule = match &file.img.schedule {
        None | Some(ScheduleTable::Policy(_)) => (0..strategies.len() as u32).collect(),
        Some(ScheduleTable::Labels(labels)) => {
            let mut schedule = Vec::new();
            for label in labels {
                let Some(index) = strategies.iter().position(|other| other.label == *label) else {
                    let known: Vec<_> = strategies.iter().map(|s| s.label.as_str()).collect();
                    let known = known.join(", ");
                    let message =
                        format!("`{label}` found; labels of strategies expected: {known}");
                    return Err(source.error(&place, message));
                };
                schedule.push(index as u32);
            }
            schedule
        }
    };
    if schedule.is_empty() {
        return Err(source.error(&place, "[] found; at least one label expected".to_owned()));
    }
    if let Some(idle) = (0..strategies.len()).find(|i| !schedule.contains(&(*i as u32))) {
        let label = &strategies[idle].label;
        return Err(source.error(&place, format!("the strategy `{label}` has no place in it")));
    }
    let sets = file.img.sets_per_round.unwrap_or(DEFAULT_SETS_PER_ROUND);
    if !(1..=SETS_PER_ROUND_MAX).contains(&sets) {
        let message = format!("{sets} found; 1 to {SETS_PER_ROUND_MAX} expected");
        return Err(source.error(&[Key("img"), Key("sets_per_round")], message));
    }
    Ok((strategies, schedule, sets as u32))
}

/// How the schedule adapts, if it does.
pub(super) fn adaptive_of(source: &Source, file: &File) -> Result<Option<Adaptive>, ProblemError> {
    match &file.img.schedule {
        Some(ScheduleTable::Policy(PolicyTable::Adaptive(Adaptive { rounds: 0 }))) => {
            let message = "rounds = 0 found; at least 1 expected".to_owned();
            Err(source.error(&[Key("img"), Key("schedule")], message))
        }
        Some(ScheduleTable::Policy(PolicyTable::Adaptive(adaptive))) => Ok(Some(*adaptive)),
        None | Some(ScheduleTable::Labels(_)) => Ok(None),
    }
}

/// What a problem that says nothing of it is built with: strategies, schedule, sets per round.
pub(super) fn defaults() -> (Vec<Strategy>, Vec<u32>, u32) {
    let table = StrategyTable::uniform();
    let sample = Sample { sampler: SamplerKind::default(), within: WithinKind::default() };
    let strategy = Strategy {
        label: table.label,
        nodes: table.nodes as u32,
        generator: GeneratorKind::Sample(sample),
        among: table.among,
    };
    (vec![strategy], vec![0], DEFAULT_SETS_PER_ROUND as u32)
}

pub(super) fn limits_of(
    source: &Source,
    file: &File,
    space: &Space,
) -> Result<Limits, ProblemError> {
    let table = &file.limits;
    let mut limits = Limits::left_open(space);
    if table.seconds.is_some() {
        limits = Limits { seconds: table.seconds, ..limits.with_time(space) };
    }
    limits.nodes = table.nodes.unwrap_or(limits.nodes);
    limits.sets = table.sets.unwrap_or(limits.sets);
    limits
        .complaint()
        .map_or(Ok(limits), |(key, message)| Err(source.error(&[Key("limits"), Key(key)], message)))
}

pub(super) fn evaluators_of(
    source: &Source,
    file: &File,
) -> Result<Vec<EvaluatorKind>, ProblemError> {
    let evaluators = match &file.evaluators {
        Some(evaluators) => evaluators.clone(),
        None if file.query.is_some() => vec![EvaluatorKind::Query(evaluate::Query::default())],
        None => Vec::new(),
    };
    for (index, evaluator) in evaluators.iter().enumerate() {
        let place = [Key("evaluators"), Index(index)];
        let method = evaluator.method();
        if let Some((key, found, expected)) = method.complaint() {
            let message = format!("{key} = {found} found; {expected} expected");
            return Err(source.error(&place, message));
        }
        if method.needs_query() && file.query.is_none() {
            let message = format!("the {} evaluator needs a [query] table", method.name());
            return Err(source.error(&place, message));
        }
    }
    Ok(evaluators)
}
