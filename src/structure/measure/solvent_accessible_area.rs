//! The area that a probe's centre can reach when the probe rolls over the atoms.
//!
//! A. Shrake & J. A. Rupley, *Environment and exposure to solvent of protein atoms*, J. Mol. Biol. 79 (1973) 351: points are
//! spread evenly over a sphere around each atom, with the radius of atom and probe together, and those inside no other
//! atom's sphere are counted. The points lie on a golden spiral: point k of n at the height (2 k + 1) / n − 1 and the angle
//! k π (3 − √5), so all stand for equal areas.

use super::cells::Cells;
use crate::math;
use crate::structure::{Atom, Point};
use std::f64::consts::PI;

/// What the area is measured with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Its radius in Å: 1.4 is that of water.
    pub radius: f64,
    /// How many points stand for the sphere of each atom. 960 give the area of a protein to a few parts in a thousand.
    pub points: usize,
}

/// Water, with 960 points.
impl Default for Probe {
    fn default() -> Probe {
        Probe { radius: 1.4, points: 960 }
    }
}

/// An element whose radius is not known.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the radius of an atom of the element '{0}' is not known")]
pub struct NoRadius(pub String);

/// The solvent-accessible area of each atom in Å², all others in its way. Sums of them are the areas of residues and of
/// molecules; whether hydrogens, ligands and waters count is for the caller to say by leaving them out.
///
/// An atom at a place that is not finite has the area of a free sphere and is in nobody's way. The time grows as atoms ×
/// points × neighbours.
///
/// # Errors
///
/// An element has no [`van_der_waals_radius`].
pub fn solvent_accessible_areas(atoms: &[&Atom], probe: Probe) -> Result<Vec<f64>, NoRadius> {
    let reach = |atom: &&Atom| {
        let radius = van_der_waals_radius(&atom.element);
        Ok(radius.ok_or_else(|| NoRadius(atom.element.clone()))? + probe.radius)
    };
    let reaches = atoms.iter().map(reach).collect::<Result<Vec<f64>, _>>()?;
    let positions: Vec<Point> = atoms.iter().map(|atom| atom.position).collect();
    Ok(accessible_areas(&positions, &reaches, probe.points))
}

/// The area of each sphere that lies in none of the others, in Å², given centres and radii in Å, by this many points.
fn accessible_areas(centres: &[Point], radii: &[f64], points: usize) -> Vec<f64> {
    let sphere = golden_spiral(points);
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let cells = Cells::new(centres.iter().copied(), (2.0 * largest).max(1e-3));
    let mut neighbours: Vec<(f64, usize)> = Vec::new();
    let area = |(i, (centre, radius)): (usize, (&Point, &f64))| {
        neighbours.clear();
        cells.near(centre, |j| {
            let distance = (centres[j] - centre).norm();
            if j != i && distance < radius + radii[j] {
                neighbours.push((distance, j));
            }
        });
        // The nearest hide the most; and a point is likely to be hidden by what hid the one before it.
        neighbours.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut hidden_by = 0;
        let mut is_free = |direction: &&Point| {
            let place = centre + **direction * *radius;
            let hides = |(_, j): &(f64, usize)| {
                (place - centres[*j]).norm_squared() < radii[*j] * radii[*j]
            };
            let (before, from) = neighbours.split_at(hidden_by);
            if let Some(at) = from.iter().position(hides) {
                hidden_by += at;
                return false;
            }
            if let Some(at) = before.iter().position(hides) {
                hidden_by = at;
                return false;
            }
            true
        };
        let free = sphere.iter().filter(|direction| is_free(direction)).count();
        4.0 * PI * radius * radius * free as f64 / points.max(1) as f64
    };
    centres.iter().zip(radii).enumerate().map(area).collect()
}

/// Directions spread evenly.
fn golden_spiral(count: usize) -> Vec<Point> {
    let turn = PI * (3.0 - 5f64.sqrt());
    let direction = |k: usize| {
        let height = (2 * k + 1) as f64 / count as f64 - 1.0;
        let radius = (1.0 - height * height).max(0.0).sqrt();
        let angle = k as f64 * turn;
        Point::new(math::cos(angle) * radius, height, math::sin(angle) * radius)
    };
    (0..count).map(direction).collect()
}

/// The radius of an element's atoms in Å, for the elements of proteins and of what is often bound to them. The symbol is
/// written as in the periodic table.
///
/// Van der Waals radii of A. Bondi, J. Phys. Chem. 68 (1964) 441, hydrogen and others as M. Mantina et al., J. Phys. Chem. A
/// 113 (2009) 5806 give them; for sodium, magnesium, potassium, calcium, chlorine ionic radii of R. D. Shannon, Acta
/// Cryst. A 32 (1976) 751, and 2 Å for metals of which neither is known. That is the table of mdtraj, so that areas can be
/// compared.
pub fn van_der_waals_radius(element: &str) -> Option<f64> {
    Some(match element {
        "H" | "D" => 1.20,
        "C" => 1.70,
        "N" => 1.55,
        "O" => 1.52,
        "F" => 1.47,
        "Na" => 1.02,
        "Mg" => 0.86,
        "P" => 1.80,
        "S" => 1.80,
        "Cl" => 1.81,
        "K" => 1.38,
        "Ca" => 1.14,
        "Mn" | "Fe" | "Co" => 2.00,
        "Ni" => 1.63,
        "Cu" => 1.40,
        "Zn" => 1.39,
        "Se" => 1.90,
        "Br" => 1.85,
        "I" => 1.98,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_of_one_sphere_and_of_two_is_known() {
        let free = accessible_areas(&[Point::x()], &[3.0], 960);
        assert!((free[0] - 4.0 * PI * 9.0).abs() < 1e-12);
        // A cap of height h is missing of each, 2 π R h.
        for (distance, radii) in [(4.0, [3.0, 3.0]), (3.2, [3.1, 2.6]), (0.9, [3.0, 2.5])] {
            let centres = [
                Point::new(0.3, 0.2, 0.1),
                Point::new(0.3, 0.2, 0.1) + Point::new(0.6, 0.0, 0.8) * distance,
            ];
            let found = accessible_areas(&centres, &radii, 20_000);
            for (i, [r, s]) in [[radii[0], radii[1]], [radii[1], radii[0]]].into_iter().enumerate()
            {
                let height = r - (distance * distance + r * r - s * s) / (2.0 * distance);
                let expected: f64 = 2.0 * PI * r * (2.0 * r - height);
                let error = (found[i] - expected).abs() / (4.0 * PI * r * r);
                assert!(error < 1e-3, "{distance} {i}: {} {expected}", found[i]);
            }
        }
        // One inside another, and two at one place, where neither hides the other since both are as large.
        assert_eq!(accessible_areas(&[Point::x(), Point::x() * 1.5], &[1.0, 3.0], 99)[0], 0.0);
    }

    #[test]
    fn hidden_points_are_those_that_looking_at_all_spheres_finds() {
        let mut centres = Vec::new();
        for i in 0..150 {
            let angle = f64::from(i);
            centres.push(
                Point::new(math::sin(angle * 1.3), math::cos(angle * 2.1), math::sin(angle * 0.7))
                    * 9.0,
            );
        }
        let radii: Vec<f64> = (0..150).map(|i| 2.0 + f64::from(i % 7) * 0.2).collect();
        let found = accessible_areas(&centres, &radii, 120);
        let sphere = golden_spiral(120);
        for i in 0..150 {
            let is_free = |d: &&Point| {
                let place = centres[i] + **d * radii[i];
                (0..150)
                    .all(|j| j == i || (place - centres[j]).norm_squared() >= radii[j] * radii[j])
            };
            let free = sphere.iter().filter(is_free).count() as f64;
            assert_eq!(found[i], 4.0 * PI * radii[i] * radii[i] * free / 120.0);
        }
    }

    #[test]
    fn directions_are_spread_evenly() {
        let sphere = golden_spiral(960);
        assert!(sphere.iter().all(|direction| (direction.norm() - 1.0).abs() < 1e-15));
        assert!(sphere.iter().sum::<Point>().norm() / 960.0 < 1e-3);
        assert!(golden_spiral(0).is_empty());
    }

    #[test]
    fn what_cannot_be_measured_is_said_or_stands_free() {
        let atom = |element: &str, x: f64| Atom {
            name: "X".to_owned(),
            element: element.to_owned(),
            position: Point::x() * x,
        };
        let odd = atom("Uuo", 0.0);
        let error = solvent_accessible_areas(&[&odd], Probe::default()).expect_err("no radius");
        assert!(error.to_string().contains("'Uuo'"));
        let (nowhere, carbon) = (atom("C", f64::NAN), atom("C", 0.0));
        let areas = solvent_accessible_areas(&[&nowhere, &carbon], Probe::default());
        let areas = areas.expect("both are known");
        assert!(areas.iter().all(|area| (area - 4.0 * PI * 3.1 * 3.1).abs() < 1e-12));
        let none = Probe { radius: 1.4, points: 0 };
        assert_eq!(solvent_accessible_areas(&[&carbon], none), Ok(vec![0.0]));
    }
}
