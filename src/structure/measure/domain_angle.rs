//! The angle between domains of a protein.
//!
//! O. Beckstein, E. J. Denning, J. R. Perilla & T. B. Woolf, *Zipping and unzipping of adenylate kinase*, J. Mol. Biol. 394
//! (2009) 160: each of three sets of residues is represented by the centroid of some of its atoms, in the paper those of the
//! backbone and Cβ, and the angle is that at the middle one. For adenylate kinase of *E. coli* the angle of the domain that
//! binds AMP (NMP) is that of the residues 115–125, 90–100 and 35–55, the angle of the lid (LID) that of 179–185, 115–125
//! and 125–153.

use super::superposition::centroid;
use crate::math;
use crate::structure::{Point, Residue};
use std::ops::RangeInclusive;

/// The Cα atoms.
pub const CA: &[&str] = &["CA"];

/// The heavy atoms of the backbone and Cβ, which Beckstein et al. use.
pub const BACKBONE_AND_CB: &[&str] = &["N", "CA", "C", "O", "CB"];

/// The angle in radians, in [0, π], at the centroid of the `middle` points between the centroids of the others; `None`
/// if one of the sets is empty, or the middle lies where one of the others does.
pub fn angle_of_centroids(one: &[Point], middle: &[Point], other: &[Point]) -> Option<f64> {
    if one.is_empty() || middle.is_empty() || other.is_empty() {
        return None;
    }
    let at = centroid(middle);
    let (a, b) = (centroid(one) - at, centroid(other) - at);
    let (a, b) = (a.try_normalize(0.0)?, b.try_normalize(0.0)?);
    // The cosine alone would lose half of the digits near 0 and π.
    Some(math::atan2(a.cross(&b).norm(), a.dot(&b)))
}

/// The angle between domains, in radians, in [0, π]: that at the `middle` of the centroids of all atoms of the names `atoms`
/// in the residues whose numbers lie in the ranges; `None` if there are no such atoms in one of them. Insertion codes make
/// no difference. On adenylate kinase, [`CA`] and [`BACKBONE_AND_CB`] are up to 0.8° apart.
pub fn domain_angle(
    residues: &[Residue],
    one: RangeInclusive<i32>,
    middle: RangeInclusive<i32>,
    other: RangeInclusive<i32>,
    atoms: &[&str],
) -> Option<f64> {
    let [one, middle, other] = [one, middle, other].map(|range| {
        let chosen = residues.iter().filter(|residue| range.contains(&residue.number.number));
        let of_residue = |residue: &Residue| {
            let named = residue.atoms.iter().filter(|atom| atoms.contains(&atom.name.as_str()));
            named.map(|atom| atom.position).collect::<Vec<_>>()
        };
        chosen.flat_map(of_residue).collect::<Vec<_>>()
    });
    angle_of_centroids(&one, &middle, &other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn angles_are_those_at_the_middle_centroid() {
        let middle = [Point::new(1.0, 1.0, 0.0), Point::new(1.0, 1.0, 2.0)];
        let along = |x: f64, y: f64| [Point::new(1.0 + x, 1.0 + y, 1.0)];
        for (x, y, angle) in
            [(2.0, 0.0, 0.0), (0.0, 3.0, PI / 2.0), (-1.0, 0.0, PI), (1.0, -1.0, PI / 4.0)]
        {
            let found = angle_of_centroids(&along(1.0, 0.0), &middle, &along(x, y));
            assert!((found.expect("an angle") - angle).abs() < 1e-15);
        }
        assert_eq!(angle_of_centroids(&along(1.0, 0.0), &middle, &[]), None);
        assert_eq!(angle_of_centroids(&along(0.0, 0.0), &middle, &along(1.0, 0.0)), None);
    }
}
