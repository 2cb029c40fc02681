//! The problem of a protein's folding.

use super::transition::{expect_valid, protein_of};
use super::{Problem, ProblemError, StrategySpec};
use crate::connect::{AmongKind, Neighbors};
use crate::evaluate::{EvaluatorKind, FormationOrder};
use crate::folding::Native;
use crate::generator::{GeneratorKind, GraphNeighbors, Mrrg};
use crate::model::protein::ProteinSpec;
use crate::model::{Description, Model, Scratch};
use crate::seed::{Purpose, Seed};
use crate::source::fitting;
use std::path::Path;

/// Nodes of a set, and sets of a round: 250 samples between two evaluations (S. Nath 2013, §5.3.2), five sets of either step.
const NODES: u64 = 25;
const SETS_PER_ROUND: u64 = 10;

/// The longest step of extensions that is tried, radians in the metric of all torsions; it is halved until the native conformation can be
/// left by it.
const LONGEST_STEP: f64 = 1.0;

/// So often it is halved at most.
const HALVINGS: u32 = 8;

/// The native conformation can be left by a step if at least so many of so many random directions are valid.
const LEAVING: usize = 3;
const DIRECTIONS_TRIED: usize = 2000;

/// The long steps are so many times the short ones. Long ones lead from the native conformation to unstructured ones in a dozen
/// steps; short ones find ways through the narrow surroundings of the native conformation, where parts form one after the
/// other.
const LONG: f64 = 4.0;

/// In how many directions a node is extended: S. Nath 2013, §5.3.2.1, found 7 best for proteins.
const DIRECTIONS: u32 = 7;

/// With how many nearest nodes each new one is tried. As many as of robots, 2e ln n, would be more edges than a chain's motions are
/// cheap enough for.
const NEIGHBORS: u32 = 5;

/// The most extensions tried for one milestone: of a large protein that has grown into a corner hardly any is valid.
const ATTEMPTS: u64 = 1_000_000;

/// A pathway begins where at most one native contact in so many is there. Random conformations of a chain have one or the other by
/// chance, mostly within helices.
const CONTACTS_FOR_ONE: usize = 20;

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
    let model = protein.prepare();
    let native = Native::of(&*model, &mut Scratch::new());
    let Some(native) = native.filter(|native| !native.parts.is_empty()) else {
        let message = "protein.source: a structure without helices and strands that touch found; one whose order of formation can \
                       be followed expected";
        return Err(ProblemError::pathless(message.to_owned()));
    };
    let long = longest_step(&*model, &native.q);
    let unstructured = (native.contacts.len() / CONTACTS_FOR_ONE) as u32;
    let order = FormationOrder { unstructured, ..FormationOrder::default() };
    builder
        .strategies([long / LONG, long].map(grown))
        .sets_per_round(SETS_PER_ROUND)
        .evaluator(EvaluatorKind::FormationOrder(order))
        .build()
}

/// The longest step by which the native conformation can be left: a graph that cannot leave it is none.
fn longest_step(model: &dyn Model, native: &[f64]) -> f64 {
    let (space, scratch) = (model.space(), &mut Scratch::new());
    let mut step = LONGEST_STEP;
    for _ in 0..HALVINGS {
        // The same directions for every length.
        let mut stream = Seed::of_calibration(0, "fold").stream(Purpose::Sampling);
        let mut leaves = |_: &usize| {
            let [mut toward, mut q] = [vec![0.0; native.len()], vec![0.0; native.len()]];
            space.sample_uniform(&mut stream, &mut toward);
            let distance = space.distance(native, &toward);
            space.interpolate(native, &toward, (step / distance).min(1.0), &mut q);
            space.canonicalize(&mut q).is_ok()
                && model.is_valid(&q, scratch)
                && model.motion(native, &q, 1, scratch).is_some()
        };
        if (0..DIRECTIONS_TRIED).filter(|index| leaves(index)).take(LEAVING).count() == LEAVING {
            break;
        }
        step /= 2.0;
    }
    step
}

/// Sets that grow by one of the steps.
fn grown(step: f64) -> StrategySpec {
    let growth = Mrrg {
        step: Some(step),
        directions: DIRECTIONS,
        neighbors: GraphNeighbors::Fixed(NEIGHBORS),
        attempts: ATTEMPTS,
        ..Mrrg::default()
    };
    let among = AmongKind::Neighbors(Neighbors::default());
    StrategySpec::generated(format!("grow-{step}"), GeneratorKind::Mrrg(growth))
        .nodes(NODES)
        .among(among)
}
