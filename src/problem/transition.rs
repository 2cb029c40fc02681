//! The problem of a protein's transition between two known structures.

use super::{Problem, ProblemBuilder, StrategySpec};
use crate::connect::{AmongKind, NodesAndComponents};
use crate::evaluate::{BarrierTrend, EvaluatorKind, FlowRatio};
use crate::generator::{ElasticGrowth, GeneratorKind, GrowthAim, Interpolation};
use crate::model::protein::refit::{Refit, Weights, refit};
use crate::model::protein::{KT, Protein, ProteinSpec};
use crate::model::{Description, Draw, Model, ModelKind, Scratch};
use crate::sampler::{SamplerKind, TorsionNoise};
use crate::source::{ProblemError, fitting};
use crate::structure::Residue;
use crate::structure::measure::rmsd;
use std::path::Path;

/// Nodes of a set.
const NODES: u64 = 50;

/// Sets of a round: so many that judging a round takes a small part of its time.
const SETS_PER_ROUND: u64 = 16;

/// By how much the lowest barrier may have fallen over the last doubling of nodes when the roadmap is large enough, model kJ/mol.
const FALL_OF_BARRIER: f64 = 5.0 * KT;

/// How strongly each Cα is held to its place while ends are relaxed, kT/Å², if nothing is said: adenylate kinase and calmodulin move by
/// about 0.3 Å.
pub const HOLD: f64 = 10.0;

/// The longest step of relaxing, Å, how many are taken at most, and below which length there are no more.
const RELAXING_STEP: f64 = 0.3;
const RELAXING_STEPS: usize = 40;
const RELAXED: f64 = 0.003;

/// A protein between two structures, as a problem with a query.
#[derive(Debug)]
pub struct Transition {
    /// The problem: start is the source structure, goal what comes nearest to the target on the source's linkage, both relaxed.
    pub problem: Problem,
    /// How near what comes nearest is.
    pub refit: Refit,
    /// What relaxing did to the start and to the goal.
    pub relaxed: [Relaxed; 2],
}

/// What relaxing did to an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxed {
    /// How far it moved, RMSD of all Cα in Å after superposition.
    pub moved: f64,
    /// Its energy before and after, model kJ/mol.
    pub energy: [f64; 2],
}

/// Makes the problem of a transition from the source of `spec` to its target: with interpolations between the ends, and sets that
/// grow at the frontier between them, at the lowest barrier, and anywhere.
///
/// Both ends are relaxed first, each Cα being held to its place with `hold` kT/Å² ([`HOLD`]), or not at all where that is 0. For the
/// hydrogen bonds of a crystal are not at the distances that the energy has least at, and those of a refit even less: every way
/// out of them leads down, so that the ends themselves would be the highest places of all paths and nothing could be said of
/// the barrier between them.
///
/// Relative paths start in `folder`. Characters that a problem's name cannot have become `-`.
///
/// # Errors
/// What is wrong with the structures, and ends that break the rules, with the first pair of atoms that does.
pub fn transition(
    name: &str,
    folder: &Path,
    spec: &ProteinSpec,
    hold: f64,
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
    let ends = [("start", protein.linkage().source()), ("goal", refit.q.clone())];
    for (end, q) in &ends {
        expect_valid(&protein, end, q)?;
    }
    let model = protein.prepare();
    let ends = ends.map(|(_, q)| {
        let moved = if hold > 0.0 { relaxed(&*model, &q, hold) } else { q.clone() };
        let energy = [&q, &moved].map(|q| model.energy(q, &mut Scratch::new()).unwrap_or(0.0));
        (Relaxed { moved: apart(&*model, &q, &moved), energy }, moved)
    });
    let relaxed = [ends[0].0, ends[1].0];
    let [(_, start), (_, goal)] = ends;
    let mut problem = builder
        .query(start, goal)
        .strategies(strategies())
        .sets_per_round(SETS_PER_ROUND)
        .evaluator(EvaluatorKind::FlowRatio(FlowRatio::default()))
        .evaluator(EvaluatorKind::BarrierTrend(BarrierTrend::new(FALL_OF_BARRIER)))
        .build()?;
    if protein.has_obstacles() {
        problem.notes.push(
            "obstacles: the first residue stands still, so the goal stands beside them where its torsions lead, and not where \
             the target's file has it"
                .to_owned(),
        );
    }
    Ok(Transition { problem, refit, relaxed })
}

/// How the roadmap of a transition is made.
fn strategies() -> Vec<StrategySpec> {
    let among =
        || AmongKind::NodesAndComponents(NodesAndComponents { cycles: 3, ..Default::default() });
    let generated = |label: &str, generator| {
        StrategySpec::generated(label, generator).nodes(NODES).among(among())
    };
    let grown = |label: &str, aim| {
        let growth = ElasticGrowth { aim, ..ElasticGrowth::default() };
        generated(label, GeneratorKind::ElasticGrowth(growth))
    };
    let interpolation = GeneratorKind::Interpolation(Interpolation::default());
    vec![
        grown("frontier", GrowthAim::Frontier),
        generated("interpolation", interpolation),
        grown("barrier", GrowthAim::Barrier),
        grown("anywhere", GrowthAim::Anywhere),
    ]
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
pub(super) fn expect_valid(protein: &Protein, end: &str, q: &[f64]) -> Result<(), ProblemError> {
    protein.broken_rule(q).map_or(Ok(()), |message| {
        Err(ProblemError::pathless(format!(
            "the {end} is not valid: {message}; `rules` and `highest` that it keeps expected"
        )))
    })
}

/// The configuration near `end` at which the springs of the elastic network are in balance with others that hold each Cα in
/// its place with `hold` kT/Å²; of those on the way there that are valid, the one of the least energy.
fn relaxed(model: &dyn Model, end: &[f64], hold: f64) -> Vec<f64> {
    let scratch = &mut Scratch::new();
    let energy = |q: &[f64], scratch: &mut Scratch| model.energy(q, scratch).unwrap_or(f64::NAN);
    let mut best = (energy(end, scratch), end.to_vec());
    let Some(residues) = model.shape(end, scratch).map(|shape| shape.len()) else { return best.1 };
    let mut here = end.to_vec();
    for _ in 0..RELAXING_STEPS {
        let Some(elastic) = model.elastic(&here) else { break };
        let draw = Draw { target: end, residues: 0..residues, strength: hold };
        let Some(next) = elastic.toward(&draw, RELAXING_STEP) else { break };
        let reached = energy(&next, scratch);
        if reached < best.0 && model.is_valid(&next, scratch) {
            best = (reached, next.clone());
        }
        let moved = apart(model, &here, &next);
        here = next;
        if moved < RELAXED {
            break;
        }
    }
    best.1
}

/// How far apart two configurations are, RMSD of all Cα in Å.
fn apart(model: &dyn Model, a: &[f64], b: &[f64]) -> f64 {
    let scratch = &mut Scratch::new();
    let [a, b] = [a, b].map(|q| model.shape(q, scratch).unwrap_or_default());
    rmsd(&a, &b)
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

pub(super) fn protein_of(builder: &ProblemBuilder) -> Result<Protein, ProblemError> {
    let problem = builder.build()?;
    match problem.model {
        ModelKind::Protein(protein) => Ok(protein),
        _ => unreachable!("the problem was built of a protein's spec"),
    }
}
