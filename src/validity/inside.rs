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

    /// Parity of the crossings of the ray from `point` along +x. Each edge is judged by the same
    /// arithmetic for both triangles it belongs to, so a ray through an edge or a vertex is
    /// counted consistently and a closed surface never leaks.
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
    for i in 0..3 {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        if (a[2] > z) != (b[2] > z) {
            let (low, high) = if a[2] < b[2] { (a, b) } else { (b, a) };
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

    proptest! {
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
