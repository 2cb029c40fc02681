//! Where the plane of motion, z = 0, cuts a body.

use crate::scene::{Body, Shape, Surface, tessellate};
use petgraph::unionfind::UnionFind;
use std::collections::BTreeMap;

/// Lines along x on which points inside a section are looked for. Odd, so that one goes through the middle.
const LINES: usize = 15;
/// So many points of a part are given at most.
const POINTS: usize = 8;

type Point = [f64; 2];

/// Points of each part of a body that is an obstacle in the plane, which stand for it. A part is what one closed curve bounds in
/// which the plane cuts the body's surface, or a connected piece of the surface that the plane does not cut.
///
/// The points lie inside the section, as far from its border as may be, the farthest first; of a mesh that is a mere surface they lie on the
/// curve. Last comes a point of the piece, wherever it lies, seen from above, for robots that are not flat; of a primitive, which has one part, it is its middle and
/// comes first. Curves that lie in others bound cavities, or what stands in a cavity: the former are no parts.
pub(super) fn parts(body: &Body) -> Vec<Vec<Point>> {
    let Surface { vertices, triangles } = surface(&body.shape);
    let vertices: Vec<[f64; 3]> = vertices.into_iter().map(|p| body.pose.apply(p)).collect();
    let pieces = match &body.shape {
        Shape::Mesh(mesh) => mesh.pieces(),
        _ => vec![Some(0); vertices.len()],
    };
    let section = Section::of(&vertices, &triangles, &pieces);
    let mut parts = Vec::new();
    for (piece, witness) in body.shape.witnesses().into_iter().enumerate() {
        let [x, y, _] = body.pose.apply(witness);
        let curves = section.curves.iter().enumerate().filter(|(_, curve)| curve.piece == piece);
        let is_cut = curves.clone().next().is_some();
        let outer = curves.filter(|(number, _)| !body.solid || !section.is_inside_others(*number));
        let mut own: Vec<Vec<Point>> = outer
            .map(|(number, curve)| match body.solid {
                true => section.points_inside(number),
                false => curve.points_on(),
            })
            .collect();
        match (own.first_mut(), &body.shape) {
            (None, _) if is_cut => {}
            (None, _) => own.push(vec![[x, y]]),
            (Some(first), Shape::Mesh(_)) => first.push([x, y]),
            (Some(first), _) => first.insert(0, [x, y]),
        }
        parts.append(&mut own);
    }
    parts
}

/// The triangles of a shape, of a mesh also the flat ones, which close its surface.
fn surface(shape: &Shape) -> Surface {
    match shape {
        Shape::Mesh(mesh) => {
            Surface { vertices: mesh.vertices.clone(), triangles: mesh.triangles.clone() }
        }
        // No obstacle is a point.
        other => tessellate(other, 0.0),
    }
}

/// A connected curve in which the plane cuts a surface.
struct Curve {
    /// Number of the piece of the surface.
    piece: usize,
    /// The straight parts, one of each triangle.
    segments: Vec<[Point; 2]>,
}

/// All that the plane cuts of a surface.
struct Section {
    curves: Vec<Curve>,
}

impl Section {
    /// The section of a surface. Corners in the plane count as above it; where nothing is below it, as below it. So a surface that
    /// touches the plane is cut just inside, and a triangle has none or two of its edges cut.
    fn of(vertices: &[[f64; 3]], triangles: &[[u32; 3]], pieces: &[Option<usize>]) -> Section {
        let is_below = vertices.iter().any(|p| p[2] < 0.0);
        let is_above = |corner: u32| match vertices[corner as usize][2] {
            z if is_below => z >= 0.0,
            z => z > 0.0,
        };
        // Where an edge is cut: computed from its lower corner, so that triangles that share it have the same point.
        let cut = |(low, high): (u32, u32)| {
            let (a, b) = (vertices[low as usize], vertices[high as usize]);
            let share = a[2] / (a[2] - b[2]);
            [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
        };
        let mut edges: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        let mut cuts: Vec<([usize; 2], [Point; 2], usize)> = Vec::new();
        for [a, b, c] in triangles {
            let of_triangle = [(*a, *b), (*b, *c), (*c, *a)];
            let crossed = of_triangle.into_iter().filter(|(a, b)| is_above(*a) != is_above(*b));
            let crossed: Vec<_> = crossed.map(|(a, b)| (a.min(b), a.max(b))).collect();
            if let ([one, other], Some(piece)) = (&crossed[..], pieces[*a as usize]) {
                let ends = [*one, *other].map(|edge| {
                    let next = edges.len();
                    *edges.entry(edge).or_insert(next)
                });
                cuts.push((ends, [cut(*one), cut(*other)], piece));
            }
        }
        let mut connected: UnionFind<usize> = UnionFind::new(edges.len());
        for ([one, other], ..) in &cuts {
            connected.union(*one, *other);
        }
        let mut curves: Vec<Curve> = Vec::new();
        let mut numbers = BTreeMap::new();
        for ([edge, _], segment, piece) in cuts {
            let number = *numbers.entry(connected.find(edge)).or_insert(curves.len());
            if number == curves.len() {
                curves.push(Curve { piece, segments: Vec::new() });
            }
            curves[number].segments.push(segment);
        }
        Section { curves }
    }

    /// Whether a curve lies inside an odd number of others, as that of a cavity does.
    fn is_inside_others(&self, number: usize) -> bool {
        let curve = &self.curves[number];
        let points = curve.segments.iter().flatten();
        let Some(left) = points.min_by(|a, b| a[0].total_cmp(&b[0])) else { return false };
        let others = self.curves.iter().enumerate().filter(|(other, _)| *other != number);
        let to_the_left =
            others.flat_map(|(_, other)| other.crossings(left[1])).filter(|x| *x < left[0]).count();
        to_the_left % 2 == 1
    }

    /// Points inside the section beside a curve, the farthest from all curves first.
    fn points_inside(&self, number: usize) -> Vec<Point> {
        let curve = &self.curves[number];
        let heights = curve.segments.iter().flatten().map(|[_, y]| *y);
        let (low, high) = heights
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
        let mut found: Vec<(f64, Point)> = Vec::new();
        for line in 0..LINES {
            let y = low + (high - low) * (line as f64 + 0.5) / LINES as f64;
            let of_curve = |(other, curve): (usize, &Curve)| {
                curve.crossings(y).map(move |x| (x, other == number)).collect::<Vec<_>>()
            };
            let mut crossings: Vec<(f64, bool)> =
                self.curves.iter().enumerate().flat_map(of_curve).collect();
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            for [(left, is_own), (right, is_own_too)] in crossings.as_chunks::<2>().0 {
                let point = [(left + right) / 2.0, y];
                if *is_own || *is_own_too {
                    found.push((self.distance(point), point));
                }
            }
        }
        // Stable: of equals the one that was found first.
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.truncate(POINTS);
        found.into_iter().map(|(_, point)| point).collect()
    }

    /// The distance of a point from the nearest curve.
    fn distance(&self, [x, y]: Point) -> f64 {
        let segments = self.curves.iter().flat_map(|curve| &curve.segments);
        let square = |[a, b]: &[Point; 2]| {
            let (along, from) = ([b[0] - a[0], b[1] - a[1]], [x - a[0], y - a[1]]);
            let length = along[0] * along[0] + along[1] * along[1];
            let share = (along[0] * from[0] + along[1] * from[1]) / length;
            // Of a segment without length any of its points will do.
            let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
            let away = [from[0] - share * along[0], from[1] - share * along[1]];
            away[0] * away[0] + away[1] * away[1]
        };
        segments.map(square).fold(f64::INFINITY, f64::min).sqrt()
    }
}

impl Curve {
    /// Where a line along x at this height crosses the curve.
    fn crossings(&self, y: f64) -> impl Iterator<Item = f64> {
        let crossed = self.segments.iter().filter(move |[a, b]| (a[1] <= y) != (b[1] <= y));
        crossed.map(move |[a, b]| a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
    }

    /// Points on the curve: middles of its segments.
    fn points_on(&self) -> Vec<Point> {
        let step = self.segments.len().div_ceil(POINTS).max(1);
        let some = self.segments.iter().step_by(step);
        some.map(|[a, b]| [0, 1].map(|axis| (a[axis] + b[axis]) / 2.0)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Mesh, Pose, box_surface};

    fn body(shape: Shape, pose: Pose) -> Body {
        Body { shape, pose, solid: true }
    }

    fn mesh(vertices: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Shape {
        Shape::Mesh(Mesh { vertices, triangles })
    }

    /// A box of these edge lengths around a place, as a mesh; turned inside out if it is a cavity.
    fn box_at(size: [f64; 3], at: [f64; 3], is_cavity: bool) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let (corners, triangles) = box_surface(size);
        let moved = corners.map(|corner| [0, 1, 2].map(|axis| corner[axis] + at[axis]));
        let turned = |[a, b, c]: [u32; 3]| if is_cavity { [a, c, b] } else { [a, b, c] };
        (moved.to_vec(), triangles.into_iter().map(turned).collect())
    }

    /// One mesh of several.
    fn both(meshes: impl IntoIterator<Item = (Vec<[f64; 3]>, Vec<[u32; 3]>)>) -> Shape {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for (of_one, its) in meshes {
            let first = vertices.len() as u32;
            triangles.extend(its.into_iter().map(|corners| corners.map(|corner| corner + first)));
            vertices.extend(of_one);
        }
        mesh(vertices, triangles)
    }

    #[test]
    fn a_box_is_cut_through_its_middle() {
        let at = Pose { translation: [2.0, 1.0, 0.2], ..Pose::IDENTITY };
        let (corners, triangles) = box_surface([2.0, 1.0, 1.0]);
        let parts = parts(&body(mesh(corners.to_vec(), triangles), at));
        assert_eq!(parts.len(), 1);
        let [x, y] = parts[0][0];
        assert!((x - 2.0).abs() < 1e-12 && (y - 1.0).abs() < 1e-12, "{parts:?}");
        for [x, y] in &parts[0][..parts[0].len() - 1] {
            assert!((1.0..3.0).contains(x) && (0.5..1.5).contains(y), "{parts:?}");
        }
        // The point of the piece comes last.
        assert_eq!(parts[0].last(), Some(&[1.0, 0.5]));
    }

    /// Two pyramids that hang at one point: one piece, which the plane cuts in two.
    #[test]
    fn what_the_plane_cuts_twice_has_two_parts() {
        let pyramid = |x: f64| [[x, 0.0, -1.0], [x + 1.0, 0.0, -1.0], [x, 1.0, -1.0]];
        let mut vertices = vec![[0.0, 0.0, 1.0]];
        vertices.extend(pyramid(2.0));
        vertices.extend(pyramid(-3.0));
        let of = |i: u32| [[0, i, i + 1], [0, i + 1, i + 2], [0, i + 2, i], [i, i + 2, i + 1]];
        let shape = mesh(vertices, of(1).into_iter().chain(of(4)).collect());
        assert_eq!(shape.witnesses().len(), 1);
        let parts = parts(&body(shape, Pose::IDENTITY));
        assert_eq!(parts.len(), 2, "{parts:?}");
        assert!(parts[0][0][0] > 1.0 && parts[1][0][0] < -0.9, "{parts:?}");
    }

    #[test]
    fn a_cavity_is_no_part_and_what_stands_in_it_is_one() {
        let hollow = |more: Option<_>| {
            let walls =
                [box_at([4.0, 4.0, 4.0], [0.0; 3], false), box_at([3.0, 3.0, 3.0], [0.0; 3], true)];
            parts(&body(both(walls.into_iter().chain(more)), Pose::IDENTITY))
        };
        let walls = hollow(None);
        let in_walls = |[x, y]: &Point| x.abs().max(y.abs()) > 1.5 && x.abs().max(y.abs()) < 2.0;
        assert_eq!(walls.len(), 1, "{walls:?}");
        assert!(walls[0][..walls[0].len() - 1].iter().all(in_walls), "{walls:?}");
        let pillar = box_at([1.0, 1.0, 1.0], [0.5, 0.0, 0.0], false);
        let with_pillar = hollow(Some(pillar));
        assert_eq!(with_pillar.len(), 2);
        let [x, y] = with_pillar[1][0];
        assert!((x - 0.5).abs() < 1e-12 && y.abs() < 1e-12, "{with_pillar:?}");
    }

    #[test]
    fn what_the_plane_touches_is_cut_and_what_it_misses_has_its_point() {
        let at = |z: f64| {
            let (vertices, triangles) = box_at([1.0, 1.0, 1.0], [0.0, 0.0, z], false);
            parts(&body(mesh(vertices, triangles), Pose::IDENTITY))
        };
        for z in [-0.5, 0.5] {
            let parts = at(z);
            assert!(parts.len() == 1 && parts[0].len() > 1, "{parts:?}");
            assert!(parts[0][0].iter().all(|value| value.abs() < 1e-12), "{parts:?}");
        }
        assert_eq!(at(0.6), [[[-0.5, -0.5]]]);
    }

    #[test]
    fn a_mere_surface_has_points_on_its_curve() {
        let (vertices, triangles) = box_at([2.0, 2.0, 2.0], [0.0; 3], false);
        let shell = Body { solid: false, ..body(mesh(vertices, triangles), Pose::IDENTITY) };
        let parts = parts(&shell);
        assert_eq!(parts.len(), 1);
        for [x, y] in &parts[0] {
            assert!((x.abs().max(y.abs()) - 1.0).abs() < 1e-12, "{parts:?}");
        }
    }
}
