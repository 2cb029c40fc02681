use crate::scene::Mesh;

/// A regular grid of cells over a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    min: [f64; 3],
    max: [f64; 3],
    cells: [usize; 3],
}

/// The most cells of a grid.
const CELLS_MAX: usize = 1 << 24;

impl Grid {
    /// A grid of `cells` cells along x, y and z over the box between two corners. `None` if the box has no volume, a
    /// number is not finite, or there are no cells, or more than 2²⁴.
    pub fn new(min: [f64; 3], max: [f64; 3], cells: [usize; 3]) -> Option<Grid> {
        let has_size = |i: usize| max[i] > min[i] && (max[i] - min[i]).is_finite();
        let count = cells.iter().try_fold(1usize, |count, along| count.checked_mul(*along))?;
        let fits = (1..=CELLS_MAX).contains(&count) && (0..3).all(has_size);
        fits.then_some(Grid { min, max, cells })
    }

    /// The number of cells. They are numbered along x first, then along y, then along z.
    pub fn len(&self) -> usize {
        self.cells.iter().product()
    }

    /// Whether there are no cells, which is never so.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The cell that holds a point; `None` outside of the box. What lies between two cells is in the upper one, and the box's upper sides are
    /// in the last cells.
    pub fn cell_of(&self, point: [f64; 3]) -> Option<usize> {
        let mut cell = 0;
        for axis in (0..3).rev() {
            let (min, max, count) = (self.min[axis], self.max[axis], self.cells[axis]);
            if !(min..=max).contains(&point[axis]) {
                return None;
            }
            let place = ((point[axis] - min) / (max - min) * count as f64) as usize;
            cell = cell * count + place.min(count - 1);
        }
        Some(cell)
    }

    /// How many points are in each cell, and how many in none.
    pub fn counts(&self, points: &[[f64; 3]]) -> (Vec<usize>, usize) {
        let (mut counts, mut outside) = (vec![0; self.len()], 0);
        for point in points {
            match self.cell_of(*point) {
                Some(cell) => counts[cell] += 1,
                None => outside += 1,
            }
        }
        (counts, outside)
    }

    /// The area of a mesh's surface in each cell, in the square of the scene's unit: exact but for rounding. A triangle
    /// that lies in the plane between two cells counts in the upper one.
    pub fn areas(&self, mesh: &Mesh) -> Vec<f64> {
        let mut areas = vec![0.0; self.len()];
        for corners in mesh.faces() {
            let triangle = corners.map(|corner| mesh.vertices[corner as usize]).to_vec();
            self.cut(&triangle, 2, 0, &mut areas);
        }
        areas
    }

    /// Cuts a convex polygon by the planes between the cells along an axis, and what is left along the axes before it.
    /// `cell` is the number of the cell as far as the axes after it tell.
    fn cut(&self, polygon: &[[f64; 3]], axis: usize, cell: usize, areas: &mut [f64]) {
        let (min, max, count) = (self.min[axis], self.max[axis], self.cells[axis]);
        let plane = |index: usize| min + (max - min) * (index as f64 / count as f64);
        let span = polygon.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p[axis]), high.max(p[axis]))
        });
        for index in 0..count {
            let (low, high) = (plane(index), plane(index + 1));
            let last = index + 1 == count;
            if span.1 < low || span.0 > high || span.0 == high && !last {
                continue;
            }
            let above = half(polygon, axis, 1.0, low);
            let inside = half(&above, axis, -1.0, -high);
            let number = cell * count + index;
            match axis {
                0 => areas[number] += area(&inside),
                _ => self.cut(&inside, axis - 1, number, areas),
            }
        }
    }
}

/// The part of a convex polygon where `sign` times the coordinate along an axis is at least `least`.
fn half(polygon: &[[f64; 3]], axis: usize, sign: f64, least: f64) -> Vec<[f64; 3]> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, from) in polygon.iter().enumerate() {
        let to = &polygon[(i + 1) % polygon.len()];
        let (a, b) = (sign * from[axis] - least, sign * to[axis] - least);
        if a >= 0.0 {
            kept.push(*from);
        }
        if (a < 0.0) != (b < 0.0) && a != b {
            let share = a / (a - b);
            kept.push([0, 1, 2].map(|k| from[k] + share * (to[k] - from[k])));
        }
    }
    kept
}

/// The area of a flat polygon.
fn area(polygon: &[[f64; 3]]) -> f64 {
    let Some(first) = polygon.first() else { return 0.0 };
    let mut sum = [0.0; 3];
    for (b, c) in polygon.iter().zip(polygon.iter().skip(1)) {
        let (u, v) = ([0, 1, 2].map(|k| b[k] - first[k]), [0, 1, 2].map(|k| c[k] - first[k]));
        for (k, part) in sum.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            *part += u[i] * v[j] - u[j] * v[i];
        }
    }
    0.5 * (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]).sqrt()
}
