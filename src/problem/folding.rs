//! The problem of a protein's folding.

use super::transition::{expect_valid, protein_of};
use super::{Problem, ProblemError, StrategySpec};
use crate::connect::{AmongKind, Neighbors};
use crate::evaluate::{EvaluatorKind, FormationOrder};
use crate::generator::{GeneratorKind, Mrrg, NeighborCount};
use crate::model::protein::ProteinSpec;
use crate::source::fitting;
use std::path::Path;

/// Nodes of a set, and sets of a round: 250 samples between two evaluations (S. Nath 2013, §5.3.2), five sets of either step.
const NODES: u64 = 25;
const SETS_PER_ROUND: u64 = 10;

/// How far extensions move at most, radians in the metric of all torsions, each with as many sets. Long ones lead from the
/// native conformation to unstructured ones in a dozen steps; short ones find a way through the narrow surroundings of the
/// native conformation, where parts form one after the other.
const STEPS: [f64; 2] = [0.25, 1.0];

/// In how many directions a node is extended: S. Nath 2013, §5.3.2.1, found 7 best for proteins.
const DIRECTIONS: u32 = 7;

/// With how many nearest nodes each new one is tried. As many as of robots, 2e ln n, would be more edges than a chain's motions are
/// cheap enough for.
const NEIGHBORS: u32 = 5;

/// Makes the problem of a protein's folding to its only structure: a graph that grows from the native conformation out to
/// unstructured ones, until the [order of formation](crate::folding) varies no more. `name` and `folder` as for
/// [`transition`](super::transition()).
///
/// # Errors
/// What is wrong with the structure, one that breaks the rules, with the first pair of atoms that does, and one without helices
/// and strands.
pub fn folding(name: &str, folder: &Path, spec: &ProteinSpec) -> Result<Problem, ProblemError> {
    let builder = Problem::builder(fitting(name), spec.clone()).folder(folder);
    let protein = protein_of(&builder)?;
    expect_valid(&protein, "source", &protein.linkage().source())?;
    builder
        .strategies(STEPS.map(grown))
        .sets_per_round(SETS_PER_ROUND)
        .evaluator(EvaluatorKind::FormationOrder(FormationOrder::default()))
        .build()
}

/// Sets that grow by one of the steps.
fn grown(step: f64) -> StrategySpec {
    let growth = Mrrg {
        step: Some(step),
        directions: DIRECTIONS,
        neighbors: NeighborCount::Fixed(NEIGHBORS),
        ..Mrrg::default()
    };
    let among = AmongKind::Neighbors(Neighbors::default());
    StrategySpec::generated(format!("grow-{step}"), GeneratorKind::Mrrg(growth))
        .nodes(NODES)
        .among(among)
}
