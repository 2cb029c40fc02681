//! Triangle meshes: what is kept of a file, and whether it encloses anything.

use bincode::{Decode, Encode};
use petgraph::unionfind::UnionFind;
use std::collections::BTreeMap;

/// A triangle mesh: welded vertices, and triangles. No two triangles have the same corners, but for walls with material
/// on either side, which are there twice, once for each side, so that the surface is closed.
///
/// Triangles have an area, with one exception: flat triangles, whose corners lie in a line, are kept where they close
/// the seam between neighbours whose corners do not coincide, as without them the surface would not be closed.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Mesh {
    /// Vertices `x y z` in the mesh's frame.
    pub vertices: Vec<[f64; 3]>,
    /// Corners of the triangles: indices of vertices.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The triangles that have an area: the surface. A flat triangle lies on the edges of these, so that whatever
    /// meets it meets one of them.
    pub fn faces(&self) -> impl Iterator<Item = [u32; 3]> {
        faces_of(&self.vertices, &self.triangles)
    }

    /// Number of edges that an odd number of triangles share: 0 for a closed surface.
    pub fn odd_edges(&self) -> usize {
        odd_edges(&self.triangles)
    }

    /// Number of edges along which triangles are not turned the same way: walked in one direction more often than in the other, where every
    /// triangle is walked around counter-clockwise. 0 for a closed surface that tells inside from outside.
    pub fn unevenly_turned_edges(&self) -> usize {
        let mut walked = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let along = if from < to { 1i64 } else { -1 };
                *walked.entry((from.min(to), from.max(to))).or_insert(0) += along;
            }
        }
        walked.values().filter(|sum| **sum != 0).count()
    }

    /// Whether the surface is closed, so that it has an inside.
    pub fn is_closed(&self) -> bool {
        self.odd_edges() == 0
    }

    /// Why the mesh is not the surface of something solid, if it is not: it is open, or inside and outside cannot be told.
    pub fn surface_complaint(&self) -> Option<String> {
        match (self.odd_edges(), self.unevenly_turned_edges()) {
            (0, 0) => None,
            (0, uneven) => Some(format!(
                "a mesh with {uneven} edges along which triangles are not turned the same way found; triangles all counter-clockwise, seen from outside, expected"
            )),
            (open, _) => {
                Some(format!("a mesh with {open} open edges found; a closed mesh expected"))
            }
        }
    }

    /// A point of each connected piece of the surface: its first vertex. Pieces are connected by vertices
    /// in common.
    pub(crate) fn witnesses(&self) -> Vec<[f64; 3]> {
        self.first_vertices().into_iter().map(|index| self.vertices[index as usize]).collect()
    }

    /// The first vertex of each connected piece of the surface, by its number.
    pub(crate) fn first_vertices(&self) -> Vec<u32> {
        let mut first = Vec::new();
        for (vertex, piece) in (0u32..).zip(self.pieces()) {
            if piece == Some(first.len()) {
                first.push(vertex);
            }
        }
        first
    }

    /// Per vertex the number of the connected piece of the surface that it belongs to, in the order of the pieces' first
    /// vertices; `None` of one that no triangle has.
    pub(crate) fn pieces(&self) -> Vec<Option<usize>> {
        let mut pieces = UnionFind::new(self.vertices.len());
        let mut used = vec![false; self.vertices.len()];
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| corner as usize);
            pieces.union(a, b);
            pieces.union(a, c);
            for corner in [a, b, c] {
                used[corner] = true;
            }
        }
        let mut numbers = BTreeMap::new();
        let labels: Vec<usize> = pieces.into_labeling();
        let number = |(label, used): (usize, bool)| {
            let next = numbers.len();
            used.then(|| *numbers.entry(label).or_insert(next))
        };
        labels.into_iter().zip(used).map(number).collect()
    }

    /// The volume that each connected piece encloses, in the order of [`Mesh::pieces`]; below 0 where its triangles are turned inward.
    pub(crate) fn volumes(&self) -> Vec<f64> {
        let (pieces, first) = (self.pieces(), self.first_vertices());
        let mut volumes = vec![0.0; first.len()];
        for corners in &self.triangles {
            let Some(piece) = pieces[corners[0] as usize] else { continue };
            let at = |vertex: u32| self.vertices[vertex as usize];
            volumes[piece] += tetrahedron(at(first[piece]), corners.map(at)) / 6.0;
        }
        volumes
    }

    /// The diagonal of the box around the triangles, a length; 0 if there are none.
    pub(super) fn size(&self) -> f64 {
        if self.triangles.is_empty() {
            return 0.0;
        }
        let (min, max) = self.bounding_box();
        (0..3).map(|axis| (max[axis] - min[axis]) * (max[axis] - min[axis])).sum::<f64>().sqrt()
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

/// Six times the volume of the tetrahedron that a triangle spans with a point. It is above 0 where the point is behind the triangle, whose
/// corners are seen counter-clockwise from the front. Summed over a closed surface it is six times the enclosed volume, whatever the point;
/// one near the surface loses least to rounding.
pub(crate) fn tetrahedron(point: [f64; 3], corners: [[f64; 3]; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| [0, 1, 2].map(|axis| corner[axis] - point[axis]));
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Number of edges that an odd number of the triangles share.
pub(super) fn odd_edges(triangles: &[[u32; 3]]) -> usize {
    let mut count_of = BTreeMap::new();
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *count_of.entry((from.min(to), from.max(to))).or_insert(0u32) += 1;
        }
    }
    count_of.values().filter(|count| **count % 2 == 1).count()
}

/// The triangles that have an area.
pub(super) fn faces_of(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
) -> impl Iterator<Item = [u32; 3]> {
    triangles.iter().copied().filter(|corners| {
        let [a, b, c] = corners.map(|corner| vertices[corner as usize]);
        area_squared(a, b, c) > 0.0
    })
}

fn area_squared(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    n[0] * n[0] + n[1] * n[1] + n[2] * n[2]
}
