//! Whether a point lies inside a closed surface.

use crate::scene::Mesh;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy};

/// A closed surface prepared for containment tests.
#[derive(Debug)]
pub(super) struct Inside {
    triangles: Vec<[[f64; 3]; 3]>,
    tree: Bvh,
}

impl Inside {
    pub(super) fn new(mesh: &Mesh) -> Inside {
        let triangles: Vec<_> = mesh
            .triangles
            .iter()
            .map(|corners| corners.map(|corner| mesh.vertices[corner as usize]))
            .collect();
        let boxes: Vec<Aabb> = triangles
            .iter()
            .map(|corners| Aabb::from_points(corners.iter().map(|p| Vector::from_array(*p))))
            .collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        Inside { triangles, tree }
    }

    /// Whether the surface encloses `point`: whether the ray from it along +x crosses an odd number of triangles.
    ///
    /// An edge is judged by the same arithmetic for each triangle that it belongs to, so that a ray through an edge
    /// or a vertex is counted consistently. Flat triangles that close a seam count like all others: where rounding
    /// opens a gap between the two sides of a seam, they cover it.
    pub(super) fn contains(&self, point: Vector) -> bool {
        let [x, y, z] = point.to_array();
        let ray_meets = |node: &parry3d_f64::partitioning::BvhNode| {
            let (min, max) = (node.mins(), node.maxs());
            max.x >= x && min.y <= y && y <= max.y && min.z <= z && z <= max.z
        };
        let crossings = self
            .tree
            .leaves(ray_meets)
            .filter(|leaf| crosses(&self.triangles[*leaf as usize], [x, y, z]))
            .count();
        crossings % 2 == 1
    }
}

/// Whether the ray from `point` along +x crosses the triangle.
fn crosses(corners: &[[f64; 3]; 3], [x, y, z]: [f64; 3]) -> bool {
    // Even–odd rule in the y–z plane, half open in z.
    let mut covered = false;
    let mut at_height = x;
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if (a[2] > z) != (b[2] > z) {
            let (low, high) = if a[2] < b[2] { (a, b) } else { (b, a) };
            at_height = low[0] + (z - low[2]) / (high[2] - low[2]) * (high[0] - low[0]);
            let side = (high[1] - low[1]) * (z - low[2]) - (y - low[1]) * (high[2] - low[2]);
            if side > 0.0 {
                covered = !covered;
            }
        }
    }
    if !covered {
        return false;
    }
    let [a, b, c] = corners;
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    if normal == [0.0; 3] {
        // A flat triangle: all of it is on a line, which crosses the ray's height at `at_height`.
        return at_height > x;
    }
    // Where the line meets the triangle's plane: normal · (p − a) = 0, solved for x.
    let ahead = normal[1] * (y - a[1]) + normal[2] * (z - a[2]) + normal[0] * (x - a[0]);
    if normal[0] > 0.0 { ahead < 0.0 } else { ahead > 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn octahedron() -> Mesh {
        let vertices = [
            [1.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ];
        let mut triangles = Vec::new();
        for x in [0, 1] {
            for y in [2, 3] {
                for z in [4, 5] {
                    triangles.push([x, y, z]);
                }
            }
        }
        Mesh { vertices: vertices.to_vec(), triangles }
    }

    /// A box 1 by 1 by `height` whose face at x = 0 is cut along its diagonal, on one side in the middle
    /// too; a flat triangle lies between.
    fn box_with_a_seam(share: f64, height: f64) -> Mesh {
        let corner = |i: usize| [(i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64 * height];
        let mut vertices: Vec<[f64; 3]> = (0..8).map(corner).collect();
        vertices.push([0.0, share, share * height]);
        let triangles = vec![
            [0, 2, 6],
            [0, 4, 8],
            [8, 4, 6],
            [0, 8, 6],
            [1, 3, 7],
            [1, 5, 7],
            [0, 1, 5],
            [0, 4, 5],
            [2, 3, 7],
            [2, 6, 7],
            [0, 1, 3],
            [0, 2, 3],
            [4, 5, 7],
            [4, 6, 7],
        ];
        Mesh { vertices, triangles }
    }

    proptest! {
        /// Rays that run along the seam, through it and beside it.
        #[test]
        fn a_seam_that_flat_triangles_close_does_not_leak(
            share in 0.01f64..0.99, height in 0.5f64..4.0, along in -0.1f64..1.1, x in -1.0f64..2.0,
            off in prop::sample::select(vec![-1e-16, 0.0, 1e-16, 1e-3]),
        ) {
            let mesh = box_with_a_seam(share, height);
            prop_assert!(mesh.is_closed());
            prop_assume!(x.abs() > 1e-9 && (x - 1.0).abs() > 1e-9);
            prop_assume!(along.abs() > 1e-9 && (along - 1.0).abs() > 1e-9);
            let point = Vector::new(x, along + off, along * height);
            let unit = 0.0..1.0;
            let expected = unit.contains(&x) && unit.contains(&point.y) && unit.contains(&along);
            prop_assert_eq!(Inside::new(&mesh).contains(point), expected);
        }

        #[test]
        fn an_octahedron_contains_what_it_should(x in -1.2f64..1.2, y in -1.2f64..1.2, z in -1.2f64..1.2) {
            let norm = x.abs() + y.abs() + z.abs();
            prop_assume!((norm - 1.0).abs() > 1e-9);
            let inside = Inside::new(&octahedron());
            prop_assert_eq!(inside.contains(Vector::new(x, y, z)), norm < 1.0);
        }

        #[test]
        fn rays_through_edges_and_corners_do_not_leak(x in -1.2f64..1.2, y in 0usize..3, z in 0usize..3) {
            let levels = [-0.5, 0.0, 0.5];
            let (y, z) = (levels[y], levels[z]);
            let norm = x.abs() + f64::abs(y) + f64::abs(z);
            prop_assume!((norm - 1.0).abs() > 1e-9);
            prop_assert_eq!(Inside::new(&octahedron()).contains(Vector::new(x, y, z)), norm < 1.0);
        }
    }
}
