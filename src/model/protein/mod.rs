//! Proteins: a chain whose backbone torsions turn, in an energy made of the contacts of known structures.
//!
//! A configuration is the phi and psi of every residue that has them, in radians. The description is [`Protein`];
//! `docs/proteins.md` says what the model is, where it comes from, and what a result means. Lengths are in Å, energies in
//! *model kJ/mol*: the constraints come from structures that are known, so that energies tell which conformations are
//! near them, and no rates follow from them.

mod all_atoms;
mod chain_in_energy;
mod describe;
mod resolve;
mod sound;
mod spec;
mod write;

pub mod atoms;
#[cfg(test)]
mod chains;
mod elastic;
pub mod energy;
pub mod equations;
pub mod kinematics;
pub mod linkage;
pub mod motion;
pub mod placed;
pub mod refit;
pub mod validity;

pub use spec::{ChainSpec, FileSpec, Gaps, ObstacleSpec, ProteinSpec};

use super::relaxation::relaxed_energy;
use super::{
    CannotRelax, Description, Documents, Model, ModelKind, Molecule, NodeValue, Relaxation,
    RelaxedModel, Resolve,
};
use crate::source::{ProblemError, Source};
use crate::space::{Dof, Factor, FactorKind, Space};
use crate::structure::Residue;
use bincode::{Decode, Encode};
use chain_in_energy::ChainInEnergy;
use energy::EnergySpec;
use linkage::{Linkage, TorsionKind};
use motion::EnergySteps;
use validity::Rules;

pub(crate) use super::cost::KT;

pub(super) const ENERGY: &[NodeValue] = &[NodeValue { name: "energy", unit: "kJ/mol" }];

/// A chain that moves, with what makes its energy: plain data.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Protein {
    /// The residues whose bonds, angles and omegas the linkage has, in their order along the chain.
    pub(crate) source: Vec<Residue>,
    /// The other end of a transition, if the problem is one.
    pub(crate) target: Option<Target>,
    /// What is made of gaps.
    pub(crate) gaps: Gaps,
    /// Chains that stand still.
    pub(crate) obstacles: Vec<Vec<Residue>>,
    /// Which conformations are invalid.
    pub(crate) rules: Rules,
    /// Which terms the energy has.
    pub(crate) energy: EnergySpec,
    /// The highest energy that is valid, model kJ/mol; `None`: any.
    pub(crate) highest: Option<f64>,
    /// How far apart the configurations of a motion are at which its energy is computed.
    pub(crate) step: EnergySteps,
}

/// A second structure of the chain.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Target {
    /// Its residues.
    pub(crate) residues: Vec<Residue>,
    /// Which residue of the source is which of the target, both counted from 0, ascending.
    pub(crate) matches: Vec<[u32; 2]>,
}

impl Protein {
    /// The residues of the source, in their order along the chain.
    pub fn source(&self) -> &[Residue] {
        &self.source
    }

    /// The residues of the other end, if there is one.
    pub fn target(&self) -> Option<&[Residue]> {
        self.target.as_ref().map(|target| &target.residues[..])
    }

    /// Which residue of the source is which of the target, both counted from 0; none without a target.
    pub fn matches(&self) -> &[[u32; 2]] {
        self.target.as_ref().map_or(&[], |target| &target.matches[..])
    }

    /// Whether chains stand around it that do not move.
    pub fn has_obstacles(&self) -> bool {
        !self.obstacles.is_empty()
    }

    /// Which conformations are invalid.
    pub fn rules(&self) -> &Rules {
        &self.rules
    }

    /// Why a configuration is not valid, for people to read: the first pair of atoms that breaks a rule, or its energy, above
    /// the highest that is valid; `None` if it is valid.
    pub fn broken_rule(&self, q: &[f64]) -> Option<String> {
        ChainInEnergy::of(self).broken_rule(q)
    }

    /// The linkage.
    pub(crate) fn linkage(&self) -> Linkage {
        Linkage::of(&self.source).expect("a sound description has a linkage")
    }
}

impl Resolve for Protein {
    type Spec = ProteinSpec;

    const TABLES: &'static [&'static str] = &["protein"];

    fn spec(source: &Source) -> Result<ProteinSpec, ProblemError> {
        spec::read(source)
    }

    fn resolve(
        spec: &ProteinSpec,
        source: &Source,
        notes: &mut Vec<String>,
    ) -> Result<Protein, ProblemError> {
        resolve::resolve(spec, source, notes)
    }

    fn to_spec(&self) -> ProteinSpec {
        let Protein { source, target, gaps, obstacles, rules, energy, highest, step } =
            self.clone();
        ProteinSpec {
            source: ChainSpec::Residues(source),
            target: target.map(|target| ChainSpec::Residues(target.residues)),
            gaps,
            obstacles: ObstacleSpec::Residues(obstacles),
            rules,
            energy,
            highest,
            step: match step {
                EnergySteps::Length(length) => Some(length),
                EnergySteps::Turn(_) => None,
            },
            turn: match step {
                EnergySteps::Length(_) => None,
                EnergySteps::Turn(turn) => Some(turn),
            },
        }
    }
}

impl Description for Protein {
    fn space(&self) -> Space {
        let torsions = self.linkage().torsions;
        let factor = |at| Factor { kind: FactorKind::Angle, at, weight: 1.0 };
        let dofs = torsions.iter().map(|torsion| {
            let name = match torsion.kind {
                TorsionKind::Phi => "phi",
                TorsionKind::Psi => "psi",
            };
            let number = self.source[torsion.residue].number;
            Dof { name: format!("{name}_{number}"), unit: "rad" }
        });
        Space::new((0..torsions.len()).map(factor).collect(), dofs.collect(), 0)
    }

    fn node_values(&self) -> &'static [NodeValue] {
        ENERGY
    }

    fn cost_unit(&self) -> &'static str {
        "kT"
    }

    fn has_directed_costs(&self) -> bool {
        true
    }

    fn sound(&self) -> Result<(), String> {
        self.complaint().map_or(Ok(()), |(key, message)| Err(format!("protein.{key}: {message}")))
    }

    fn prepare(&self) -> Box<dyn Model> {
        Box::new(ChainInEnergy::of(self))
    }

    fn difference(&self, other: &ModelKind) -> Option<&'static str> {
        // Without `..`: whoever adds a field has to compare it here.
        let Protein { source, target, gaps, obstacles, rules, energy, highest, step } = self;
        let ModelKind::Protein(other) = other else { return Some("the kind of model") };
        let parts = [
            ("the source structure", *source == other.source && *gaps == other.gaps),
            ("the target structure", *target == other.target),
            ("the obstacles", *obstacles == other.obstacles),
            ("the rules", *rules == other.rules),
            ("the energy", *energy == other.energy),
            ("the highest valid energy", *highest == other.highest),
            ("the step of motions", *step == other.step),
        ];
        parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
    }

    fn describe(&self, out: &mut String) {
        describe::describe(self, out).expect("writing to memory cannot fail");
    }

    fn describe_end(&self, name: &str, q: &[f64], out: &mut String) {
        describe::describe_end(self, name, q, out).expect("writing to memory cannot fail");
    }

    fn write(&self, documents: &mut Documents) {
        write::write(self, documents);
    }

    fn molecule(&self) -> Option<&dyn Molecule> {
        Some(self)
    }

    fn relaxed(&self, relaxation: &Relaxation, level: f64) -> Result<RelaxedModel, CannotRelax> {
        let highest = relaxed_energy(relaxation, self.highest, level, "a protein")?;
        let made = Protein { highest: Some(highest), ..self.clone() };
        Ok(RelaxedModel::new(ModelKind::Protein(made)))
    }
}

#[cfg(test)]
mod tests;
