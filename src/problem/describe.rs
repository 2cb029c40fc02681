use super::Problem;
use crate::generator::Sample;
use crate::internal::plain::plain;
use crate::model::Scratch;
use crate::schedule::Adaptive;
use crate::source::{setting, value};
use crate::space::Space;
use crate::strategy::Strategy;
use std::fmt::Write;

/// The most values of a configuration that are shown.
const VALUES_SHOWN: usize = 24;

pub(super) fn describe(problem: &Problem) -> String {
    let mut text = String::new();
    write_all(problem, &mut text).expect("writing to memory cannot fail");
    text
}

fn write_all(problem: &Problem, out: &mut String) -> std::fmt::Result {
    let space = problem.space();
    writeln!(out, "problem          {} (seed {})", plain(&problem.name), problem.seed)?;
    writeln!(out, "configuration    {}", plain(&space.form()))?;
    problem.model.description().describe(out);
    if let Some(function) = &problem.function {
        let judges =
            "judges configurations too; it is sampled along motions, of which nothing is proved";
        writeln!(out, "function         {}: {judges}", plain(function.identity()))?;
    }
    if let Some(query) = &problem.query {
        let goal_name = |index: usize| match query.other_goals.len() {
            0 => "goal".to_owned(),
            others => format!("goal {} of {}", index + 1, others + 1),
        };
        let goals = query.goals().enumerate().map(|(index, q)| (goal_name(index), q));
        for (name, q) in std::iter::once(("start".to_owned(), &query.start[..])).chain(goals) {
            let values = &q[..q.len().min(VALUES_SHOWN)];
            match q.len() - values.len() {
                0 => writeln!(out, "{name:<16} {values:?}")?,
                more => writeln!(out, "{name:<16} {values:?} and {more} more values")?,
            }
            problem.model.description().describe_end(&name, q, out);
        }
    }
    for strategy in &problem.strategies {
        let Strategy { label, nodes, generator, among } = strategy;
        let makes = match generator.as_sample() {
            Some(Sample { sampler, within }) => {
                format!("sampler = {}, within = {}", value(sampler), value(within))
            }
            None => format!("generator = {}", value(generator)),
        };
        let (label, among) = (plain(label), value(among));
        let methods = format!("{makes}, among = {among}");
        writeln!(out, "strategy         {label}: {nodes} nodes per set, {}", plain(&methods))?;
        write_hints(problem, strategy, out)?;
    }
    let labels: Vec<_> = problem
        .schedule
        .iter()
        .map(|index| plain(&problem.strategies[index.index()].label))
        .collect();
    writeln!(
        out,
        "schedule         {}, {}; {} sets per round",
        labels.join(" "),
        match problem.adaptive {
            None => "over and over".to_owned(),
            Some(Adaptive { rounds }) =>
                format!("by what they united for their cost in the last {rounds} rounds"),
        },
        problem.sets_per_round
    )?;
    for evaluator in &problem.evaluators {
        writeln!(out, "until            {}", plain(&setting(evaluator)))?;
    }
    let sets = match problem.limits.sets {
        u64::MAX => "any number of".to_owned(),
        sets => sets.to_string(),
    };
    write!(out, "limits           {} nodes, {sets} sets", problem.limits.nodes)?;
    match problem.limits.seconds {
        Some(seconds) => writeln!(out, ", {seconds} s")?,
        None => writeln!(out, ", any time")?,
    }
    if let Some(settings) = &problem.relaxation {
        writeln!(out, "relaxation       {}", plain(&value(settings)))?;
    }
    for note in &problem.notes {
        writeln!(out, "chosen           {note}")?;
    }
    writeln!(out, "problem digest   {}", problem.digest())
}

/// A line for each approximate path of a strategy: what was read, and how much of it is valid as it is.
fn write_hints(problem: &Problem, strategy: &Strategy, out: &mut String) -> std::fmt::Result {
    let mut generator = strategy.generator.clone();
    let paths = generator.method_mut().hint_paths_mut();
    if paths.is_empty() {
        return Ok(());
    }
    let (cx, scratch) = (problem.context(), &mut Scratch::new());
    for path in paths {
        let configurations = path.configurations();
        let name = if path.file().is_empty() { "given in numbers" } else { path.file() };
        let is_valid = |q: &&Vec<f64>| {
            let mut q = q.to_vec();
            cx.stored(&mut q).is_ok() && cx.model().is_valid(&q, scratch)
        };
        let (count, length) = (configurations.len(), length_of(cx.space(), configurations));
        let valid = configurations.iter().filter(is_valid).count();
        writeln!(
            out,
            "hint             {}: {count} configurations, of which {valid} are valid, {length:.4} long",
            plain(name)
        )?;
    }
    Ok(())
}

/// The length of a path in the metric.
fn length_of(space: &Space, path: &[Vec<f64>]) -> f64 {
    path.windows(2).map(|leg| space.distance(&leg[0], &leg[1])).fold(0.0, |sum, leg| sum + leg)
}
