//! How a grid's values come about.

use super::{Grid, encoding};
use crate::lanes::with_lanes;
use crate::model::docking::energy::cells::{Cells, LANES};
use crate::model::docking::energy::parameters::hydrophobic_radius;
use crate::model::docking::energy::sum::{CoulombField, HydrophobicField, PairSum};
use crate::model::docking::energy::switch::NEAREST_SQUARED;
use crate::model::docking::energy::terms::{HYDROPHOBIC_DEPTH, HYDROPHOBIC_FAR, HYDROPHOBIC_NEAR};
use crate::structure::Point;
use fearless_simd::f64x8;
use fearless_simd::prelude::*;

impl Grid {
    /// Fills all values.
    ///
    /// # Panics
    /// If there are not `values_len()` of them.
    pub fn fill(&self, sum: &PairSum, out: &mut [f32]) {
        self.check(out);
        for (layer, out) in out.chunks_exact_mut(self.layer_len().max(1)).enumerate() {
            self.fill_layer(sum, layer, out);
        }
    }

    /// Fills the values of one layer, counted from 0; the bits do not depend on what else is filled, or by whom.
    ///
    /// # Panics
    /// If there are not `layer_len()` of them, or if `sum` has other kinds of atoms than the grid was made for.
    pub fn fill_layer(&self, sum: &PairSum, layer: usize, out: &mut [f32]) {
        assert_eq!(out.len(), self.layer_len(), "the values are those of another grid");
        assert_eq!(self.kinds, sum.kinds.len(), "the grid is that of another ligand");
        with_lanes!(sum.lanes, simd => simd.vectorize(
            #[inline(always)]
            || self.fill_with(simd, sum, layer, out)
        ));
    }

    /// The same with these lanes, which are eight points along x.
    ///
    /// All kinds of atoms are served by one pass over the protein: 1/r¹² and 1/r⁶ are summed for each of its elements, and
    /// the parameters of the pairs are multiplied in at the end.
    #[inline(always)]
    fn fill_with<S: Simd>(&self, simd: S, sum: &PairSum, layer: usize, out: &mut [f32]) {
        let number = |value: f64| f64x8::splat(simd, value);
        let (plane, numbers) = (self.plane(), self.lookup.numbers());
        let mut powers = vec![[number(0.0); 2]; sum.all.elements.len()];
        for y in 0..self.counts[1] {
            for x in (0..self.counts[0]).step_by(LANES) {
                let points = Points::new(simd, self.point([x, y, layer]), self.spacing);
                let (first, lanes) = (y * self.counts[0] + x, LANES.min(self.counts[0] - x));
                points.powers(simd, sum, &mut powers);
                for (kind, pairs) in sum.all.pairs.iter().enumerate() {
                    let mut repulsion = number(0.0);
                    let mut attraction = points.hydrophobic(simd, sum, kind);
                    for ([twelfths, sixths], pair) in powers.iter().zip(pairs) {
                        repulsion += *twelfths * number(pair.a);
                        attraction += *sixths * number(pair.b);
                    }
                    let begin = kind * plane * numbers + first * numbers;
                    let out = out[begin..begin + lanes * numbers].chunks_exact_mut(numbers);
                    for ((repulsion, attraction), out) in
                        repulsion.as_slice().iter().zip(attraction.as_slice()).zip(out)
                    {
                        encoding::write(self.lookup, *repulsion, *attraction, out);
                    }
                }
                if let Some(field) = &sum.charged {
                    let potential = points.potential(simd, sum, field);
                    let begin = self.kinds * plane * numbers + first;
                    for (out, potential) in
                        out[begin..begin + lanes].iter_mut().zip(potential.as_slice())
                    {
                        *out = *potential as f32;
                    }
                }
            }
        }
    }
}

/// Eight neighbouring points along x.
struct Points<S: Simd> {
    from: Point,
    length: f64,
    x: f64x8<S>,
}

impl<S: Simd> Points<S> {
    #[inline(always)]
    fn new(simd: S, from: Point, spacing: f64) -> Points<S> {
        let steps = f64x8::simd_from(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let x = steps * f64x8::splat(simd, spacing) + f64x8::splat(simd, from.x);
        Points { from, length: spacing * 7.0, x }
    }

    /// Calls `visit` with every point of the cells that may be nearer than `reach`, its number and the squared distances from
    /// the eight.
    #[inline(always)]
    fn near(&self, simd: S, cells: &Cells, reach: f64, mut visit: impl FnMut(usize, f64x8<S>)) {
        let number = |value: f64| f64x8::splat(simd, value);
        let [xs, ys, zs] = &cells.at;
        cells.runs(
            self.from,
            self.length,
            reach,
            #[inline(always)]
            |run| {
                for other in run {
                    let x = self.x - number(xs[other]);
                    let (y, z) = (self.from.y - ys[other], self.from.z - zs[other]);
                    let squared = x * x + number(y * y + z * z);
                    visit(other, squared.max(number(NEAREST_SQUARED)));
                }
            },
        );
    }

    /// For every element of the protein the sums of 1/r¹² and 1/r⁶ over its atoms, switched off at the cut-off.
    #[inline(always)]
    fn powers(&self, simd: S, sum: &PairSum, powers: &mut [[f64x8<S>; 2]]) {
        powers.fill([f64x8::splat(simd, 0.0); 2]);
        self.near(
            simd,
            &sum.all.narrow,
            sum.cutoff,
            #[inline(always)]
            |atom, squared| {
                let (factor, _) = sum.switch.at_eight(simd, squared);
                let inverse = f64x8::splat(simd, 1.0) / squared;
                let sixth = inverse * inverse * inverse;
                let switched = sixth * factor;
                let [twelfths, sixths] = &mut powers[sum.all.element_of[atom]];
                *twelfths += switched * sixth;
                *sixths += switched;
            },
        );
    }

    /// How far the hydrophobic energies of a kind of atom are below zero, in kJ/mol.
    #[inline(always)]
    fn hydrophobic(&self, simd: S, sum: &PairSum, kind: usize) -> f64x8<S> {
        let number = |value: f64| f64x8::splat(simd, value);
        let mut total = number(0.0);
        let Some(HydrophobicField { cells, radii, widest }) = &sum.hydrophobic else {
            return total;
        };
        let kind = sum.kinds[kind];
        if !kind.is_hydrophobic {
            return total;
        }
        let radius = hydrophobic_radius(kind.element);
        let width = HYDROPHOBIC_FAR - HYDROPHOBIC_NEAR;
        self.near(
            simd,
            cells,
            radius + widest + HYDROPHOBIC_FAR,
            #[inline(always)]
            |atom, squared| {
                let left = number(HYDROPHOBIC_FAR + radius + radii[atom]) - squared.sqrt();
                let share = left.max(number(0.0)).min(number(width));
                total += share * number(-HYDROPHOBIC_DEPTH / width);
            },
        );
        total
    }

    /// The potential of the protein's charges, in kJ/mol per elementary charge.
    #[inline(always)]
    fn potential(&self, simd: S, sum: &PairSum, field: &CoulombField) -> f64x8<S> {
        let mut total = f64x8::splat(simd, 0.0);
        self.near(
            simd,
            &field.cells,
            sum.cutoff,
            #[inline(always)]
            |atom, squared| {
                let (factor, _) = sum.switch.at_eight(simd, squared);
                total += f64x8::splat(simd, field.strengths[atom]) / squared * factor;
            },
        );
        total
    }
}
