//! Which of a file's triangles make up a surface, where some are stored more than once or are flat.

use super::mesh::{faces_of, odd_edges};
use std::collections::{BTreeMap, BTreeSet};

/// A surface as the triangles that are kept of those stored.
pub(super) struct Kept {
    pub triangles: Vec<[u32; 3]>,
    /// Triangles stored, each set of corners counted once.
    pub unique: usize,
    /// Edges that an odd number of the triangles share, flat ones counted: 0 for a closed surface.
    pub odd_edges: usize,
    /// Pairs of triangles with the same corners among those kept: walls with material on either side.
    pub pairs: usize,
}

impl Kept {
    /// The surface of triangles with three different corners each, in the order of the file.
    ///
    /// Of triangles with the same corners the first is kept: many files store every triangle twice, once for either
    /// side. Where such a surface is open, two others are tried, and the first that is closed is taken. In both a
    /// triangle may be kept twice, so that it closes nothing and opens nothing: bricks that stand side by side in
    /// one file store the wall between them once for each.
    /// 1. Triangles that are stored for both of their sides are kept twice.
    /// 2. Triangles that are stored an even number of times are kept twice.
    pub(super) fn of(vertices: &[[f64; 3]], stored: &[[u32; 3]]) -> Kept {
        let mut seen = BTreeSet::new();
        let first = stored.iter().copied().filter(|corners| seen.insert(sorted(*corners)));
        let unique: Vec<[u32; 3]> = first.collect();
        let count = unique.len();
        let once = Kept::from(vertices, unique, count);
        if once.odd_edges == 0 || count == stored.len() {
            return once;
        }
        let mut others = [by_sides(stored), by_count(stored)].into_iter();
        let closed = others.find_map(|list| {
            let kept = Kept::from(vertices, list, count);
            (kept.odd_edges == 0 && kept.has_outside(vertices)).then(|| kept.counted())
        });
        closed.unwrap_or(once)
    }

    /// Whether a triangle with an area is there once: a surface of nothing but pairs would be closed whatever it is.
    fn has_outside(&self, vertices: &[[f64; 3]]) -> bool {
        let faces: Vec<[u32; 3]> = faces_of(vertices, &self.triangles).map(sorted).collect();
        let different: BTreeSet<&[u32; 3]> = faces.iter().collect();
        2 * different.len() > faces.len()
    }

    /// Flat triangles are kept only where the surface is closed by them and not without them.
    fn from(vertices: &[[f64; 3]], list: Vec<[u32; 3]>, unique: usize) -> Kept {
        let with_flat = odd_edges(&list);
        let faces: Vec<[u32; 3]> = faces_of(vertices, &list).collect();
        let without = if faces.len() < list.len() { odd_edges(&faces) } else { with_flat };
        let (triangles, odd_edges) = match without {
            0 if !faces.is_empty() => (faces, 0),
            _ if faces.is_empty() || with_flat > 0 => (faces, with_flat),
            _ => (list, 0),
        };
        Kept { triangles, unique, odd_edges, pairs: 0 }
    }

    /// Counts the pairs.
    fn counted(self) -> Kept {
        let different: BTreeSet<[u32; 3]> = self.triangles.iter().copied().map(sorted).collect();
        Kept { pairs: self.triangles.len() - different.len(), ..self }
    }
}

/// Of triangles with the same corners the first for either side.
fn by_sides(stored: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut seen = BTreeSet::new();
    let is_new = |corners: &[u32; 3]| seen.insert((sorted(*corners), is_even(*corners)));
    stored.iter().copied().filter(is_new).collect()
}

/// Of triangles with the same corners the first, and where their number is even a second one, turned over: what is
/// written of it is then read by [`by_sides`].
fn by_count(stored: &[[u32; 3]]) -> Vec<[u32; 3]> {
    // The number of triangles, and the first, until the second is met.
    let mut copies: BTreeMap<[u32; 3], (usize, Option<[u32; 3]>)> = BTreeMap::new();
    for corners in stored {
        copies.entry(sorted(*corners)).or_insert((0, Some(*corners))).0 += 1;
    }
    let mut begun = BTreeSet::new();
    let mut kept = Vec::new();
    for corners in stored {
        let key = sorted(*corners);
        let (count, first) = copies.get_mut(&key).expect("all were counted");
        if begun.insert(key) {
            kept.push(*corners);
        } else if *count % 2 == 0
            && let Some([a, b, c]) = first.take()
        {
            kept.push([a, c, b]);
        }
    }
    kept
}

fn sorted(mut corners: [u32; 3]) -> [u32; 3] {
    corners.sort_unstable();
    corners
}

/// Whether the corners go round as their sorted order does: the other triangles with the same corners show the
/// other side.
fn is_even([a, b, c]: [u32; 3]) -> bool {
    (a < b) ^ (b < c) ^ (a < c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_sides_of_a_triangle_are_told_apart() {
        let [a, b, c] = [3, 7, 9];
        for even in [[a, b, c], [b, c, a], [c, a, b]] {
            let [a, b, c] = even;
            assert!(is_even(even) && !is_even([a, c, b]), "{even:?}");
        }
    }
}
