//! Surfaces of shapes that are given by a distance function: naive surface nets (Gibson, *Constrained elastic surface nets*, 1998). Every cell of a
//! grid that the surface passes has one vertex, and every edge of the grid that the surface crosses two triangles, so
//! that the surface is closed, and its edges are about as long as a cell is wide.

use std::collections::BTreeMap;
use std::fmt::Write;

/// How often triangles are made more alike.
const ROUNDS: usize = 4;

/// A closed surface, wound so that it is seen from outside counter-clockwise.
#[derive(Default)]
pub struct Surface {
    /// The vertices.
    pub vertices: Vec<[f64; 3]>,
    /// Corners of the triangles.
    pub triangles: Vec<[usize; 3]>,
}

impl Surface {
    /// As an OBJ file, to five decimals.
    pub fn obj(&self) -> String {
        let mut obj = String::new();
        for [x, y, z] in &self.vertices {
            writeln!(obj, "v {x:.5} {y:.5} {z:.5}").expect("memory");
        }
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| corner + 1);
            writeln!(obj, "f {a} {b} {c}").expect("memory");
        }
        obj
    }
}

/// The surface where a function is 0, which is negative within the shape and about the distance from it outside, by cells of this width. The
/// shape lies within `half` of the origin along each axis.
pub fn surface(width: f64, half: [f64; 3], distance: &dyn Fn([f64; 3]) -> f64) -> Surface {
    // The grid is a little beside the origin, so that flat sides do not pass through its points.
    let cells = half.map(|half| (half / width).ceil() as usize * 2 + 3);
    let point = |at: [usize; 3]| {
        [0, 1, 2].map(|axis| {
            width * (at[axis] as f64 - 0.5 * cells[axis] as f64 + [0.137, 0.213, 0.171][axis])
        })
    };
    let index = |at: [usize; 3]| (at[0] * (cells[1] + 1) + at[1]) * (cells[2] + 1) + at[2];
    let mut values = Vec::new();
    for x in 0..=cells[0] {
        for y in 0..=cells[1] {
            for z in 0..=cells[2] {
                values.push(distance(point([x, y, z])));
            }
        }
    }
    let value = |at: [usize; 3]| values[index(at)];
    let mut out = Surface::default();
    let mut vertex_of = BTreeMap::new();
    for x in 0..cells[0] {
        for y in 0..cells[1] {
            for z in 0..cells[2] {
                if let Some(vertex) = crossing([x, y, z], &point, &value) {
                    vertex_of.insert([x, y, z], out.vertices.len());
                    out.vertices.push(projected(vertex, width, distance));
                }
            }
        }
    }
    // The four cells around every edge that the surface crosses.
    for x in 1..cells[0] {
        for y in 1..cells[1] {
            for z in 1..cells[2] {
                for axis in 0..3 {
                    let from = [x, y, z];
                    let mut to = from;
                    to[axis] += 1;
                    let [inside, beyond] = [value(from), value(to)].map(|value| value < 0.0);
                    if inside == beyond {
                        continue;
                    }
                    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                    let around = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(by_u, by_v)| {
                        let mut cell = from;
                        (cell[u], cell[v]) = (cell[u] - by_u, cell[v] - by_v);
                        vertex_of[&cell]
                    });
                    let [a, b, c, d] = around;
                    let quad = if inside { [a, b, c, d] } else { [a, d, c, b] };
                    push_quad(&mut out, quad);
                }
            }
        }
    }
    for _ in 0..ROUNDS {
        even_out(&mut out, width, distance);
    }
    out
}

/// Moves every vertex half of the way to the middle of its neighbours, and back onto the surface: triangles become more alike.
fn even_out(out: &mut Surface, width: f64, distance: &dyn Fn([f64; 3]) -> f64) {
    let mut sums = vec![([0.0; 3], 0.0); out.vertices.len()];
    for corners in &out.triangles {
        // An edge is seen from both of its triangles, once in each direction.
        for k in 0..3 {
            let (sum, count) = &mut sums[corners[k]];
            let other = out.vertices[corners[(k + 1) % 3]];
            (0..3).for_each(|axis| sum[axis] += other[axis]);
            *count += 1.0;
        }
    }
    for (vertex, (sum, count)) in out.vertices.iter_mut().zip(sums) {
        let middle = sum.map(|sum| sum / count);
        let half = [0, 1, 2].map(|axis| 0.5 * (vertex[axis] + middle[axis]));
        *vertex = projected(half, width, distance);
    }
}

/// The mean of where the surface crosses the edges of a cell.
fn crossing(
    cell: [usize; 3],
    point: &dyn Fn([usize; 3]) -> [f64; 3],
    value: &dyn Fn([usize; 3]) -> f64,
) -> Option<[f64; 3]> {
    let corner = |bits: usize| [0, 1, 2].map(|axis| cell[axis] + (bits >> axis & 1));
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for bits in 0..8 {
        for axis in 0..3 {
            if bits >> axis & 1 == 1 {
                continue;
            }
            let (from, to) = (corner(bits), corner(bits | 1 << axis));
            let (a, b) = (value(from), value(to));
            if (a < 0.0) != (b < 0.0) {
                let (p, q, t) = (point(from), point(to), a / (a - b));
                (0..3).for_each(|axis| sum[axis] += p[axis] + t * (q[axis] - p[axis]));
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum.map(|sum| sum / count))
}

/// A point moved onto the surface, at most by half a cell.
fn projected(start: [f64; 3], width: f64, distance: &dyn Fn([f64; 3]) -> f64) -> [f64; 3] {
    let mut at = start;
    let by = 1e-4 * width;
    for _ in 0..4 {
        let here = distance(at);
        let slope = [0, 1, 2].map(|axis| {
            let mut beside = at;
            beside[axis] += by;
            (distance(beside) - here) / by
        });
        let square = slope.iter().map(|part| part * part).sum::<f64>().max(0.1);
        at = [0, 1, 2].map(|axis| {
            let moved = at[axis] - here * slope[axis] / square;
            moved.clamp(start[axis] - 0.5 * width, start[axis] + 0.5 * width)
        });
    }
    at
}

/// Two triangles of four corners, divided along the shorter diagonal.
fn push_quad(out: &mut Surface, [a, b, c, d]: [usize; 4]) {
    let length = |from: usize, to: usize| {
        let (p, q) = (out.vertices[from], out.vertices[to]);
        (0..3).map(|axis| (p[axis] - q[axis]) * (p[axis] - q[axis])).sum::<f64>()
    };
    let triangles =
        if length(a, c) <= length(b, d) { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] };
    out.triangles.extend(triangles);
}
