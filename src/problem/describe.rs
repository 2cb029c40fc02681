use super::Problem;
use crate::generator::Sample;
use crate::internal::plain::plain;
use crate::schedule::Adaptive;
use crate::source::{setting, value};
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
    for note in &problem.notes {
        writeln!(out, "chosen           {note}")?;
    }
    writeln!(out, "problem digest   {}", problem.digest())
}
