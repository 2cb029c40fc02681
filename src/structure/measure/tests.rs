//! Chains of ideal geometry for the tests of the measures.

use crate::math;
use crate::structure::{AminoAcid, Atom, Point, Residue, ResidueNumber};
use std::f64::consts::PI;

/// The atom that continues a chain a–b–c at a distance from c (Å), an angle b–c–d and a dihedral a–b–c–d (degrees).
fn next(a: Point, b: Point, c: Point, [length, angle, dihedral]: [f64; 3]) -> Point {
    let (angle, dihedral) = (angle / 180.0 * PI, dihedral / 180.0 * PI);
    let along = (c - b).normalize();
    let normal = (b - a).cross(&along).normalize();
    let side = normal.cross(&along);
    let across = side * math::cos(dihedral) + normal * math::sin(dihedral);
    c + (across * math::sin(angle) - along * math::cos(angle)) * length
}

/// Alanines without side chains, at the bond lengths and angles of R. A. Engh & R. Huber (1991), with every phi and psi
/// the same, in degrees, and omega 180°.
pub fn ideal_chain(count: usize, phi: f64, psi: f64) -> Vec<Residue> {
    let mut n = Point::new(0.0, 0.0, 0.0);
    let mut ca = Point::new(1.458, 0.0, 0.0);
    let mut c = next(Point::new(0.0, 1.0, 0.0), n, ca, [1.525, 111.0, phi]);
    let mut residues = Vec::new();
    for number in 1..=count {
        let next_n = next(n, ca, c, [1.329, 117.2, psi]);
        let o = next(n, ca, c, [1.231, 120.1, psi + 180.0]);
        let named = [("N", n), ("CA", ca), ("C", c), ("O", o)];
        let atom = |(name, position): (&str, Point)| Atom {
            name: name.to_owned(),
            element: name[..1].to_owned(),
            position,
        };
        residues.push(Residue {
            number: ResidueNumber { number: number as i32, insertion: None },
            name: "ALA".to_owned(),
            amino_acid: Some(AminoAcid::Alanine),
            atoms: named.map(atom).into(),
        });
        let next_ca = next(ca, c, next_n, [1.458, 121.7, 180.0]);
        let next_c = next(c, next_n, next_ca, [1.525, 111.0, phi]);
        (n, ca, c) = (next_n, next_ca, next_c);
    }
    residues
}
