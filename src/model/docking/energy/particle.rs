//! An atom as the energy sees it.

use super::parameters::hydrophobic_radius;
use crate::ligand::Element;

/// An atom as the energy sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Its element.
    pub element: Element,
    /// Its charge in elementary charges.
    pub charge: f64,
    /// Whether it takes part in the hydrophobic term.
    pub is_hydrophobic: bool,
}

/// Whether an atom is hydrophobic, as AutoDock Vina types it: a carbon all of whose neighbours are carbon or hydrogen,
/// and fluorine, chlorine, bromine and iodine.
///
/// `model::assign_types` of AutoDock Vina 1.2.
pub(super) fn is_hydrophobic(
    element: Element,
    neighbours: impl IntoIterator<Item = Element>,
) -> bool {
    let is_hetero = |element: Element| element.is_heavy() && element != Element::CARBON;
    match element {
        Element::CARBON => !neighbours.into_iter().any(is_hetero),
        _ => hydrophobic_radius(element) > 0.0,
    }
}
