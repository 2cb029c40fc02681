//! Triangle meshes: what is kept of a file, and whether it encloses anything.

use super::raw::RawMesh;
use bincode::{Decode, Encode};
use std::collections::BTreeMap;

/// A triangle mesh: welded vertices and unique triangles with an area.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Mesh {
    /// Vertices `x y z` in the mesh's frame.
    pub vertices: Vec<[f64; 3]>,
    /// Corners of the triangles: indices of vertices.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Joins equal vertices, drops triangles without area and all but the first of triangles
    /// with the same corners (many files store both sides).
    pub(super) fn weld(raw: RawMesh, scale: f64) -> Mesh {
        let mut index_of = BTreeMap::new();
        let mut vertices: Vec<[f64; 3]> = Vec::new();
        let welded: Vec<u32> = raw
            .vertices
            .iter()
            .map(|vertex| {
                let vertex = vertex.map(|value| value * scale + 0.0);
                *index_of.entry(vertex.map(f64::to_bits)).or_insert_with(|| {
                    vertices.push(vertex);
                    vertices.len() as u32 - 1
                })
            })
            .collect();
        let mut seen = std::collections::BTreeSet::new();
        let mut triangles = Vec::new();
        for corners in raw.triangles {
            let corners = corners.map(|corner| welded[corner as usize]);
            let mut sorted = corners;
            sorted.sort_unstable();
            let [a, b, c] = corners.map(|corner| vertices[corner as usize]);
            if area_squared(a, b, c) > 0.0 && seen.insert(sorted) {
                triangles.push(corners);
            }
        }
        Mesh { vertices, triangles }
    }

    /// Number of edges that an odd number of triangles share: 0 for a closed surface.
    pub fn odd_edges(&self) -> usize {
        let mut count_of = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *count_of.entry((from.min(to), from.max(to))).or_insert(0u32) += 1;
            }
        }
        count_of.values().filter(|count| **count % 2 == 1).count()
    }

    /// Whether the surface is closed, so that it has an inside.
    pub fn is_closed(&self) -> bool {
        self.odd_edges() == 0
    }

    /// The first vertex of each connected piece of the surface.
    pub(crate) fn witnesses(&self) -> Vec<[f64; 3]> {
        let mut piece: Vec<u32> = (0..self.vertices.len() as u32).collect();
        fn root(piece: &mut [u32], mut i: u32) -> u32 {
            while piece[i as usize] != i {
                piece[i as usize] = piece[piece[i as usize] as usize];
                i = piece[i as usize];
            }
            i
        }
        let mut used = vec![false; self.vertices.len()];
        for corners in &self.triangles {
            let roots = corners.map(|corner| root(&mut piece, corner));
            let least = roots[0].min(roots[1]).min(roots[2]);
            for other in roots {
                piece[other as usize] = least;
            }
            for corner in corners {
                used[*corner as usize] = true;
            }
        }
        let mut seen = std::collections::BTreeSet::new();
        (0..self.vertices.len() as u32)
            .filter(|i| used[*i as usize] && seen.insert(root(&mut piece, *i)))
            .map(|i| self.vertices[i as usize])
            .collect()
    }

    /// Least and largest coordinates.
    pub fn bounding_box(&self) -> ([f64; 3], [f64; 3]) {
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in self.triangles.iter().flatten() {
            for (axis, value) in self.vertices[*corner as usize].into_iter().enumerate() {
                min[axis] = min[axis].min(value);
                max[axis] = max[axis].max(value);
            }
        }
        (min, max)
    }
}

fn area_squared(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    n[0] * n[0] + n[1] * n[1] + n[2] * n[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(offset: f64) -> RawMesh {
        let corner = |i: usize| [0, 1, 2].map(|axis| (i >> axis & 1) as f64 + offset);
        let quads =
            [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let triangles =
            quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        RawMesh { vertices: (0..8).map(corner).collect(), triangles }
    }

    #[test]
    fn a_cube_is_closed_and_an_open_box_is_not() {
        let mut mesh = Mesh::weld(cube(0.0), 1.0);
        assert!(mesh.is_closed());
        mesh.triangles.truncate(10);
        assert_eq!(mesh.odd_edges(), 4);
    }

    #[test]
    fn doubled_and_flat_triangles_are_dropped_and_pieces_told_apart() {
        let (mut raw, other) = (cube(0.0), cube(5.0));
        raw.triangles.extend(raw.triangles.clone().into_iter().map(|[a, b, c]| [a, c, b]));
        raw.triangles.push([0, 0, 1]);
        raw.vertices.extend(other.vertices);
        raw.triangles.extend(other.triangles.iter().map(|corners| corners.map(|c| c + 8)));
        let mesh = Mesh::weld(raw, 2.0);
        assert_eq!(mesh.triangles.len(), 24);
        assert_eq!(mesh.witnesses(), [[0.0; 3], [10.0; 3]]);
        assert_eq!(mesh.bounding_box(), ([0.0; 3], [12.0; 3]));
    }
}
