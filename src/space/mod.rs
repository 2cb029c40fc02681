//! Configuration spaces: what the numbers of a configuration mean, how far apart two
//! configurations are and what lies between them.
//!
//! Every robot's space is a product of three kinds of [`Factor`]: real intervals, wrapped angles
//! and rotations in 3D (unit quaternions). A configuration is a flat slice of `f64`, one value
//! per degree of freedom in the order of [`Space::dofs`]; a quaternion takes four values,
//! `w x y z`.

mod configs;
mod displacement;
mod quaternion;
mod rigid;

pub use configs::Configs;
pub use quaternion::{canonical, slerp, stored_form};
pub use rigid::{BaseJoint, rigid_factors, rigid_space};

use quaternion::Slerp;

use crate::math;
use crate::seed::Stream;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// One factor of the product.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FactorKind {
    /// A real number in an interval, in the scene's length unit.
    Real {
        /// Least value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// An angle in radians, in `[-π, π)`, that wraps.
    Angle,
    /// A rotation in 3D: a unit quaternion `w x y z` whose first non-zero value is positive.
    Rotation,
}

/// A factor of the product with its place and its weight in the metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Factor {
    /// What the values are.
    pub kind: FactorKind,
    /// Index of the first value in a configuration.
    pub at: usize,
    /// Metric length per unit of the factor: 1 for lengths, length per radian for rotations.
    pub weight: f64,
}

/// A degree of freedom as people read it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dof {
    /// Name, as in the header of a path: `x`, `qw`, …
    pub name: String,
    /// Unit: `length`, `rad`, or `1` for the values of a quaternion.
    pub unit: &'static str,
}

/// A configuration space.
#[derive(Clone, Debug)]
pub struct Space {
    factors: Vec<Factor>,
    dofs: Vec<Dof>,
    translations: usize,
}

/// A direction in which a configuration can move: a vector tangent to the space, of any length.
#[derive(Clone, Debug)]
pub struct Direction {
    /// Per factor of the space its components in the metric: three of a rotation, one of any other factor.
    factors: Vec<[f64; 3]>,
    /// The vector's length.
    size: f64,
}

/// Relative margin of every pruning bound on distances; rounding errors are a thousand times smaller.
const PRUNING_MARGIN: f64 = 1e-12;

/// Gives every value a name that no other has. Names that are given only once stay.
fn make_unique(dofs: &mut [Dof]) {
    let mut taken: BTreeSet<String> = dofs.iter().map(|dof| dof.name.clone()).collect();
    // For each name that is given, the next number to try.
    let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
    for dof in dofs {
        let given = dof.name.clone();
        let number = numbers.entry(given.clone()).or_insert(1);
        while *number > 1 {
            let name = format!("{given}-{number}");
            if taken.insert(name.clone()) {
                dof.name = name;
                break;
            }
            *number += 1;
        }
        *number += 1;
    }
}

impl Space {
    /// The product of `factors`, described by `dofs`, of which the first `translations` are the position of the robot's
    /// base. Where a name is given to several values, those after the first get `NAME-2`, `NAME-3` and so on: exported
    /// columns and attributes are told apart by these names.
    ///
    /// # Panics
    /// If the factors do not cover the degrees of freedom in order.
    pub fn new(factors: Vec<Factor>, mut dofs: Vec<Dof>, translations: usize) -> Space {
        let mut next = 0;
        for factor in &factors {
            assert_eq!(factor.at, next, "factors follow one another");
            next += if factor.kind == FactorKind::Rotation { 4 } else { 1 };
        }
        assert_eq!(next, dofs.len(), "every value has a name");
        make_unique(&mut dofs);
        Space { factors, dofs, translations }
    }

    /// The degrees of freedom, one per value of a configuration.
    pub fn dofs(&self) -> &[Dof] {
        &self.dofs
    }

    /// How many values, the first ones, are the position of the robot's base. All others turn the base or move joints.
    pub fn translations(&self) -> usize {
        self.translations
    }

    /// The factors of the product.
    pub fn factors(&self) -> &[Factor] {
        &self.factors
    }

    /// Number of values of a configuration.
    pub fn len(&self) -> usize {
        self.dofs.len()
    }

    /// Whether configurations have no values.
    pub fn is_empty(&self) -> bool {
        self.dofs.is_empty()
    }

    /// Draws a configuration uniformly: reals in their intervals, angles on the circle, rotations
    /// on SO(3) by the Haar measure. `out` has [`Space::len`] values.
    pub fn sample_uniform(&self, stream: &mut Stream, out: &mut [f64]) {
        self.fill_from_unit_numbers(|| stream.unit(), out);
    }

    /// The dimension of the unit cube that [`Space::of_cube`] maps to the space: one per real value and angle, three
    /// per rotation.
    pub fn cube_dimensions(&self) -> usize {
        self.factors
            .iter()
            .map(|factor| if factor.kind == FactorKind::Rotation { 3 } else { 1 })
            .sum()
    }

    /// Maps a point of the unit cube of [`Space::cube_dimensions`] to a configuration in stored form. The map preserves
    /// measure: points uniform in the cube give configurations with the distribution of [`Space::sample_uniform`].
    ///
    /// # Panics
    /// If the point has too few coordinates.
    pub fn of_cube(&self, point: &[f64], out: &mut [f64]) {
        let mut coordinates = point.iter();
        self.fill_from_unit_numbers(
            || *coordinates.next().expect("as many coordinates as the cube has"),
            out,
        );
    }

    /// Writes the configuration, in stored form, that numbers in `[0, 1]` stand for: one per real and angle, three per
    /// rotation. `unit` gives them in the order of the factors.
    fn fill_from_unit_numbers(&self, mut unit: impl FnMut() -> f64, out: &mut [f64]) {
        let between =
            |share: f64, low: f64, high: f64| (low + share * (high - low)).clamp(low, high);
        for factor in &self.factors {
            let at = factor.at;
            match factor.kind {
                FactorKind::Real { min, max } => out[at] = between(unit(), min, max),
                FactorKind::Angle => out[at] = math::wrap_angle(between(unit(), -PI, PI)),
                FactorKind::Rotation => {
                    let rotation = quaternion::rotation_of([unit(), unit(), unit()]);
                    out[at..at + 4].copy_from_slice(&rotation);
                }
            }
        }
    }

    /// The same space with every real interval longer by `length`, in the metric, at either end.
    pub(crate) fn widened(&self, length: f64) -> Space {
        let mut wide = self.clone();
        for factor in &mut wide.factors {
            if let FactorKind::Real { min, max } = &mut factor.kind
                && factor.weight > 0.0
            {
                *min -= length / factor.weight;
                *max += length / factor.weight;
            }
        }
        wide
    }

    /// The same space with the intervals of the base's position no longer than those of a box, each longer by `length`, in the metric, at
    /// either end. An interval that would be empty stays as it is.
    pub(crate) fn narrowed(&self, [low, high]: [[f64; 3]; 2], length: f64) -> Space {
        let mut narrow = self.clone();
        for (axis, factor) in narrow.factors.iter_mut().take(self.translations).enumerate() {
            if let FactorKind::Real { min, max } = &mut factor.kind
                && factor.weight > 0.0
            {
                let by = length / factor.weight;
                let (from, to) = (min.max(low[axis] - by), max.min(high[axis] + by));
                if from <= to {
                    (*min, *max) = (from, to);
                }
            }
        }
        narrow
    }

    /// Whether every real value lies in its interval.
    pub fn within_bounds(&self, q: &[f64]) -> bool {
        self.factors.iter().all(|factor| match factor.kind {
            FactorKind::Real { min, max } => (min..=max).contains(&q[factor.at]),
            FactorKind::Angle | FactorKind::Rotation => true,
        })
    }

    /// Brings a configuration into the form that is stored: angles in `[-π, π)`, quaternions of
    /// unit length with their first non-zero value positive, no negative zero.
    ///
    /// # Errors
    /// Says which value is not finite or which quaternion is zero.
    pub fn canonicalize(&self, q: &mut [f64]) -> Result<(), String> {
        for (value, dof) in q.iter().zip(&self.dofs) {
            if !value.is_finite() {
                return Err(format!("the value of {} is {value}, not a finite number", dof.name));
            }
        }
        for factor in &self.factors {
            match factor.kind {
                FactorKind::Real { .. } => {}
                FactorKind::Angle => q[factor.at] = math::wrap_angle(q[factor.at]),
                FactorKind::Rotation => {
                    let quaternion =
                        [q[factor.at], q[factor.at + 1], q[factor.at + 2], q[factor.at + 3]];
                    let quaternion = canonical(quaternion).ok_or_else(|| {
                        format!("the quaternion (w x y z) = {quaternion:?} has no direction")
                    })?;
                    q[factor.at..factor.at + 4].copy_from_slice(&quaternion);
                }
            }
        }
        for value in q.iter_mut() {
            *value += 0.0; // −0 becomes 0
        }
        Ok(())
    }

    /// Whether configurations of the two spaces are of one form: the same degrees of freedom in the same order.
    /// The bounds may differ.
    pub fn has_form_of(&self, other: &Space) -> bool {
        let kind = |factor: &Factor| (std::mem::discriminant(&factor.kind), factor.at);
        self.dofs == other.dofs && self.factors.iter().map(kind).eq(other.factors.iter().map(kind))
    }

    /// The names of the degrees of freedom, as people read them.
    pub fn form(&self) -> String {
        let names: Vec<_> = self.dofs.iter().map(|dof| dof.name.as_str()).collect();
        names.join(" ")
    }

    /// Distance of two configurations in the scene's length unit: the square root of the weighted
    /// sum of squares over the factors. Angles count by their shortest turn, rotations by the angle
    /// of the rotation between them (in `[0, π]`). Symmetric to the bit.
    pub fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut sum = 0.0;
        for factor in &self.factors {
            let difference = match factor.kind {
                FactorKind::Real { .. } => a[factor.at] - b[factor.at],
                FactorKind::Angle => math::angle_between(a[factor.at], b[factor.at]),
                FactorKind::Rotation => 2.0 * math::acos(dot(a, b, factor.at).abs()),
            } * factor.weight;
            sum += difference * difference;
        }
        sum.sqrt()
    }

    /// [`Space::distance`], or `None` where it is cheaply known to exceed `bound`. The value, when
    /// given, may exceed the bound too.
    pub fn distance_unless_above(&self, a: &[f64], b: &[f64], bound: f64) -> Option<f64> {
        let mut below = 0.0;
        for factor in &self.factors {
            below += match factor.kind {
                FactorKind::Real { .. } => {
                    let difference = (a[factor.at] - b[factor.at]) * factor.weight;
                    difference * difference
                }
                FactorKind::Angle => {
                    let difference =
                        math::angle_between(a[factor.at], b[factor.at]) * factor.weight;
                    difference * difference
                }
                // The bound angle² ≥ 8 (1 − cos(angle / 2)) needs no arc cosine.
                FactorKind::Rotation => {
                    let chord = (1.0 - dot(a, b, factor.at).abs()).max(0.0);
                    8.0 * chord * factor.weight * factor.weight
                }
            };
        }
        if below > bound * bound * (1.0 + PRUNING_MARGIN) {
            return None;
        }
        Some(self.distance(a, b))
    }

    /// [`Space::distance`], or `None` where it is cheaply known to be less than `bound`. The value,
    /// when given, may be less too.
    pub fn distance_unless_below(&self, a: &[f64], b: &[f64], bound: f64) -> Option<f64> {
        let mut above = 0.0;
        for factor in &self.factors {
            let difference = match factor.kind {
                FactorKind::Real { .. } => a[factor.at] - b[factor.at],
                FactorKind::Angle => math::angle_between(a[factor.at], b[factor.at]),
                // The bound angle ≤ π √(1 − cos(angle / 2)) needs no arc cosine.
                FactorKind::Rotation => PI * (1.0 - dot(a, b, factor.at).abs()).max(0.0).sqrt(),
            } * factor.weight;
            above += difference * difference;
        }
        if bound > 0.0 && above * (1.0 + PRUNING_MARGIN) < bound * bound {
            return None;
        }
        Some(self.distance(a, b))
    }

    /// The largest distance that two configurations can have.
    pub fn diameter(&self) -> f64 {
        let extent = |factor: &Factor| match factor.kind {
            FactorKind::Real { min, max } => factor.weight * (max - min),
            FactorKind::Angle | FactorKind::Rotation => factor.weight * PI,
        };
        self.factors.iter().map(|factor| extent(factor) * extent(factor)).sum::<f64>().sqrt()
    }

    /// The configuration at distance `length` from `q` in a direction drawn uniformly:
    /// [`Space::direction`], then [`Space::along`].
    pub fn step(&self, q: &[f64], length: f64, stream: &mut Stream, out: &mut [f64]) {
        self.along(q, &self.direction(stream), length, out);
    }

    /// A configuration drawn uniformly from the ball of this radius about `q`: its distance, then [`Space::step`].
    pub fn step_within(&self, q: &[f64], radius: f64, stream: &mut Stream, out: &mut [f64]) {
        // The volume within a distance is as its power of the number of dimensions.
        let dimensions = self.cube_dimensions() as f64;
        let share = crate::math::exp(crate::math::ln(stream.unit()) / dimensions);
        self.step(q, radius * share, stream, out);
    }

    /// A direction drawn uniformly from the unit sphere of the metric's tangent space. Factors without
    /// weight do not move.
    pub fn direction(&self, stream: &mut Stream) -> Direction {
        let mut factors: Vec<[f64; 3]> = Vec::with_capacity(self.factors.len());
        let mut square = 0.0;
        for factor in &self.factors {
            let numbers = match (factor.weight > 0.0, factor.kind) {
                (false, _) => 0,
                (true, FactorKind::Rotation) => 3,
                (true, FactorKind::Real { .. } | FactorKind::Angle) => 1,
            };
            let mut components = [0.0; 3];
            for component in components.iter_mut().take(numbers) {
                *component = stream.normal();
                square += *component * *component;
            }
            factors.push(components);
        }
        Direction { factors, size: square.sqrt() }
    }

    /// The configuration at distance `length` from `q` on the geodesic that leaves it in a direction.
    /// Angles and rotations wrap, so the distance is less where a factor turns by more than half a turn.
    /// `out` is in stored form but may lie out of bounds.
    pub fn along(&self, q: &[f64], direction: &Direction, length: f64, out: &mut [f64]) {
        let scale = if direction.size > 0.0 { length / direction.size } else { 0.0 };
        for (factor, components) in self.factors.iter().zip(&direction.factors) {
            let at = factor.at;
            let by = components
                .map(|component| component * scale / factor.weight.max(f64::MIN_POSITIVE));
            match factor.kind {
                FactorKind::Real { .. } => out[at] = q[at] + by[0] + 0.0,
                FactorKind::Angle => out[at] = math::wrap_angle(q[at] + by[0]),
                FactorKind::Rotation => {
                    let from = [q[at], q[at + 1], q[at + 2], q[at + 3]];
                    out[at..at + 4].copy_from_slice(&quaternion::turned(from, by));
                }
            }
        }
    }

    /// The configuration at fraction `t` of the shortest motion from `a` to `b`, at constant
    /// speed in every factor. `out` is in stored form, except that a quaternion may be its negative or have a length
    /// off by rounding.
    pub fn interpolate(&self, a: &[f64], b: &[f64], t: f64, out: &mut [f64]) {
        self.way(a, b).at(t, out);
    }

    /// [`Space::interpolate`] prepared for many values of `t`.
    pub(crate) fn way<'a>(&'a self, a: &'a [f64], b: &'a [f64]) -> Way<'a> {
        let four = |q: &[f64], at: usize| [q[at], q[at + 1], q[at + 2], q[at + 3]];
        let rotations = self.factors.iter().filter(|factor| factor.kind == FactorKind::Rotation);
        let mut turns = rotations.map(|factor| Slerp::new(four(a, factor.at), four(b, factor.at)));
        Way { factors: &self.factors, a, b, turn: turns.next(), more: turns.collect() }
    }
}

/// The shortest motion between two configurations, prepared for evaluation at many times.
#[derive(Clone, Debug)]
pub(crate) struct Way<'a> {
    factors: &'a [Factor],
    a: &'a [f64],
    b: &'a [f64],
    /// The interpolation of the first rotation, kept here so that most spaces need no allocation.
    turn: Option<Slerp>,
    /// The interpolation of the other rotations, which only linkages with spherical joints have.
    more: Vec<Slerp>,
}

impl Way<'_> {
    /// See [`Space::interpolate`].
    pub(crate) fn at(&self, t: f64, out: &mut [f64]) {
        let Way { a, b, .. } = *self;
        let mut turns = self.turn.iter().chain(&self.more);
        for factor in self.factors {
            let at = factor.at;
            match factor.kind {
                FactorKind::Real { .. } => out[at] = a[at] + (b[at] - a[at]) * t,
                FactorKind::Angle => {
                    out[at] = math::wrap_angle(a[at] + math::wrap_angle(b[at] - a[at]) * t);
                }
                FactorKind::Rotation => {
                    let turn = turns.next().expect("one for every rotation");
                    out[at..at + 4].copy_from_slice(&turn.at(t));
                }
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64], at: usize) -> f64 {
    a[at] * b[at] + a[at + 1] * b[at + 1] + a[at + 2] * b[at + 2] + a[at + 3] * b[at + 3]
}

#[cfg(test)]
mod tests;
