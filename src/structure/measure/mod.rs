//! What is measured of structures, one file per measure.
//!
//! Lengths are in Å, areas in Å², angles in radians; energies of hydrogen bonds in kcal/mol, as in the paper that defines
//! them.

mod cells;
mod contacts;
mod domain_angle;
mod elements;
mod hydrogen_bonds;
mod jacobi;
mod ladders;
mod radius_of_gyration;
mod rmsd;
mod secondary_structure;
mod segments;
mod solvent_accessible_area;
mod superposition;

#[cfg(test)]
mod tests;

pub use contacts::{
    APART, CA_REACH, NativeContacts, ca_contacts, contacts_of_points, share_of_ca_contacts,
};
pub use domain_angle::{BACKBONE_AND_CB, CA, angle_of_centroids, domain_angle};
pub use elements::{Element, elements};
pub use hydrogen_bonds::{
    COUPLING as HYDROGEN_BOND_COUPLING, HydrogenBond, WEAKEST as WEAKEST_HYDROGEN_BOND,
    amide_hydrogens, energy as hydrogen_bond_energy, hydrogen_bonds, strongest_two,
};
pub use radius_of_gyration::{mass, radius_of_gyration, radius_of_gyration_by_mass};
pub use rmsd::{CentredPoints, rmsd, rmsd_in_place};
pub use secondary_structure::{SecondaryStructure, ThreeStates, secondary_structure};
pub use segments::segments;
pub use solvent_accessible_area::{
    NoRadius, Probe, solvent_accessible_areas, van_der_waals_radius,
};
pub use superposition::{Superposition, centroid, superpose};
