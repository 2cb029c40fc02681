//! Whether the surface of a shape meets itself: the check that the paper lacks, and whose absence it names as the reason why shapes
//! changed their topology.

use super::surface::Surface;
use parry3d_f64::math::Vector;
use robust::{Coord, Coord3D, orient2d, orient3d};
use std::cmp::Ordering;

/// The least volume that each piece of the surface encloses, as a share of its volume at rest. A piece with less, or turned
/// inside out, is refused.
const LEAST_VOLUME: f64 = 1e-3;

/// What of the robot at rest is known for the check.
pub(super) struct SelfCollision {
    /// Pairs of triangles that meet at rest already, in ascending order: they may.
    at_rest: Vec<(u32, u32)>,
    /// The volume of each piece at rest, by sign.
    volumes: Vec<f64>,
}

impl SelfCollision {
    pub fn new(surface: &Surface, rest: &[Vector]) -> SelfCollision {
        let mut at_rest = Vec::new();
        meetings(surface, rest, &mut |pair| {
            at_rest.push(pair);
            true
        });
        at_rest.sort_unstable();
        SelfCollision { at_rest, volumes: surface.volumes(rest) }
    }

    /// Whether two triangles without a common vertex meet that do not at rest, or a piece of the surface encloses no volume any more.
    pub fn is_met(&self, surface: &Surface, shape: &[Vector]) -> bool {
        let turned = |(now, rest): (f64, &f64)| *rest != 0.0 && now / rest < LEAST_VOLUME;
        if surface.volumes(shape).into_iter().zip(&self.volumes).any(turned) {
            return true;
        }
        let mut met = false;
        meetings(surface, shape, &mut |pair| {
            met = self.at_rest.binary_search(&pair).is_err();
            !met
        });
        met
    }
}

/// Calls `found` with pairs of triangles that have no common vertex and meet, the smaller index first, until it says `false`. Touching is
/// meeting. Flat triangles meet nothing: they lie on the edges of others.
fn meetings(surface: &Surface, shape: &[Vector], found: &mut dyn FnMut((u32, u32)) -> bool) {
    let boxes: Vec<[[f64; 3]; 2]> = surface
        .triangles
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|corner| shape[corner as usize]);
            [a.min(b).min(c).to_array(), a.max(b).max(c).to_array()]
        })
        .collect();
    // Triangles by where their boxes begin along x: only those that begin before one's box ends can meet it.
    let mut order: Vec<u32> = (0..surface.triangles.len() as u32).collect();
    let begins = |index: u32| boxes[index as usize][0][0];
    order.sort_by(|a, b| begins(*a).total_cmp(&begins(*b)).then(a.cmp(b)));
    for (at, first) in order.iter().enumerate() {
        let [least, most] = boxes[*first as usize];
        for second in &order[at + 1..] {
            let [other_least, other_most] = boxes[*second as usize];
            if other_least[0] > most[0] {
                break;
            }
            let apart =
                (1..3).any(|axis| other_least[axis] > most[axis] || least[axis] > other_most[axis]);
            let [a, b] = [first, second].map(|index| surface.triangles[*index as usize]);
            if apart || a.iter().any(|corner| b.contains(corner)) {
                continue;
            }
            let [a, b] =
                [a, b].map(|corners| corners.map(|corner| shape[corner as usize].to_array()));
            if meet(&a, &b) && !found((*first.min(second), *first.max(second))) {
                return;
            }
        }
    }
}

type Triangle = [[f64; 3]; 3];

/// Whether two triangles meet, exactly for their corners as they are given.
pub(super) fn meet(a: &Triangle, b: &Triangle) -> bool {
    if is_flat(a) || is_flat(b) {
        return false;
    }
    let sides = |of: &Triangle, points: &Triangle| points.map(|point| side(of, point));
    let apart = |sides: [Ordering; 3]| {
        sides[0] != Ordering::Equal && sides.iter().all(|side| *side == sides[0])
    };
    let (of_a, of_b) = (sides(b, a), sides(a, b));
    if apart(of_a) || apart(of_b) {
        return false;
    }
    let crosses = |edges: &Triangle, sides: [Ordering; 3], other: &Triangle| {
        (0..3).any(|at| {
            let next = (at + 1) % 3;
            pierces([edges[at], edges[next]], [sides[at], sides[next]], other)
        })
    };
    crosses(a, of_a, b) || crosses(b, of_b, a)
}

/// Whether a segment, whose ends are on these sides of a triangle's plane, meets the triangle.
fn pierces([p, q]: [[f64; 3]; 2], sides: [Ordering; 2], triangle: &Triangle) -> bool {
    match sides {
        [Ordering::Equal, Ordering::Equal] => crosses_within_plane([p, q], triangle),
        [one, other] if one == other => false,
        _ => {
            let [a, b, c] = *triangle;
            let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| side(&[p, q, from], to));
            !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
        }
    }
}

/// Whether a segment in a triangle's plane meets the triangle. Both are seen along an axis along which the triangle is not a line.
fn crosses_within_plane(segment: [[f64; 3]; 2], triangle: &Triangle) -> bool {
    let Some(axis) = (0..3).find(|axis| flat_turn(triangle, *axis) != Ordering::Equal) else {
        return false;
    };
    let [p, q] = segment;
    let facing = flat_turn(triangle, axis);
    let [a, b, c] = *triangle;
    // A triangle and a segment are convex: they are apart if and only if a line along a side of the triangle, or along the
    // segment, parts them.
    let parted_by_side = [(a, b), (b, c), (c, a)].into_iter().any(|(from, to)| {
        [p, q].into_iter().all(|end| {
            let turn = flat_turn(&[from, to, end], axis);
            turn != Ordering::Equal && turn != facing
        })
    });
    let turns = [a, b, c].map(|corner| flat_turn(&[p, q, corner], axis));
    let parted_by_segment =
        turns[0] != Ordering::Equal && turns.iter().all(|turn| *turn == turns[0]);
    !(parted_by_side || parted_by_segment)
}

fn is_flat(triangle: &Triangle) -> bool {
    (0..3).all(|axis| flat_turn(triangle, axis) == Ordering::Equal)
}

/// How three points turn, seen along an axis; exact.
fn flat_turn(points: &Triangle, axis: usize) -> Ordering {
    let [a, b, c] =
        points.map(|point| Coord { x: point[(axis + 1) % 3], y: point[(axis + 2) % 3] });
    sign(orient2d(a, b, c))
}

/// On which side of a triangle's plane a point is; exact.
fn side(triangle: &Triangle, point: [f64; 3]) -> Ordering {
    let coordinates = |[x, y, z]: [f64; 3]| Coord3D { x, y, z };
    let [a, b, c] = triangle.map(coordinates);
    sign(orient3d(a, b, c, coordinates(point)))
}

fn sign(number: f64) -> Ordering {
    number.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}
