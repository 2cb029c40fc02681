//! Peptide bonds: where a chain is broken, and where it is cis.

use super::{Residue, torsion};
use std::f64::consts::FRAC_PI_2;

/// The longest distance of C and the next N, in Å, that counts as a peptide bond.
///
/// The bond is 1.33 Å long (Engh & Huber 1991); 2.0 Å leaves room for poor models. Across one missing residue three atoms
/// stand between the two, which are at least 2.65 Å apart then (the least of 2353 in real structures).
pub const PEPTIDE_BOND_MAX: f64 = 2.0;

/// Two residues that follow one another in a chain without a peptide bond.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// The index of the residue before it; the next one is behind it.
    pub before: usize,
    /// How far C is from the next N, in Å; `None` where one of these atoms is missing.
    pub distance: Option<f64>,
}

/// The gaps of a chain in order.
pub fn gaps(residues: &[Residue]) -> Vec<Gap> {
    let pairs = residues.windows(2).enumerate();
    let gap = |(before, pair): (usize, &[Residue])| {
        let distance = match (pair[0].position("C"), pair[1].position("N")) {
            (Some(c), Some(n)) => Some((n - c).norm()),
            _ => None,
        };
        let is_bond = distance.is_some_and(|distance| distance <= PEPTIDE_BOND_MAX);
        (!is_bond).then_some(Gap { before, distance })
    };
    pairs.filter_map(gap).collect()
}

/// A peptide bond in the cis form.
#[derive(Clone, Debug, PartialEq)]
pub struct CisPeptide {
    /// The index of the residue before the bond; the next one is behind it.
    pub before: usize,
    /// Omega in radians: the torsion CA, C, N(i+1), CA(i+1), nearer to 0 than to ±π.
    pub omega: f64,
}

/// The peptide bonds in the cis form, |omega| < 90°, in order.
pub fn cis_peptides(residues: &[Residue]) -> Vec<CisPeptide> {
    let pairs = residues.windows(2).enumerate();
    let cis = |(before, pair): (usize, &[Residue])| {
        let omega = omega(&pair[0], &pair[1]).filter(|omega| omega.abs() < FRAC_PI_2)?;
        Some(CisPeptide { before, omega })
    };
    pairs.filter_map(cis).collect()
}

/// Omega between two residues that a peptide bond joins, in radians; `None` where there is none or an atom is missing.
pub fn omega(residue: &Residue, next: &Residue) -> Option<f64> {
    let [ca, c] = ["CA", "C"].map(|name| residue.position(name));
    let [n, next_ca] = ["N", "CA"].map(|name| next.position(name));
    let (ca, c, n, next_ca) = (ca?, c?, n?, next_ca?);
    ((n - c).norm() <= PEPTIDE_BOND_MAX).then(|| torsion(&ca, &c, &n, &next_ca))
}

/// Phi and psi of every residue in radians, `None` at the ends, at gaps and where an atom is missing.
pub fn phi_psi(residues: &[Residue]) -> Vec<[Option<f64>; 2]> {
    let backbone = |residue: &Residue| {
        let [n, ca, c] = ["N", "CA", "C"].map(|name| residue.position(name));
        Some([n?, ca?, c?])
    };
    let is_joined = |one: &Residue, next: &Residue| omega(one, next).is_some();
    let angles = |place: usize| {
        let residue = &residues[place];
        let Some([n, ca, c]) = backbone(residue) else { return [None; 2] };
        let before = place.checked_sub(1).map(|before| &residues[before]);
        let before = before.filter(|before| is_joined(before, residue));
        let after = residues.get(place + 1).filter(|after| is_joined(residue, after));
        let phi = before.and_then(|before| before.position("C"));
        let psi = after.and_then(|after| after.position("N"));
        [
            phi.map(|before| torsion(&before, &n, &ca, &c)),
            psi.map(|after| torsion(&n, &ca, &c, &after)),
        ]
    };
    (0..residues.len()).map(angles).collect()
}
