//! How far a body reaches from its centre.

use super::superposition::{centroid, root_mean};
use crate::structure::{Atom, Point};

/// The radius of gyration of points that all count alike, in Å: the root of the mean squared distance from the centroid;
/// 0 if there are none.
pub fn radius_of_gyration(points: &[Point]) -> f64 {
    let centre = centroid(points);
    root_mean(points.iter().map(|point| (point - centre).norm_squared()).sum(), points.len())
}

/// The radius of gyration by mass, in Å: the root of the mean squared distance from the centre of mass, in both of which
/// each atom counts by its [`mass`]. That is what is compared with scattering, apart from the shell of water.
///
/// `None` if the mass of an atom's element is not in the table, or there are no atoms.
pub fn radius_of_gyration_by_mass<'a>(atoms: impl IntoIterator<Item = &'a Atom>) -> Option<f64> {
    let weighed: Option<Vec<(Point, f64)>> =
        atoms.into_iter().map(|atom| Some((atom.position, mass(&atom.element)?))).collect();
    let weighed = weighed.filter(|weighed| !weighed.is_empty())?;
    let total: f64 = weighed.iter().map(|(_, mass)| mass).sum();
    let moment = weighed.iter().fold(Point::zeros(), |sum, (point, mass)| sum + point * *mass);
    let centre = moment / total;
    let squares: f64 = weighed.iter().map(|(p, mass)| (p - centre).norm_squared() * mass).sum();
    Some((squares / total).sqrt())
}

/// The mean mass of an element's atoms in daltons, for the elements of proteins and of what is often bound to them:
/// standard atomic weights, abridged, of IUPAC (T. Prohaska et al., Pure Appl. Chem. 94 (2022) 573). The symbol is written as
/// in the periodic table.
pub fn mass(element: &str) -> Option<f64> {
    Some(match element {
        "H" => 1.008,
        "D" => 2.014,
        "C" => 12.011,
        "N" => 14.007,
        "O" => 15.999,
        "F" => 18.998,
        "Na" => 22.990,
        "Mg" => 24.305,
        "P" => 30.974,
        "S" => 32.06,
        "Cl" => 35.45,
        "K" => 39.098,
        "Ca" => 40.078,
        "Mn" => 54.938,
        "Fe" => 55.845,
        "Co" => 58.933,
        "Ni" => 58.693,
        "Cu" => 63.546,
        "Zn" => 65.38,
        "Se" => 78.971,
        "Br" => 79.904,
        "I" => 126.90,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn atom(element: &str, x: f64) -> Atom {
        let position = Point::new(x, 7.0, -3.0);
        Atom { name: element.to_owned(), element: element.to_owned(), position }
    }

    #[test]
    fn a_pair_reaches_half_its_length() {
        let pair = [Point::new(1.0, 2.0, 3.0), Point::new(1.0, 2.0, 7.0)];
        assert_eq!(radius_of_gyration(&pair), 2.0);
        assert_eq!((radius_of_gyration(&pair[..1]), radius_of_gyration(&[])), (0.0, 0.0));
    }

    #[test]
    fn heavy_atoms_count_more() {
        // Two masses a distance apart: distance √(m₁ m₂) / (m₁ + m₂).
        let expected = 4.0 * (12.011 * 32.06f64).sqrt() / (12.011 + 32.06);
        let found = radius_of_gyration_by_mass(&[atom("C", 1.0), atom("S", 5.0)]);
        assert!((found.expect("both are known") - expected).abs() < 1e-14);
        let alike = radius_of_gyration_by_mass(&[atom("Ca", 1.0), atom("Ca", 5.0)]);
        assert!((alike.expect("it is known") - 2.0).abs() < 1e-14);
        assert_eq!(radius_of_gyration_by_mass(&[atom("C", 1.0), atom("Xx", 5.0)]), None);
        assert_eq!(radius_of_gyration_by_mass([]), None);
    }
}
