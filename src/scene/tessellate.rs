//! Shapes as triangles: for drawing, and for cutting them by a plane.

use super::{Shape, box_surface};
use crate::math;
use std::f64::consts::PI;

/// Corners of a circle; a multiple of 4, so that a quarter of a circle is a whole number of steps.
const AROUND: usize = 32;

/// Vertices and, per triangle, the indices of its corners, seen from outside counter-clockwise.
#[derive(Default)]
pub(crate) struct Surface {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

/// The surface of a shape in its own frame, what is round within it; a point becomes a ball of radius `dot`.
pub(crate) fn tessellate(shape: &Shape, dot: f64) -> Surface {
    match shape {
        Shape::Point => capsule(dot, 0.0),
        Shape::Box { size } => {
            let (corners, triangles) = box_surface(*size);
            Surface { vertices: corners.to_vec(), triangles }
        }
        Shape::Sphere { radius } => capsule(*radius, 0.0),
        Shape::Cylinder { radius, height } => {
            let half = height / 2.0;
            turned(&[(0.0, -half), (*radius, -half), (*radius, half), (0.0, half)])
        }
        Shape::Capsule { radius, height } => capsule(*radius, *height),
        Shape::Mesh(mesh) => {
            Surface { vertices: mesh.vertices.clone(), triangles: mesh.faces().collect() }
        }
    }
}

fn capsule(radius: f64, height: f64) -> Surface {
    let quarter = AROUND / 4;
    let arc = |end: f64| {
        (0..=quarter).map(move |i| {
            let angle = PI / 2.0 * i as f64 / quarter as f64;
            (radius * math::cos(angle), end * (height / 2.0 + radius * math::sin(angle)))
        })
    };
    let mut outline: Vec<(f64, f64)> = arc(-1.0).collect();
    outline.reverse();
    outline.extend(arc(1.0).skip(usize::from(height == 0.0)));
    let last = outline.len() - 1;
    (outline[0].0, outline[last].0) = (0.0, 0.0);
    turned(&outline)
}

/// The surface of revolution of an outline about the z axis; the outline is given from bottom to top as distances
/// from the axis and heights.
fn turned(outline: &[(f64, f64)]) -> Surface {
    let mut surface = Surface::default();
    let mut rings: Vec<Vec<u32>> = Vec::new();
    for (radius, z) in outline {
        let corners = if *radius == 0.0 { 1 } else { AROUND };
        let first = surface.vertices.len() as u32;
        for i in 0..corners {
            let angle = math::TURN * i as f64 / AROUND as f64;
            surface.vertices.push([radius * math::cos(angle), radius * math::sin(angle), *z]);
        }
        rings.push((0..AROUND as u32).map(|i| first + i % corners as u32).collect());
    }
    for pair in rings.windows(2) {
        for i in 0..AROUND {
            let next = (i + 1) % AROUND;
            let [a, b, c, d] = [pair[0][i], pair[0][next], pair[1][next], pair[1][i]];
            let halves = [[a, b, c], [a, c, d]];
            let whole = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
            surface.triangles.extend(halves.into_iter().filter(whole));
        }
    }
    surface
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume that a closed surface encloses, positive where it is seen from outside.
    fn volume(surface: &Surface) -> f64 {
        let at = |i: u32| surface.vertices[i as usize];
        let six = surface.triangles.iter().map(|[a, b, c]| {
            let ([ax, ay, az], [bx, by, bz], [cx, cy, cz]) = (at(*a), at(*b), at(*c));
            ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        });
        six.sum::<f64>() / 6.0
    }

    #[test]
    fn surfaces_are_closed_and_hold_the_volume_of_their_shapes() {
        let ball = 4.0 / 3.0 * PI * 8.0;
        for (shape, expected) in [
            (Shape::Box { size: [1.0, 2.0, 3.0] }, 6.0),
            (Shape::Sphere { radius: 2.0 }, ball),
            (Shape::Cylinder { radius: 2.0, height: 3.0 }, 12.0 * PI),
            (Shape::Capsule { radius: 2.0, height: 3.0 }, 12.0 * PI + ball),
            (Shape::Point, ball / 8.0),
        ] {
            let surface = tessellate(&shape, 1.0);
            let volume = volume(&surface);
            assert!(volume > 0.97 * expected && volume < 1.000001 * expected, "{shape:?} {volume}");
            let mut edges = std::collections::BTreeSet::new();
            for [a, b, c] in &surface.triangles {
                for edge in [(a, b), (b, c), (c, a)] {
                    assert!(edges.insert((*edge.0, *edge.1)), "{shape:?}");
                }
            }
            assert!(edges.iter().all(|(a, b)| edges.contains(&(*b, *a))), "{shape:?}");
        }
    }
}
