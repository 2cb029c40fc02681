//! From what a problem asks for to a checked description of a deformable robot, and back.

use super::settings::{DeformationMethod, DeformationSettings, Feasibility, GeometricSettings};
use super::spec::{FeasibilitySpec, GeometricSpec, MethodSpec, Scales, Table};
use super::{Deformable, DeformableSpec, surface};
use crate::model::bodies::{Bodies, centroid};
use crate::model::{Resolve, ScaleCentre};
use crate::source::{ProblemError, Source};

/// Into so many parts the longest edge of the robot's bounding box is cut, unless the problem says otherwise.
const EDGES: f64 = 16.0;
/// The share of the longest edge of the robot's bounding box that a neighbourhood reaches, unless the problem says otherwise.
const NEIGHBOURHOOD: f64 = 0.25;
/// The clearance as a share of the resolution, unless the problem says otherwise.
const CLEARANCE: f64 = 0.25;

/// Checks a deformable robot and makes what is asked for.
pub(super) fn resolve(
    spec: &DeformableSpec,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Deformable, ProblemError> {
    let DeformableSpec { bodies, table } = spec;
    let bodies = Bodies::resolve(bodies, source, notes)?;
    let deformable = made(bodies, table, notes);
    match deformable.complaint() {
        None => Ok(deformable),
        Some((place, message)) => Err(source.error(&place, message)),
    }
}

fn made(bodies: Bodies, table: &Table, notes: &mut Vec<String>) -> Deformable {
    let Table { feasibility, method, highest_energy, clearance, step, longest_edge } = table;
    let size = surface::longest_side(&bodies);
    let resolution = bodies.resolution;
    let mut chosen = |given: Option<f64>, key: &str, length: f64, reason: &str| {
        given.unwrap_or_else(|| {
            notes.push(format!("{key} = {length}, {reason}"));
            length
        })
    };
    let padding = bodies.robot.padding.iter().copied().fold(0.0, f64::max);
    let (usual, reason) = match padding > resolution * CLEARANCE {
        true => (padding, "the padding of the robot"),
        false => (resolution * CLEARANCE, "a quarter of the resolution"),
    };
    let clearance = chosen(*clearance, "clearance", usual, reason);
    let step = chosen(*step, "step", resolution, "the resolution");
    let reason = "a 16th of the longest edge of the robot's bounding box";
    let longest_edge = chosen(*longest_edge, "longest_edge", size / EDGES, reason);
    let method = match method {
        MethodSpec::BoundingBox(settings) => DeformationMethod::BoundingBox(settings.clone()),
        MethodSpec::Geometric(spec) => {
            let reason = "a quarter of the longest edge of the robot's bounding box";
            let reach = chosen(spec.neighbourhood, "neighbourhood", size * NEIGHBOURHOOD, reason);
            DeformationMethod::Geometric(geometric(spec, reach))
        }
    };
    let feasibility = match feasibility {
        FeasibilitySpec::Scaled { scales, centre } => {
            let centre = match centre {
                ScaleCentre::Point(point) => *point,
                ScaleCentre::Centroid => {
                    let bodies: Vec<_> = bodies.robot.bodies().cloned().collect();
                    centroid(&bodies)
                }
            };
            Feasibility::Scaled { scales: ladder(scales), centre }
        }
        FeasibilitySpec::Penetrating { depth, vectors } => {
            Feasibility::Penetrating { depth: *depth, vectors: *vectors }
        }
    };
    let highest_energy = highest_energy.unwrap_or(f64::INFINITY);
    let deformation = DeformationSettings { method, highest_energy, clearance, step };
    Deformable { bodies, feasibility, deformation, longest_edge }
}

/// The method of deformation that is asked for, of a robot of this longest edge.
pub(super) fn method(spec: &MethodSpec, size: f64) -> DeformationMethod {
    match spec {
        MethodSpec::BoundingBox(settings) => DeformationMethod::BoundingBox(settings.clone()),
        MethodSpec::Geometric(spec) => {
            let reach = spec.neighbourhood.unwrap_or(size * NEIGHBOURHOOD);
            DeformationMethod::Geometric(geometric(spec, reach))
        }
    }
}

fn geometric(spec: &GeometricSpec, neighbourhood: f64) -> GeometricSettings {
    let GeometricSpec {
        directions,
        shortest,
        longest,
        neighbourhood: _,
        guide,
        rounds,
        refuse_self_collisions,
    } = spec.clone();
    GeometricSettings {
        directions,
        shortest,
        longest,
        neighbourhood,
        guide,
        rounds,
        refuse_self_collisions,
    }
}

/// The scales of a ladder, from the first down. There are no more of them than are needed to see that there are too many.
fn ladder(scales: &Scales) -> Vec<f64> {
    match scales {
        Scales::Listed(scales) => scales.clone(),
        Scales::Even { count, least } => {
            let count = (*count).min(super::sound::SCALES_MAX as u32 + 1);
            let last = f64::from(count.saturating_sub(1).max(1));
            (0..count).map(|rung| 1.0 - (1.0 - least) * (f64::from(rung) / last)).collect()
        }
    }
}

/// What asks for this description.
pub(super) fn to_spec(deformable: &Deformable) -> DeformableSpec {
    let Deformable { bodies, feasibility, deformation, longest_edge } = deformable.clone();
    let DeformationSettings { method, highest_energy, clearance, step } = deformation;
    let feasibility = match feasibility {
        Feasibility::Scaled { scales, centre } => FeasibilitySpec::Scaled {
            scales: Scales::Listed(scales),
            centre: ScaleCentre::Point(centre),
        },
        Feasibility::Penetrating { depth, vectors } => {
            FeasibilitySpec::Penetrating { depth, vectors }
        }
    };
    let method = match method {
        DeformationMethod::BoundingBox(settings) => MethodSpec::BoundingBox(settings),
        DeformationMethod::Geometric(settings) => MethodSpec::Geometric(settings.into()),
    };
    let table = Table {
        feasibility,
        method,
        highest_energy: Some(highest_energy),
        clearance: Some(clearance),
        step: Some(step),
        longest_edge: Some(longest_edge),
    };
    DeformableSpec { bodies: bodies.to_spec(), table }
}
