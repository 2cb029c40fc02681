//! The protein's part of the energy in a grid: values at points in space, between which it is interpolated.

mod encode;
mod fill;
mod interpolate;
mod points;

use super::sum::PairSum;
use crate::structure::Point;
use bincode::{Decode, Encode};
use interpolate::{Cell, linear, cubic};
use serde::{Deserialize, Serialize};

/// How the energy at a place is made of the values of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Lookup {
    Nearest,
    Trilinear,
    Tricubic,
    #[default]
    Roots,
    CubicRoots,
}

impl Lookup {
    fn channels(self) -> usize {
        match self {
            Lookup::Nearest | Lookup::Trilinear | Lookup::Tricubic => 1,
            Lookup::Roots | Lookup::CubicRoots => 2,
        }
    }
}

/// A grid.
#[derive(Clone, Debug)]
pub struct Grid {
    low: Point,
    spacing: f64,
    counts: [usize; 3],
    lookup: Lookup,
    kinds: usize,
    has_charges: bool,
}

impl Grid {
    pub fn new(sum: &PairSum, corners: [Point; 2], spacing: f64, lookup: Lookup) -> Grid {
        let [one, other] = corners;
        let low = one.inf(&other);
        let size = one.sup(&other) - low;
        let count = |axis: usize| ((size[axis] / spacing).ceil().max(1.0) as usize) + 1;
        Grid {
            low,
            spacing,
            counts: [count(0), count(1), count(2)],
            lookup,
            kinds: sum.kinds.len(),
            has_charges: sum.charged.is_some(),
        }
    }

    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    pub fn layers(&self) -> usize {
        self.counts[2]
    }

    pub fn layer_len(&self) -> usize {
        let numbers = self.kinds * self.lookup.channels() + usize::from(self.has_charges);
        self.counts[0] * self.counts[1] * numbers
    }

    pub fn values_len(&self) -> usize {
        self.layers() * self.layer_len()
    }

    pub fn fill(&self, sum: &PairSum, out: &mut [f32]) {
        for (layer, out) in out.chunks_exact_mut(self.layer_len()).enumerate() {
            self.fill_layer(sum, layer, out);
        }
    }

    fn cell(&self, at: Point) -> Option<Cell> {
        let mut cell = Cell { base: [0; 3], part: [0.0; 3] };
        for axis in 0..3 {
            let place = (at[axis] - self.low[axis]) / self.spacing;
            let last = self.counts[axis] - 1;
            if !(place >= 0.0 && place <= last as f64) {
                return None;
            }
            let base = (place as usize).min(last - 1);
            cell.base[axis] = base;
            cell.part[axis] = place - base as f64;
        }
        Some(cell)
    }

    /// The energy of an atom and its derivative.
    #[inline(always)]
    fn of_atom(&self, values: &[f32], sum: &PairSum, atom: usize, at: Point) -> (f64, Point) {
        let Some(cell) = self.cell(at) else {
            let (parts, gradient) = sum.of_atom(atom, at);
            return (parts.total(), gradient);
        };
        let kind = sum.kind_of[atom];
        let plane = self.counts[0] * self.counts[1];
        let channels = self.lookup.channels();
        let begin = kind * plane * channels;
        let charge_begin = self.kinds * plane * channels;
        let per = 1.0 / self.spacing;
        let shape = interpolate::Shape { counts: self.counts, layer: self.layer_len(), per };
        let charge = sum.charges[atom];
        let has_charge = self.has_charges && charge != 0.0;
        let (mut energy, mut gradient) = match self.lookup {
            Lookup::Nearest => interpolate::nearest(values, &shape, begin, &cell),
            Lookup::Trilinear => {
                let ([v], [g]) = linear::<1>(values, &shape, begin, &cell);
                (v, g)
            }
            Lookup::Tricubic => {
                let ([v], [g]) = cubic::<1>(values, &shape, begin, &cell);
                (v, g)
            }
            Lookup::Roots => {
                let (v, g) = linear::<2>(values, &shape, begin, &cell);
                encode::energy_of_roots(v, g)
            }
            Lookup::CubicRoots => {
                let (v, g) = cubic::<2>(values, &shape, begin, &cell);
                encode::energy_of_roots(v, g)
            }
        };
        if has_charge {
            let (v, g) = match self.lookup {
                Lookup::Nearest => interpolate::nearest(values, &shape, charge_begin, &cell),
                Lookup::Trilinear | Lookup::Roots => {
                    let ([v], [g]) = linear::<1>(values, &shape, charge_begin, &cell);
                    (v, g)
                }
                Lookup::Tricubic | Lookup::CubicRoots => {
                    let ([v], [g]) = cubic::<1>(values, &shape, charge_begin, &cell);
                    (v, g)
                }
            };
            energy += charge * v;
            gradient += g * charge;
        }
        (energy, gradient)
    }

    pub fn energy(&self, values: &[f32], sum: &PairSum, positions: &[Point]) -> f64 {
        let mut energy = 0.0;
        for (atom, at) in positions.iter().enumerate().take(sum.ligand_atoms()) {
            energy += self.of_atom(values, sum, atom, *at).0;
        }
        energy
    }

    pub fn gradient(&self, values: &[f32], sum: &PairSum, positions: &[Point], out: &mut [Point]) -> f64 {
        let mut energy = 0.0;
        for (atom, (at, out)) in positions.iter().zip(out).enumerate().take(sum.ligand_atoms()) {
            let (of_atom, gradient) = self.of_atom(values, sum, atom, *at);
            energy += of_atom;
            *out = gradient;
        }
        energy
    }
}
