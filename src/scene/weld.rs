//! From triangles as stored to a mesh: vertices joined, repeated and flat triangles dropped.

use super::Mesh;
use super::closing::Kept;
use super::raw::RawMesh;
use std::collections::BTreeMap;

/// The share of a mesh's size that vertices of an open mesh may be apart and still be one, where nobody says
/// otherwise: what single precision leaves of a coordinate, a few times over.
pub const WELD_SHARE: f64 = 1e-6;

/// Which vertices of a mesh are one. Each vertex is replaced by the first one that is near enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weld {
    /// Those at most this far apart, a length after scaling; 0 joins equal ones only. The rounding of the decimals
    /// in a file does not grow with the size of what it describes.
    Length(f64),
    /// Equal ones; and where that leaves the surface open, those at most this share of the mesh's size apart, if it
    /// is closed by that. The size is the diagonal of the box around the triangles. Else nothing more is joined: a
    /// closed mesh stays to the bit what it is.
    ToClose(f64),
}

/// A mesh made of the triangles of a file, and what that took.
pub(super) struct Welded {
    pub mesh: Mesh,
    /// Triangles with different corners, each set of corners counted once.
    pub unique_triangles: usize,
    /// Edges that an odd number of the triangles share. Flat triangles count, since they may close a seam between
    /// neighbours whose corners do not coincide: without them a closed surface would seem open.
    pub odd_edges: usize,
    /// Pairs of triangles with the same corners that the mesh keeps.
    pub pairs: usize,
    /// How far apart vertices are that were joined to close the surface, and how many edges are open without.
    pub closed_by: Option<(f64, usize)>,
}

impl Mesh {
    /// Joins vertices, and drops what is superfluous: of triangles with the same corners all but the first (many
    /// files store both sides; [`Kept`] says where two are kept), triangles without an area (unless the surface is
    /// closed with them and open without them), and vertices that no triangle uses.
    pub(super) fn weld(raw: &RawMesh, scale: [f64; 3], weld: Weld) -> Welded {
        let scaled = raw.vertices.iter();
        let scaled = scaled.map(|vertex| [0, 1, 2].map(|axis| vertex[axis] * scale[axis] + 0.0));
        let (length, share) = match weld {
            Weld::Length(length) => (length, 0.0),
            Weld::ToClose(share) => (0.0, share),
        };
        let joined = if length > 0.0 { join_near(scaled, length) } else { join_equal(scaled) };
        let welded = Welded::of(&joined, &raw.triangles);
        let length = share * welded.mesh.size();
        if welded.odd_edges == 0 || length == 0.0 {
            return welded;
        }
        let mut near = join_near(joined.0.iter().copied(), length);
        near.1 = joined.1.iter().map(|equal| near.1[*equal as usize]).collect();
        let near = Welded::of(&near, &raw.triangles);
        if near.odd_edges > 0 || near.mesh.faces().next().is_none() {
            return welded;
        }
        Welded { closed_by: Some((length, welded.odd_edges)), ..near }
    }
}

impl Welded {
    fn of((vertices, welded): &Joined, triangles: &[[u32; 3]]) -> Welded {
        let corners = triangles.iter().map(|corners| corners.map(|corner| welded[corner as usize]));
        let whole = corners.filter(|[a, b, c]| a != b && b != c && c != a);
        let kept = Kept::of(vertices, &whole.collect::<Vec<_>>());
        Welded {
            mesh: without_unused(vertices, kept.triangles),
            unique_triangles: kept.unique,
            odd_edges: kept.odd_edges,
            pairs: kept.pairs,
            closed_by: None,
        }
    }
}

/// Edge of the cubes in which near vertices are looked for, in tolerances.
const CUBE: f64 = 16.0;

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
    // A grid of cubes, some tolerances wide: the vertices within the tolerance lie in a vertex's own cube, and in the
    // neighbouring ones if it is that near to a side.
    let side = CUBE * tolerance;
    let reach = (1.0 + 1e-3) * tolerance;
    let mut cells: BTreeMap<[u64; 3], Vec<u32>> = BTreeMap::new();
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let cell = |value: f64| (value / side).floor() + 0.0;
    let welded = all
        .map(|vertex| {
            let ends = vertex.map(|value| [cell(value - reach), cell(value + reach)]);
            let mut first = u32::MAX;
            for beside in 0..8 {
                let ways = [0, 1, 2].map(|axis| beside >> axis & 1);
                // Where both ends are in one cube, that is looked at once.
                if (0..3).any(|axis| ways[axis] == 1 && ends[axis][0] == ends[axis][1]) {
                    continue;
                }
                let key = [0, 1, 2].map(|axis| ends[axis][ways[axis]].to_bits());
                for index in cells.get(&key).into_iter().flatten() {
                    if distance_squared(vertices[*index as usize], vertex) <= tolerance * tolerance
                    {
                        first = first.min(*index);
                    }
                }
            }
            if first == u32::MAX {
                first = vertices.len() as u32;
                vertices.push(vertex);
                cells.entry(vertex.map(|value| cell(value).to_bits())).or_default().push(first);
            }
            first
        })
        .collect();
    (vertices, welded)
}

/// The triangles with those of the vertices that they use.
fn without_unused(vertices: &[[f64; 3]], mut triangles: Vec<[u32; 3]>) -> Mesh {
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
    let vertices = vertices.iter().zip(used).filter(|(_, used)| *used).map(|(vertex, _)| *vertex);
    Mesh { vertices: vertices.collect(), triangles }
}

fn distance_squared(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}
