//! The problem of a protein's transition between two known structures.

use super::{Problem, ProblemBuilder, StrategySpec};
use crate::model::ModelKind;
use crate::model::protein::refit::{Refit, Weights, refit};
use crate::model::protein::{Protein, ProteinSpec};
use crate::sampler::{About, SamplerKind, TorsionNoise};
use crate::source::{ProblemError, fitting};
use crate::structure::Residue;
use std::path::Path;

/// Nodes of a set.
const NODES: u64 = 50;

/// A protein between two structures, as a problem with a query.
#[derive(Debug)]
pub struct Transition {
    /// The problem: start is the source structure, goal what comes nearest to the target on the source's linkage.
    pub problem: Problem,
    /// How near that is.
    pub refit: Refit,
}

/// Makes the problem of a transition from the source of `spec` to its target, with sets of torsion noise about both ends.
/// Relative paths start in `folder`. Characters that a problem's name cannot have become `-`.
///
/// # Errors
/// What is wrong with the structures, and ends that break the rules, with the first pair of atoms that does.
pub fn transition(
    name: &str,
    folder: &Path,
    spec: &ProteinSpec,
) -> Result<Transition, ProblemError> {
    let builder = Problem::builder(fitting(name), spec.clone()).folder(folder);
    let protein = protein_of(&builder)?;
    let Some(target) = protein.target() else {
        let message = "protein.target: none found; the other end of the transition expected";
        return Err(ProblemError::pathless(message.to_owned()));
    };
    let counterparts = counterparts(&protein, target)?;
    let fitted = refit(
        protein.source(),
        &protein.linkage(),
        &counterparts,
        protein.rules(),
        &Weights::default(),
    );
    let refit =
        fitted.map_err(|error| ProblemError::pathless(format!("protein.target: {error}")))?;
    let (start, goal) = (protein.linkage().source(), refit.q.clone());
    expect_valid(&protein, "start", &start)?;
    expect_valid(&protein, "goal", &goal)?;
    let noise = TorsionNoise { about: About::Ends, ..TorsionNoise::default() };
    let strategy = StrategySpec::sampled("noise", SamplerKind::TorsionNoise(noise)).nodes(NODES);
    let mut problem = builder.query(start, goal).strategy(strategy).build()?;
    if protein.has_obstacles() {
        problem.notes.push(
            "obstacles: the first residue stands still, so the goal stands beside them where its torsions lead, and not where \
             the target's file has it"
                .to_owned(),
        );
    }
    Ok(Transition { problem, refit })
}

/// Makes the problem of a protein about its only structure, with sets of torsion noise about it and no criterion.
/// `name` and `folder` as for [`transition`].
///
/// # Errors
/// What is wrong with the structure, and one that breaks the rules, with the first pair of atoms that does.
pub fn about_native(
    name: &str,
    folder: &Path,
    spec: &ProteinSpec,
) -> Result<Problem, ProblemError> {
    let builder = Problem::builder(fitting(name), spec.clone()).folder(folder);
    let protein = protein_of(&builder)?;
    expect_valid(&protein, "source", &protein.linkage().source())?;
    let noise = SamplerKind::TorsionNoise(TorsionNoise::default());
    let strategy = StrategySpec::sampled("noise", noise).nodes(NODES);
    builder.strategy(strategy).build()
}

/// An error where an end of a problem is not valid.
fn expect_valid(protein: &Protein, end: &str, q: &[f64]) -> Result<(), ProblemError> {
    protein.broken_rule(q).map_or(Ok(()), |message| {
        Err(ProblemError::pathless(format!(
            "the {end} is not valid: {message}; `rules` and `highest` that it keeps expected"
        )))
    })
}

/// The target's residues, one for each of the source's.
fn counterparts(protein: &Protein, target: &[Residue]) -> Result<Vec<Residue>, ProblemError> {
    let (source, matches) = (protein.source(), protein.matches());
    let is_matched = |at: &usize| matches.iter().any(|[here, _]| *here as usize == *at);
    if let Some(lone) = (0..source.len()).find(|at| !is_matched(at)) {
        let message = format!(
            "protein.target: no counterpart of {} found; all of the source's residues expected: choose those that both ends \
             have by `residues`",
            source[lone]
        );
        return Err(ProblemError::pathless(message));
    }
    Ok(matches.iter().map(|[_, there]| target[*there as usize].clone()).collect())
}

fn protein_of(builder: &ProblemBuilder) -> Result<Protein, ProblemError> {
    let problem = builder.build()?;
    match problem.model {
        ModelKind::Protein(protein) => Ok(protein),
        _ => unreachable!("the problem was built of a protein's spec"),
    }
}
