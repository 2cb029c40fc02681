//! The exact energy of a ligand at a protein: the sum over all pairs of their atoms.

use super::cells::{Cells, NARROW, WIDE};
use super::parameters::{PairCoefficients, hydrophobic_radius};
use super::particle::Particle;
use super::spec::EnergySpec;
use super::switch::Switch;
use super::terms::{COULOMB, CoulombTerm, HYDROPHOBIC_FAR, HydrophobicTerm, VanDerWaalsTerm, sum};
use crate::lanes::{Lanes, with_lanes};
use crate::ligand::Element;
use crate::structure::Point;
use fearless_simd::Simd;

/// The parts of an energy, in kJ/mol.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts {
    /// Of the 12-6 terms.
    pub van_der_waals: f64,
    /// Of the Coulomb terms; 0 where charges do not count.
    pub coulomb: f64,
    /// Of the hydrophobic terms; 0 where they do not count.
    pub hydrophobic: f64,
}

impl Parts {
    /// Their sum.
    pub fn total(&self) -> f64 {
        self.van_der_waals + self.coulomb + self.hydrophobic
    }
}

/// What tells apart the atoms of a ligand, their charges aside: atoms of one kind feel the same at the same place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct AtomKind {
    /// The element.
    pub element: Element,
    /// Whether the hydrophobic term counts for it.
    pub is_hydrophobic: bool,
}

/// The sum over all pairs of atoms of a protein, which stays where it is, and a ligand: 12-6 terms, Coulomb and
/// hydrophobic terms as far as the specification has them.
///
/// The protein's atoms lie in cells, so that a ligand's atom only meets those within the cut-off.
#[derive(Clone, Debug)]
pub struct PairSum {
    pub(super) switch: Switch,
    pub(super) cutoff: f64,
    /// The kinds of atoms of the ligand, in rising order.
    pub(super) kinds: Vec<AtomKind>,
    /// The kind of every atom of the ligand.
    pub(super) kind_of: Vec<usize>,
    /// The charge of every atom of the ligand, in elementary charges.
    pub(super) charges: Vec<f64>,
    pub(super) lanes: Lanes,
    pub(super) all: VanDerWaalsField,
    pub(super) charged: Option<CoulombField>,
    pub(super) hydrophobic: Option<HydrophobicField>,
}

/// All atoms of the protein, for the 12-6 terms.
#[derive(Clone, Debug)]
pub(super) struct VanDerWaalsField {
    pub cells: Cells,
    /// A of every atom of the protein with an atom of each kind, in kJ/mol Å¹².
    pub a: Vec<Vec<f64>>,
    /// B, in kJ/mol Å⁶.
    pub b: Vec<Vec<f64>>,
    /// The same atoms in cells for grids.
    pub narrow: Cells,
    /// The elements of the protein, in rising order.
    pub elements: Vec<Element>,
    /// Which of them every atom of the protein is, in the order of the cells for grids.
    pub element_of: Vec<usize>,
    /// A and B of every kind with every element of the protein.
    pub pairs: Vec<Vec<PairCoefficients>>,
}

/// The charged atoms of the protein.
#[derive(Clone, Debug)]
pub(super) struct CoulombField {
    pub cells: Cells,
    /// Their charges times the constant over the factor of the dielectric, in kJ/mol Å² per elementary charge.
    pub strengths: Vec<f64>,
}

/// The hydrophobic atoms of the protein.
#[derive(Clone, Debug)]
pub(super) struct HydrophobicField {
    pub cells: Cells,
    /// Their radii in Å.
    pub radii: Vec<f64>,
    /// The largest radius.
    pub widest: f64,
}

impl PairSum {
    /// Of a protein's particles at their positions (Å, finite) and a ligand's particles. Where there are more particles
    /// than positions, or fewer, those that have both count.
    pub fn new(
        spec: &EnergySpec,
        protein: &[Particle],
        positions: &[Point],
        ligand: &[Particle],
    ) -> PairSum {
        let kind = |particle: &Particle| AtomKind {
            element: particle.element,
            is_hydrophobic: spec.hydrophobic && particle.is_hydrophobic,
        };
        let mut kinds: Vec<AtomKind> = ligand.iter().map(kind).collect();
        kinds.sort_unstable();
        kinds.dedup();
        let kind_of =
            ligand.iter().map(|particle| kinds.partition_point(|known| *known < kind(particle)));
        let strength = spec.dielectric.map(|factor| COULOMB / factor);
        let protein = &protein[..protein.len().min(positions.len())];
        PairSum {
            switch: Switch::new(spec.cutoff),
            cutoff: spec.cutoff,
            kind_of: kind_of.collect(),
            charges: ligand.iter().map(|particle| particle.charge).collect(),
            lanes: Lanes::widest(),
            all: VanDerWaalsField::new(spec, protein, positions, &kinds),
            charged: strength.map(|strength| CoulombField::new(strength, protein, positions)),
            hydrophobic: spec.hydrophobic.then(|| HydrophobicField::new(protein, positions)),
            kinds,
        }
    }

    /// How many atoms the ligand has.
    pub fn ligand_atoms(&self) -> usize {
        self.kind_of.len()
    }

    /// The kinds of the ligand's atoms, in rising order.
    pub fn kinds(&self) -> &[AtomKind] {
        &self.kinds
    }

    /// Which kind an atom of the ligand is.
    pub fn kind_of(&self, atom: usize) -> usize {
        self.kind_of[atom]
    }

    /// The energy in kJ/mol with the ligand's atoms at these positions in Å: one position per atom. It is no number if a
    /// position is none.
    pub fn energy(&self, ligand_positions: &[Point]) -> f64 {
        self.parts(ligand_positions).total()
    }

    /// The same by its parts, whose sum is the energy to the last bit.
    pub fn parts(&self, ligand_positions: &[Point]) -> Parts {
        let mut parts = Parts::default();
        for (atom, at) in ligand_positions.iter().enumerate().take(self.ligand_atoms()) {
            let of_atom = self.of_atom(atom, *at).0;
            parts.van_der_waals += of_atom.van_der_waals;
            parts.coulomb += of_atom.coulomb;
            parts.hydrophobic += of_atom.hydrophobic;
        }
        parts
    }

    /// The energy, to the same bits, and its derivative by the position of every atom of the ligand, in kJ/(mol Å), which
    /// is written to `out`, one vector per atom.
    pub fn gradient(&self, ligand_positions: &[Point], out: &mut [Point]) -> f64 {
        let mut parts = Parts::default();
        let atoms = ligand_positions.iter().zip(out).enumerate().take(self.ligand_atoms());
        for (atom, (at, out)) in atoms {
            let (of_atom, gradient) = self.of_atom(atom, *at);
            parts.van_der_waals += of_atom.van_der_waals;
            parts.coulomb += of_atom.coulomb;
            parts.hydrophobic += of_atom.hydrophobic;
            *out = gradient;
        }
        parts.total()
    }

    /// The energy of one atom of the ligand at a position, and its derivative by the position.
    pub fn of_atom(&self, atom: usize, at: Point) -> (Parts, Point) {
        if !at.iter().all(|value| value.is_finite()) {
            let none = f64::NAN;
            let parts = Parts { van_der_waals: none, coulomb: 0.0, hydrophobic: 0.0 };
            return (parts, Point::repeat(none));
        }
        with_lanes!(self.lanes, simd => simd.vectorize(
            #[inline(always)]
            || {
                let kind = self.kind_of[atom];
                let AtomKind { element, is_hydrophobic } = self.kinds[kind];
                let term = VanDerWaalsTerm {
                    switch: self.switch,
                    a: &self.all.a[kind],
                    b: &self.all.b[kind],
                };
                let mut parts = Parts::default();
                let mut gradient;
                (parts.van_der_waals, gradient) = sum(simd, &self.all.cells, self.cutoff, at, &term);
                let charge = self.charges[atom];
                if let Some(CoulombField { cells, strengths }) =
                    self.charged.as_ref().filter(|_| charge != 0.0)
                {
                    let term = CoulombTerm { switch: self.switch, strengths, charge };
                    let of_charges;
                    (parts.coulomb, of_charges) = sum(simd, cells, self.cutoff, at, &term);
                    gradient += of_charges;
                }
                if let Some(HydrophobicField { cells, radii, widest }) =
                    self.hydrophobic.as_ref().filter(|_| is_hydrophobic)
                {
                    let radius = hydrophobic_radius(element);
                    let term = HydrophobicTerm { radii, radius };
                    let reach = radius + widest + HYDROPHOBIC_FAR;
                    let of_surfaces;
                    (parts.hydrophobic, of_surfaces) = sum(simd, cells, reach, at, &term);
                    gradient += of_surfaces;
                }
                (parts, gradient)
            }
        ))
    }
}

impl VanDerWaalsField {
    fn new(
        spec: &EnergySpec,
        protein: &[Particle],
        positions: &[Point],
        kinds: &[AtomKind],
    ) -> VanDerWaalsField {
        let mut elements: Vec<Element> = protein.iter().map(|particle| particle.element).collect();
        elements.sort_unstable();
        elements.dedup();
        let cells = Cells::new(&positions[..protein.len()], WIDE);
        let narrow = Cells::new(&positions[..protein.len()], NARROW);
        let element_of: Vec<usize> = ordered(&narrow, |number| {
            elements.partition_point(|known| *known < protein[number].element)
        });
        let pairs: Vec<Vec<PairCoefficients>> = kinds
            .iter()
            .map(|kind| {
                elements.iter().map(|other| spec.parameters.pair(kind.element, *other)).collect()
            })
            .collect();
        let coefficients = |pairs: &Vec<PairCoefficients>| {
            let of = |number: usize| {
                pairs[elements.partition_point(|known| *known < protein[number].element)]
            };
            (ordered(&cells, |number| of(number).a), ordered(&cells, |number| of(number).b))
        };
        let (a, b) = pairs.iter().map(coefficients).unzip();
        VanDerWaalsField { cells, a, b, narrow, elements, element_of, pairs }
    }
}

impl CoulombField {
    fn new(strength: f64, protein: &[Particle], positions: &[Point]) -> CoulombField {
        let charged: Vec<usize> = of_protein(protein, |particle| particle.charge != 0.0);
        let at: Vec<Point> = charged.iter().map(|number| positions[*number]).collect();
        let cells = Cells::new(&at, WIDE);
        let strengths = ordered(&cells, |number| protein[charged[number]].charge * strength);
        CoulombField { cells, strengths }
    }
}

impl HydrophobicField {
    fn new(protein: &[Particle], positions: &[Point]) -> HydrophobicField {
        let radius = |number: usize| hydrophobic_radius(protein[number].element);
        let hydrophobic: Vec<usize> = of_protein(protein, |particle| particle.is_hydrophobic);
        let at: Vec<Point> = hydrophobic.iter().map(|number| positions[*number]).collect();
        let cells = Cells::new(&at, WIDE);
        let radii = ordered(&cells, |number| radius(hydrophobic[number]));
        let widest = hydrophobic.iter().map(|number| radius(*number)).fold(0.0, f64::max);
        HydrophobicField { cells, radii, widest }
    }
}

/// The numbers of the protein's particles of which `is_one` says so.
fn of_protein(protein: &[Particle], is_one: impl Fn(&Particle) -> bool) -> Vec<usize> {
    (0..protein.len()).filter(|number| is_one(&protein[*number])).collect()
}

/// A value of every point in the order of its cells, and none (0) of those that fill the last lanes.
fn ordered<T: Default>(cells: &Cells, value: impl Fn(usize) -> T) -> Vec<T> {
    cells.order.iter().map(|number| number.map_or_else(T::default, &value)).collect()
}
