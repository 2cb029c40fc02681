//! Oriented boxes around sets of points (S. Gottschalk, M. C. Lin, D. Manocha, *OBBTree: a hierarchical
//! structure for rapid interference detection*, SIGGRAPH 1996).

use super::element::Element;
use nalgebra::Matrix3;
use parry3d_f64::math::Vector;

/// An oriented bounding box: all `p` with `|axis · (p − centre)| ≤ half` for each of its three unit axes, the short side
/// first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Obb {
    pub centre: Vector,
    pub axes: [Vector; 3],
    pub half: Vector,
    /// Half its diagonal.
    pub radius: f64,
}

/// The axes of the frame itself.
pub(super) const UPRIGHT: [Vector; 3] = [Vector::X, Vector::Y, Vector::Z];
/// For at most this many elements the box is also tried along the edges of every triangle.
const FEW: usize = 16;

impl Obb {
    /// The box of least surface among those along the axes of the frame, along the principal axes of the corners,
    /// along those of the surface, and, for few elements, along the edges of every triangle.
    pub fn around(elements: &[&Element]) -> Obb {
        let mut best = Obb::along(UPRIGHT, elements);
        let mut offer = |frame: Option<[Vector; 3]>| {
            if let Some(frame) = frame {
                let other = Obb::along(frame, elements);
                if other.surface() < 0.999 * best.surface() {
                    best = other;
                }
            }
        };
        // One or two triangles fit best along their edges, so that principal axes need not be computed for most nodes.
        let edges = elements.len() <= 2 && elements.iter().all(|one| one.normal != Vector::ZERO);
        if !edges {
            offer(principal(elements, false));
            offer(principal(elements, true));
        }
        if elements.len() <= FEW {
            for element in elements {
                let [a, b, c] = element.corners;
                for edge in [b - a, c - b, a - c] {
                    offer(frame(element.normal, edge));
                }
            }
        }
        best
    }

    /// Whether one of the box's axes separates the box from a ball of the given radius that goes straight from one
    /// point to another, so that the ball misses it.
    #[inline]
    pub fn misses(&self, [from, to]: [Vector; 2], radius: f64) -> bool {
        let (first, last) = (from - self.centre, to - self.centre);
        let apart = |axis: Vector, half: f64| {
            let (begin, end, reach) = (axis.dot(first), axis.dot(last), half + radius);
            begin > reach && end > reach || begin < -reach && end < -reach
        };
        let ([a, b, c], half) = (self.axes, self.half);
        apart(a, half.x) || apart(b, half.y) || apart(c, half.z)
    }

    fn along(axes: [Vector; 3], elements: &[&Element]) -> Obb {
        let mut sides = axes.map(|axis| (0.0, axis));
        let mut centre = Vector::ZERO;
        for (half, axis) in &mut sides {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for element in elements {
                let (from, to) = element.span(*axis);
                low = low.min(from);
                high = high.max(to);
            }
            centre += *axis * (0.5 * (low + high));
            *half = 0.5 * (high - low);
        }
        // The short side comes first: two boxes that are apart are most often separated along it.
        sides.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let half = Vector::from_array(sides.map(|(half, _)| half));
        // More than the rounding of the axes can make the box too small.
        let half = half + Vector::splat(1e-12 * (half.length() + centre.length()));
        let axes = sides.map(|(_, axis)| axis);
        Obb { centre, axes, half, radius: half.length() }
    }

    fn surface(&self) -> f64 {
        let Vector { x, y, z } = self.half;
        x * y + y * z + z * x
    }
}

/// The frame with the first axis along `first` and the second towards `second`; `None` where they
/// span no plane.
fn frame(first: Vector, second: Vector) -> Option<[Vector; 3]> {
    let unit = |v: Vector| {
        let length = v.length();
        (length > 1e-150).then(|| v / length)
    };
    let first = unit(first)?;
    let across = |v: Vector| unit(v - first * first.dot(v));
    // Done twice, so that even nearly parallel vectors give axes at right angles.
    let second = across(across(unit(second)?)?)?;
    (first.dot(second).abs() < 1e-14).then(|| [first, second, first.cross(second)])
}

/// The eigenvectors of the covariance of the corners; with `by_area`, of points spread over the
/// surface.
fn principal(elements: &[&Element], by_area: bool) -> Option<[Vector; 3]> {
    let mut points = Vec::new();
    for element in elements {
        let area = if by_area { element.normal.length() } else { 1.0 };
        let [a, b, c] = element.corners;
        points.extend([(a, area), (b, area), (c, area)]);
        if by_area {
            points.push(((a + b + c) / 3.0, 9.0 * area));
        }
    }
    let whole: f64 = points.iter().map(|(_, weight)| weight).sum();
    if whole <= 0.0 {
        return None;
    }
    let mean = points.iter().fold(Vector::ZERO, |sum, (p, weight)| sum + *p * (weight / whole));
    let size = points.iter().fold(0.0f64, |most, (p, _)| most.max((*p - mean).abs().max_element()));
    if size <= 0.0 {
        return None;
    }
    let mut spread = Matrix3::zeros();
    for (p, weight) in &points {
        let d = ((*p - mean) / size).to_array();
        for i in 0..3 {
            for j in 0..3 {
                spread[(i, j)] += d[i] * d[j] * (weight / whole);
            }
        }
    }
    let eigen = spread.symmetric_eigen();
    let vector = |i: usize| {
        let column = eigen.eigenvectors.column(i);
        Vector::new(column[0], column[1], column[2])
    };
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]).then(a.cmp(b)));
    frame(vector(order[0]), vector(order[1]))
}
