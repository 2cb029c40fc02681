//! From triangles as stored to a mesh: vertices joined, repeated and flat triangles dropped.

use super::Mesh;
use super::mesh::{faces_of, odd_edges};
use super::raw::RawMesh;
use std::collections::{BTreeMap, BTreeSet};

/// The surface of a file after vertices are joined and before flat triangles are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Surface {
    /// Triangles with different corners, each set of corners counted once.
    pub unique_triangles: usize,
    /// Edges that an odd number of these triangles share. Flat triangles count, since they may close a seam between
    /// neighbours whose corners do not coincide: without them a closed surface would seem open.
    pub odd_edges: usize,
}

impl Mesh {
    /// Joins vertices that are near each other, and drops what is superfluous: of triangles with the same corners all
    /// but the first (many files store both sides), triangles without an area (unless the surface is closed with them
    /// and open without them), and vertices that no triangle uses.
    ///
    /// Each vertex is replaced by the first vertex at most `tolerance` away; a tolerance of 0 joins equal ones only.
    /// The tolerance is a length, after scaling by `scale`, and no share of the mesh's size: the rounding of the
    /// decimals in a file does not grow with the size of what it describes.
    pub(super) fn weld(raw: RawMesh, scale: [f64; 3], tolerance: f64) -> (Mesh, Surface) {
        let scaled = raw.vertices.iter();
        let scaled = scaled.map(|vertex| [0, 1, 2].map(|axis| vertex[axis] * scale[axis] + 0.0));
        let (vertices, welded) =
            if tolerance > 0.0 { join_near(scaled, tolerance) } else { join_equal(scaled) };
        let mut seen = BTreeSet::new();
        let mut triangles = Vec::new();
        for corners in raw.triangles {
            let corners = corners.map(|corner| welded[corner as usize]);
            let mut sorted = corners;
            sorted.sort_unstable();
            if sorted[0] < sorted[1] && sorted[1] < sorted[2] && seen.insert(sorted) {
                triangles.push(corners);
            }
        }
        let surface =
            Surface { unique_triangles: triangles.len(), odd_edges: odd_edges(&triangles) };
        let faces: Vec<[u32; 3]> = faces_of(&vertices, &triangles).collect();
        // Flat triangles stay only where the surface is closed by them and not without them.
        if faces.is_empty() || surface.odd_edges > 0 || odd_edges(&faces) == 0 {
            triangles = faces;
        }
        (without_unused(vertices, triangles), surface)
    }
}

/// The vertices that are left after joining, and for every vertex of the file the index of the one that it became.
type Joined = (Vec<[f64; 3]>, Vec<u32>);

fn join_equal(all: impl Iterator<Item = [f64; 3]>) -> Joined {
    let mut index_of = BTreeMap::new();
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let welded = all
        .map(|vertex| {
            *index_of.entry(vertex.map(f64::to_bits)).or_insert_with(|| {
                vertices.push(vertex);
                vertices.len() as u32 - 1
            })
        })
        .collect();
    (vertices, welded)
}

fn join_near(all: impl Iterator<Item = [f64; 3]>, tolerance: f64) -> Joined {
    // A grid of cubes whose side is the tolerance: vertices within the tolerance lie in the same cube or in
    // neighbouring ones.
    let mut cells: BTreeMap<[u64; 3], Vec<u32>> = BTreeMap::new();
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let key = |cell: [f64; 3]| cell.map(|value| (value + 0.0).to_bits());
    let welded = all
        .map(|vertex| {
            let cell = vertex.map(|value| (value / tolerance).floor());
            let mut first = u32::MAX;
            for beside in 0..27 {
                let step = [beside % 3, beside / 3 % 3, beside / 9].map(|s| f64::from(s) - 1.0);
                let neighbor = [0, 1, 2].map(|axis| cell[axis] + step[axis]);
                for index in cells.get(&key(neighbor)).into_iter().flatten() {
                    if distance_squared(vertices[*index as usize], vertex) <= tolerance * tolerance
                    {
                        first = first.min(*index);
                    }
                }
            }
            if first == u32::MAX {
                first = vertices.len() as u32;
                vertices.push(vertex);
                cells.entry(key(cell)).or_default().push(first);
            }
            first
        })
        .collect();
    (vertices, welded)
}

/// Removes the vertices that no triangle uses.
fn without_unused(vertices: Vec<[f64; 3]>, mut triangles: Vec<[u32; 3]>) -> Mesh {
    let mut used = vec![false; vertices.len()];
    for corner in triangles.iter().flatten() {
        used[*corner as usize] = true;
    }
    let mut kept = 0;
    let new_index: Vec<u32> = used
        .iter()
        .map(|used| {
            kept += u32::from(*used);
            kept.wrapping_sub(1)
        })
        .collect();
    for corner in triangles.iter_mut().flatten() {
        *corner = new_index[*corner as usize];
    }
    let vertices =
        vertices.into_iter().zip(used).filter(|(_, used)| *used).map(|(vertex, _)| vertex);
    Mesh { vertices: vertices.collect(), triangles }
}

fn distance_squared(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
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
        RawMesh { vertices: (0..8).map(corner).collect(), triangles, ..RawMesh::default() }
    }

    #[test]
    fn a_cube_is_closed_and_an_open_box_is_not() {
        let mut mesh = Mesh::weld(cube(0.0), [1.0; 3], 0.0).0;
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
        let mesh = Mesh::weld(raw, [2.0; 3], 0.0).0;
        assert_eq!(mesh.triangles.len(), 24);
        assert_eq!(mesh.witnesses(), [[0.0; 3], [10.0; 3]]);
        assert_eq!(mesh.bounding_box(), ([0.0; 3], [12.0; 3]));
    }

    #[test]
    fn near_vertices_join_the_first_and_unused_ones_go() {
        let mut raw = cube(0.0);
        // Every triangle gets corners of its own, each a little off.
        let own: Vec<[f64; 3]> =
            raw.triangles.iter().flatten().map(|c| raw.vertices[*c as usize]).collect();
        let off = |(i, v): (usize, [f64; 3])| v.map(|x| x + if i > 0 { 4e-7 } else { 0.0 });
        raw.vertices = own.into_iter().enumerate().map(off).collect();
        raw.triangles = (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        raw.vertices.push([9.0; 3]);
        let mesh = Mesh::weld(raw, [1.0; 3], 1e-6).0;
        assert_eq!((mesh.vertices.len(), mesh.vertices[0]), (8, [0.0; 3]));
        assert!(mesh.is_closed());
        assert!(mesh.bounding_box().1[0] < 1.1);
    }

    #[test]
    fn a_flat_triangle_closes_a_seam() {
        // The front is cut from edge to edge at the middle, its neighbour below is not.
        let mut raw = cube(0.0);
        raw.vertices.push([0.5, 0.0, 0.0]);
        let at = raw.triangles.iter().position(|t| t.contains(&0) && t.contains(&1));
        let [a, b, c] = raw.triangles[at.unwrap()];
        let rest = [a, b, c].into_iter().find(|corner| *corner > 1).unwrap();
        raw.triangles[at.unwrap()] = [0, 8, rest];
        raw.triangles.push([8, 1, rest]);
        let (_, open) = Mesh::weld(
            RawMesh {
                vertices: raw.vertices.clone(),
                triangles: raw.triangles.clone(),
                ..RawMesh::default()
            },
            [1.0; 3],
            0.0,
        );
        assert_eq!(open.odd_edges, 3);
        raw.triangles.push([0, 1, 8]);
        let (mesh, closed) = Mesh::weld(raw, [1.0; 3], 0.0);
        assert_eq!((closed.unique_triangles, closed.odd_edges), (14, 0));
        assert_eq!((mesh.triangles.len(), mesh.faces().count()), (14, 13));
        assert!(mesh.is_closed());
        let again = super::super::obj::tests::read_text(&mesh.to_obj());
        assert_eq!(Mesh::weld(again, [1.0; 3], 0.0).0, mesh);
    }
}
