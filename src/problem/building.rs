//! How the roadmap is built: strategies, schedule, limits and evaluators.

use super::file::{File, PolicyTable, ScheduleTable};
use super::{Limits, Problem, StrategySpec};
use crate::context::Context;
use crate::evaluate::{self, EvaluatorKind};
use crate::generator::Sample;
use crate::methods::{BRACKETS_MAX, too_deep};
use crate::numbers::StrategyIndex;
use crate::schedule::Adaptive;
use crate::source::ProblemError;
use crate::source::Source;
use crate::source::Step::{Index, Key};
use crate::space::Space;
use crate::strategy::Strategy;

const SET_NODES_MAX: u64 = 1_000_000;
const SETS_PER_ROUND_MAX: u64 = 1_000_000;
const DEFAULT_SETS_PER_ROUND: u64 = 5;

/// Which sets are made, in which order: what [`Problem`](super::Problem) says of it.
pub(super) struct Sets {
    pub strategies: Vec<Strategy>,
    pub schedule: Vec<StrategyIndex>,
    pub adaptive: Option<Adaptive>,
    pub sets_per_round: u32,
}

pub(super) fn sets_of(source: &Source, file: &File) -> Result<Sets, ProblemError> {
    // A schedule can only name the strategy that every problem without strategies has.
    let has_trees = file.query.is_some() && file.img.schedule.is_none();
    let (default, default_schedule) = default_strategies(has_trees);
    let specs = if file.strategies.is_empty() { &default } else { &file.strategies };
    let mut strategies: Vec<Strategy> = Vec::new();
    for (index, spec) in specs.iter().enumerate() {
        let fail = |keys: &[&str], message: String| {
            let mut place = vec![Key("strategies"), Index(index)];
            place.extend(keys.iter().map(|key| Key(key)));
            Err(source.error(&place, message))
        };
        if spec.label.is_empty() || spec.label.len() > 100 {
            return fail(&["label"], "1 to 100 bytes expected".to_owned());
        }
        if strategies.iter().any(|other| other.label == spec.label) {
            let message = format!("`{}` found twice; labels of their own expected", spec.label);
            return fail(&["label"], message);
        }
        if !(1..=SET_NODES_MAX).contains(&spec.nodes) {
            let message = format!("{} found; 1 to {SET_NODES_MAX} expected", spec.nodes);
            return fail(&["nodes"], message);
        }
        let sampler = spec.sampler.as_ref().or_else(|| spec.generator.as_ref()?.sampler());
        if sampler.is_some_and(|sampler| !sampler.method().is_within(BRACKETS_MAX - 2)) {
            let key = if spec.sampler.is_some() { "sampler" } else { "generator" };
            return fail(&[key], too_deep());
        }
        let generator = match spec.maker() {
            Ok(generator) => generator,
            Err((key, message)) => return fail(&[key], message.to_owned()),
        };
        let complaints = match generator.as_sample() {
            // The keys of the short form.
            Some(Sample { sampler, within }) if spec.generator.is_none() => vec![
                ("sampler", sampler.method().complaint()),
                ("within", within.method().complaint()),
            ],
            _ => vec![("generator", generator.method().complaint())],
        };
        let among = ("among", spec.among.method().complaint());
        for (role, complaint) in complaints.into_iter().chain([among]) {
            if let Some(complaint) = complaint {
                return fail(&[role], complaint.to_string());
            }
        }
        strategies.push(Strategy {
            label: spec.label.clone(),
            nodes: spec.nodes as u32,
            generator,
            among: spec.among.clone(),
        });
    }

    let place = [Key("img"), Key("schedule")];
    let schedule = match &file.img.schedule {
        None if file.strategies.is_empty() => default_schedule,
        None | Some(ScheduleTable::Policy(_)) => {
            (0..strategies.len() as u32).map(StrategyIndex).collect()
        }
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
                schedule.push(StrategyIndex(index as u32));
            }
            schedule
        }
    };
    if schedule.is_empty() {
        return Err(source.error(&place, "[] found; at least one label expected".to_owned()));
    }
    let indices = (0..strategies.len() as u32).map(StrategyIndex);
    if let Some(idle) = indices.into_iter().find(|index| !schedule.contains(index)) {
        let label = &strategies[idle.index()].label;
        return Err(source.error(&place, format!("the strategy `{label}` has no place in it")));
    }
    let sets = file.img.sets_per_round.unwrap_or(DEFAULT_SETS_PER_ROUND);
    if !(1..=SETS_PER_ROUND_MAX).contains(&sets) {
        let message = format!("{sets} found; 1 to {SETS_PER_ROUND_MAX} expected");
        return Err(source.error(&[Key("img"), Key("sets_per_round")], message));
    }
    let adaptive = adaptive_of(source, file)?;
    Ok(Sets { strategies, schedule, adaptive, sets_per_round: sets as u32 })
}

/// How the schedule adapts, if it does.
fn adaptive_of(source: &Source, file: &File) -> Result<Option<Adaptive>, ProblemError> {
    match &file.img.schedule {
        Some(ScheduleTable::Policy(PolicyTable::Adaptive(Adaptive { rounds: 0 }))) => {
            let message = "rounds = 0 found; at least 1 expected".to_owned();
            Err(source.error(&[Key("img"), Key("schedule")], message))
        }
        Some(ScheduleTable::Policy(PolicyTable::Adaptive(adaptive))) => Ok(Some(*adaptive)),
        None if file.strategies.is_empty() => Ok(default_adaptive(file.query.is_some())),
        None | Some(ScheduleTable::Labels(_)) => Ok(None),
    }
}

/// The strategies of a problem that names none, and which of them make its sets.
///
/// Uniform sampling, and, if there is a query, trees from both its ends whose blocked extensions slide along what blocks them. Each of the
/// two solves queries that the other is long about, and both together many sooner than either (`docs/performance.md`, "Time to solve").
fn default_strategies(has_trees: bool) -> (Vec<StrategySpec>, Vec<StrategyIndex>) {
    let (uniform, growing) = (StrategyIndex(0), StrategyIndex(1));
    match has_trees {
        false => (vec![StrategySpec::uniform()], vec![uniform]),
        true => {
            (vec![StrategySpec::uniform(), StrategySpec::from_both_ends()], vec![uniform, growing])
        }
    }
}

/// How the schedule over these strategies adapts: if there are several, none takes much more effort than another unless it unites more.
fn default_adaptive(has_trees: bool) -> Option<Adaptive> {
    has_trees.then(Adaptive::default)
}

/// The sets of a problem that says nothing of them.
pub(super) fn default_sets(has_query: bool) -> Sets {
    let (specs, schedule) = default_strategies(has_query);
    Sets {
        strategies: specs.into_iter().map(strategy_of).collect(),
        schedule,
        adaptive: default_adaptive(has_query),
        sets_per_round: DEFAULT_SETS_PER_ROUND as u32,
    }
}

/// Adds to the strategies of a problem with a query that names none trees from gaps, where the robot and the obstacles have any.
pub(super) fn add_gaps(problem: &mut Problem, cx: &Context) {
    if problem.query.is_none() || cx.model.gaps().is_none() {
        return;
    }
    let spec = StrategySpec::from_gaps();
    problem.schedule.push(StrategyIndex(problem.strategies.len() as u32));
    problem.strategies.push(strategy_of(spec));
}

/// A default strategy.
fn strategy_of(spec: StrategySpec) -> Strategy {
    Strategy {
        generator: spec.maker().expect("default strategies have a sampler or a generator"),
        label: spec.label,
        nodes: spec.nodes as u32,
        among: spec.among,
    }
}

pub(super) fn limits_of(
    source: &Source,
    file: &File,
    space: &Space,
) -> Result<Limits, ProblemError> {
    let asked = &file.limits;
    let mut limits = Limits::left_open(space);
    if asked.seconds.is_some() {
        limits = Limits { seconds: asked.seconds, ..limits.with_time(space) };
    }
    limits.nodes = asked.nodes.unwrap_or(limits.nodes);
    limits.sets = asked.sets.unwrap_or(limits.sets);
    limits
        .complaint()
        .map_or(Ok(limits), |(key, message)| Err(source.error(&[Key("limits"), Key(key)], message)))
}

pub(super) fn evaluators_of(
    source: &Source,
    file: &File,
) -> Result<Vec<EvaluatorKind>, ProblemError> {
    for (index, evaluator) in file.evaluators.iter().flatten().enumerate() {
        if !evaluator.method().is_within(BRACKETS_MAX) {
            return Err(source.error(&[Key("evaluators"), Index(index)], too_deep()));
        }
    }
    let evaluators = match &file.evaluators {
        Some(evaluators) => evaluators.clone(),
        None if file.query.is_some() => vec![EvaluatorKind::Query(evaluate::Query::default())],
        None => Vec::new(),
    };
    for (index, evaluator) in evaluators.iter().enumerate() {
        let place = [Key("evaluators"), Index(index)];
        let method = evaluator.method();
        if let Some(complaint) = method.complaint() {
            return Err(source.error(&place, complaint.to_string()));
        }
        if method.needs_query() && file.query.is_none() {
            let message = format!("the {} evaluator needs a [query] table", method.name());
            return Err(source.error(&place, message));
        }
    }
    Ok(evaluators)
}
