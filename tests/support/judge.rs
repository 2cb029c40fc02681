//! An independent judge of paths: slow, plain, and its own.

use roadmill::math;
use roadmill::model::bodies::validity::BoundsMeaning;
use roadmill::problem::Problem;
use roadmill::scene::Shape;
use roadmill::space::BaseJoint;

type Point = [f64; 3];
type Matrix = [[f64; 3]; 3];

/// How much finer than the problem's resolution the judge looks.
const REFINEMENT: f64 = 20.0;

/// A body as triangles, and whether it is an oriented box.
struct Part {
    vertices: Vec<Point>,
    triangles: Vec<[usize; 3]>,
    /// The eight corners stand in the order of a box's corner bits.
    is_box: bool,
    solid: bool,
}

pub struct Judge<'a> {
    problem: &'a Problem,
    robot: Vec<Part>,
    obstacles: Vec<Part>,
    reach: f64,
}

impl<'a> Judge<'a> {
    pub fn new(problem: &'a Problem) -> Judge<'a> {
        let parts = |bodies: &[roadmill::scene::Body]| -> Vec<Part> {
            bodies
                .iter()
                .map(|body| {
                    let rotation = matrix(body.pose.rotation);
                    let place = |p: &Point| add(apply(&rotation, *p), body.pose.translation);
                    let (vertices, triangles, is_box) = match &body.shape {
                        Shape::Box { size } => (corners_of(*size), box_triangles(), true),
                        Shape::Mesh(mesh) => {
                            let index = |t: &[u32; 3]| t.map(|corner| corner as usize);
                            let triangles = mesh.triangles.iter().map(index).collect();
                            (mesh.vertices.clone(), triangles, false)
                        }
                        other => panic!("the judge knows no {}", other.name()),
                    };
                    let vertices = vertices.iter().map(place).collect();
                    Part { vertices, triangles, is_box, solid: body.solid }
                })
                .collect()
        };
        let robot = parts(&problem.model().bodies().expect("bodies").robot().links[0].bodies);
        let lengths = robot.iter().flat_map(|part| &part.vertices).map(|v| dot(*v, *v).sqrt());
        let reach = lengths.fold(0.0, f64::max);
        Judge {
            problem,
            obstacles: parts(problem.model().bodies().expect("bodies").obstacles()),
            robot,
            reach,
        }
    }

    /// Length of a path in the metric: translation and weighted rotation, root of squares.
    pub fn length(&self, path: &[&[f64]]) -> f64 {
        let weight = self.problem.model().bodies().expect("bodies").rotation_length();
        path.windows(2)
            .map(|pair| {
                let (shift, angle) = self.change(pair[0], pair[1]);
                (shift * shift + weight * weight * angle * angle).sqrt()
            })
            .sum()
    }

    /// Walks a path in steps of at most a twentieth of the resolution for any robot point and
    /// returns how many configurations it looked at.
    pub fn walk(&self, path: &[&[f64]]) -> Result<usize, String> {
        let finest = self.problem.model().bodies().expect("bodies").resolution() / REFINEMENT;
        let mut looked = 0;
        let mut last: Option<Vec<Vec<Point>>> = None;
        for pair in path.windows(2) {
            let (shift, angle) = self.change(pair[0], pair[1]);
            let steps = ((shift + self.reach * angle) / finest).ceil().max(1.0) as usize;
            for step in 0..=steps {
                let q = self.between(pair[0], pair[1], step as f64 / steps as f64);
                let placed = self.placed(&q);
                if let Some(last) = &last {
                    let moved = farthest(last, &placed);
                    if moved > finest * (1.0 + 1e-9) {
                        return Err(format!("a robot point jumps by {moved} at {q:?}"));
                    }
                }
                self.look(&q, &placed)?;
                last = Some(placed);
                looked += 1;
            }
        }
        Ok(looked)
    }

    fn translations(&self) -> usize {
        match self.problem.model().bodies().expect("bodies").robot().motion {
            BaseJoint::Fixed => unreachable!("only rigid bodies are judged"),
            BaseJoint::Translation2d | BaseJoint::Rigid2d => 2,
            BaseJoint::Translation3d | BaseJoint::Rigid3d => 3,
        }
    }

    /// Length of the translation and angle of the rotation between two configurations.
    fn change(&self, a: &[f64], b: &[f64]) -> (f64, f64) {
        let axes = self.translations();
        let shift = (0..axes).map(|i| (b[i] - a[i]) * (b[i] - a[i])).sum::<f64>().sqrt();
        let angle = match self.problem.model().bodies().expect("bodies").robot().motion {
            BaseJoint::Fixed => unreachable!("only rigid bodies are judged"),
            BaseJoint::Translation2d | BaseJoint::Translation3d => 0.0,
            BaseJoint::Rigid2d => shortest_turn(a[2], b[2]).abs(),
            // From the chord rather than the arc cosine: |a − b| = 2 sin(angle / 4).
            BaseJoint::Rigid3d => {
                let (plus, minus) =
                    (chord(&a[3..7], &b[3..7], 1.0), chord(&a[3..7], &b[3..7], -1.0));
                let sine = (plus.min(minus) / 2.0).min(1.0);
                4.0 * math::atan2(sine, (1.0 - sine * sine).sqrt())
            }
        };
        (shift, angle)
    }

    fn between(&self, a: &[f64], b: &[f64], t: f64) -> Vec<f64> {
        let axes = self.translations();
        let mut q: Vec<f64> = (0..axes).map(|i| (1.0 - t) * a[i] + t * b[i]).collect();
        match self.problem.model().bodies().expect("bodies").robot().motion {
            BaseJoint::Fixed => unreachable!("only rigid bodies are judged"),
            BaseJoint::Translation2d | BaseJoint::Translation3d => {}
            BaseJoint::Rigid2d => q.push(a[2] + shortest_turn(a[2], b[2]) * t),
            BaseJoint::Rigid3d => q.extend(slerp(&a[3..7], &b[3..7], t)),
        }
        q
    }

    /// The vertices of every robot part in the world's frame.
    fn placed(&self, q: &[f64]) -> Vec<Vec<Point>> {
        let (rotation, translation) =
            match self.problem.model().bodies().expect("bodies").robot().motion {
                BaseJoint::Fixed => unreachable!("only rigid bodies are judged"),
                BaseJoint::Translation2d => (matrix([1.0, 0.0, 0.0, 0.0]), [q[0], q[1], 0.0]),
                BaseJoint::Translation3d => (matrix([1.0, 0.0, 0.0, 0.0]), [q[0], q[1], q[2]]),
                BaseJoint::Rigid2d => {
                    let (sine, cosine) = (math::sin(q[2]), math::cos(q[2]));
                    let turn = [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]];
                    (turn, [q[0], q[1], 0.0])
                }
                BaseJoint::Rigid3d => (matrix([q[3], q[4], q[5], q[6]]), [q[0], q[1], q[2]]),
            };
        let place = |v: &Point| add(apply(&rotation, *v), translation);
        self.robot.iter().map(|part| part.vertices.iter().map(place).collect()).collect()
    }

    /// Looks at one configuration.
    fn look(&self, q: &[f64], placed: &[Vec<Point>]) -> Result<(), String> {
        let bounds = &self.problem.model().bodies().expect("bodies").bounds();
        let axes = self.translations();
        let outside = |p: &[f64]| (0..axes).any(|i| p[i] < bounds.min[i] || p[i] > bounds.max[i]);
        let all_held = bounds.meaning == BoundsMeaning::Body;
        if outside(q) || all_held && placed.iter().flatten().any(|p| outside(p)) {
            return Err(format!("the robot leaves the bounds at {q:?}"));
        }
        for (part, vertices) in self.robot.iter().zip(placed) {
            for (index, obstacle) in self.obstacles.iter().enumerate() {
                if meet((part, vertices), (obstacle, &obstacle.vertices)) {
                    return Err(format!("the robot meets obstacle {index} at {q:?}"));
                }
            }
        }
        Ok(())
    }
}

/// The farthest that a vertex is from where it was; parts are hulls of their vertices, and the
/// farthest point of a hull between two poses is one of them.
fn farthest(before: &[Vec<Point>], after: &[Vec<Point>]) -> f64 {
    let pairs = before.iter().flatten().zip(after.iter().flatten());
    pairs.map(|(a, b)| dot(sub(*b, *a), sub(*b, *a)).sqrt()).fold(0.0, f64::max)
}

fn meet(a: (&Part, &[Point]), b: (&Part, &[Point])) -> bool {
    if a.0.is_box && b.0.is_box {
        return boxes_meet(a.1, b.1);
    }
    surfaces_meet(a, b) || holds_any(b, a.1) || holds_any(a, b.1)
}

/// Whether a solid holds some vertex of the other: brute force over all vertices, so that meshes
/// of several pieces need no bookkeeping.
fn holds_any(part: (&Part, &[Point]), vertices: &[Point]) -> bool {
    let (low, high) = frame(part.1);
    let near = |v: &&Point| (0..3).all(|i| low[i] <= v[i] && v[i] <= high[i]);
    vertices.iter().filter(near).any(|v| holds(part, *v))
}

/// Whether a point lies in a closed surface: the solid angles of its triangles sum to a multiple
/// of 4π other than 0 (A. van Oosterom, J. Strackee, *The solid angle of a plane triangle*, 1983).
fn holds((part, vertices): (&Part, &[Point]), p: Point) -> bool {
    if !part.solid {
        return false;
    }
    let sum: f64 = part
        .triangles
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|corner| sub(vertices[corner], p));
            let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
            let numerator = dot(a, cross(b, c));
            let denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            2.0 * math::atan2(numerator, denominator)
        })
        .sum();
    sum.abs() > 2.0 * std::f64::consts::PI
}

/// Separating axes of two boxes given by their corners: face normals and products of edges.
fn boxes_meet(a: &[Point], b: &[Point]) -> bool {
    let edges = |c: &[Point]| [sub(c[1], c[0]), sub(c[2], c[0]), sub(c[4], c[0])];
    let (ea, eb) = (edges(a), edges(b));
    let products = ea.iter().flat_map(|u| eb.iter().map(|v| cross(*u, *v)));
    let mut axes = ea.into_iter().chain(eb).chain(products);
    !axes.any(|axis| separates(axis, a, b))
}

fn surfaces_meet((a, va): (&Part, &[Point]), (b, vb): (&Part, &[Point])) -> bool {
    let (low, high) = frame(va);
    // Triangles of `b` near all of `a`, then every pair of them.
    let mut near = Vec::new();
    for corners in &b.triangles {
        let triangle = corners.map(|corner| vb[corner]);
        let (l, h) = frame(&triangle);
        if (0..3).all(|i| l[i] <= high[i] && low[i] <= h[i]) {
            near.push((triangle, l, h));
        }
    }
    a.triangles.iter().any(|corners| {
        let triangle = corners.map(|corner| va[corner]);
        let (low, high) = frame(&triangle);
        near.iter().any(|(other, l, h)| {
            (0..3).all(|i| l[i] <= high[i] && low[i] <= h[i]) && triangles_meet(&triangle, other)
        })
    })
}

/// Separating axes of two triangles: both normals, products of edges, and for triangles in one
/// plane the edges' normals within it.
fn triangles_meet(a: &[Point; 3], b: &[Point; 3]) -> bool {
    let edges = |c: &[Point; 3]| [sub(c[1], c[0]), sub(c[2], c[1]), sub(c[0], c[2])];
    let (ea, eb) = (edges(a), edges(b));
    let (na, nb) = (cross(ea[0], ea[1]), cross(eb[0], eb[1]));
    if separates(na, a, b) || separates(nb, a, b) {
        return false;
    }
    for u in ea {
        if separates(cross(na, u), a, b) || eb.iter().any(|v| separates(cross(u, *v), a, b)) {
            return false;
        }
    }
    !eb.iter().any(|v| separates(cross(nb, *v), a, b))
}

/// Whether a gap shows along the axis. An axis without length shows none.
fn separates(axis: Point, a: &[Point], b: &[Point]) -> bool {
    let span = |points: &[Point]| {
        points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            let along = dot(axis, *p);
            (low.min(along), high.max(along))
        })
    };
    let ((low_a, high_a), (low_b, high_b)) = (span(a), span(b));
    dot(axis, axis) > 1e-24 && (high_a < low_b || high_b < low_a)
}

fn shortest_turn(from: f64, to: f64) -> f64 {
    let turn = 2.0 * std::f64::consts::PI;
    let difference = to - from;
    difference - turn * (difference / turn).round()
}

fn chord(a: &[f64], b: &[f64], sign: f64) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - sign * b) * (a - sign * b)).sum::<f64>().sqrt()
}

/// Turns by an even share of the angle along the shorter arc: an orthonormal frame of the plane of
/// the two quaternions, then a point on its circle.
fn slerp(a: &[f64], b: &[f64], t: f64) -> [f64; 4] {
    let inner: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    let sign = if inner < 0.0 { -1.0 } else { 1.0 };
    let across: Vec<f64> = a.iter().zip(b).map(|(a, b)| sign * b - sign * inner * a).collect();
    let sine = across.iter().map(|value| value * value).sum::<f64>().sqrt();
    if sine < 1e-14 {
        return [a[0], a[1], a[2], a[3]];
    }
    let angle = math::atan2(sine, inner.abs()) * t;
    let (along, beside) = (math::cos(angle), math::sin(angle) / sine);
    [0, 1, 2, 3].map(|i| a[i] * along + across[i] * beside)
}

/// The rotation matrix of a unit quaternion `w x y z`.
fn matrix([w, x, y, z]: [f64; 4]) -> Matrix {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

fn corners_of(size: Point) -> Vec<Point> {
    let sign = |i: usize, axis: usize| if i >> axis & 1 == 1 { 0.5 } else { -0.5 };
    (0..8).map(|i| [0, 1, 2].map(|axis| size[axis] * sign(i, axis))).collect()
}

fn box_triangles() -> Vec<[usize; 3]> {
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect()
}

fn frame(points: &[Point]) -> (Point, Point) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in points {
        for i in 0..3 {
            low[i] = low[i].min(p[i]);
            high[i] = high[i].max(p[i]);
        }
    }
    (low, high)
}

fn apply(m: &Matrix, p: Point) -> Point {
    m.map(|row| dot(row, p))
}

fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
