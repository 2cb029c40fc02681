//! The shells of a closed surface: its parts, each closed by itself, with their triangles turned to the same side.

use crate::scene::Mesh;
use petgraph::unionfind::UnionFind;

/// A part of a surface that is closed by itself.
#[derive(Debug)]
pub(super) struct Shell {
    /// Corners of its triangles, as indices of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// Whether the triangles are turned consistently, all of them counter-clockwise as seen from the same side of the
    /// surface. It is false of a surface with one side only, and where sheets meet along an edge so that they cannot be
    /// told apart.
    pub is_oriented: bool,
}

/// One side of a triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The vertices at its ends, the lower index first.
    ends: [u32; 2],
    triangle: u32,
    /// Whether the triangle has its ends in this order.
    forward: bool,
}

/// Marks the absence of a neighbour.
const NONE: u32 = u32::MAX;

/// Divides a closed surface into shells, in the order of their first triangles.
///
/// Triangles that alone share an edge belong together. Where more than two share an edge, the pieces that are closed
/// there by themselves stay apart, and the others are joined. Triangles that were turned the other way than most of
/// their shell are turned round.
pub(super) fn shells(mesh: &Mesh) -> Vec<Shell> {
    let triangles = &mesh.triangles;
    let mut sides: Vec<Side> = Vec::with_capacity(3 * triangles.len());
    for (triangle, [a, b, c]) in triangles.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let ends = [*from.min(to), *from.max(to)];
            sides.push(Side { ends, triangle: triangle as u32, forward: from < to });
        }
    }
    sides.sort_unstable();
    let pieces = pieces(&sides, triangles.len());
    let (turned, mut consistent) = turned(&sides, &pieces, triangles.len());
    mark_unbalanced(&sides, &pieces, &turned, &mut consistent);

    let mut shells: Vec<Shell> = Vec::new();
    let mut shell_of = vec![NONE; triangles.len()];
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        let piece = pieces[index] as usize;
        if shell_of[piece] == NONE {
            shell_of[piece] = shells.len() as u32;
            shells.push(Shell { triangles: Vec::new(), is_oriented: consistent[piece] });
        }
        let corners = if turned[index] { [*a, *c, *b] } else { [*a, *b, *c] };
        shells[shell_of[piece] as usize].triangles.push(corners);
    }
    shells
}

/// The triangles at each edge.
fn edges(sides: &[Side]) -> impl Iterator<Item = &[Side]> {
    sides.chunk_by(|one, other| one.ends == other.ends)
}

/// For every triangle the piece that it belongs to, named by one of its triangles.
fn pieces(sides: &[Side], count: usize) -> Vec<u32> {
    let mut pieces: UnionFind<u32> = UnionFind::new(count);
    for edge in edges(sides).filter(|edge| edge.len() == 2) {
        pieces.union(edge[0].triangle, edge[1].triangle);
    }
    for edge in edges(sides).filter(|edge| edge.len() > 2) {
        let mut roots: Vec<u32> = edge.iter().map(|side| pieces.find(side.triangle)).collect();
        roots.sort_unstable();
        let open: Vec<u32> = roots
            .chunk_by(|one, other| one == other)
            .filter(|same| same.len() % 2 == 1)
            .map(|same| same[0])
            .collect();
        open.windows(2).for_each(|pair| {
            pieces.union(pair[0], pair[1]);
        });
    }
    pieces.into_labeling()
}

/// The sides at an edge, those of one piece after those of another.
fn by_piece(edge: &[Side], pieces: &[u32]) -> Vec<(u32, Side)> {
    let mut of: Vec<(u32, Side)> =
        edge.iter().map(|side| (pieces[side.triangle as usize], *side)).collect();
    of.sort_unstable();
    of
}

/// For every triangle whether it is to be turned round, and for every piece, at the index that is its name, whether all
/// triangles could be turned consistently across the edges that only two triangles of it share.
fn turned(sides: &[Side], pieces: &[u32], count: usize) -> (Vec<bool>, Vec<bool>) {
    // For every triangle up to three neighbours, and whether these go along the common edge in the same direction.
    let mut neighbors = vec![[(NONE, false); 3]; count];
    let mut join = |one: Side, other: Side| {
        let same = one.forward == other.forward;
        for (at, to) in [(one, other), (other, one)] {
            let slots = &mut neighbors[at.triangle as usize];
            if let Some(free) = slots.iter_mut().find(|(triangle, _)| *triangle == NONE) {
                *free = (to.triangle, same);
            }
        }
    };
    for edge in edges(sides) {
        match edge {
            [one, other] => join(*one, *other),
            _ => {
                let of_pieces = by_piece(edge, pieces);
                for same in of_pieces.chunk_by(|one, other| one.0 == other.0) {
                    if let [(_, one), (_, other)] = same {
                        join(*one, *other);
                    }
                }
            }
        }
    }
    let mut turned = vec![false; count];
    let mut seen = vec![false; count];
    let mut consistent = vec![true; count];
    let mut reached: Vec<u32> = Vec::new();
    for first in 0..count {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        reached.clear();
        reached.push(first as u32);
        let mut next = 0;
        while let Some(at) = reached.get(next).copied() {
            next += 1;
            for (triangle, same) in neighbors[at as usize] {
                if triangle == NONE {
                    continue;
                }
                // Neighbours that are turned alike go along their common edge in opposite directions.
                let expected = turned[at as usize] ^ same;
                if !seen[triangle as usize] {
                    seen[triangle as usize] = true;
                    turned[triangle as usize] = expected;
                    reached.push(triangle);
                } else if turned[triangle as usize] != expected {
                    consistent[pieces[at as usize] as usize] = false;
                }
            }
        }
        let others = reached.iter().filter(|triangle| turned[**triangle as usize]).count();
        if 2 * others > reached.len() {
            reached.iter().for_each(|triangle| turned[*triangle as usize] ^= true);
        }
    }
    (turned, consistent)
}

/// Marks the pieces of which more triangles go along some edge in one direction than in the other.
fn mark_unbalanced(sides: &[Side], pieces: &[u32], turned: &[bool], consistent: &mut [bool]) {
    for edge in edges(sides).filter(|edge| edge.len() > 2) {
        let of_pieces = by_piece(edge, pieces);
        for same in of_pieces.chunk_by(|one, other| one.0 == other.0) {
            let forward = |(_, side): &&(u32, Side)| side.forward ^ turned[side.triangle as usize];
            if 2 * same.iter().filter(forward).count() != same.len() {
                consistent[same[0].0 as usize] = false;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::bodies::validity::inside::tests::{joined, octahedron};

    /// Every edge of an oriented shell is gone along as often in either direction.
    fn is_balanced(shell: &Shell) -> bool {
        let mut directed: Vec<([u32; 2], bool)> = Vec::new();
        for [a, b, c] in &shell.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                directed.push(([*from.min(to), *from.max(to)], from < to));
            }
        }
        directed.sort_unstable();
        directed
            .chunk_by(|one, other| one.0 == other.0)
            .all(|edge| 2 * edge.iter().filter(|(_, forward)| *forward).count() == edge.len())
    }

    #[test]
    fn shells_are_told_apart_and_turned_like_most_of_their_triangles() {
        let (one, mut other) = (octahedron([0.0; 3], 1.0), octahedron([0.5, 0.0, 0.0], 1.0));
        let kept = one.triangles.clone();
        for corners in &mut other.triangles[..3] {
            corners.swap(0, 1);
        }
        let mesh = joined(&[one, other]);
        let shells = shells(&mesh);
        assert_eq!(shells.len(), 2);
        assert_eq!(shells[0].triangles, kept);
        for shell in &shells {
            assert!(shell.is_oriented && is_balanced(shell));
        }
        assert_eq!(shells[1].triangles[4..], mesh.triangles[12..]);
        assert_ne!(shells[1].triangles[..3], mesh.triangles[8..11]);
    }

    /// Two octahedra with an edge, or only a corner, in common.
    #[test]
    fn shells_that_share_an_edge_stay_two() {
        for merged in [[(2, 2), (4, 4)].as_slice(), &[(2, 2)]] {
            let mut other = octahedron([0.0; 3], 2.0);
            other.vertices[2] = [0.0, 1.0, 0.0];
            other.vertices[4] = [0.0, 0.0, 1.0];
            let mut mesh = joined(&[octahedron([0.0; 3], 1.0), other]);
            for corner in mesh.triangles.iter_mut().flatten() {
                if let Some((_, to)) = merged.iter().find(|(from, _)| *corner == 6 + from) {
                    *corner = *to;
                }
            }
            assert!(mesh.is_closed());
            let shells = shells(&mesh);
            assert_eq!(shells.len(), 2, "{merged:?}");
            assert!(shells.iter().all(|shell| shell.is_oriented && is_balanced(shell)));
        }
    }

    /// The projective plane with six vertices: closed, and with one side only.
    #[test]
    fn a_surface_with_one_side_is_not_oriented() {
        let triangles = [
            [0, 1, 2],
            [0, 2, 3],
            [0, 3, 4],
            [0, 4, 5],
            [0, 5, 1],
            [1, 2, 4],
            [2, 3, 5],
            [3, 4, 1],
            [4, 5, 2],
            [5, 1, 3],
        ];
        let mut vertices = octahedron([0.0; 3], 1.0).vertices;
        vertices.truncate(6);
        let mesh = Mesh { vertices, triangles: triangles.to_vec() };
        assert!(mesh.is_closed());
        let shells = shells(&mesh);
        assert_eq!(shells.len(), 1);
        assert!(!shells[0].is_oriented);
    }
}
