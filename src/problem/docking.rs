//! The problems of a ligand's poses at a protein, and of its affinity to one.

use super::{Problem, ProblemBuilder, ProblemError, StrategySpec};
use crate::binding::Exact;
use crate::connect::{AmongKind, Nearest, NearestNodes, NodesAndComponents, WithinKind};
use crate::evaluate::{EvaluatorKind, ExposedSurface};
use crate::generator::{GeneratorKind, Hopping, Minima};
use crate::ligand::Ligand;
use crate::model::docking::{Docking, DockingSpec};
use crate::model::{Description, ModelKind, Scratch};
use crate::sampler::{Given, LowEnergyCells, ProteinSurface, SamplerKind, Uniform, Uobprm};
use crate::source::fitting_name;
use std::path::Path;

/// At how many nodes the build of a search for poses ends. With 4000 in a box of 22.5 Å three of ten seeds missed the pose of biotin, and of
/// XK263; with 12 000 none missed biotin's (docs/docking-studies.md).
const NODES_MAX: u64 = 12_000;

/// Nodes of a set: half of them are drawn, half are the minima below these.
const NODES: u64 = 50;
/// Nodes of a set of uniform ones, which are there for the ways out alone.
const NODES_UNIFORM: u64 = 10;
/// Sets of a round: one cycle of the schedule, or about one.
const SETS_PER_ROUND: u64 = 10;
/// With how many nearest nodes a new one is tried (O. B. Bayazit 2003, chapter V E 2).
const NEIGHBORS: u32 = 10;
/// How many of these are tried though they are joined already, since of several ways out the one over the lowest barrier counts; and how many
/// pairs of two components.
const CYCLES: u32 = 3;

/// The sampler of H.-Y. Yeh's chapter 6: how long segments are, in the metric of the space, Å, and the step along them. The thesis has the length,
/// and of the step that it is the resolution at which collisions are looked for.
const SEGMENT: f64 = 10.0;
const STEP: f64 = 0.25;
/// The thesis has 5000 samples for two proteins and 7000 for a third.
const SAMPLES: u64 = 5_000;

/// How poses are searched for.
#[derive(Clone, Debug, Default)]
pub struct PoseSearch {
    /// The number of nodes at which the build ends; 12 000 if nothing is said.
    pub nodes: Option<u64>,
    /// Poses of the ligand that a user expects to be near one: placed as they are, in the shape that the problem's ligand has, and
    /// descended with all torsions (O. B. Bayazit 2003, chapter V D 3, takes them from a haptic device that moves a rigid ligand).
    pub hints: Vec<Ligand>,
    /// Whether the build ends before, once every exposed residue of the protein has a sample and samples lie closely.
    pub ends_when_covered: bool,
}

/// Makes the problem of a ligand's poses at a protein: minima below configurations in cells of low energy and at the protein's surface,
/// uniform ones, through which ways lead out, and hints.
///
/// The build ends at a number of nodes. That every exposed residue has a sample ([`ExposedSurface`]) is no end by itself: it says that
/// all of the surface was visited, and nothing of how low the minima are that were found there, which go on getting lower
/// long after.
///
/// Relative paths start in `folder`. Characters that a problem's name cannot have become `-`.
///
/// # Errors
/// What is wrong with the protein or the ligand; a hint that is another molecule, or lies outside of the box.
pub fn docking(
    name: &str,
    folder: &Path,
    spec: &DockingSpec,
    search: &PoseSearch,
) -> Result<Problem, ProblemError> {
    let builder = Problem::builder(fitting_name(name), spec.clone()).folder(folder);
    let strategies = minima(&["cells", "surface", "hops"], &WithinKind::default(), &among());
    let (mut notes, mut strategies) = (Vec::new(), strategies);
    let mut schedule: Vec<&str> = ["hops", "cells", "hops", "surface"].repeat(2);
    if !search.hints.is_empty() {
        let docking = docking_of(&builder)?;
        let poses = hinted(&docking, &search.hints, &mut notes)?;
        let nodes = NODES.min(2 * poses.len() as u64);
        let (given, within) = (SamplerKind::Given(Given::new(poses)), WithinKind::default());
        strategies.push(descended("hints", given, within).among(among()).nodes(nodes));
        schedule.push("hints");
    }
    let uniform = SamplerKind::Uniform(Uniform::default());
    strategies.push(StrategySpec::sampled("uniform", uniform).nodes(NODES_UNIFORM).among(among()));
    schedule.push("uniform");
    let builder = builder
        .strategies(strategies)
        .schedule(schedule)
        .sets_per_round(SETS_PER_ROUND)
        .most_nodes(search.nodes.unwrap_or(NODES_MAX));
    let builder = match search.ends_when_covered {
        true => builder.evaluator(EvaluatorKind::ExposedSurface(ExposedSurface::default())),
        false => builder.evaluators([]),
    };
    let mut problem = builder.build()?;
    problem.notes.extend(notes);
    Ok(problem)
}

/// How samples are made from which a ligand's affinity is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AffinitySearch {
    /// The number of nodes at which the build ends at the latest; 5000 if nothing is said.
    pub nodes: Option<u64>,
    /// Whether samples are the minima below configurations at the surface and in cells of low energy, and these, instead of
    /// configurations spread evenly over the surface.
    pub minima: bool,
    /// The length of a segment of `uobprm`, in the metric of the space, Å.
    pub length: f64,
    /// The step along it.
    pub step: f64,
    /// Up to which mean distance to the nearest sample, in percent of the ligand's diameter, the build goes on before that number; `None`: it goes
    /// on to the number of nodes.
    pub percent: Option<f64>,
}

impl Default for AffinitySearch {
    fn default() -> AffinitySearch {
        let percent = Some(ExposedSurface::default().percent);
        AffinitySearch { nodes: None, minima: false, length: SEGMENT, step: STEP, percent }
    }
}

/// Makes the problem of samples from which a ligand's affinity to a protein is estimated (H.-Y. Yeh 2016, chapter 6): spread evenly over
/// the protein's surface, until every exposed residue has one and they lie closely. Edges are of no use there, so that few are tried.
///
/// `name` and `folder` as for [`docking`].
///
/// # Errors
/// What is wrong with the protein or the ligand.
pub fn affinity(
    name: &str,
    folder: &Path,
    spec: &DockingSpec,
    search: &AffinitySearch,
) -> Result<Problem, ProblemError> {
    let AffinitySearch { nodes, length, step, percent, .. } = *search;
    let few = WithinKind::Nearest(Nearest { neighbors: 1, ..Nearest::default() });
    let lone = AmongKind::NearestNodes(NearestNodes { neighbors: 1, ..NearestNodes::default() });
    let strategies = match search.minima {
        true => minima(&["cells", "surface"], &few, &lone),
        false => {
            let sampler = SamplerKind::Uobprm(Uobprm::new(length, step));
            vec![StrategySpec::sampled("surface", sampler).within(few).among(lone).nodes(NODES)]
        }
    };
    let covered = percent.map(|percent| {
        EvaluatorKind::ExposedSurface(ExposedSurface { percent, ..Default::default() })
    });
    Problem::builder(fitting_name(name), spec.clone())
        .folder(folder)
        .strategies(strategies)
        .sets_per_round(SETS_PER_ROUND)
        .evaluators(covered)
        .most_nodes(nodes.unwrap_or(SAMPLES))
        .build()
}

/// Strategies of minima, by their labels, with these connections: of `cells` and `surface` those below samples, of `hops` low ones.
fn minima(labels: &[&str], within: &WithinKind, among: &AmongKind) -> Vec<StrategySpec> {
    let cells = SamplerKind::LowEnergyCells(LowEnergyCells::default());
    let surface = SamplerKind::ProteinSurface(ProteinSurface::default());
    let strategy = |label: &&str| {
        let generated = match *label {
            "cells" => descended(label, cells.clone(), within.clone()),
            "hops" => {
                let hopping = Hopping { within: within.clone(), ..Hopping::default() };
                StrategySpec::generated(*label, GeneratorKind::Hopping(hopping))
            }
            _ => descended(label, surface.clone(), within.clone()),
        };
        generated.among(among.clone()).nodes(NODES)
    };
    labels.iter().map(strategy).collect()
}

/// Sets of what a sampler draws, and of the minima below.
fn descended(label: &str, sampler: SamplerKind, within: WithinKind) -> StrategySpec {
    let minima = Minima { within, ..Minima::new(sampler) };
    StrategySpec::generated(label, GeneratorKind::Minima(minima))
}

/// The published connection with the ten nearest nodes, some of them whether joined already or not, since of several ways out the one over
/// the lowest barrier counts; and then what joins components, so that no pose is left without a way out.
fn among() -> AmongKind {
    let (neighbors, cycles, pairs) = (NEIGHBORS, CYCLES, CYCLES);
    let joins = NodesAndComponents { neighbors, cycles, pairs, ..Default::default() };
    AmongKind::NodesAndComponents(joins)
}

/// The configurations of hints. One that is not valid, as it touches the protein, is descended until it is, which is noted.
fn hinted(
    docking: &Docking,
    hints: &[Ligand],
    notes: &mut Vec<String>,
) -> Result<Vec<Vec<f64>>, ProblemError> {
    let (exact, space) = (Exact::of(docking, 0), docking.space());
    let scratch = &mut Scratch::new();
    let mut configurations = Vec::new();
    for (number, hint) in hints.iter().enumerate() {
        let number = number + 1;
        let refuse = |message: String| ProblemError::pathless(format!("hint {number}: {message}"));
        let positions = docking.positions_in(hint).map_err(refuse)?;
        let placed = docking.placed(&positions).filter(|q| space.within_bounds(q));
        let Some(q) = placed else {
            let message =
                "a pose outside of the box found; one with its centre in the box expected";
            return Err(refuse(message.to_owned()));
        };
        let energy = exact.energy(&q).sum();
        if energy <= docking.highest() {
            configurations.push(q);
            continue;
        }
        let (q, reached) = exact.improved(&q, scratch);
        if reached > docking.highest() || reached.is_nan() {
            let message = format!(
                "an energy of {energy:.3e} kJ/mol found, {reached:.3e} after a descent; a pose that does not lie in the protein expected"
            );
            return Err(refuse(message));
        }
        notes.push(format!(
            "hint {number}: its energy of {energy:.3e} kJ/mol is not valid; the minimum below it, of {reached:.1}, is taken"
        ));
        configurations.push(q);
    }
    Ok(configurations)
}

/// The model that a builder makes, whatever its strategies.
fn docking_of(builder: &ProblemBuilder) -> Result<Docking, ProblemError> {
    match builder.build()?.model {
        ModelKind::Docking(docking) => Ok(docking),
        _ => unreachable!("the problem was built of a spec of docking"),
    }
}
