//! What positions tell of bonds: which atoms are bonded, and which bonds are single.

use super::error::LigandFault;
use super::{Atom, Bond, BondOrder, Element};
use crate::structure::Point;

/// How much farther apart than the sum of their covalent radii bonded atoms may be, in Å.
pub const BOND_TOLERANCE: f64 = 0.45;
/// Atoms nearer than this, in Å, are at one place: no bond is so short (that of H₂ has 0.74 Å).
pub const SAME_PLACE: f64 = 0.4;

/// The bonds between atoms whose distance is at most the sum of their covalent radii and [`BOND_TOLERANCE`], in the
/// order of their atoms; their orders are unknown. Hydrogens are bonded to heavy atoms only, and each to the nearest.
///
/// # Errors
/// Two atoms at one place, nearer than [`SAME_PLACE`].
pub(super) fn bonds_by_distance(atoms: &[(Element, Point)]) -> Result<Vec<Bond>, LigandFault> {
    let mut bonds = Vec::new();
    // The nearest heavy atom of each hydrogen, with its distance.
    let mut nearest: Vec<Option<(f64, usize)>> = vec![None; atoms.len()];
    for (b, (second, at_b)) in atoms.iter().enumerate() {
        for (a, (first, at_a)) in atoms[..b].iter().enumerate() {
            let distance = (at_b - at_a).norm();
            if distance < SAME_PLACE {
                let found = format!("atoms {} and {} only {distance:.2} Å apart", a + 1, b + 1);
                return Err(LigandFault::BadBond(found));
            }
            let most = first.covalent_radius() + second.covalent_radius() + BOND_TOLERANCE;
            if distance > most {
                continue;
            }
            match (first.is_heavy(), second.is_heavy()) {
                (true, true) => bonds.push([a, b]),
                (false, false) => {}
                (is_heavy, _) => {
                    let (heavy, hydrogen) = if is_heavy { (a, b) } else { (b, a) };
                    if nearest[hydrogen].is_none_or(|(least, _)| distance < least) {
                        nearest[hydrogen] = Some((distance, heavy));
                    }
                }
            }
        }
    }
    let hydrogens = nearest.iter().enumerate().filter_map(|(hydrogen, heavy)| {
        heavy.map(|(_, heavy)| [hydrogen.min(heavy), hydrogen.max(heavy)])
    });
    bonds.extend(hydrogens);
    bonds.sort_unstable();
    Ok(bonds.into_iter().map(|atoms| Bond { atoms, order: BondOrder::Unknown }).collect())
}

/// Lengths in Å above which a bond between two elements is taken to be single, for pairs of which double bonds are known
/// between atoms with other heavy neighbours. All other pairs have single bonds only.
///
/// Double bonds are up to about 1.35 (C=C), 1.29 (C=N), 1.23 (C=O) and 1.26 Å (N=N) long, single bonds of conjugated atoms
/// and of amides from about 1.45 (C-C) and 1.33 Å (C-N) on (F. H. Allen et al., "Tables of bond lengths determined by X-ray and neutron
/// diffraction", J. Chem. Soc. Perkin Trans. 2, 1987, S1-S19), but lengths in PDB files are uncertain by several hundredths.
/// The limits lie near to double bonds, as outside of rings single ones are far more common: half way between, at
/// 1.40 Å, the link of benzamidine in 3PTB would be missed, which has 1.39 Å there.
const SINGLE_ABOVE: [(Element, Element, f64); 7] = [
    (Element::CARBON, Element::CARBON, 1.37),
    (Element::CARBON, Element::NITROGEN, 1.29),
    (Element::CARBON, Element::OXYGEN, 1.27),
    (Element::CARBON, Element::SULPHUR, 1.68),
    (Element::NITROGEN, Element::NITROGEN, 1.28),
    (Element::NITROGEN, Element::OXYGEN, 1.27),
    (Element::NITROGEN, Element::SULPHUR, 1.55),
];

/// The order of a bond of unknown order that is part of no ring: whether it is single by its length. Without positions
/// it is taken to be single, as most such bonds are.
pub(super) fn is_single_by_length(first: &Atom, second: &Atom) -> bool {
    let (Some(at_first), Some(at_second)) = (first.position, second.position) else { return true };
    let pair = (first.element.min(second.element), first.element.max(second.element));
    let above = SINGLE_ABOVE.iter().find(|(a, b, _)| (*a, *b) == pair);
    above.is_none_or(|(_, _, above)| (at_second - at_first).norm() > *above)
}
