//! Robots and obstacles of the tests.

use crate::math;
use crate::scene::{Body, Mesh, Pose, Shape};
use std::collections::BTreeMap;

/// A ball: an icosahedron whose triangles are divided into four `levels` times, 20 · 4ⁿ triangles.
pub fn ball(radius: f64, levels: u32) -> Mesh {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut vertices = Vec::new();
    for (one, other) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        vertices.push([0.0, one, other]);
        vertices.push([one, other, 0.0]);
        vertices.push([other, 0.0, one]);
    }
    let near = |a: [f64; 3], b: [f64; 3]| {
        (0..3).map(|axis| (a[axis] - b[axis]) * (a[axis] - b[axis])).sum::<f64>() < 4.1
    };
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [vertices[a], vertices[b], vertices[c]];
                if near(p, q) && near(q, r) && near(r, p) {
                    let outward = determinant(p, q, r) > 0.0;
                    let [b, c] = if outward { [b, c] } else { [c, b] };
                    triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    for _ in 0..levels {
        divide(&mut vertices, &mut triangles);
    }
    for vertex in &mut vertices {
        let length = (vertex[0] * vertex[0] + vertex[1] * vertex[1] + vertex[2] * vertex[2]).sqrt();
        *vertex = vertex.map(|value| value * radius / length);
    }
    Mesh { vertices, triangles }
}

/// Divides every triangle into four.
pub fn divide(vertices: &mut Vec<[f64; 3]>, triangles: &mut Vec<[u32; 3]>) {
    let mut middles = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let (p, q) = (vertices[a as usize], vertices[b as usize]);
            vertices.push([0, 1, 2].map(|axis| (p[axis] + q[axis]) / 2.0));
            vertices.len() as u32 - 1
        })
    };
    let parts = |[a, b, c]: &[u32; 3]| {
        let [ab, bc, ca] = [middle(*a, *b), middle(*b, *c), middle(*c, *a)];
        [[*a, ab, ca], [*b, bc, ab], [*c, ca, bc], [ab, bc, ca]]
    };
    *triangles = triangles.iter().flat_map(parts).collect();
}

/// A tube of this radius along a line in the plane of x and y that turns left by `turn` in the middle, each half of it as long as `half`,
/// with `around` corners; `steps` rings to each half. It begins at the origin, in the direction of x.
pub fn elbow(half: f64, radius: f64, turn: f64, steps: u32, around: u32) -> Mesh {
    let bend = half * 0.6;
    let mut rings = Vec::new();
    let (mut at, mut heading) = ([0.0, 0.0], 0.0);
    let step = half / f64::from(steps);
    for ring in 0..=2 * steps {
        rings.push((at, heading));
        let along = f64::from(ring) * step - (half - bend / 2.0);
        let turned = turn * ((along + step).clamp(0.0, bend) - along.clamp(0.0, bend)) / bend;
        let middle = heading + turned / 2.0;
        at = [at[0] + step * math::cos(middle), at[1] + step * math::sin(middle)];
        heading += turned;
    }
    let mut vertices = Vec::new();
    for ([x, y], heading) in &rings {
        for corner in 0..around {
            let angle = math::TURN * f64::from(corner) / f64::from(around);
            let (across, up) = (radius * math::cos(angle), radius * math::sin(angle));
            vertices.push([x - across * math::sin(*heading), y + across * math::cos(*heading), up]);
        }
    }
    let ends = [vertices.len() as u32, vertices.len() as u32 + 1];
    for ([x, y], _) in [rings[0], rings[rings.len() - 1]] {
        vertices.push([x, y, 0.0]);
    }
    let corner = |ring: u32, corner: u32| ring * around + corner % around;
    let mut triangles = Vec::new();
    for at in 0..around {
        for ring in 0..2 * steps {
            let [a, b] = [corner(ring, at), corner(ring, at + 1)];
            let [c, d] = [corner(ring + 1, at), corner(ring + 1, at + 1)];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
        triangles.push([ends[0], corner(0, at + 1), corner(0, at)]);
        triangles.push([ends[1], corner(2 * steps, at), corner(2 * steps, at + 1)]);
    }
    let mesh = Mesh { vertices, triangles };
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|corner| mesh.vertices[corner as usize]);
            determinant(a, b, c)
        })
        .sum();
    match volume < 0.0 {
        true => Mesh {
            triangles: mesh.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
            ..mesh
        },
        false => mesh,
    }
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// A motion without rotation.
pub fn moved(x: f64, y: f64, z: f64) -> Pose {
    Pose { translation: [x, y, z], ..Pose::IDENTITY }
}

/// A box with these edge lengths about a point.
pub fn block(size: [f64; 3], [x, y, z]: [f64; 3]) -> Body {
    Body { shape: Shape::Box { size }, pose: moved(x, y, z), solid: true }
}

/// A ball about a point.
pub fn round(radius: f64, [x, y, z]: [f64; 3]) -> Body {
    Body { shape: Shape::Sphere { radius }, pose: moved(x, y, z), solid: true }
}

/// A plate in the plane x = 0 with a square hole about the origin, of four boxes.
pub fn plate_with_hole(hole: f64, width: f64, thickness: f64) -> Vec<Body> {
    let rim = (width - hole) / 2.0;
    let middle = (width + hole) / 4.0;
    let upright = [thickness, rim, width];
    let level = [thickness, hole, rim];
    vec![
        block(upright, [0.0, middle, 0.0]),
        block(upright, [0.0, -middle, 0.0]),
        block(level, [0.0, 0.0, middle]),
        block(level, [0.0, 0.0, -middle]),
    ]
}

/// Four balls of different sizes about a narrow passage along x.
pub fn four_balls() -> Vec<Body> {
    vec![
        round(1.0, [0.0, 1.55, 0.1]),
        round(0.8, [0.1, -1.3, 0.0]),
        round(0.9, [-0.1, 0.1, 1.4]),
        round(0.7, [0.0, 0.0, -1.25]),
    ]
}
