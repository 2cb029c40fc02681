use super::{GaveUp, Sampler, collect, default_attempts, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{CellLimits, LigandAtProtein, LowCells, Scratch};
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use crate::structure::Point;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A ligand placed by the energy's grid (O. B. Bayazit, PhD thesis, 2003, chapter V D 2 and Figure 23): its base in a random cell of
/// low energy, those beside high ones favoured, with a random orientation; then link by link a random angle, until the atoms of the link
/// are in acceptable cells; if none is found, one link back.
///
/// Acceptable is a cell whose energy is at most `acceptable`, or one beside such a cell: *"we allow some of the atoms to be placed in
/// high(er) potential cells provided that these cells are adjacent to low potential neighbors"*. The base is the ligand's root piece, and
/// the cells' energies are those of its atom nearest to the centre. What is low, and how often is tried, the thesis does not say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct LowEnergyCells {
    /// Up to this energy of its central atom the base may begin in a cell, kJ/mol.
    pub low: f64,
    /// From this energy on a cell is high, kJ/mol.
    pub high: f64,
    /// Up to this energy a cell is acceptable for an atom, kJ/mol.
    pub acceptable: f64,
    /// The share of milestones whose base begins in a low cell with a high neighbour.
    pub at_boundary: f64,
    /// How many angles are tried for a link before the one before it is tried again.
    pub angles: u32,
    /// The most placements of a base, and of links, tried for one milestone.
    pub attempts: u64,
}

impl Default for LowEnergyCells {
    fn default() -> LowEnergyCells {
        let (low, high, acceptable) = (-1.0, 0.0, 0.0);
        let attempts = default_attempts();
        LowEnergyCells { low, high, acceptable, at_boundary: 0.8, angles: 20, attempts }
    }
}

/// How many times the number of links, and some more, angles are drawn for one placement of the base.
const BACK_TRACKS: u64 = 10;

impl LowEnergyCells {
    /// Puts the base into a cell; whether its atoms are in acceptable ones.
    fn place_base(
        &self,
        cx: &Context,
        ligand: &dyn LigandAtProtein,
        cells: &LowCells,
        stream: &mut Stream,
        q: &mut [f64],
    ) -> bool {
        cx.space.sample_uniform(stream, q);
        let wants_boundary = stream.unit() < self.at_boundary;
        let (first, second) = match wants_boundary {
            true => (&cells.at_boundary, &cells.inside),
            false => (&cells.inside, &cells.at_boundary),
        };
        let from = if first.is_empty() { second } else { first };
        let cell = from[stream.below(from.len() as u64) as usize];
        for axis in 0..3 {
            q[axis] = cell[axis] + cells.spacing * (stream.unit() - 0.5);
        }
        cx.space.within_bounds(q) && self.is_acceptable(ligand, cells.spacing, 0, q)
    }

    /// Draws angles for all links; whether that succeeded.
    fn place_links(
        &self,
        ligand: &dyn LigandAtProtein,
        spacing: f64,
        stream: &mut Stream,
        q: &mut [f64],
    ) -> bool {
        let pieces = ligand.pieces().len();
        // Per piece how many angles have been tried since the piece before it was placed.
        let mut tried = vec![0; pieces];
        let mut left = BACK_TRACKS * u64::from(self.angles) * pieces as u64;
        let mut piece = 1;
        while piece < pieces {
            if left == 0 {
                return false;
            }
            if tried[piece] == self.angles {
                tried[piece] = 0;
                if piece == 1 {
                    return false;
                }
                piece -= 1;
                continue;
            }
            tried[piece] += 1;
            left -= 1;
            q[ligand.torsion_of(piece)] = PI * (2.0 * stream.unit() - 1.0);
            if self.is_acceptable(ligand, spacing, piece, q) {
                piece += 1;
                if piece < pieces {
                    tried[piece] = 0;
                }
            }
        }
        true
    }

    /// Whether all atoms of a piece are in acceptable cells.
    fn is_acceptable(
        &self,
        ligand: &dyn LigandAtProtein,
        spacing: f64,
        piece: usize,
        q: &[f64],
    ) -> bool {
        let positions = ligand.positions(q);
        ligand.pieces()[piece].iter().all(|atom| {
            let at = positions[*atom];
            let is_low = |at: &Point| ligand.atom_energy(*atom, at) <= self.acceptable;
            let beside = |axis: usize, by: f64| {
                let mut near = at;
                near[axis] += by;
                is_low(&near)
            };
            is_low(&at) || (0..3).any(|axis| beside(axis, -spacing) || beside(axis, spacing))
        })
    }

    /// The cells in which the base may begin.
    fn cells(&self, ligand: &dyn LigandAtProtein) -> std::sync::Arc<LowCells> {
        ligand.low_cells(ligand.central_atom(), CellLimits { low: self.low, high: self.high })
    }
}

impl Sampler for LowEnergyCells {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let Some(ligand) = cx.model.ligand() else {
            return Err(GaveUp { attempts: 0 });
        };
        let cells = self.cells(ligand);
        if cells.at_boundary.is_empty() && cells.inside.is_empty() {
            return Err(GaveUp { attempts: 0 });
        }
        collect(count, self.attempts, out, |q| {
            self.place_base(cx, ligand, &cells, &mut stream, q)
                && self.place_links(ligand, cells.spacing, &mut stream, q)
                && cx.model.is_valid(q, scratch)
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        let energies = [("low", self.low), ("high", self.high), ("acceptable", self.acceptable)];
        if let Some((key, energy)) = energies.iter().find(|(_, energy)| !energy.is_finite()) {
            return Some(Complaint::new(key, energy, "a finite energy"));
        }
        if !(0.0..=1.0).contains(&self.at_boundary) {
            return Some(Complaint::new("at_boundary", self.at_boundary, "0 to 1"));
        }
        if !(1..=1_000_000).contains(&self.angles) {
            return Some(Complaint::new("angles", self.angles, "1 to 1000000"));
        }
        zero("attempts", self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        super::at_a_protein(cx)
    }
}
