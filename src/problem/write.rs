//! A problem written out as a problem file that loads to the same problem.

use super::Problem;
use crate::generator::Sample;
use crate::model::Documents;
use crate::source::{setting, value};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A problem as files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The problem file.
    pub text: String,
    /// The files that it names: name and contents. Of bodies these are meshes, Wavefront `.obj`; bodies with the
    /// same mesh share one.
    pub files: Vec<(String, String)>,
}

impl Problem {
    /// Writes the problem as TOML whose other files stand in `folder`, a path from the file's own folder.
    /// What loads from it has the same [`Problem::digest`] and the same query: every number is
    /// written with the digits that give it back to the bit, and every mesh as it is used, after all
    /// that its reader joined, turned and moved. Notes become comments.
    pub fn to_toml(&self, folder: &str) -> Written {
        let mut documents = Documents {
            text: String::new(),
            folder: folder.to_owned(),
            files: Vec::new(),
            names: BTreeMap::new(),
        };
        head(self, &mut documents.text).expect("writing to memory cannot fail");
        self.model.description().write(&mut documents);
        building(self, &mut documents.text).expect("writing to memory cannot fail");
        Written { text: documents.text, files: documents.files }
    }
}

fn head(problem: &Problem, out: &mut String) -> std::fmt::Result {
    for note in &problem.notes {
        let line: String = note.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        writeln!(out, "# {line}")?;
    }
    if let Some(function) = &problem.function {
        let identity = function.identity();
        writeln!(
            out,
            "# judged by the validity function {identity:?} too, which no file can have"
        )?;
    }
    writeln!(out, "name = {}", value(&problem.name))?;
    writeln!(out, "seed = {}", problem.seed)?;
    if problem.evaluators.is_empty() && problem.query.is_some() {
        writeln!(out, "evaluators = []")?;
    }
    Ok(())
}

fn building(problem: &Problem, out: &mut String) -> std::fmt::Result {
    if let Some(query) = &problem.query {
        writeln!(out, "\n[query]\nstart = {:?}", query.start)?;
        match &query.other_goals[..] {
            [] => writeln!(out, "goal = {:?}", query.goal)?,
            _ => writeln!(out, "goal = {:?}", query.goals().collect::<Vec<_>>())?,
        }
    }
    let labels = problem.schedule.iter().map(|index| &problem.strategies[index.index()].label);
    let labels: Vec<&String> = labels.collect();
    writeln!(out, "\n[img]\nsets_per_round = {}", problem.sets_per_round)?;
    match &problem.adaptive {
        None => writeln!(out, "schedule = {}", value(&labels))?,
        Some(adaptive) => writeln!(out, "schedule = {{ adaptive = {} }}", value(adaptive))?,
    }
    for strategy in &problem.strategies {
        writeln!(out, "\n[[strategies]]\nlabel = {}", value(&strategy.label))?;
        writeln!(out, "nodes = {}", strategy.nodes)?;
        match strategy.generator.as_sample() {
            Some(Sample { sampler, within }) => {
                writeln!(out, "sampler = {}\nwithin = {}", value(sampler), value(within))?;
            }
            None => writeln!(out, "generator = {}", value(&strategy.generator))?,
        }
        writeln!(out, "among = {}", value(&strategy.among))?;
    }
    for evaluator in &problem.evaluators {
        writeln!(out, "\n[[evaluators]]")?;
        writeln!(out, "{}", setting(evaluator))?;
    }
    let limits = &problem.limits;
    writeln!(out, "\n[limits]")?;
    if let Some(nodes) = problem.nodes_to_say() {
        writeln!(out, "nodes = {nodes}")?;
    }
    if limits.sets != u64::MAX {
        writeln!(out, "sets = {}", limits.sets)?;
    }
    match limits.seconds {
        Some(seconds) => writeln!(out, "seconds = {seconds:?}"),
        None => Ok(()),
    }
}
