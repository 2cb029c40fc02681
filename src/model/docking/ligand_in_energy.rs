//! The model: a ligand in the energy of a protein and its own.

use super::energy::{OwnTerms, PairSum, capped, ligand_particles, protein_particles};
use super::exposed::exposed;
use super::grid::Field;
use super::kinematics::{BASE, Linkage, Placement};
use super::low_cells::low_cells;
use super::motion::{Between, cost, steps};
use super::near::NearAtoms;
use super::{Docking, ENERGY, StillChain, space_of};
use crate::ligand::Ligand;
use crate::model::{
    CellLimits, Cost, EnergyParts, ExposedResidue, LigandAtProtein, LowCells, Model, ModelScratch,
    NodeValue, Reason, Scratch, Validity, out_of_range,
};
use crate::shelf::Shelf;
use crate::space::{BaseJoint, Space};
use crate::structure::{Point, Residue};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Atoms of the ligand act upon one another if more bonds than this are between them: what is nearer is held by bonds and angles.
const BONDS_APART: usize = 3;
/// Strategies ask for cells by turns, each by its own limits.
const CELLS_KEPT: usize = 4;

/// A ligand in the energy of a protein that stands still.
pub(super) struct LigandInEnergy {
    space: Space,
    linkage: Linkage,
    field: Field,
    own: OwnTerms,
    highest: f64,
    step: f64,
    ligand: Ligand,
    chains: Vec<StillChain>,
    protein: Vec<Point>,
    near: OnceLock<NearAtoms>,
    given: Option<Vec<f64>>,
    exposed: OnceLock<Vec<ExposedResidue>>,
    /// The cells that were asked for last, at most [`CELLS_KEPT`] times: a memory that saves time alone.
    cells: Mutex<Vec<(usize, CellLimits, Arc<LowCells>)>>,
}

/// Positions, and what becomes of them.
#[derive(Default)]
struct DockingScratch {
    pieces: Vec<Placement>,
    positions: Vec<Point>,
    by_atoms: Vec<Point>,
    sums: Vec<[Point; 2]>,
    between: Between,
}

impl ModelScratch for DockingScratch {
    fn poison(&mut self, rubbish: u64) {
        let number = rubbish as f64;
        let many = rubbish as usize % 50;
        self.pieces.clear();
        self.positions = vec![Point::new(number, -number, f64::NAN); many];
        self.by_atoms = vec![Point::new(f64::INFINITY, number, number); many];
        self.sums = vec![[Point::new(number, number, number); 2]; many % 7];
        self.between = Between { q: vec![number; many % 5], energies: vec![-number; many] };
    }
}

impl LigandInEnergy {
    /// Prepares the model of a description that is sound but for its grid.
    ///
    /// # Errors
    /// What is wrong with the grid: what was found and what is expected.
    pub fn of(docking: &Docking) -> Result<LigandInEnergy, String> {
        let Docking { chains, ligand, bounds, energy, grid, highest, step, .. } = docking;
        let linkage = docking.linkage();
        let space = space_of(&linkage, *bounds);
        let residues: Vec<Vec<Residue>> =
            chains.iter().map(|chain| chain.residues.clone()).collect();
        let particles = protein_particles(&residues).expect("a sound protein has known elements");
        let atoms = residues.iter().flatten().flat_map(|residue| &residue.atoms);
        let positions: Vec<Point> = atoms.map(|atom| atom.position).collect();
        // Where hydrogens were removed, their charges are at the heavy atoms already.
        let of_ligand = ligand_particles(ligand, false);
        let sum = PairSum::new(energy, &particles, &positions, &of_ligand);
        // The grid holds every atom of the ligand in its given shape, wherever its centre is; atoms beyond get their exact sums.
        let reach = Point::from([linkage.radius(); 3]);
        let corners = [Point::from(bounds[0]) - reach, Point::from(bounds[1]) + reach];
        let pairs = pairs_apart(ligand, &linkage);
        let given = Some(linkage.given()).filter(|given| space.within_bounds(given));
        Ok(LigandInEnergy {
            field: Field::new(sum, corners, *grid)?,
            own: OwnTerms::new(energy, &of_ligand, &pairs),
            space,
            linkage,
            highest: *highest,
            step: *step,
            ligand: ligand.clone(),
            chains: chains.clone(),
            protein: positions,
            near: OnceLock::new(),
            given,
            exposed: OnceLock::new(),
            cells: Mutex::new(Vec::new()),
        })
    }

    /// The energy at `q`, by exact sums, part by part.
    pub fn exact_at(&self, q: &[f64]) -> EnergyParts {
        let positions = self.positions(q);
        let parts = self.field.sum().parts(&positions);
        EnergyParts {
            van_der_waals: parts.van_der_waals,
            coulomb: parts.coulomb,
            hydrophobic: parts.hydrophobic,
            own: self.own.energy(&positions),
        }
    }

    fn energy_at(&self, q: &[f64], pieces: &mut Vec<Placement>, positions: &mut Vec<Point>) -> f64 {
        self.linkage.place(q, pieces, positions);
        self.field.energy(positions) + self.own.energy(positions)
    }
}

/// The pairs of the ligand's atoms that act upon one another: of different rigid pieces, and more than [`BONDS_APART`] bonds apart.
fn pairs_apart(ligand: &Ligand, linkage: &Linkage) -> Vec<[usize; 2]> {
    let count = ligand.atoms().len();
    let mut neighbours = vec![Vec::new(); count];
    for bond in ligand.bonds() {
        let [a, b] = bond.atoms;
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    let mut piece_of = vec![0; count];
    for (piece, atoms) in linkage.pieces().iter().enumerate() {
        atoms.iter().for_each(|atom| piece_of[*atom] = piece);
    }
    let mut pairs = Vec::new();
    for first in 0..count {
        let mut is_near = vec![false; count];
        is_near[first] = true;
        let mut shell = vec![first];
        for _ in 0..BONDS_APART {
            let mut next = Vec::new();
            for other in shell.iter().flat_map(|atom| &neighbours[*atom]) {
                if !std::mem::replace(&mut is_near[*other], true) {
                    next.push(*other);
                }
            }
            shell = next;
        }
        let far = (first + 1..count)
            .filter(|second| !is_near[*second] && piece_of[first] != piece_of[*second]);
        pairs.extend(far.map(|second| [first, second]));
    }
    pairs
}

impl Model for LigandInEnergy {
    fn space(&self) -> &Space {
        &self.space
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        let DockingScratch { pieces, positions, .. } = scratch.for_configuration();
        if !self.space.within_bounds(q) {
            return Validity::OutOfBounds;
        }
        match self.energy_at(q, pieces, positions) <= self.highest {
            true => Validity::Valid,
            false => Validity::Invalid,
        }
    }

    /// The costs are the climbs in units of kT.
    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let DockingScratch { pieces, positions, between, .. } = scratch.for_motion();
        if !(self.space.within_bounds(a) && self.space.within_bounds(b)) {
            return None;
        }
        let steps = LigandAtProtein::steps(self, a, b, self.step / f64::from(refinement));
        let energy = |q: &[f64]| self.energy_at(q, pieces, positions);
        let cost = cost(&self.space, (a, b), steps, self.highest, between, energy)?;
        Some(Cost::Directed(cost))
    }

    fn energy(&self, q: &[f64], scratch: &mut Scratch) -> Option<f64> {
        let DockingScratch { pieces, positions, .. } = scratch.of_model();
        Some(self.energy_at(q, pieces, positions))
    }

    fn gradient(&self, q: &[f64], out: &mut [f64], scratch: &mut Scratch) -> Option<f64> {
        let DockingScratch { pieces, positions, by_atoms, sums, .. } = scratch.of_model();
        self.linkage.place(q, pieces, positions);
        by_atoms.clear();
        by_atoms.resize(positions.len(), Point::zeros());
        let of_field = self.field.gradient(positions, by_atoms);
        let of_own = self.own.gradient(positions, by_atoms);
        self.linkage.gradient(pieces, positions, by_atoms, sums, out);
        Some(of_field + of_own)
    }

    fn has_gradient(&self) -> bool {
        true
    }

    fn ligand(&self) -> Option<&dyn LigandAtProtein> {
        Some(self)
    }

    fn keep_on(&self, shelf: &Arc<dyn Shelf>) {
        self.field.keep_on(shelf.clone());
    }

    fn native(&self) -> Option<&[f64]> {
        self.given.as_deref()
    }

    fn reasons(&self, q: &[f64], _depths: bool) -> Vec<Reason> {
        let mut reasons = out_of_range(&self.space, q);
        let energy = self.energy_at(q, &mut Vec::new(), &mut Vec::new());
        // An energy that is no number is not valid either.
        if energy > self.highest || energy.is_nan() {
            let highest = self.highest;
            let text = format!("the energy is {energy} kJ/mol, at most {highest} expected");
            reasons.push(Reason::Other { text });
        }
        reasons
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

impl LigandAtProtein for LigandInEnergy {
    fn ligand(&self) -> &Ligand {
        &self.ligand
    }

    fn pieces(&self) -> &[Vec<usize>] {
        self.linkage.pieces()
    }

    fn torsion_of(&self, piece: usize) -> usize {
        BASE + piece - 1
    }

    fn parent_of(&self, piece: usize) -> usize {
        self.linkage.parent(piece)
    }

    fn central_atom(&self) -> usize {
        self.linkage.central_atom()
    }

    fn positions(&self, q: &[f64]) -> Vec<Point> {
        let mut positions = Vec::new();
        self.linkage.place(q, &mut Vec::new(), &mut positions);
        positions
    }

    fn steps(&self, a: &[f64], b: &[f64], length: f64) -> usize {
        let turn = BaseJoint::Rigid3d.angle_between(a, b);
        steps(self.linkage.longest_way(a, b, turn), length)
    }

    fn diameter(&self) -> f64 {
        self.linkage.diameter()
    }

    fn protein(&self) -> &[Point] {
        &self.protein
    }

    fn atoms_near(&self, at: &Point, reach: f64, visit: &mut dyn FnMut(&Point)) {
        self.near.get_or_init(|| NearAtoms::new(&self.protein)).near(at, reach, visit);
    }

    fn exposed(&self) -> &[ExposedResidue] {
        self.exposed.get_or_init(|| exposed(&self.chains))
    }

    fn atom_energy(&self, atom: usize, at: &Point) -> f64 {
        let (grid, sum) = (self.field.grid(), self.field.sum());
        let point = grid.and_then(|(grid, values)| Some((grid, values, grid.nearest_point(*at)?)));
        match point {
            Some((grid, values, point)) => grid.at_point(values, sum, atom, point),
            None => sum.of_atom(atom, *at).0.total(),
        }
    }

    fn force(&self, q: &[f64], most: f64) -> Point {
        let positions = self.positions(q);
        let mut by_atoms = vec![Point::zeros(); positions.len()];
        self.field.gradient(&positions, &mut by_atoms);
        let force = by_atoms.iter().fold(Point::zeros(), |sum, by| sum - by);
        capped(force, most)
    }

    fn low_cells(&self, atom: usize, limits: CellLimits) -> Arc<LowCells> {
        // A thread that panicked left the memory as it was.
        let mut cells = self.cells.lock().unwrap_or_else(PoisonError::into_inner);
        let known = cells.iter().find(|(of, by, _)| (*of, *by) == (atom, limits));
        if let Some((_, _, found)) = known {
            return found.clone();
        }
        let found = Arc::new(low_cells(&self.field, atom, limits));
        if cells.len() == CELLS_KEPT {
            cells.remove(0);
        }
        cells.push((atom, limits, found.clone()));
        found
    }

    fn exact(&self, q: &[f64]) -> EnergyParts {
        self.exact_at(q)
    }
}
