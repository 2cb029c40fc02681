//! The model: a chain made ready for work.

use super::atoms::ResidueAtoms;
use super::elastic::{Network, Prepared, Springs};
use super::energy::{
    Constraint, ConstraintKind, Constraints, Hydrophobic, Mixture, carried_over, constraints_of,
};
use super::equations::Sites;
use super::kinematics::Conformer;
use super::linkage::Linkage;
use super::motion::{
    EnergySteps, Limits as MotionLimits, MotionScratch, MotionValidity, Profile, profile,
};
use super::placed::{Placed, Site};
use super::validity::{Atom, Counts, Limits, Obstacles, Screen, Violation};
use super::{ENERGY, KT, Protein};
use crate::model::{
    Cost, Directed, Elastic, Model, ModelScratch, NodeValue, Reason, Scratch, Validity,
};
use crate::space::Space;
use crate::structure::Point;
use crate::structure::measure::{Element, elements};

/// A protein whose torsions turn, in its energy.
pub(super) struct ChainInEnergy {
    space: Space,
    native: Vec<f64>,
    /// Helices and strands of the source structure.
    elements: Vec<Element>,
    /// The names of the residues, as in the source's file.
    residues: Vec<String>,
    conformer: Conformer,
    /// A conformation still to be placed, with what the chain lacks.
    empty: Placed,
    limits: Limits,
    obstacles: Obstacles,
    motions: MotionValidity,
    energy: Mixture,
    highest: Option<f64>,
    step: EnergySteps,
    network: Network,
}

/// A conformation, and what motions are looked at with.
#[derive(Default)]
pub(super) struct ProteinScratch {
    placed: Option<Placed>,
    screen: Screen,
    motion: MotionScratch,
    between: Vec<f64>,
}

impl ModelScratch for ProteinScratch {
    fn poison(&mut self, rubbish: u64) {
        if let Some(placed) = &mut self.placed {
            placed.poison();
        }
        self.between.push(f64::from_bits(rubbish));
        self.screen.poison();
        self.motion.poison(rubbish);
    }
}

impl ChainInEnergy {
    /// Of a sound description.
    pub fn of(protein: &Protein) -> ChainInEnergy {
        let linkage = protein.linkage();
        let conformer = Conformer::of(&protein.source, &linkage)
            .expect("a sound description has all backbone atoms");
        let network = network_of(protein, &linkage, &conformer);
        let atoms = protein.obstacles.iter().flatten().flat_map(|residue| &residue.atoms);
        let heavy = atoms.filter(|atom| atom.is_heavy());
        let obstacles = Obstacles::new(heavy.map(|atom| atom.position).collect());
        let limits = protein.rules.at_nodes();
        let along = MotionLimits::of(&protein.rules, &protein.source, &linkage.gaps);
        let motions = MotionValidity::new(&linkage, &protein.source, obstacles.points(), along)
            .expect("a sound description has all Cα");
        ChainInEnergy {
            space: crate::model::Description::space(protein),
            native: linkage.source(),
            elements: elements(&protein.source),
            residues: protein.source.iter().map(ToString::to_string).collect(),
            energy: energy_of(protein, &conformer),
            empty: conformer.placed(),
            conformer,
            limits,
            obstacles,
            motions,
            highest: protein.highest,
            step: protein.step,
            network,
        }
    }

    /// Places the chain at `q` in the scratch.
    fn placed<'a>(&self, q: &[f64], scratch: &'a mut Option<Placed>) -> &'a Placed {
        // That of another chain may have been left, which lacks other atoms.
        let fits = |placed: &Placed| placed.lacks_what(&self.empty);
        if !scratch.as_ref().is_some_and(fits) {
            *scratch = None;
        }
        let placed = scratch.get_or_insert_with(|| self.empty.clone());
        self.conformer.place(q, placed);
        placed
    }

    /// The energies of both basins, or of the only one, without hydrophobic pairs, at `q`.
    pub fn basins(&self, q: &[f64]) -> Vec<f64> {
        self.energy.basins(self.placed(q, &mut None))
    }

    /// The energy of hydrophobic pairs at `q`.
    pub fn hydrophobic(&self, q: &[f64]) -> f64 {
        self.energy.hydrophobic(self.placed(q, &mut None))
    }

    /// The whole energy at `q`.
    pub fn energy_at(&self, q: &[f64]) -> f64 {
        self.energy.energy(self.placed(q, &mut None))
    }

    /// The positions of all Cα at `q`, Å.
    pub fn alphas(&self, q: &[f64]) -> Vec<Point> {
        alphas_of(self.placed(q, &mut None))
    }

    /// How many pairs violate each rule at `q`.
    pub fn counts(&self, q: &[f64]) -> Counts {
        let screen = &mut Screen::default();
        self.limits.count(self.placed(q, &mut None), &self.obstacles, screen)
    }

    /// The first violation at `q`.
    pub fn first_violation(&self, q: &[f64]) -> Option<Violation> {
        let screen = &mut Screen::default();
        self.limits.first_violation(self.placed(q, &mut None), &self.obstacles, screen)
    }

    /// Why `q` is not valid, for people to read: the first pair of atoms that breaks a rule, or its energy, above the highest
    /// that is valid; `None` if it is valid.
    pub fn broken_rule(&self, q: &[f64]) -> Option<String> {
        if let Some(violation) = self.first_violation(q) {
            return Some(self.text_of(&violation));
        }
        let (highest, energy) = (self.highest?, self.energy_at(q));
        (energy > highest).then(|| {
            format!(
                "an energy of {energy:.1} model kJ/mol, where {highest} is the highest that is valid"
            )
        })
    }

    /// "Backbone: VAL 35 N and GLY 40 O, 2.312 Å apart".
    pub fn text_of(&self, violation: &Violation) -> String {
        let Violation { rule, first, second, distance } = violation;
        let (residue, other) = (&self.residues[first.0], self.residues.get(second.0));
        let atom = |atom: &Atom| format!("{atom:?}");
        let second = match (second.1, other) {
            (Atom::Obstacle, _) | (_, None) => format!("obstacle atom {}", second.0),
            (at, Some(other)) => format!("{other} {}", atom(&at)),
        };
        format!("{rule:?}: {residue} {} and {second}, {distance:.3} Å apart", atom(&first.1))
    }

    fn is_allowed(&self, energy: f64) -> bool {
        self.highest.is_none_or(|highest| energy <= highest)
    }
}

/// The elastic network of the constraints of all ends.
fn network_of(protein: &Protein, linkage: &Linkage, conformer: &Conformer) -> Network {
    let sites = Sites::of(conformer.atoms(), linkage);
    let basins = basins_of(protein);
    let constraints: Vec<Constraint> = basins.iter().flat_map(Constraints::list).copied().collect();
    let springs = Springs::new(&constraints, protein.rules.at_nodes(), &sites);
    Network::new(linkage.clone(), sites, springs, conformer.clone())
}

fn alphas_of(placed: &Placed) -> Vec<Point> {
    (0..placed.len()).map(|residue| placed.at(Site::CA, residue)).collect()
}

/// The constraints of the source, and those of the target between residues that the source has, too.
pub(super) fn basins_of(protein: &Protein) -> Vec<Constraints> {
    if !protein.energy.constraints {
        return vec![Constraints::default()];
    }
    let mut basins = vec![Constraints::new(constraints_of(&protein.source))];
    if let Some(target) = &protein.target {
        let there = constraints_of(&target.residues);
        let mut here = carried_over(&there, &target.matches);
        // What the source lacks can hold no bond: the hydrogen of a proline, the side chain of a glycine.
        let atoms = ResidueAtoms::of(&protein.source).unwrap_or_default();
        here.retain(|constraint| match constraint.kind {
            ConstraintKind::HydrogenBond => atoms[constraint.first].hydrogen.is_some(),
            ConstraintKind::Disulphide => {
                [constraint.first, constraint.second].iter().all(|at| atoms[*at].centroid.is_some())
            }
        });
        basins.push(Constraints::new(here));
    }
    basins
}

fn energy_of(protein: &Protein, conformer: &Conformer) -> Mixture {
    let hydrophobic = protein.energy.hydrophobic.then(|| Hydrophobic::of(conformer.atoms()));
    let mut basins = basins_of(protein).into_iter();
    match (basins.next(), basins.next()) {
        (Some(a), Some(b)) => Mixture::of_two(a, b, protein.energy.ends, hydrophobic),
        (one, _) => Mixture::single(one.unwrap_or_default(), hydrophobic),
    }
}

impl Model for ChainInEnergy {
    fn space(&self) -> &Space {
        &self.space
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        let scratch: &mut ProteinScratch = scratch.for_configuration();
        if !self.space.within_bounds(q) {
            return Validity::OutOfBounds;
        }
        let placed = self.placed(q, &mut scratch.placed);
        let is_valid = self.limits.is_valid(placed, &self.obstacles, &mut scratch.screen)
            && (self.highest.is_none() || self.is_allowed(self.energy.energy(placed)));
        if is_valid { Validity::Valid } else { Validity::Invalid }
    }

    /// The costs are the climbs in units of kT: −ln of the probability of every step (Amato and Song 2002).
    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let ProteinScratch { placed, motion, between, .. } = scratch.for_motion();
        if !(self.space.within_bounds(a) && self.space.within_bounds(b)) {
            return None;
        }
        if !self.motions.is_valid(a, b, motion) {
            return None;
        }
        let step = self.step.finer(refinement);
        let energy = |q: &[f64]| self.energy.energy(self.placed(q, placed));
        let Profile { forward, backward, peak } = profile((a, b), step, KT, between, energy)?;
        let cost = Directed { forward, backward, peak };
        self.is_allowed(peak).then_some(Cost::Directed(cost))
    }

    fn energy(&self, q: &[f64], scratch: &mut Scratch) -> Option<f64> {
        let scratch: &mut ProteinScratch = scratch.of_model();
        Some(self.energy.energy(self.placed(q, &mut scratch.placed)))
    }

    fn shape(&self, q: &[f64], scratch: &mut Scratch) -> Option<Vec<Point>> {
        let scratch: &mut ProteinScratch = scratch.of_model();
        Some(alphas_of(self.placed(q, &mut scratch.placed)))
    }

    fn elastic<'a>(&'a self, q: &[f64]) -> Option<Box<dyn Elastic + 'a>> {
        Some(Box::new(Prepared::of(self.network.about(q))))
    }

    fn native(&self) -> Option<&[f64]> {
        Some(&self.native)
    }

    fn elements(&self) -> &[Element] {
        &self.elements
    }

    fn reasons(&self, q: &[f64], _depths: bool) -> Vec<Reason> {
        self.broken_rule(q).map(|text| Reason::Other { text }).into_iter().collect()
    }

    fn is_obstructed(&self) -> bool {
        true
    }

    fn node_values(&self) -> &'static [NodeValue] {
        ENERGY
    }

    fn values(&self, q: &[f64], out: &mut Vec<f64>, scratch: &mut Scratch) {
        out.extend(self.energy(q, scratch));
    }
}
