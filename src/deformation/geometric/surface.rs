use crate::deformation::SoftBody;
use crate::scene::tetrahedron;
use parry3d_f64::math::Vector;
use std::collections::BTreeMap;

/// What of the robot's surface is the same for every shape: which vertices are joined, and how far apart they are at rest.
pub(super) struct Surface {
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Their areas at rest.
    pub areas: Vec<f64>,
    /// The edges, each once, the vertex of the smaller index first; ordered by their vertices.
    pub edges: Vec<Edge>,
    /// The mean length of the edges at rest.
    pub mean_edge: f64,
    /// Per vertex its neighbours along edges, and the length of the edge at rest.
    neighbours: Lists<(u32, f64)>,
    /// Per vertex the triangles that have it as a corner.
    triangles_at: Lists<u32>,
    /// Per vertex the number of the connected piece of the surface that it belongs to; `None` of one that no triangle has.
    pub pieces: Vec<Option<usize>>,
    /// Per piece the number of its vertices.
    pub piece_sizes: Vec<usize>,
    /// Per piece its first vertex.
    pub first_vertices: Vec<u32>,
}

/// An edge of the surface.
pub(super) struct Edge {
    /// Its vertices.
    pub ends: [u32; 2],
    /// Its length at rest.
    pub length: f64,
}

impl Surface {
    pub fn new(body: &SoftBody) -> Surface {
        let (vertices, triangles) = (body.vertices(), body.triangles());
        let mut lengths = BTreeMap::new();
        for [a, b, c] in triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let ends = [*from.min(to), *from.max(to)];
                lengths.entry(ends).or_insert_with(|| {
                    let [p, q] = ends.map(|end| vertices[end as usize]);
                    (0..3).map(|axis| (p[axis] - q[axis]) * (p[axis] - q[axis])).sum::<f64>().sqrt()
                });
            }
        }
        let edges: Vec<Edge> =
            lengths.into_iter().map(|(ends, length)| Edge { ends, length }).collect();
        let both_ways = edges.iter().flat_map(|edge| {
            let [a, b] = edge.ends;
            [(a, (b, edge.length)), (b, (a, edge.length))]
        });
        let corners = triangles
            .iter()
            .zip(0u32..)
            .flat_map(|(corners, index)| corners.iter().map(move |corner| (*corner, index)));
        let pieces = body.mesh().pieces();
        let (mut piece_sizes, mut first_vertices) = (Vec::new(), Vec::new());
        for (vertex, piece) in (0u32..).zip(&pieces) {
            let Some(piece) = *piece else { continue };
            if piece == piece_sizes.len() {
                piece_sizes.push(0);
                first_vertices.push(vertex);
            }
            piece_sizes[piece] += 1;
        }
        let sum: f64 = edges.iter().map(|edge| edge.length).sum();
        Surface {
            mean_edge: sum / edges.len() as f64,
            neighbours: Lists::new(vertices.len(), both_ways.collect()),
            triangles_at: Lists::new(vertices.len(), corners.collect()),
            areas: triangles
                .iter()
                .map(|corners| area(corners.map(|corner| vertices[corner as usize])))
                .collect(),
            triangles: triangles.to_vec(),
            edges,
            pieces,
            piece_sizes,
            first_vertices,
        }
    }

    /// The volume that each piece encloses in a shape with these vertices; negative if its triangles are wound inward.
    pub fn volumes(&self, shape: &[Vector]) -> Vec<f64> {
        let mut volumes = vec![0.0; self.first_vertices.len()];
        for corners in &self.triangles {
            let Some(piece) = self.pieces[corners[0] as usize] else { continue };
            let at = |vertex: u32| shape[vertex as usize].to_array();
            let first = at(self.first_vertices[piece]);
            volumes[piece] += tetrahedron(first, corners.map(at)) / 6.0;
        }
        volumes
    }

    /// The neighbours of a vertex along edges, and the lengths of the edges at rest.
    pub fn neighbours(&self, vertex: u32) -> &[(u32, f64)] {
        self.neighbours.of(vertex)
    }

    /// The triangles that have one of the vertices as a corner, in ascending order, each once.
    pub fn triangles_around(&self, vertices: impl Iterator<Item = u32>) -> Vec<u32> {
        let mut around: Vec<u32> =
            vertices.flat_map(|vertex| self.triangles_at.of(vertex)).copied().collect();
        around.sort_unstable();
        around.dedup();
        around
    }

    /// The corners of some triangles, in ascending order, each once.
    pub fn corners_of(&self, triangles: &[u32]) -> Vec<u32> {
        let mut corners: Vec<u32> =
            triangles.iter().flat_map(|index| self.triangles[*index as usize]).collect();
        corners.sort_unstable();
        corners.dedup();
        corners
    }
}

fn area(corners: [[f64; 3]; 3]) -> f64 {
    let [a, b, c] = corners.map(Vector::from_array);
    let across = (b - a).cross(c - a);
    across.dot(across).sqrt() / 2.0
}

/// A list per vertex, one after another in one vector.
struct Lists<T> {
    starts: Vec<usize>,
    items: Vec<T>,
}

impl<T> Lists<T> {
    /// Items in the order given, each with the vertex whose list it is in.
    fn new(vertices: usize, mut items: Vec<(u32, T)>) -> Lists<T> {
        items.sort_by_key(|(vertex, _)| *vertex);
        let mut starts = vec![0; vertices + 1];
        for (vertex, _) in &items {
            starts[*vertex as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            starts[vertex + 1] += starts[vertex];
        }
        Lists { starts, items: items.into_iter().map(|(_, item)| item).collect() }
    }

    fn of(&self, vertex: u32) -> &[T] {
        let vertex = vertex as usize;
        &self.items[self.starts[vertex]..self.starts[vertex + 1]]
    }
}
