//! The shapes of the three experiments as distance functions: letters, a ball, a teapot and a seal.

/// The letters of the sliding experiment: flat bars and arcs, 1 high and 0.24 thick.
pub const LETTERS: [char; 5] = ['D', 'S', 'M', 'F', 'T'];
/// Half of the width of a letter's strokes, and half of its thickness.
const STROKE: f64 = 0.1;
const THICK: f64 = 0.12;

/// The distance from a letter, extruded along z, negative within it.
pub fn letter(name: char, [x, y, z]: [f64; 3]) -> f64 {
    let bars: &[[f64; 4]] = match name {
        'D' => &[[-0.25, -0.4, -0.25, 0.4], [-0.25, 0.4, -0.05, 0.4], [-0.25, -0.4, -0.05, -0.4]],
        'M' => &[
            [-0.3, -0.4, -0.3, 0.4],
            [-0.3, 0.4, 0.0, -0.05],
            [0.0, -0.05, 0.3, 0.4],
            [0.3, 0.4, 0.3, -0.4],
        ],
        'F' => &[[-0.25, -0.4, -0.25, 0.4], [-0.25, 0.4, 0.25, 0.4], [-0.25, 0.02, 0.15, 0.02]],
        'T' => &[[0.0, -0.4, 0.0, 0.4], [-0.3, 0.4, 0.3, 0.4]],
        _ => &[],
    };
    let mut flat = bars.iter().map(|bar| to_bar([x, y], *bar)).fold(f64::INFINITY, f64::min);
    flat = match name {
        'D' => flat.min(to_arc([x + 0.05, y], 0.4, [[0.0, 0.4], [0.0, -0.4]], |[x, _]| x < 0.0)),
        'S' => flat
            .min(to_arc([x, y - 0.2], 0.2, [[0.15, 0.132], [0.0, -0.2]], |[x, y]| {
                x > 0.0 && y < 0.88 * x
            }))
            .min(to_arc([x, y + 0.2], 0.2, [[-0.15, -0.132], [0.0, 0.2]], |[x, y]| {
                x < 0.0 && y > 0.88 * x
            })),
        _ => flat,
    };
    (flat - STROKE).max(z.abs() - THICK)
}

/// The distance from a bar without width between two points.
fn to_bar([x, y]: [f64; 2], [ax, ay, bx, by]: [f64; 4]) -> f64 {
    let (ux, uy) = (bx - ax, by - ay);
    let t = (((x - ax) * ux + (y - ay) * uy) / (ux * ux + uy * uy)).clamp(0.0, 1.0);
    length([x - ax - t * ux, y - ay - t * uy, 0.0])
}

/// The distance from a part of a circle about the origin: all but the directions `left_out`, between two ends.
fn to_arc(
    [x, y]: [f64; 2],
    radius: f64,
    ends: [[f64; 2]; 2],
    left_out: fn([f64; 2]) -> bool,
) -> f64 {
    if !left_out([x, y]) {
        return (length([x, y, 0.0]) - radius).abs();
    }
    let [one, other] = ends.map(|[a, b]| length([x - a, y - b, 0.0]));
    one.min(other)
}

/// The distance from a ball about the origin.
pub fn ball(point: [f64; 3], radius: f64) -> f64 {
    length(point) - radius
}

/// The distance from a teapot: a body of revolution with a lid and its knob, a spout and a handle, all one surface. It is about
/// 2.6 long and 1.7 high.
pub fn teapot([x, y, z]: [f64; 3]) -> f64 {
    let round = length([x, y, 0.0]);
    // The body: a ball made flatter, cut off below, with a rim above.
    let body = (length([x, y, z / 0.85]) - 0.8) * 0.85;
    let body = body.max(-0.6 - z);
    let rim = length([round - 0.42, z - 0.58, 0.0]) - 0.09;
    let knob = length([x, y, z - 0.82]) - 0.14;
    let spout = to_bone([x, y, z], [[0.6, 0.0, -0.15], [1.05, 0.0, 0.15]], [0.24, 0.15]);
    let tip = to_bone([x, y, z], [[1.05, 0.0, 0.15], [1.2, 0.0, 0.5]], [0.15, 0.12]);
    let handle = length([length([x + 0.85, z - 0.02, 0.0]) - 0.36, y, 0.0]) - 0.11;
    let parts = [rim, knob, spout, tip, handle];
    parts.into_iter().fold(body, |union, part| smooth_union(union, part, 0.1))
}

/// The distance from a rounded bar between two points, with a radius at each.
fn to_bone(point: [f64; 3], [a, b]: [[f64; 3]; 2], radii: [f64; 2]) -> f64 {
    let along = [0, 1, 2].map(|axis| b[axis] - a[axis]);
    let from = [0, 1, 2].map(|axis| point[axis] - a[axis]);
    let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let t = (dot(from, along) / dot(along, along)).clamp(0.0, 1.0);
    length([0, 1, 2].map(|axis| from[axis] - t * along[axis]))
        - (radii[0] + t * (radii[1] - radii[0]))
}

/// The union of two shapes with a rounded seam.
fn smooth_union(a: f64, b: f64, width: f64) -> f64 {
    let near = (1.0 - (a - b).abs() / width).max(0.0);
    a.min(b) - 0.25 * width * near * near
}

/// The distance from a seal: a block whose upper side, at z = 0, carries a ring, a cross within it and four studs, 0.3 high.
pub fn seal([x, y, z]: [f64; 3]) -> f64 {
    let block = (x.abs() - 1.8).max(y.abs() - 1.8).max((z + 0.3).abs() - 0.3);
    let round = length([x, y, 0.0]);
    let high = (z - 0.05).abs() - 0.25;
    let ring = ((round - 0.75).abs() - 0.11).max(high);
    let cross = (x.abs() - 0.45).max(y.abs() - 0.1).min((y.abs() - 0.45).max(x.abs() - 0.1));
    let cross = cross.max((z - 0.0).abs() - 0.2);
    let stud = length([x.abs() - 1.2, y.abs() - 1.2, z]) - 0.3;
    [ring, cross, stud].into_iter().fold(block, f64::min)
}

fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}
