//! A pose that is known, beside those that were found.

use super::candidates::{Candidates, Exact};
use crate::ligand::Symmetries;
use crate::model::docking::Docking;
use crate::model::{EnergyParts, Scratch};
use crate::structure::Point;
use crate::structure::measure::{rmsd, rmsd_in_place};

/// A pose within so many Å of the reference is the same: what docking counts as a success.
pub const SAME_POSE: f64 = 2.0;

/// A known pose, such as that of a crystal, and the minimum below it. The known pose is descended before anything is compared with it
/// (O. B. Bayazit 2003, chapter V F 3), since poses that are found are minima of the model's energy.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The positions of the ligand's atoms in the known pose, Å.
    pub positions: Vec<Point>,
    /// The energy of the configuration that is nearest to them, by exact sums, kJ/mol.
    pub energy: EnergyParts,
    /// How far that configuration is from the positions, RMSD in Å: 0 of the pose that the ligand was given with.
    pub misfit: f64,
    /// The configuration of the minimum.
    pub q: Vec<f64>,
    /// The positions of the ligand's atoms at the minimum, Å.
    pub descended: Vec<Point>,
    /// The energy of the minimum, kJ/mol.
    pub descended_energy: EnergyParts,
}

impl Reference {
    /// The reference at these positions of the ligand's atoms. `None` if there are not as many as atoms, or where its centre is outside
    /// of the box.
    pub fn of(exact: &Exact, docking: &Docking, positions: Vec<Point>) -> Option<Reference> {
        let (nearest, misfit) = docking.shaped(&positions)?;
        if !exact.context().space().within_bounds(&nearest) {
            return None;
        }
        let (q, _) = exact.improved(&nearest, &mut Scratch::new());
        Some(Reference {
            energy: exact.energy(&nearest),
            misfit,
            descended: docking.positions_at(&q),
            descended_energy: exact.energy(&q),
            positions,
            q,
        })
    }
}

/// How poses of a ligand are compared.
pub struct Comparison {
    symmetries: Option<Symmetries>,
    /// The numbers of the heavy atoms.
    heavy: Vec<usize>,
}

impl Comparison {
    /// By the symmetries of a ligand; without them where it has too many, which [`Comparison::is_corrected`] tells.
    pub fn of(docking: &Docking) -> Comparison {
        let ligand = docking.ligand();
        let is_heavy = |atom: &usize| ligand.atoms()[*atom].element.is_heavy();
        let heavy: Vec<usize> = (0..ligand.atoms().len()).filter(is_heavy).collect();
        Comparison { symmetries: docking.symmetries(), heavy }
    }

    /// The positions of the heavy atoms among those of all.
    fn heavy(&self, positions: &[Point]) -> Vec<Point> {
        self.heavy.iter().map(|atom| positions[*atom]).collect()
    }

    /// Whether what is the same of a symmetric ligand counts as the same.
    pub fn is_corrected(&self) -> bool {
        self.symmetries.is_some()
    }

    /// The RMSD of heavy atoms of two poses as they stand, Å.
    pub fn distance(&self, a: &[Point], b: &[Point]) -> f64 {
        match &self.symmetries {
            Some(symmetries) => symmetries.rmsd(a, b),
            None => rmsd_in_place(&self.heavy(a), &self.heavy(b)),
        }
    }

    /// The RMSD of heavy atoms after the best rotation and translation, Å: of the shapes alone.
    pub fn of_shapes(&self, a: &[Point], b: &[Point]) -> f64 {
        match &self.symmetries {
            Some(symmetries) => symmetries.rmsd_superposed(a, b),
            None => rmsd(&self.heavy(a), &self.heavy(b)),
        }
    }
}

/// What the poses that were found say of a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// The pose of lowest energy is the reference.
    First,
    /// The reference has a lower energy than every pose that was found: the search has missed it.
    SamplingMiss,
    /// A pose elsewhere has a lower energy than the reference: the energy prefers it, whatever is searched.
    ScoringMiss,
}

impl Found {
    /// What the poses in rising energy say of a reference; `None` if there are none.
    pub fn of(
        candidates: &Candidates,
        reference: &Reference,
        comparison: &Comparison,
    ) -> Option<Found> {
        let best = candidates.candidates.first()?;
        let distance = comparison.distance(&best.positions, &reference.descended);
        Some(if distance <= SAME_POSE {
            Found::First
        } else if reference.descended_energy.sum() < best.energy.sum() {
            Found::SamplingMiss
        } else {
            Found::ScoringMiss
        })
    }
}
