//! The protein's part of the energy in a grid: values at points of space, and an energy anywhere made of those nearby.

mod encoding;
mod fill;
mod force;
mod interpolation;
mod shape;

use super::sum::PairSum;
use crate::structure::Point;
use bincode::{Decode, Encode};
use interpolation::{Map, cubic, linear, nearest};
use serde::{Deserialize, Serialize};
use shape::Place;

pub use force::capped;
pub use shape::{SPACING_RANGE, VALUES_MAX};

/// How the energy of an atom is made of the values of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Lookup {
    /// The energy at the nearest point, as O. B. Bayazit 2003, chapter V, with points 0.5 Å apart. Its gradient is the
    /// difference of the energies at the points around that one.
    Nearest,
    /// Energies, interpolated linearly along each axis between the eight points around, as AutoDock does.
    Trilinear,
    /// The same of reciprocals: 1/√R and 1/A are interpolated, R being the sum of what repels and A of what attracts.
    /// Energies bend upwards beside an atom, so that a straight line between two points lies above them; these reciprocals
    /// bend far less.
    #[default]
    Reciprocal,
    /// The same reciprocals, interpolated by Catmull-Rom splines between the 64 points around: nearer to the exact sum,
    /// at several times the cost.
    Tricubic,
}

/// A grid over a box: for every kind of atom of a ligand the energy at every point, and, where charges count, the
/// potential.
///
/// The grid itself is but its shape; the values are numbers that the caller keeps, so that they can be shared between
/// processes. They are `layers()` layers, one for every z, of `layer_len()` numbers each, so that each can be filled by
/// itself; [`Grid::fill`] fills them all, to the same bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The first point, in Å.
    low: Point,
    /// The distance of neighbouring points in Å.
    spacing: f64,
    /// One over it.
    per: f64,
    /// How many points there are along each axis, at least two.
    counts: [usize; 3],
    lookup: Lookup,
    /// How many kinds of atoms there are.
    kinds: usize,
    /// Whether there is a map of the potential.
    has_potential: bool,
}

impl Grid {
    /// The energy in kJ/mol of a ligand with its atoms at these positions in Å, one per atom. An atom outside of the grid
    /// has its exact sum. An atom deep within the protein has at most 10⁵ kJ/mol with [`Lookup::Nearest`] and
    /// [`Lookup::Trilinear`], and 10⁸ with the others.
    ///
    /// # Panics
    /// If there are not `values_len()` values.
    pub fn energy(&self, values: &[f32], sum: &PairSum, ligand_positions: &[Point]) -> f64 {
        self.check(values);
        let mut energy = 0.0;
        for (atom, at) in ligand_positions.iter().enumerate().take(sum.ligand_atoms()) {
            energy += self.of_atom(values, sum, atom, *at).0;
        }
        energy
    }

    /// The energy, to the same bits, and its derivative by the position of every atom of the ligand, in kJ/(mol Å), which
    /// is written to `out`, one vector per atom. Within a cell of the grid it is the derivative of that energy, except with
    /// [`Lookup::Nearest`].
    ///
    /// # Panics
    /// If there are not `values_len()` values.
    pub fn gradient(
        &self,
        values: &[f32],
        sum: &PairSum,
        ligand_positions: &[Point],
        out: &mut [Point],
    ) -> f64 {
        self.check(values);
        let mut energy = 0.0;
        let atoms = ligand_positions.iter().zip(out).enumerate().take(sum.ligand_atoms());
        for (atom, (at, out)) in atoms {
            let (of_atom, gradient) = self.of_atom(values, sum, atom, *at);
            energy += of_atom;
            *out = gradient;
        }
        energy
    }

    /// The energy in kJ/mol of an atom of the ligand at a point of the grid, as its values say it: what the energy-based
    /// generator goes by.
    ///
    /// # Panics
    /// If there are not `values_len()` values, or if the point is none of the grid's.
    pub fn at_point(&self, values: &[f32], sum: &PairSum, atom: usize, point: [usize; 3]) -> f64 {
        self.check(values);
        let kind = self.kind_map(values, sum.kind_of[atom]);
        let energy = if self.lookup.is_plain() {
            kind.at::<1>(point)[0]
        } else {
            encoding::energy(kind.at::<2>(point), [Point::zeros(); 2]).0
        };
        let charge = sum.charges[atom];
        self.potential_map(values).map_or(energy, |map| energy + charge * map.at::<1>(point)[0])
    }

    fn check(&self, values: &[f32]) {
        assert_eq!(values.len(), self.values_len(), "the values are those of another grid");
    }

    /// The energy of an atom at a position, and its derivative by the position.
    #[inline(always)]
    pub(super) fn of_atom(
        &self,
        values: &[f32],
        sum: &PairSum,
        atom: usize,
        at: Point,
    ) -> (f64, Point) {
        let Some(place) = self.place(at) else {
            let (parts, gradient) = sum.of_atom(atom, at);
            return (parts.total(), gradient);
        };
        let kind = self.kind_map(values, sum.kind_of[atom]);
        let (energy, gradient) = match self.lookup {
            Lookup::Nearest | Lookup::Trilinear => self.plain(&kind, &place),
            Lookup::Reciprocal => {
                let (values, gradients) = linear::<2>(&kind, &place);
                encoding::energy(values, gradients)
            }
            Lookup::Tricubic => {
                let (values, gradients) = cubic::<2>(&kind, &place);
                encoding::energy(values, gradients)
            }
        };
        let charge = sum.charges[atom];
        match self.potential_map(values) {
            Some(map) if charge != 0.0 => {
                let (potential, slope) = self.plain(&map, &place);
                (energy + charge * potential, gradient + slope * charge)
            }
            _ => (energy, gradient),
        }
    }

    /// The value of a map that needs no decoding, and its derivative by the position.
    #[inline(always)]
    fn plain(&self, map: &Map, place: &Place) -> (f64, Point) {
        match self.lookup {
            Lookup::Nearest => nearest(map, place),
            Lookup::Trilinear | Lookup::Reciprocal => {
                let ([value], [gradient]) = linear::<1>(map, place);
                (value, gradient)
            }
            Lookup::Tricubic => {
                let ([value], [gradient]) = cubic::<1>(map, place);
                (value, gradient)
            }
        }
    }
}
