//! Points in cells, so that those near a place are found without a look at all.

use crate::structure::Point;
use std::ops::Range;

/// How many points are looked at at once.
pub(super) const LANES: usize = 8;
/// The edges in Å of cells for sums of pairs: rows are wide, as every row costs as much as a dozen pairs.
pub(super) const WIDE: [f64; 3] = [1.5, 8.0, 8.0];
/// The edges in Å of cells for grids, whose lanes are points of the grid, so that short runs cost no more than long ones.
pub(super) const NARROW: [f64; 3] = [1.5, 3.0, 3.0];
/// The most cells along an axis: of points that are scattered over a large space the cells are larger.
const CELLS_MAX: f64 = 256.0;
/// Where the points are that fill the last lanes: farther from everything than any cut-off.
const FAR: f64 = 1e7;

/// Points in cells. The cells of one y and z are a row; a row's points stand one after the other in the order of x.
///
/// Behind every row stand seven points that are far away, so that its points can be looked at by eights from any of them on:
/// what the last eight have beyond those asked for belongs to the same row, or is far away.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    low: [f64; 3],
    edges: [f64; 3],
    /// One over the edges: a product is quicker than a quotient.
    per: [f64; 3],
    counts: [usize; 3],
    /// For every row and every cell of it, and for the row's end, where its points begin.
    begins: Vec<usize>,
    /// The numbers that the points had, in their new order; `None` of those that are far away.
    pub order: Vec<Option<usize>>,
    /// Their coordinates in Å, in the new order.
    pub at: [Vec<f64>; 3],
}

impl Cells {
    /// Of points, finite ones; cells have at least these edges in Å.
    pub fn new(points: &[Point], least_edges: [f64; 3]) -> Cells {
        let mut low = [0.0; 3];
        let mut edges = least_edges;
        let mut counts = [1; 3];
        for axis in 0..3 {
            let values = points.iter().map(|point| point[axis]);
            let (least, most) = values
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
                    (least.min(value), most.max(value))
                });
            if least <= most {
                low[axis] = least;
                edges[axis] = edges[axis].max((most - least) / CELLS_MAX);
                counts[axis] = cell_of(most - least, 1.0 / edges[axis]) + 1;
            }
        }
        let mut cells = Cells {
            low,
            edges,
            per: edges.map(|edge| 1.0 / edge),
            counts,
            begins: Vec::new(),
            order: Vec::new(),
            at: Default::default(),
        };
        cells.fill(points);
        cells
    }

    fn fill(&mut self, points: &[Point]) {
        let [along_x, along_y, along_z] = self.counts;
        let place = |point: &Point| {
            let [x, y, z] = [0, 1, 2].map(|axis| {
                cell_of(point[axis] - self.low[axis], self.per[axis]).min(self.counts[axis] - 1)
            });
            (z * along_y + y, x)
        };
        let mut sorted: Vec<((usize, usize), usize)> =
            points.iter().map(place).zip(0..points.len()).collect();
        sorted.sort_unstable();
        let mut next = sorted.into_iter().peekable();
        for row in 0..along_y * along_z {
            let before = self.order.len();
            for x in 0..along_x {
                self.begins.push(self.order.len());
                while let Some((_, number)) = next.next_if(|(place, _)| *place == (row, x)) {
                    self.push(Some(number), points[number].into());
                }
            }
            self.begins.push(self.order.len());
            if self.order.len() > before {
                (1..LANES).for_each(|_| self.push(None, [FAR; 3]));
            }
        }
    }

    fn push(&mut self, number: Option<usize>, at: [f64; 3]) {
        self.order.push(number);
        self.at.iter_mut().zip(at).for_each(|(all, value)| all.push(value));
    }

    /// Calls `visit` with every run of points that may be nearer than `reach` (Å) to the stretch along x from `from` on that is
    /// `length` (Å) long, in a fixed order.
    #[inline(always)]
    pub fn runs(&self, from: Point, length: f64, reach: f64, mut visit: impl FnMut(Range<usize>)) {
        let [along_x, along_y, _] = self.counts;
        let squared = reach * reach;
        let Some(ys) = self.range(1, from.y, reach) else { return };
        let Some(zs) = self.range(2, from.z, reach) else { return };
        for z in zs {
            let from_z = self.distance(2, z, from.z);
            for y in ys.clone() {
                let from_y = self.distance(1, y, from.y);
                let left = squared - from_y * from_y - from_z * from_z;
                if left <= 0.0 {
                    continue;
                }
                let width = left.sqrt();
                let first = from.x - width - self.low[0];
                let last = from.x + length + width - self.low[0];
                if last < 0.0 {
                    continue;
                }
                let begin = cell_of(first, self.per[0]);
                if begin >= along_x {
                    continue;
                }
                let end = cell_of(last, self.per[0]).min(along_x - 1) + 1;
                let row = (z * along_y + y) * (along_x + 1);
                let run = self.begins[row + begin]..self.begins[row + end];
                if !run.is_empty() {
                    visit(run);
                }
            }
        }
    }

    /// The cells along an axis that are nearer than `reach` to a value.
    fn range(&self, axis: usize, value: f64, reach: f64) -> Option<Range<usize>> {
        let (first, last) = (value - reach - self.low[axis], value + reach - self.low[axis]);
        let begin = cell_of(first, self.per[axis]);
        let is_there = last >= 0.0 && begin < self.counts[axis] && !self.order.is_empty();
        is_there.then(|| begin..cell_of(last, self.per[axis]).min(self.counts[axis] - 1) + 1)
    }

    /// How far a value is from a cell along an axis.
    fn distance(&self, axis: usize, cell: usize, value: f64) -> f64 {
        let begin = self.low[axis] + cell as f64 * self.edges[axis];
        (begin - value).max(value - (begin + self.edges[axis])).max(0.0)
    }
}

/// The cell of a distance from the first cell's begin, with one over the edge; what is before it is in the first.
fn cell_of(distance: f64, per: f64) -> usize {
    // The conversion cuts off what is behind the point, and makes 0 of what is below it.
    (distance * per) as usize
}
