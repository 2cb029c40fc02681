//! Docking: a flexible ligand at a protein that stands still, in the energy of its atoms.
//!
//! A configuration is the position of the ligand's centre, its orientation as a quaternion, and one angle per torsion link (O. B.
//! Bayazit, *Solving Motion Planning Problems by Iterative Relaxation of Constraints*, PhD thesis, Texas A&M University, 2003,
//! chapter V, eq. 5.1; H.-Y. Yeh, PhD thesis, Texas A&M University, 2016, chapter 6). The description is [`Docking`];
//! `docs/docking.md` says what the model is and what a result means. Lengths are in Å, energies in kJ/mol, angles in radians,
//! positions in the frame of the protein's file.

mod describe;
mod exposed;
mod grid;
mod kinematics;
mod ligand_in_energy;
mod low_cells;
mod motion;
mod near;
mod placed;
mod receptor;
mod resolve;
mod sound;
mod spec;
#[cfg(test)]
mod tests;
mod write;

pub mod energy;

pub use grid::{EnergyLookup, GridSpec};
pub use spec::{
    DockingSpec, LigandFile, LigandSpec, Policy, ReceptorFile, ReceptorSpec, RegionSpec, StillChain,
};

use super::relaxation::relaxed_energy;
use super::{
    CannotRelax, Description, Documents, Energies, Model, ModelKind, Molecule, NodeValue,
    Relaxation, RelaxedModel, Resolve,
};
use crate::ligand::{Ligand, LinkRule};
use crate::source::{ProblemError, Source};
use crate::space::{BaseJoint, Dof, Factor, FactorKind, Space, rigid_factors};
use crate::structure::{Atom, Residue, ResidueNumber};
use bincode::{Decode, Encode};
use energy::{EnergySpec, Own};
use kinematics::{BASE, Linkage};
use ligand_in_energy::LigandInEnergy;

/// The step of motions unless the file says otherwise, Å.
const STEP: f64 = 0.5;

/// Why a description can be prepared.
const SOUND: &str = "a sound description has a grid";

const ENERGY: &[NodeValue] = &[NodeValue { name: "energy", unit: "kJ/mol" }];

/// A ligand at a protein: plain data.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Docking {
    /// The protein's chains.
    pub(crate) chains: Vec<StillChain>,
    /// The ligand, in the pose that it was given with.
    pub(crate) ligand: Ligand,
    /// Whether the ligand has no torsion links.
    pub(crate) rigid: bool,
    /// Whether bonds of amides are torsion links.
    pub(crate) amides: bool,
    /// Least and largest position of the ligand's centre.
    pub(crate) bounds: [[f64; 3]; 2],
    /// Which terms the energy has.
    pub(crate) energy: EnergySpec,
    /// How the energy is looked up.
    pub(crate) grid: GridSpec,
    /// The highest energy that is valid, kJ/mol.
    pub(crate) highest: f64,
    /// How far an atom moves at most between two energies along a motion, Å.
    pub(crate) step: f64,
}

impl Docking {
    /// The protein's chains.
    pub fn chains(&self) -> &[StillChain] {
        &self.chains
    }

    /// The ligand, in the pose that it was given with.
    pub fn ligand(&self) -> &Ligand {
        &self.ligand
    }

    /// Least and largest position of the ligand's centre, Å.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
    }

    /// Which terms the energy has.
    pub fn energy(&self) -> &EnergySpec {
        &self.energy
    }

    /// The highest energy that is valid, kJ/mol.
    pub fn highest(&self) -> f64 {
        self.highest
    }

    /// How many degrees of freedom the ligand has: 6, and one for each torsion link.
    pub fn degrees_of_freedom(&self) -> usize {
        6 + self.linkage().links()
    }

    /// The configuration of the pose that the ligand was given with, be it within the bounds or not.
    pub fn given(&self) -> Vec<f64> {
        self.linkage().given()
    }

    /// The model by exact sums, whatever the grid is that the description asks for.
    pub(crate) fn exactly(&self) -> Box<dyn Model> {
        let grid = GridSpec { lookup: EnergyLookup::Exact, ..self.grid };
        Box::new(LigandInEnergy::of(&Docking { grid, ..self.clone() }).expect(SOUND))
    }

    fn linkage(&self) -> Linkage {
        Linkage::of(&self.ligand, LinkRule { amides: self.amides }, self.rigid)
            .expect("a sound ligand has positions")
    }

    /// The ligand at a configuration, as a residue of a structure.
    fn ligand_residue(&self, positions: &[crate::structure::Point]) -> Residue {
        let names = crate::ligand::atom_names(&self.ligand);
        let atoms = self.ligand.atoms().iter().zip(names).zip(positions);
        let atom = |((atom, name), position): ((&crate::ligand::Atom, String), &_)| Atom {
            name,
            element: atom.element.symbol().to_owned(),
            position: *position,
        };
        Residue {
            number: ResidueNumber { number: 1, insertion: None },
            name: crate::ligand::residue_name(&self.ligand).to_owned(),
            amino_acid: None,
            atoms: atoms.map(atom).collect(),
        }
    }
}

impl Resolve for Docking {
    type Spec = DockingSpec;

    const TABLES: &'static [&'static str] = &["docking"];

    fn spec(source: &Source) -> Result<DockingSpec, ProblemError> {
        spec::read(source)
    }

    fn resolve(
        spec: &DockingSpec,
        source: &Source,
        notes: &mut Vec<String>,
    ) -> Result<Docking, ProblemError> {
        resolve::resolve(spec, source, notes)
    }

    fn to_spec(&self) -> DockingSpec {
        resolve::to_spec(self)
    }
}

impl Description for Docking {
    fn space(&self) -> Space {
        space_of(&self.linkage(), self.bounds)
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
        self.complaint().map_or(Ok(()), |(key, message)| Err(format!("docking.{key}: {message}")))
    }

    fn prepare(&self) -> Box<dyn Model> {
        Box::new(LigandInEnergy::of(self).expect(SOUND))
    }

    fn difference(&self, other: &ModelKind) -> Option<&'static str> {
        // Without `..`: whoever adds a field has to compare it here.
        let Docking { chains, ligand, rigid, amides, bounds, energy, grid, highest, step } = self;
        let ModelKind::Docking(other) = other else { return Some("the kind of model") };
        let parts = [
            ("the protein", *chains == other.chains),
            ("the ligand", *ligand == other.ligand),
            ("which bonds are torsion links", (*rigid, *amides) == (other.rigid, other.amides)),
            ("the box of the ligand", *bounds == other.bounds),
            ("the energy", *energy == other.energy),
            ("the grid", *grid == other.grid),
            ("the highest valid energy", *highest == other.highest),
            ("the step of motions", *step == other.step),
        ];
        parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
    }

    fn describe(&self, out: &mut String) {
        describe::describe(self, out).expect("writing to memory cannot fail");
    }

    fn write(&self, documents: &mut Documents) {
        write::write(self, documents);
    }

    fn molecule(&self) -> Option<&dyn Molecule> {
        Some(self)
    }

    fn relaxed(&self, relaxation: &Relaxation, level: f64) -> Result<RelaxedModel, CannotRelax> {
        let highest = relaxed_energy(relaxation, Some(self.highest), level, "docking")?;
        let made = Docking { highest, ..self.clone() };
        Ok(RelaxedModel::new(ModelKind::Docking(made)))
    }
}

/// The configuration space of a ligand whose centre is within `bounds`.
fn space_of(linkage: &Linkage, [min, max]: [[f64; 3]; 2]) -> Space {
    let (mut factors, mut dofs) =
        rigid_factors(BaseJoint::Rigid3d, min, max, linkage.rotation_length());
    for (number, weight) in linkage.torsion_weights().enumerate() {
        factors.push(Factor { kind: FactorKind::Angle, at: BASE + number, weight });
        dofs.push(Dof { name: format!("torsion_{}", number + 1), unit: "rad" });
    }
    Space::new(factors, dofs, 3)
}

impl Molecule for Docking {
    fn chains_at(&self, q: &[f64]) -> Vec<Vec<Residue>> {
        let mut positions = Vec::new();
        self.linkage().place(q, &mut Vec::new(), &mut positions);
        let moving = vec![self.ligand_residue(&positions)];
        std::iter::once(moving)
            .chain(self.chains.iter().map(|chain| chain.residues.clone()))
            .collect()
    }

    fn has_chains_that_stand_still(&self) -> bool {
        true
    }

    fn energies(&self) -> Energies<'_> {
        let model = LigandInEnergy::of(self).expect(SOUND);
        let mut columns = vec!["van_der_waals [kJ/mol]"];
        let EnergySpec { dielectric, hydrophobic, own, .. } = self.energy;
        let (coulomb, own) = (dielectric.is_some(), own != Own::None);
        columns.extend(coulomb.then_some("coulomb [kJ/mol]"));
        columns.extend(hydrophobic.then_some("hydrophobic [kJ/mol]"));
        columns.extend(own.then_some("own [kJ/mol]"));
        columns.push("energy [kJ/mol]");
        let at = move |q: &[f64]| {
            let parts = model.exact_at(q);
            let mut numbers = vec![parts.van_der_waals];
            numbers.extend(coulomb.then_some(parts.coulomb));
            numbers.extend(hydrophobic.then_some(parts.hydrophobic));
            numbers.extend(own.then_some(parts.own));
            numbers.push(parts.sum());
            numbers
        };
        Energies { columns, at: Box::new(at) }
    }

    fn about_energies(&self) -> &'static str {
        "The energy is the sum of 12-6 terms between the atoms of a protein that does not move and those of the ligand, with what other \
         terms the problem asks for: no water, no entropy, no charges unless it says so. It tells poses that fit from poses that do \
         not; it is no free energy of binding."
    }
}
