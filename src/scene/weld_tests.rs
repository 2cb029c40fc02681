//! Closedness of what is read.

use super::raw::RawMesh;
use super::{Mesh, Weld};
use proptest::prelude::*;

fn cube(offset: f64) -> RawMesh {
    cube_at([offset; 3])
}

fn cube_at(offset: [f64; 3]) -> RawMesh {
    let corner = |i: usize| [0, 1, 2].map(|axis| (i >> axis & 1) as f64 + offset[axis]);
    let quads =
        [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    RawMesh { vertices: (0..8).map(corner).collect(), triangles, ..RawMesh::default() }
}

#[test]
fn a_cube_is_closed_and_an_open_box_is_not() {
    let mut mesh = Mesh::weld(&cube(0.0), [1.0; 3], Weld::Length(0.0)).mesh;
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
    let mesh = Mesh::weld(&raw, [2.0; 3], Weld::Length(0.0)).mesh;
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
    let mesh = Mesh::weld(&raw, [1.0; 3], Weld::Length(1e-6)).mesh;
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
    assert_eq!(Mesh::weld(&raw, [1.0; 3], Weld::Length(0.0)).odd_edges, 3);
    raw.triangles.push([0, 1, 8]);
    let closed = Mesh::weld(&raw, [1.0; 3], Weld::Length(0.0));
    assert_eq!((closed.unique_triangles, closed.odd_edges), (14, 0));
    let mesh = closed.mesh;
    assert_eq!((mesh.triangles.len(), mesh.faces().count()), (14, 13));
    assert!(mesh.is_closed());
    let again = super::obj::tests::read_text(&mesh.to_obj());
    assert_eq!(Mesh::weld(&again, [1.0; 3], Weld::Length(0.0)).mesh, mesh);
}

/// The meshes as one.
fn together(meshes: &[RawMesh]) -> RawMesh {
    let mut all = RawMesh::default();
    for mesh in meshes {
        let first = all.vertices.len() as u32;
        all.vertices.extend(&mesh.vertices);
        all.triangles.extend(mesh.triangles.iter().map(|t| t.map(|corner| corner + first)));
    }
    all
}

/// Two bricks with a wall between them, stored once for each.
fn bricks() -> RawMesh {
    together(&[cube(0.0), cube_at([1.0, 0.0, 0.0])])
}

const EXACT: Weld = Weld::ToClose(0.0);

/// What is written of a mesh is read as the same mesh.
fn assert_stays(mesh: &Mesh) {
    let again = super::obj::tests::read_text(&mesh.to_obj());
    for weld in [EXACT, Weld::Length(0.0)] {
        assert_eq!(Mesh::weld(&again, [1.0; 3], weld).mesh, *mesh);
    }
}

#[test]
fn a_wall_between_two_bricks_is_there_for_either_side() {
    let welded = Mesh::weld(&bricks(), [1.0; 3], EXACT);
    assert_eq!((welded.unique_triangles, welded.odd_edges, welded.pairs), (22, 0, 2));
    assert_eq!((welded.mesh.vertices.len(), welded.mesh.triangles.len()), (12, 24));
    assert!(welded.mesh.is_closed());
    assert_stays(&welded.mesh);
    // Stored for one side only, in both bricks: the number of copies tells.
    let mut raw = bricks();
    let wall = |t: &[u32; 3]| t.iter().all(|corner| raw.vertices[*corner as usize][0] == 1.0);
    let walls: Vec<usize> = (12..24).filter(|i| wall(&raw.triangles[*i])).collect();
    assert_eq!(walls.len(), 2);
    for i in walls {
        raw.triangles[i].swap(1, 2);
    }
    let welded = Mesh::weld(&raw, [1.0; 3], EXACT);
    assert_eq!((welded.odd_edges, welded.pairs), (0, 2));
    assert_stays(&welded.mesh);
}

#[test]
fn a_sheet_stored_for_both_sides_encloses_nothing() {
    let mut raw = cube(0.0);
    raw.triangles.truncate(10);
    raw.triangles.extend(raw.triangles.clone().into_iter().map(|[a, b, c]| [a, c, b]));
    let welded = Mesh::weld(&raw, [1.0; 3], EXACT);
    assert_eq!((welded.odd_edges, welded.pairs, welded.mesh.triangles.len()), (4, 0, 10));
    // Beside a closed cube it is kept, and the cube is closed.
    let welded = Mesh::weld(&together(&[raw, cube(5.0)]), [1.0; 3], EXACT);
    assert_eq!((welded.odd_edges, welded.pairs, welded.mesh.triangles.len()), (0, 10, 32));
    assert_stays(&welded.mesh);
}

#[test]
fn a_flat_triangle_beside_a_closed_surface_opens_nothing() {
    let mut raw = cube(0.0);
    raw.vertices.extend([[2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]);
    raw.triangles.push([0, 8, 9]);
    let welded = Mesh::weld(&raw, [1.0; 3], EXACT);
    assert_eq!((welded.odd_edges, welded.mesh.triangles.len()), (0, 12));
    assert_eq!(welded.mesh, Mesh::weld(&cube(0.0), [1.0; 3], EXACT).mesh);
}

/// Every triangle with corners of its own, moved by what `noise` says.
fn apart(raw: &RawMesh, mut noise: impl FnMut() -> f64) -> RawMesh {
    let corners = raw.triangles.iter().flatten().map(|corner| raw.vertices[*corner as usize]);
    let vertices: Vec<[f64; 3]> = corners.map(|v| v.map(|value| value + noise())).collect();
    let triangles = (0..raw.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    RawMesh { vertices, triangles: triangles.collect(), ..RawMesh::default() }
}

#[test]
fn vertices_are_joined_where_that_closes_a_mesh_and_nowhere_else() {
    let mut sign = 1.0;
    let mut noisy = apart(&cube(0.0), || {
        sign = -sign;
        sign * 1e-7
    });
    let open = Mesh::weld(&noisy, [1.0; 3], EXACT);
    assert!(open.odd_edges > 0 && open.closed_by.is_none());
    let closed = Mesh::weld(&noisy, [1.0; 3], Weld::ToClose(1e-6));
    assert_eq!((closed.odd_edges, closed.mesh.vertices.len()), (0, 8));
    let (length, odd) = closed.closed_by.unwrap();
    assert!((length - 3f64.sqrt() * 1e-6).abs() < 1e-9 && odd == open.odd_edges);
    assert!(Mesh::weld(&noisy, [1.0; 3], Weld::ToClose(1e-8)).odd_edges > 0);
    // The tolerance grows with the mesh.
    assert!(Mesh::weld(&noisy, [1e6; 3], Weld::ToClose(1e-6)).closed_by.is_some());
    // What stays open stays as it is stored, all of it.
    noisy.triangles.pop();
    let open = Mesh::weld(&noisy, [1.0; 3], Weld::ToClose(1e-6));
    assert_eq!((open.closed_by, open.mesh), (None, Mesh::weld(&noisy, [1.0; 3], EXACT).mesh));
    // A closed mesh with vertices that near keeps them.
    let mut thin = cube(0.0);
    for vertex in &mut thin.vertices {
        vertex[2] *= 1e-8;
    }
    let welded = Mesh::weld(&thin, [1.0; 3], Weld::ToClose(1e-6));
    assert_eq!((welded.closed_by, welded.mesh.vertices.len()), (None, 8));
}

proptest! {
    /// However triangles are ordered, turned and repeated, and whatever rounding does to their corners.
    #[test]
    fn a_closed_surface_is_closed_however_it_is_stored(
        order in Just((0..24).collect::<Vec<usize>>()).prop_shuffle(),
        repeated in proptest::collection::vec((0usize..24, 0usize..24), 0..12),
        turns in proptest::collection::vec(0usize..3, 36),
        noise in proptest::collection::vec(-2i8..3, 324),
    ) {
        let raw = bricks();
        let mut order = order;
        for (which, place) in repeated {
            order.insert(place, which);
        }
        let mut triangles: Vec<[u32; 3]> = order.iter().map(|i| raw.triangles[*i]).collect();
        for (corners, turn) in triangles.iter_mut().zip(turns) {
            corners.rotate_left(turn);
        }
        let stored = RawMesh { triangles, ..bricks() };
        let expected = Mesh::weld(&raw, [1.0; 3], EXACT);
        let found = Mesh::weld(&stored, [1.0; 3], EXACT);
        prop_assert_eq!((found.odd_edges, found.pairs), (0, 2));
        assert_stays(&found.mesh);
        let mut noise = noise.into_iter().cycle();
        let noisy = apart(&stored, || f64::from(noise.next().unwrap_or(0)) * 1e-16);
        let found = Mesh::weld(&noisy, [1.0; 3], Weld::ToClose(1e-9));
        prop_assert_eq!((found.odd_edges, found.pairs), (0, 2));
        prop_assert_eq!(found.mesh.vertices.len(), expected.mesh.vertices.len());
    }
}
