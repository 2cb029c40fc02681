//! Bodies as they are drawn: flat patches and the edges between them.

use super::coarse::coarser;
use super::vector::{cross, dot, sub};
use super::view::View;
use crate::math;
use crate::scene::{Body, Pose, Shape, box_surface};
use petgraph::unionfind::UnionFind;
use std::collections::BTreeMap;

/// Meshes of more triangles are drawn coarser.
const TRIANGLES_MAX: usize = 4000;
/// Corners of a drawn circle.
const CIRCLE: usize = 40;
/// The edge between two triangles is drawn when the cosine of the angle between their normals is below this.
const SMOOTH: f64 = 0.9;

/// Faces that lie in one plane, or nearly.
pub(super) struct Patch {
    pub polygons: Vec<Vec<[f64; 3]>>,
    /// The outward unit normal.
    pub normal: [f64; 3],
}

/// An edge to be drawn.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    pub ends: [[f64; 3]; 2],
    /// Outward normals of the two faces that meet in the edge; `None` if it is the rim of a single face.
    pub normals: Option<[[f64; 3]; 2]>,
}

/// A connected piece of a body in the world's frame: the faces and edges that the eye may see.
pub(super) struct Solid {
    pub patches: Vec<Patch>,
    pub edges: Vec<Edge>,
    /// Points whose convex hull holds the piece.
    pub points: Vec<[f64; 3]>,
    /// The faces of a box around the piece: outward unit normals `n`, and offsets `n · p` of the points `p` on each
    /// face.
    pub planes: Vec<([f64; 3], f64)>,
    /// Whether that box is the piece itself.
    pub is_box: bool,
}

impl Solid {
    /// A thin line through points. It has no faces, but takes its place in the order in which solids are painted.
    pub fn thread(points: &[[f64; 3]]) -> Solid {
        let (patches, edges, planes) = (Vec::new(), Vec::new(), Vec::new());
        Solid { patches, edges, points: points.to_vec(), planes, is_box: false }
    }

    /// The largest side of the axis-aligned bounding box of the points.
    pub fn extent(&self) -> f64 {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let lengths = axes.map(|axis| {
            let along = self.points.iter().map(|p| dot(axis, *p));
            let (low, high) = along
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(value), high.max(value))
                });
            high - low
        });
        lengths.into_iter().fold(0.0, f64::max)
    }
}

/// The pieces of a body; `frame` is the pose of the body's owner in the world.
pub(super) fn solids(body: &Body, frame: &Pose, view: &View) -> Vec<Solid> {
    let place = |p: [f64; 3]| frame.apply(body.pose.apply(p));
    let turn = |axis: [f64; 3]| sub(place(axis), place([0.0; 3]));
    match &body.shape {
        Shape::Box { size } => {
            let (corners, triangles) = box_surface(*size);
            vec![polyhedron(&corners, &triangles, place, turn, view)]
        }
        Shape::Mesh(mesh) if mesh.triangles.len() <= TRIANGLES_MAX => {
            let triangles: Vec<[u32; 3]> = mesh.faces().collect();
            pieces(&triangles)
                .iter()
                .map(|triangles| polyhedron(&mesh.vertices, triangles, place, turn, view))
                .collect()
        }
        Shape::Mesh(mesh) => {
            let coarse = coarser(mesh, TRIANGLES_MAX);
            pieces(&coarse.triangles)
                .iter()
                .map(|triangles| polyhedron(&coarse.vertices, triangles, place, turn, view))
                .collect()
        }
        Shape::Point => vec![ball_like(&[[0.0; 3]], 0.0, place, turn, view)],
        Shape::Sphere { radius } => vec![ball_like(&[[0.0; 3]], *radius, place, turn, view)],
        Shape::Capsule { radius, height } => {
            let ends = [-height / 2.0, height / 2.0].map(|z| [0.0, 0.0, z]);
            vec![ball_like(&ends, *radius, place, turn, view)]
        }
        Shape::Cylinder { radius, height } => {
            let ring = |z: f64| -> Vec<[f64; 3]> {
                circle().map(|(x, y)| place([radius * x, radius * y, z])).collect()
            };
            let rings = [ring(-height / 2.0), ring(height / 2.0)];
            let high = [*radius, *radius, height / 2.0];
            let mut solid =
                silhouette(&rings.concat(), (high.map(|v| -v), high), place, turn, view);
            let axis = turn([0.0, 0.0, 1.0]);
            let above = dot(axis, view.toward) >= 0.0;
            let [below_ring, above_ring] = rings;
            let (cap, normal) =
                if above { (above_ring, axis) } else { (below_ring, axis.map(|value| -value)) };
            solid.edges.extend(rim(&cap));
            solid.patches.push(Patch { polygons: vec![cap], normal });
            vec![solid]
        }
    }
}

/// The triangles of each connected piece of a mesh. Two triangles are connected by an edge that they alone
/// share: where more than two meet in an edge, pieces merely touch.
fn pieces(triangles: &[[u32; 3]]) -> Vec<Vec<[u32; 3]>> {
    let mut connected = UnionFind::new(triangles.len());
    for sides in sides_of(triangles).values() {
        if let [one, other] = sides[..] {
            connected.union(one, other);
        }
    }
    let labels: Vec<usize> = connected.into_labeling();
    let mut pieces: Vec<Vec<[u32; 3]>> = Vec::new();
    let mut piece_of = BTreeMap::new();
    for (corners, label) in triangles.iter().copied().zip(labels) {
        let piece = *piece_of.entry(label).or_insert(pieces.len());
        if piece == pieces.len() {
            pieces.push(Vec::new());
        }
        pieces[piece].push(corners);
    }
    pieces
}

/// The indices of the triangles at each edge, which is named by its two vertices in ascending order.
fn sides_of(triangles: &[[u32; 3]]) -> BTreeMap<(u32, u32), Vec<usize>> {
    let mut sides_of: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (index, [a, b, c]) in triangles.iter().enumerate() {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            sides_of.entry((*from.min(to), *from.max(to))).or_default().push(index);
        }
    }
    sides_of
}

/// The drawing of a surface of triangles: those that face the eye (all of an open surface), and the sharp edges and
/// outlines among them. `place` and `turn` map points and directions of the body's frame to the world's.
fn polyhedron(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
    place: impl Fn([f64; 3]) -> [f64; 3],
    turn: impl Fn([f64; 3]) -> [f64; 3],
    view: &View,
) -> Solid {
    let mut used: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
    let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for corner in triangles.iter().flatten() {
        let vertex = vertices[*corner as usize];
        used.entry(*corner).or_insert_with(|| place(vertex));
        for axis in 0..3 {
            min[axis] = min[axis].min(vertex[axis]);
            max[axis] = max[axis].max(vertex[axis]);
        }
    }
    let corners_of: Vec<[[f64; 3]; 3]> =
        triangles.iter().map(|corners| corners.map(|corner| used[&corner])).collect();
    // Six times the volume; negative where the triangles are listed inside out.
    let volume: f64 = corners_of.iter().map(|[a, b, c]| dot(*a, cross(*b, *c))).sum();
    let outward = if volume < 0.0 { -1.0 } else { 1.0 };
    let sides_of = sides_of(triangles);
    let closed = sides_of.values().all(|sides| sides.len() % 2 == 0);
    let normals: Vec<[f64; 3]> = corners_of
        .iter()
        .map(|[a, b, c]| {
            let normal = cross(sub(*b, *a), sub(*c, *a));
            let length = dot(normal, normal).sqrt();
            // Of an open surface either side may be seen.
            let sign =
                if closed || dot(normal, view.toward) * outward > 0.0 { outward } else { -outward };
            normal.map(|value| value / length * sign)
        })
        .collect();
    let seen: Vec<bool> =
        normals.iter().map(|normal| !closed || dot(*normal, view.toward) > 1e-9).collect();

    // Triangles with nearly the same normal become one patch, so that no seam shows between them.
    let mut patches: BTreeMap<[i64; 3], Patch> = BTreeMap::new();
    for (index, corners) in corners_of.iter().enumerate().filter(|(index, _)| seen[*index]) {
        let normal = normals[index];
        patches
            .entry(normal.map(|value| (value * 64.0).round() as i64))
            .or_insert_with(|| Patch { polygons: Vec::new(), normal })
            .polygons
            .push(counter_clockwise(*corners, view));
    }
    let edges = sides_of
        .iter()
        .filter(|(_, sides)| {
            let (first, last) = (sides[0], sides[sides.len() - 1]);
            let sharp = sides.len() == 1
                || dot(normals[first], normals[last]) < SMOOTH
                || seen[first] != seen[last];
            sharp && sides.iter().any(|side| seen[*side])
        })
        .map(|((a, b), sides)| Edge {
            ends: [used[a], used[b]],
            normals: match sides[..] {
                [first, second] => Some([normals[first], normals[second]]),
                _ => None,
            },
        })
        .collect();
    let corner = |vertex: &[f64; 3]| {
        (0..3).all(|axis| vertex[axis] == min[axis] || vertex[axis] == max[axis])
    };
    let is_box = closed
        && triangles.len() == 12
        && used.len() == 8
        && used.keys().all(|index| corner(&vertices[*index as usize]));
    Solid {
        patches: patches.into_values().collect(),
        edges,
        points: used.into_values().collect(),
        planes: planes((min, max), place, turn),
        is_box,
    }
}

/// The corners of a triangle in the order that is counter-clockwise in the picture: where front and back of an open surface
/// come to lie in one path, they must not take each other away from what is filled.
fn counter_clockwise([a, b, c]: [[f64; 3]; 3], view: &View) -> Vec<[f64; 3]> {
    let is_front = dot(cross(sub(b, a), sub(c, a)), view.toward) >= 0.0;
    if is_front { vec![a, b, c] } else { vec![a, c, b] }
}

/// The drawing of a convex body as its outline: the convex hull, in the picture, of points of the world's frame. The
/// box holds the body in the body's own frame.
fn silhouette(
    points: &[[f64; 3]],
    (min, max): ([f64; 3], [f64; 3]),
    place: impl Fn([f64; 3]) -> [f64; 3],
    turn: impl Fn([f64; 3]) -> [f64; 3],
    view: &View,
) -> Solid {
    let mut flat: Vec<([f64; 2], [f64; 3])> =
        points.iter().map(|p| ([dot(view.right, *p), dot(view.up, *p)], *p)).collect();
    flat.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    // Andrew's monotone chain: the lower side from left to right, then the upper one back.
    let mut outline: Vec<([f64; 2], [f64; 3])> = Vec::new();
    for side in [flat.clone(), flat.into_iter().rev().collect()] {
        let first = outline.len();
        for point in side {
            while outline.len() >= first + 2 {
                let (a, b) = (outline[outline.len() - 2].0, outline[outline.len() - 1].0);
                let p = point.0;
                let left = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                if left > 0.0 {
                    break;
                }
                outline.pop();
            }
            outline.push(point);
        }
        outline.pop();
    }
    let outline: Vec<[f64; 3]> = outline.into_iter().map(|(_, p)| p).collect();
    let corner = |i: usize| {
        place([0, 1, 2].map(|axis| if i >> axis & 1 == 1 { max[axis] } else { min[axis] }))
    };
    Solid {
        edges: rim(&outline),
        patches: vec![Patch { polygons: vec![outline], normal: view.toward }],
        points: (0..8).map(corner).collect(),
        planes: planes((min, max), place, turn),
        is_box: false,
    }
}

/// The sides of a polygon.
fn rim(polygon: &[[f64; 3]]) -> Vec<Edge> {
    let next = |i: usize| polygon[(i + 1) % polygon.len()];
    polygon.iter().enumerate().map(|(i, p)| Edge { ends: [*p, next(i)], normals: None }).collect()
}

/// The drawing of the convex hull of balls around `centres` on the body's z axis: a ball or a capsule. A point, of
/// radius 0, is drawn as a small ball.
fn ball_like(
    centres: &[[f64; 3]],
    radius: f64,
    place: impl Fn([f64; 3]) -> [f64; 3],
    turn: impl Fn([f64; 3]) -> [f64; 3],
    view: &View,
) -> Solid {
    let drawn = if radius > 0.0 { radius } else { view.length_of(4.0) };
    let rim: Vec<[f64; 3]> = centres
        .iter()
        .flat_map(|centre| {
            let centre = place(*centre);
            circle().map(move |(x, y)| {
                [0, 1, 2].map(|i| centre[i] + drawn * (view.right[i] * x + view.up[i] * y))
            })
        })
        .collect();
    let top = centres.iter().fold(0.0f64, |most, centre| most.max(centre[2]));
    let high = [drawn, drawn, top + drawn];
    silhouette(&rim, (high.map(|value| -value), high), place, turn, view)
}

/// The faces of the box `min`..`max` of a body's frame as normals and offsets in the world's frame.
fn planes(
    (min, max): ([f64; 3], [f64; 3]),
    place: impl Fn([f64; 3]) -> [f64; 3],
    turn: impl Fn([f64; 3]) -> [f64; 3],
) -> Vec<([f64; 3], f64)> {
    let (low, high) = (place(min), place(max));
    let mut planes = Vec::new();
    for axis in 0..3 {
        let mut unit = [0.0; 3];
        unit[axis] = 1.0;
        let normal = turn(unit);
        planes.push((normal, dot(normal, high)));
        planes.push((normal.map(|value| -value), -dot(normal, low)));
    }
    planes
}

/// Points of the unit circle.
fn circle() -> impl Iterator<Item = (f64, f64)> {
    (0..CIRCLE).map(|i| {
        let angle = math::TURN * i as f64 / CIRCLE as f64;
        (math::cos(angle), math::sin(angle))
    })
}
