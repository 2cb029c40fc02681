//! Meshes with fewer triangles, for pictures.

use crate::scene::{Mesh, Surface};
use std::collections::{BTreeMap, BTreeSet};

/// Cells of the finest grid along the longest side of a mesh.
const CELLS_MAX: u32 = 96;

/// A mesh with at most `most` triangles that looks alike, by *vertex clustering* (J. Rossignac and P. Borrel, *Multi-resolution
/// 3D approximations for rendering complex scenes*, 1993): all vertices in one cell of a grid become their mean, and triangles
/// that are left with less than three corners go. The finest grid of a few is taken by which the mesh becomes small enough.
pub(super) fn coarser(mesh: &Mesh, most: usize) -> Surface {
    let mut cells = CELLS_MAX;
    loop {
        let coarse = clustered(mesh, cells);
        if coarse.triangles.len() <= most || cells == 1 {
            return coarse;
        }
        cells = (cells * 3 / 4).max(1);
    }
}

/// The mesh with all vertices of a cell made one, in a grid of so many cells along its longest side.
fn clustered(mesh: &Mesh, cells: u32) -> Surface {
    let (min, max) = mesh.bounding_box();
    let longest = (0..3).map(|axis| max[axis] - min[axis]).fold(0.0, f64::max);
    let size = longest / f64::from(cells);
    let cell_of = |vertex: [f64; 3]| {
        [0, 1, 2].map(|axis| {
            ((vertex[axis] - min[axis]) / size).floor().clamp(0.0, f64::from(cells)) as u32
        })
    };
    let mut clusters: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let mut sums: Vec<([f64; 3], f64)> = Vec::new();
    let mut cluster_of = vec![None; mesh.vertices.len()];
    let (mut seen, mut triangles) = (BTreeSet::new(), Vec::new());
    for corners in mesh.faces() {
        let corners = corners.map(|corner| {
            *cluster_of[corner as usize].get_or_insert_with(|| {
                let vertex = mesh.vertices[corner as usize];
                let next = clusters.len() as u32;
                let cluster = *clusters.entry(cell_of(vertex)).or_insert(next);
                if cluster == next {
                    sums.push(([0.0; 3], 0.0));
                }
                let (sum, count) = &mut sums[cluster as usize];
                (0..3).for_each(|axis| sum[axis] += vertex[axis]);
                *count += 1.0;
                cluster
            })
        });
        let [a, b, c] = corners;
        let mut sorted = corners;
        sorted.sort_unstable();
        if a != b && b != c && c != a && seen.insert(sorted) {
            triangles.push(corners);
        }
    }
    let vertices = sums.into_iter().map(|(sum, count)| sum.map(|value| value / count)).collect();
    let coarse = Mesh { vertices, triangles };
    let triangles = coarse.faces().collect();
    Surface { vertices: coarse.vertices, triangles }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    /// A torus of many triangles, whose hole no convex outline has.
    fn torus(around: u32, along: u32) -> Mesh {
        let mut vertices = Vec::new();
        for i in 0..around {
            for j in 0..along {
                let (u, v) = (f64::from(i) / f64::from(around), f64::from(j) / f64::from(along));
                let (u, v) = (math::TURN * u, math::TURN * v);
                let radius = 3.0 + math::cos(v);
                vertices.push([radius * math::cos(u), radius * math::sin(u), math::sin(v)]);
            }
        }
        let at = |i: u32, j: u32| (i % around) * along + j % along;
        let faces = (0..around).flat_map(|i| {
            (0..along).flat_map(move |j| {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
        });
        Mesh { vertices, triangles: faces.collect() }
    }

    #[test]
    fn a_torus_keeps_its_hole() {
        let mesh = torus(200, 60);
        let coarse = coarser(&mesh, 4000);
        assert!((1000..=4000).contains(&coarse.triangles.len()), "{}", coarse.triangles.len());
        for [x, y, z] in &coarse.vertices {
            let beside = (x * x + y * y).sqrt() - 3.0;
            let from_circle = (beside * beside + z * z).sqrt();
            assert!((0.8..1.05).contains(&from_circle), "{from_circle}");
        }
        assert!(coarser(&mesh, 3).triangles.len() <= 3);
    }
}
