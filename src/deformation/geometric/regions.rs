//! Colliding triangles that are near one another along the surface are moved together; those farther apart are not, so that a
//! remote collision has no say in where a region is moved. This is the paper's neighbourhood function.

use super::surface::Surface;
use petgraph::unionfind::UnionFind;
use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};

/// Part of the surface that is moved in one direction.
#[derive(Clone, Debug)]
pub(super) struct Region {
    /// The triangles that collide, in ascending order; none of a region that is a whole piece of the surface.
    pub colliding: Vec<u32>,
    /// The vertices that are moved, in ascending order, each with its weight: the share of the push that it takes part in. It
    /// is 1 at corners of colliding triangles, and falls in proportion to the distance from them along the surface.
    pub vertices: Vec<(u32, f64)>,
    /// The triangles that have a vertex that is moved, in ascending order.
    pub triangles: Vec<u32>,
    /// By how much the weight falls with each unit of length.
    pub slope: f64,
    /// Whether there is a vertex of its piece that stays.
    pub has_rest: bool,
}

/// Puts colliding triangles, given in ascending order, into regions: two that a walk along edges of at most `neighbourhood` joins
/// belong to the same one, and so do all that are joined by way of others (single linkage). Regions are ordered by their first triangles.
///
/// Lengths along the surface are those at rest, so that what is near does not depend on the shape. A vertex that is moved with one
/// region is never a corner of another's colliding triangle.
pub(super) fn regions(surface: &Surface, colliding: &[u32], neighbourhood: f64) -> Vec<Region> {
    let corners = surface.corners_of(colliding);
    let (distances, nearest) = walk(surface, &corners, neighbourhood);
    let mut united = UnionFind::<usize>::new(surface.pieces.len());
    for index in colliding {
        let [a, b, c] = surface.triangles[*index as usize].map(|corner| corner as usize);
        united.union(a, b);
        united.union(a, c);
    }
    // The shortest walk between two sets of corners crosses an edge between the vertices nearest to one and those nearest
    // to the other.
    for edge in &surface.edges {
        let [a, b] = edge.ends.map(|end| end as usize);
        if distances[a] + edge.length + distances[b] <= neighbourhood {
            united.union(nearest[a] as usize, nearest[b] as usize);
        }
    }
    let mut groups: Vec<(usize, Vec<u32>)> = Vec::new();
    for index in colliding {
        let label = united.find(surface.triangles[*index as usize][0] as usize);
        match groups.iter_mut().find(|(of, _)| *of == label) {
            Some((_, group)) => group.push(*index),
            None => groups.push((label, vec![*index])),
        }
    }
    groups.into_iter().map(|(_, colliding)| region(surface, colliding, neighbourhood)).collect()
}

/// The region with what its colliding triangles cut off from the rest of the surface: of the parts into which the piece falls without
/// them, all but the largest by area at rest. They are what has gone through a thin obstacle. `None` if nothing is cut off.
pub(super) fn filled(surface: &Surface, of: &Region) -> Option<Region> {
    let piece = surface.pieces[*surface.corners_of(&of.colliding).first()? as usize];
    let mut is_corner = vec![false; surface.pieces.len()];
    for corner in surface.corners_of(&of.colliding) {
        is_corner[corner as usize] = true;
    }
    let mut united = UnionFind::<usize>::new(surface.pieces.len());
    for edge in &surface.edges {
        let [a, b] = edge.ends.map(|end| end as usize);
        if !is_corner[a] && !is_corner[b] {
            united.union(a, b);
        }
    }
    // Per triangle a vertex that says which part it belongs to; none of those between corners of colliding ones.
    let part = |corners: &[u32; 3]| {
        let free = corners.iter().find(|corner| !is_corner[**corner as usize])?;
        (surface.pieces[*free as usize] == piece).then(|| united.find(*free as usize))
    };
    let mut areas = BTreeMap::new();
    for (corners, area) in surface.triangles.iter().zip(&surface.areas) {
        if let Some(part) = part(corners) {
            *areas.entry(part).or_insert(0.0) += area;
        }
    }
    let largest = areas.iter().max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(a.0)))?.0;
    if areas.len() == 1 {
        return None;
    }
    let is_cut_off = |(index, corners): &(u32, &[u32; 3])| {
        of.colliding.binary_search(index).is_ok()
            || part(corners).is_some_and(|part| part != *largest)
    };
    let all = (0u32..).zip(&surface.triangles).filter(is_cut_off).map(|(index, _)| index);
    Some(region(surface, all.collect(), 1.0 / of.slope))
}

/// The region around triangles of one piece.
fn region(surface: &Surface, colliding: Vec<u32>, neighbourhood: f64) -> Region {
    let corners = surface.corners_of(&colliding);
    let (distances, _) = walk(surface, &corners, neighbourhood);
    let reached = distances.iter().filter(|distance| distance.is_finite());
    let farthest = reached.clone().fold(0.0, |most: f64, distance| most.max(*distance));
    let piece = surface.pieces[corners[0] as usize].map_or(0, |piece| surface.piece_sizes[piece]);
    let all = reached.count() == piece;
    // The part of a piece that is farthest from the collisions always stays, so that no push carries a whole piece through a
    // wall.
    let neighbourhood = if all { farthest } else { neighbourhood };
    let weight = |distance: f64| match distance {
        0.0 => 1.0,
        _ if distance < neighbourhood => 1.0 - distance / neighbourhood,
        _ => 0.0,
    };
    let weights = (0u32..).zip(distances.iter().map(|distance| weight(*distance)));
    let vertices: Vec<(u32, f64)> = weights.filter(|(_, weight)| *weight > 0.0).collect();
    Region {
        triangles: surface.triangles_around(vertices.iter().map(|(vertex, _)| *vertex)),
        slope: if neighbourhood > 0.0 { 1.0 / neighbourhood } else { f64::INFINITY },
        has_rest: vertices.len() < piece,
        colliding,
        vertices,
    }
}

/// All the surface as one region, every vertex with weight 1.
pub(super) fn whole(surface: &Surface, neighbourhood: f64) -> Region {
    let vertices = (0u32..).zip(&surface.pieces).filter(|(_, piece)| piece.is_some());
    Region {
        colliding: Vec::new(),
        vertices: vertices.map(|(vertex, _)| (vertex, 1.0)).collect(),
        triangles: (0u32..).take(surface.triangles.len()).collect(),
        slope: if neighbourhood > 0.0 { 1.0 / neighbourhood } else { f64::INFINITY },
        has_rest: false,
    }
}

/// Raises values of the region's vertices, so that along the surface they fall by no more than the region's slope: the least such
/// values that are nowhere below the given ones. Values are in the order of the region's vertices.
pub(super) fn envelope(surface: &Surface, region: &Region, values: &mut [f64]) {
    if region.slope.is_infinite() {
        return;
    }
    let place = |vertex: u32| region.vertices.binary_search_by_key(&vertex, |(vertex, _)| *vertex);
    let highest = |value: f64, index: usize| Entry { key: -value, vertex: index as u32 };
    let mut open: BinaryHeap<Reverse<Entry>> = BinaryHeap::new();
    let above = values.iter().enumerate().filter(|(_, value)| **value > 0.0);
    open.extend(above.map(|(index, value)| Reverse(highest(*value, index))));
    while let Some(Reverse(Entry { key, vertex: index })) = open.pop() {
        let value = -key;
        if value < values[index as usize] {
            continue;
        }
        for (neighbour, length) in surface.neighbours(region.vertices[index as usize].0) {
            let Ok(neighbour) = place(*neighbour) else { continue };
            let raised = value - length * region.slope;
            if raised > values[neighbour] {
                values[neighbour] = raised;
                open.push(Reverse(highest(raised, neighbour)));
            }
        }
    }
}

/// Per vertex its distance along edges at rest from the nearest of some vertices, and which that is; infinite beyond `reach`.
/// Of equally near ones it is the one with the smallest index.
fn walk(surface: &Surface, from: &[u32], reach: f64) -> (Vec<f64>, Vec<u32>) {
    let mut distances = vec![f64::INFINITY; surface.pieces.len()];
    let mut nearest = vec![u32::MAX; surface.pieces.len()];
    let mut open = BinaryHeap::new();
    for vertex in from {
        (distances[*vertex as usize], nearest[*vertex as usize]) = (0.0, *vertex);
        open.push(Reverse(Entry { key: 0.0, vertex: *vertex }));
    }
    while let Some(Reverse(Entry { key, vertex })) = open.pop() {
        if key > distances[vertex as usize] {
            continue;
        }
        for (neighbour, length) in surface.neighbours(vertex) {
            let (distance, source) = (key + length, nearest[vertex as usize]);
            let known = (distances[*neighbour as usize], nearest[*neighbour as usize]);
            let better = distance < known.0 || (distance == known.0 && source < known.1);
            if distance <= reach && better {
                (distances[*neighbour as usize], nearest[*neighbour as usize]) = (distance, source);
                open.push(Reverse(Entry { key: distance, vertex: *neighbour }));
            }
        }
    }
    (distances, nearest)
}

/// A vertex in a queue, by its key and then by its index.
#[derive(PartialEq)]
struct Entry {
    key: f64,
    vertex: u32,
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Entry) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Entry) -> Ordering {
        self.key.total_cmp(&other.key).then(self.vertex.cmp(&other.vertex))
    }
}
