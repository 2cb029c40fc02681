//! A deformable robot written out as the tables of a problem file.

use super::Deformable;
use super::settings::{DeformationSettings, Feasibility};
use crate::model::{Description, Documents};
use crate::source::value;

/// Appends the tables.
pub(super) fn write(deformable: &Deformable, documents: &mut Documents) {
    let Deformable { bodies, feasibility, deformation, longest_edge } = deformable;
    bodies.write(documents);
    let feasibility = match feasibility {
        Feasibility::Scaled { scales, centre } => {
            format!("{{ scales = {scales:?}, centre = {centre:?} }}")
        }
        Feasibility::Penetrating { depth, vectors } => {
            format!("{{ depth = {depth:?}, vectors = {vectors} }}")
        }
    };
    let DeformationSettings { method, highest_energy, clearance, step } = deformation;
    let highest_energy = match highest_energy.is_finite() {
        true => format!("{highest_energy:?}"),
        false => value("none"),
    };
    documents.text += &format!(
        "\n[deformable]\n\
         feasibility = {feasibility}\n\
         method = {}\n\
         highest_energy = {highest_energy}\n\
         clearance = {clearance:?}\n\
         step = {step:?}\n\
         longest_edge = {longest_edge:?}\n",
        value(method),
    );
}
