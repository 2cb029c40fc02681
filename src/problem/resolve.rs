//! From what a problem asks for to a checked problem.

use super::building::{Sets, add_gaps, evaluators_of, limits_of, sets_of};
use super::file::{File, KEYS};
use super::hint_files::take_in_hints;
use super::poses::ends_of;
use super::{DEFAULT_SEED, Problem};
use crate::context::Context;
use crate::generator::{Runs, Sample};
use crate::internal::plain::plain;
use crate::model::{ModelKind, ModelSpec};
use crate::seed::Seed;
use crate::source::Step::{self, Index, Key};
use crate::source::{ProblemError, Source, fits};
use crate::space::Space;
use crate::strategy::Strategy;
use std::path::Path;

/// Reads and checks the text of the problem file `path`.
pub(super) fn resolve_text(
    path: &Path,
    text: &str,
    runs: &dyn Runs,
) -> Result<Problem, ProblemError> {
    let source = Source::of_text(path, text)?;
    source.expect_keys(&[ModelSpec::tables_in(&source), &KEYS].concat())?;
    let (file, model) = (source.tables()?, ModelSpec::read(&source)?);
    resolve(source, &file, &model, runs)
}

/// Checks what is asked for and makes the problem.
pub(super) fn resolve(
    source: Source,
    file: &File,
    model: &ModelSpec,
    runs: &dyn Runs,
) -> Result<Problem, ProblemError> {
    let mut notes = Vec::new();

    let name = name_of(&source, file)?;
    let model = ModelKind::resolve(model, &source, &mut notes)?;
    let notes = notes.iter().map(|note| plain(note).into_owned()).collect();
    let Sets { mut strategies, schedule, adaptive, sets_per_round } = sets_of(&source, file)?;
    let space = model.description().space();
    take_in_parents(&source, runs, &space, &mut strategies)?;
    take_in_hints(&source, &space, &mut strategies)?;
    let limits = limits_of(&source, file, &model.description().space())?;
    let evaluators = evaluators_of(&source, file)?;
    let seed = file.seed.unwrap_or(DEFAULT_SEED);

    let problem = Problem {
        name,
        seed,
        model,
        function: None,
        query: None,
        strategies,
        schedule,
        adaptive,
        sets_per_round,
        evaluators,
        limits,
        nodes_are_given: file.limits.nodes.is_some(),
        notes,
        sources: Vec::new(),
        earlier: Vec::new(),
        relaxation: None,
    };
    let mut problem = accepted(&source, file, problem)?;
    if let Some(settings) = &file.relaxation {
        let checked = problem.checked_relaxation(settings.clone());
        problem.relaxation = Some(checked.map_err(|(keys, message)| {
            let place: Vec<Step> = keys.into_iter().map(Key).collect();
            source.error(&place, message)
        })?);
    }
    Ok(Problem { sources: source.files.into_inner(), ..problem })
}

/// Takes in the roadmaps of the runs that generators read.
fn take_in_parents(
    source: &Source,
    runs: &dyn Runs,
    space: &Space,
    strategies: &mut [Strategy],
) -> Result<(), ProblemError> {
    for (index, strategy) in strategies.iter_mut().enumerate() {
        if let Some(parent) = strategy.generator.method_mut().parent_mut() {
            let place = [Key("strategies"), Index(index), Key("generator")];
            parent
                .take_in(runs, source.folder, space)
                .map_err(|message| source.error(&place, message))?;
        }
    }
    Ok(())
}

fn name_of(source: &Source, file: &File) -> Result<String, ProblemError> {
    let name = file.name.clone().unwrap_or_else(|| source.stem());
    if !fits(&name) || name.starts_with('.') || name.len() > 100 {
        let expected = "letters, digits, `-`, `_` and `.` expected, at most 100, not led by `.`";
        return Err(source.error(&[Key("name")], format!("`{name}` found; {expected}")));
    }
    Ok(name)
}

/// Checks what needs the whole problem: configurations.
fn accepted(source: &Source, file: &File, mut problem: Problem) -> Result<Problem, ProblemError> {
    let mut cx = problem.context();
    if let Some(query) = &file.query {
        problem.query = Some(ends_of(source, &cx, &mut problem, query)?);
        cx.query.clone_from(&problem.query);
    }
    if file.strategies.is_empty() && file.img.schedule.is_none() {
        add_gaps(&mut problem, &cx);
    }
    let seed = problem.seed;
    for (index, strategy) in problem.strategies.iter_mut().enumerate() {
        let calibrating = Seed::of_calibration(seed, &strategy.label);
        strategy.generator.method_mut().calibrate(&cx, &calibrating);
        let given = file.strategies.get(index).is_some_and(|table| table.generator.is_some());
        for (key, suits) in suits(strategy, given, &cx) {
            let place = [Key("strategies"), Index(index), Key(key)];
            suits.map_err(|message| source.error(&place, message))?;
        }
    }
    let has_several_goals = problem.query.as_ref().is_some_and(|ends| !ends.other_goals.is_empty());
    for (index, evaluator) in problem.evaluators.iter_mut().enumerate() {
        if has_several_goals && !evaluator.method().knows_several_goals() {
            let name = evaluator.method().name();
            let message =
                format!("the {name} evaluator found beside several goals; one goal expected");
            return Err(source.error(&[Key("evaluators"), Index(index)], message));
        }
        let accepted = evaluator.method_mut().accept(&cx);
        accepted.map_err(|message| source.error(&[Key("evaluators"), Index(index)], message))?;
    }
    Ok(problem)
}

/// Whether a strategy's methods can work with a problem, each under its key. A generator that is `given` as such has one key.
pub(super) fn suits(
    strategy: &Strategy,
    given: bool,
    cx: &Context,
) -> Vec<(&'static str, Result<(), String>)> {
    let mut found = match strategy.generator.as_sample() {
        // The keys of the short form.
        Some(Sample { sampler, within }) if !given => {
            vec![("sampler", sampler.method().suits(cx)), ("within", within.method().suits(cx))]
        }
        _ => vec![("generator", strategy.generator.method().suits(cx))],
    };
    found.push(("among", strategy.among.method().suits(cx)));
    found
}
