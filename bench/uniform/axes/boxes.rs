//! Walls of boxes with passages carved out of them.

use roadmill::model::bodies::{BodySpec, ShapeSpec};

/// A box between two corners.
#[derive(Clone, Copy)]
pub struct Cuboid {
    pub min: [f64; 3],
    pub max: [f64; 3],
}

impl Cuboid {
    pub fn new(min: [f64; 3], max: [f64; 3]) -> Cuboid {
        Cuboid { min, max }
    }

    /// All points that are no farther than `reach` from a segment along an axis, as the largest of their coordinates' differences.
    pub fn around([from, to]: [[f64; 3]; 2], reach: f64) -> Cuboid {
        let min = [0, 1, 2].map(|i| from[i].min(to[i]) - reach);
        let max = [0, 1, 2].map(|i| from[i].max(to[i]) + reach);
        Cuboid { min, max }
    }

    fn holds(&self, point: [f64; 3]) -> bool {
        (0..3).all(|i| (self.min[i]..=self.max[i]).contains(&point[i]))
    }

    pub fn body(&self) -> BodySpec {
        let size = [0, 1, 2].map(|i| self.max[i] - self.min[i]);
        let middle = [0, 1, 2].map(|i| 0.5 * (self.min[i] + self.max[i]));
        BodySpec::new(ShapeSpec::Box { size }).at(middle)
    }
}

/// Boxes laid one after the other, each of material or of void, the later ones in the place of the earlier. What is material in the end,
/// as boxes that do not overlap: the cells between all sides of all boxes, with neighbours joined along x, then y, then z.
pub fn carve(laid: &[(Cuboid, bool)]) -> Vec<Cuboid> {
    let lines = [0, 1, 2].map(|axis| {
        let sides = laid.iter().flat_map(|(cuboid, _)| [cuboid.min[axis], cuboid.max[axis]]);
        let mut sides: Vec<f64> = sides.collect();
        sides.sort_by(f64::total_cmp);
        sides.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        sides
    });
    let mut cells = Vec::new();
    for z in lines[2].windows(2) {
        for y in lines[1].windows(2) {
            for x in lines[0].windows(2) {
                let cell = Cuboid::new([x[0], y[0], z[0]], [x[1], y[1], z[1]]);
                let middle = [0, 1, 2].map(|i| 0.5 * (cell.min[i] + cell.max[i]));
                let last = laid.iter().rev().find(|(cuboid, _)| cuboid.holds(middle));
                if last.is_some_and(|(_, material)| *material) {
                    cells.push(cell);
                }
            }
        }
    }
    (0..3).for_each(|axis| join(&mut cells, axis));
    cells
}

/// Joins boxes that follow one another along an axis and agree along the others.
fn join(cells: &mut Vec<Cuboid>, axis: usize) {
    let mut joined: Vec<Cuboid> = Vec::new();
    for cell in cells.drain(..) {
        let agrees = |before: &&mut Cuboid| {
            before.max[axis] == cell.min[axis]
                && (0..3)
                    .filter(|i| *i != axis)
                    .all(|i| before.min[i] == cell.min[i] && before.max[i] == cell.max[i])
        };
        match joined.iter_mut().find(agrees) {
            Some(before) => before.max[axis] = cell.max[axis],
            None => joined.push(cell),
        }
    }
    *cells = joined;
}
