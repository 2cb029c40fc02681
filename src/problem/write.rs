//! A problem written out as a problem file that loads to the same problem.

use super::Problem;
use super::hint_files::csv_of;
use crate::digest::Digest;
use crate::generator::{GeneratorKind, Sample};
use crate::model::Documents;
use crate::relaxation::Settings;
use crate::source::{setting, value};
use crate::space::Space;
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
        building(self, &mut documents).expect("writing to memory cannot fail");
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

/// The generator of a strategy whose approximate paths are written as files of their own, named by what they hold.
fn with_hint_files(
    generator: &GeneratorKind,
    space: &Space,
    documents: &mut Documents,
) -> GeneratorKind {
    let mut generator = generator.clone();
    for path in generator.method_mut().hint_paths_mut() {
        let csv = csv_of(path, space);
        let digest = Digest::of(csv.as_bytes());
        let named = documents.names.get(&digest).cloned();
        let name = named.unwrap_or_else(|| {
            let name = format!("hint-{}.csv", &digest.to_string()[..12]);
            documents.files.push((name.clone(), csv));
            documents.names.insert(digest, name.clone());
            name
        });
        *path = path.named(format!("{}/{name}", documents.folder));
    }
    generator
}

fn building(problem: &Problem, documents: &mut Documents) -> std::fmt::Result {
    let space = problem.space();
    let generators: Vec<GeneratorKind> = problem
        .strategies
        .iter()
        .map(|strategy| with_hint_files(&strategy.generator, &space, documents))
        .collect();
    let out = &mut documents.text;
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
    for (strategy, generator) in problem.strategies.iter().zip(&generators) {
        writeln!(out, "\n[[strategies]]\nlabel = {}", value(&strategy.label))?;
        writeln!(out, "nodes = {}", strategy.nodes)?;
        match generator.as_sample() {
            Some(Sample { sampler, within }) => {
                writeln!(out, "sampler = {}\nwithin = {}", value(sampler), value(within))?;
            }
            None => writeln!(out, "generator = {}", value(generator))?,
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
    if let Some(seconds) = limits.seconds {
        writeln!(out, "seconds = {seconds:?}")?;
    }
    if let Some(settings) = &problem.relaxation {
        writeln!(out, "\n[relaxation]")?;
        let Settings { kind, start, finest, levels, nodes, sets, paths } = settings;
        if let Some(kind) = kind {
            writeln!(out, "kind = {}", value(kind))?;
        }
        writeln!(out, "start = {start:?}\nfinest = {finest:?}\nlevels = {levels}")?;
        writeln!(out, "nodes = {nodes}\npaths = {paths}")?;
        if let Some(sets) = sets {
            writeln!(out, "sets = {sets}")?;
        }
    }
    Ok(())
}
