//! A point in an energy over the plane.
//!
//! The smallest model with energies: it is what methods for molecules are tried on, since what they should find
//! is known. The description is [`Landscape`]; `docs/landscape.md` has an example with pictures.

mod bound;
mod energy;
mod resolve;
mod sound;
mod spec;

pub use energy::{Energy, Term};
pub use spec::LandscapeSpec;

use super::relaxation::relaxed_energy;
use super::{
    CannotRelax, Cost, Description, Directed, Documents, Figure, Model, ModelKind, ModelScratch,
    NodeValue, Reason, Relaxation, RelaxedModel, Resolve, Scratch, Validity, out_of_range,
};
use crate::source::{ProblemError, Source, value};
use crate::space::{BaseJoint, Dof, Factor, FactorKind, Space};
use bincode::{Decode, Encode};
use std::fmt::Write;

const ENERGY: &[NodeValue] = &[NodeValue { name: "energy", unit: "energy" }];

/// A point that moves in a rectangle of the plane, in an energy: plain data.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Landscape {
    /// Least x and y.
    pub(crate) min: [f64; 2],
    /// Largest x and y.
    pub(crate) max: [f64; 2],
    /// The energy.
    pub(crate) energy: Energy,
    /// The highest energy that is valid; `None`: any.
    pub(crate) highest: Option<f64>,
    /// The peak of a motion is found at most so far above the highest energy on it.
    pub(crate) tolerance: f64,
}

impl Landscape {
    /// Least and largest x and y.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        [self.min, self.max]
    }

    /// The energy.
    pub fn energy(&self) -> &Energy {
        &self.energy
    }

    /// The highest energy that is valid; `None`: any.
    pub fn highest(&self) -> Option<f64> {
        self.highest
    }

    /// The peak of a motion is found at most so far above the highest energy on it.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }
}

impl Resolve for Landscape {
    type Spec = LandscapeSpec;

    const TABLES: &'static [&'static str] = &["landscape"];

    fn spec(source: &Source) -> Result<LandscapeSpec, ProblemError> {
        spec::read(source)
    }

    fn resolve(
        spec: &LandscapeSpec,
        source: &Source,
        _notes: &mut Vec<String>,
    ) -> Result<Landscape, ProblemError> {
        resolve::resolve(spec, source)
    }

    fn to_spec(&self) -> LandscapeSpec {
        let Landscape { min, max, energy, highest, tolerance } = self.clone();
        LandscapeSpec { min, max, energy, highest, tolerance: Some(tolerance) }
    }
}

impl Description for Landscape {
    fn space(&self) -> Space {
        let part = |at: usize| {
            let kind = FactorKind::Real { min: self.min[at], max: self.max[at] };
            Factor { kind, at, weight: 1.0 }
        };
        let dof = |name: &str| Dof { name: name.to_owned(), unit: "length" };
        Space::new(vec![part(0), part(1)], vec![dof("x"), dof("y")], 2)
    }

    fn node_values(&self) -> &'static [NodeValue] {
        ENERGY
    }

    fn cost_unit(&self) -> &'static str {
        "energy"
    }

    fn has_directed_costs(&self) -> bool {
        true
    }

    fn sound(&self) -> Result<(), String> {
        self.complaint().map_or(Ok(()), |(key, message)| Err(format!("landscape.{key}: {message}")))
    }

    fn prepare(&self) -> Box<dyn Model> {
        let Landscape { highest, tolerance, .. } = *self;
        let terms = self.energy.terms();
        Box::new(PointInEnergy { space: self.space(), terms, highest, tolerance })
    }

    fn difference(&self, other: &ModelKind) -> Option<&'static str> {
        // Without `..`: whoever adds a field has to compare it here.
        let Landscape { min, max, energy, highest, tolerance } = self;
        let ModelKind::Landscape(other) = other else { return Some("the kind of model") };
        let parts = [
            ("the energy", *energy == other.energy),
            ("the landscape's bounds", (min, max) == (&other.min, &other.max)),
            ("the highest valid energy", *highest == other.highest),
            ("the tolerance of peaks", *tolerance == other.tolerance),
        ];
        parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
    }

    fn describe(&self, out: &mut String) {
        let Landscape { min, max, energy, highest, tolerance } = self;
        let highest = highest.map_or("any energy is valid".to_owned(), |highest| {
            format!("energies up to {highest} are valid")
        });
        let energy = match energy {
            Energy::MullerBrown => "the Müller-Brown potential".to_owned(),
            Energy::Terms(terms) => format!("{} terms", terms.len()),
        };
        writeln!(out, "                 x y: a point in the plane")
            .and_then(|()| writeln!(out, "bounds           {min:?} to {max:?}"))
            .and_then(|()| writeln!(out, "energy           {energy}; {highest}"))
            .and_then(|()| {
                writeln!(out, "tolerance        {tolerance}: what peaks of motions are found to")
            })
            .expect("writing to memory cannot fail");
    }

    fn write(&self, documents: &mut Documents) {
        let Landscape { min, max, energy, highest, tolerance } = self;
        let energy = match energy {
            Energy::MullerBrown => "{ muller-brown = {} }".to_owned(),
            Energy::Terms(terms) => {
                let terms: Vec<String> = terms.iter().map(value).collect();
                format!("{{ terms = [\n    {},\n] }}", terms.join(",\n    "))
            }
        };
        let out = &mut documents.text;
        *out += &format!("\n[landscape]\nmin = {min:?}\nmax = {max:?}\nenergy = {energy}\n");
        *out += &highest.map_or_else(String::new, |highest| format!("highest = {highest:?}\n"));
        *out += &format!("tolerance = {tolerance:?}\n");
    }

    fn relaxed(&self, relaxation: &Relaxation, level: f64) -> Result<RelaxedModel, CannotRelax> {
        let highest = relaxed_energy(relaxation, self.highest, level, "a landscape")?;
        let made = Landscape { highest: Some(highest), ..self.clone() };
        Ok(RelaxedModel::new(ModelKind::Landscape(made)))
    }

    fn figure(&self) -> Option<&dyn Figure> {
        Some(self)
    }
}

impl Figure for Landscape {
    fn is_planar(&self) -> bool {
        true
    }

    fn bounds(&self) -> [[f64; 3]; 2] {
        [self.min, self.max].map(|[x, y]| [x, y, 0.0])
    }

    fn is_held_by_bounds(&self) -> bool {
        true
    }

    fn marker(&self, q: &[f64]) -> [f64; 3] {
        [q[0], q[1], 0.0]
    }

    fn base(&self) -> BaseJoint {
        BaseJoint::Translation2d
    }

    fn energy_at(&self, x: f64, y: f64) -> Option<f64> {
        Some(energy::energy(&self.energy.terms(), [x, y]))
    }
}

/// The model.
struct PointInEnergy {
    space: Space,
    terms: Vec<Term>,
    highest: Option<f64>,
    tolerance: f64,
}

/// Intervals of a motion that may hold its peak.
#[derive(Default)]
struct LandscapeScratch {
    open: Vec<bound::Interval>,
}

impl ModelScratch for LandscapeScratch {
    fn poison(&mut self, rubbish: u64) {
        self.open = vec![bound::Interval::rubbish(rubbish); rubbish as usize % 5];
    }
}

impl PointInEnergy {
    fn is_allowed(&self, energy: f64) -> bool {
        self.highest.is_none_or(|highest| energy <= highest)
    }

    fn energy_at(&self, q: &[f64]) -> f64 {
        energy::energy(&self.terms, [q[0], q[1]])
    }
}

impl Model for PointInEnergy {
    fn space(&self) -> &Space {
        &self.space
    }

    fn validity(&self, q: &[f64], scratch: &mut Scratch) -> Validity {
        scratch.for_configuration::<LandscapeScratch>();
        if !self.space.within_bounds(q) {
            return Validity::OutOfBounds;
        }
        if self.is_allowed(self.energy_at(q)) { Validity::Valid } else { Validity::Invalid }
    }

    /// The costs are the climbs: from the energy at either end to the peak.
    fn motion(&self, a: &[f64], b: &[f64], refinement: u32, scratch: &mut Scratch) -> Option<Cost> {
        let scratch: &mut LandscapeScratch = scratch.for_motion();
        if !(self.space.within_bounds(a) && self.space.within_bounds(b)) {
            return None;
        }
        let tolerance = self.tolerance / f64::from(refinement);
        let ends = [a, b].map(|q| [q[0], q[1]]);
        let peak = bound::peak(&self.terms, ends, tolerance, &mut scratch.open);
        let energies = [a, b].map(|q| self.energy_at(q));
        // What rounding adds to the bound covers the ends too, but not by a proof that a reader sees.
        let peak = peak.max(energies[0]).max(energies[1]);
        let [forward, backward] = energies.map(|energy| peak - energy);
        self.is_allowed(peak).then_some(Cost::Directed(Directed { forward, backward, peak }))
    }

    fn energy(&self, q: &[f64], _scratch: &mut Scratch) -> Option<f64> {
        Some(self.energy_at(q))
    }

    fn gradient(&self, q: &[f64], out: &mut [f64], _scratch: &mut Scratch) -> Option<f64> {
        out.copy_from_slice(&energy::gradient(&self.terms, [q[0], q[1]]));
        Some(self.energy_at(q))
    }

    fn has_gradient(&self) -> bool {
        true
    }

    fn reasons(&self, q: &[f64], _depths: bool) -> Vec<Reason> {
        let mut reasons = out_of_range(&self.space, q);
        let energy = self.energy_at(q);
        if let Some(highest) = self.highest.filter(|highest| energy > *highest) {
            let text = format!("the energy is {energy}, at most {highest} expected");
            reasons.push(Reason::Other { text });
        }
        reasons
    }

    fn is_obstructed(&self) -> bool {
        self.highest.is_some()
    }

    fn node_values(&self) -> &'static [NodeValue] {
        ENERGY
    }

    fn values(&self, q: &[f64], out: &mut Vec<f64>, _scratch: &mut Scratch) {
        out.push(self.energy_at(q));
    }
}

#[cfg(test)]
mod tests;
