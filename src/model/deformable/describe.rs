//! What `check` says of a deformable robot.

use super::Deformable;
use super::settings::{
    ChainMailOrder, DeformationMethod, DeformationSettings, Feasibility, LatticeInterpolation,
};
use crate::model::Description;
use std::fmt::{Result, Write};

pub(super) fn describe(deformable: &Deformable, out: &mut String) -> Result {
    let Deformable { bodies, feasibility, deformation, longest_edge } = deformable;
    bodies.describe(out);
    match feasibility {
        Feasibility::Scaled { scales, .. } => {
            let scales: Vec<String> = scales.iter().map(f64::to_string).collect();
            let scales = scales.join(" ");
            writeln!(
                out,
                "feasible         where the robot is free at one of the scales {scales}"
            )?;
        }
        Feasibility::Penetrating { depth, vectors } => {
            writeln!(
                out,
                "feasible         where one of {vectors} random vectors of length {depth} at most frees the robot, at steps no farther apart than the resolution"
            )?;
        }
    }
    let DeformationSettings { method, highest_energy, clearance, step } = deformation;
    match method {
        DeformationMethod::BoundingBox(settings) => {
            let [x, y, z] = settings.lattice;
            let order = match settings.order {
                ChainMailOrder::Queue => "queue",
                ChainMailOrder::MostReached => "most-reached",
            };
            let interpolation = match settings.interpolation {
                LatticeInterpolation::Trilinear => "trilinear",
                LatticeInterpolation::Bernstein => "Bernstein",
            };
            writeln!(
                out,
                "deformed by      a lattice of {x} x {y} x {z} points, distances {:?} to {:?} of those at rest, shear {}; \
                 ChainMail {order}, {} sweeps of relaxation, {interpolation}",
                settings.least, settings.greatest, settings.shear, settings.relaxation
            )?;
        }
        DeformationMethod::Geometric(settings) => writeln!(
            out,
            "deformed by      its triangles, edges {} to {} of their lengths at rest, regions within {}; {} directions beside normals, \
             a guide of scale {}, up to {} rounds, shapes that meet themselves are {}",
            settings.shortest,
            settings.longest,
            settings.neighbourhood,
            settings.directions,
            settings.guide,
            settings.rounds,
            if settings.refuse_self_collisions { "refused" } else { "accepted" }
        )?,
    }
    let energy = match highest_energy.is_finite() {
        true => format!("up to {highest_energy} are accepted"),
        false => "are all accepted".to_owned(),
    };
    writeln!(
        out,
        "shapes           energies {energy}; at least {clearance} from obstacles; steps of {step} at most"
    )?;
    let surface = deformable.surface();
    writeln!(
        out,
        "surface          {} vertices, {} triangles, no edge longer than {longest_edge}",
        surface.vertices.len(),
        surface.triangles.len()
    )
}
