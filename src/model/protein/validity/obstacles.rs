//! Atoms that stand still, in cells, so that a chain is held against those near it alone.
//!
//! Cells are boxes of one size that fill the box around all obstacles. The points are sorted by their cells, those of cells
//! that follow one another along z standing side by side, so that the points near a place are a few ranges of the list.

use crate::structure::Point;
use std::ops::{ControlFlow, Range};

/// The edge of a cell, Å, unless there would be too many: about the reach of the rules.
const EDGE: f64 = 3.0;
/// The most cells for each point. Cells are made larger until there are no more.
const CELLS_PER_POINT: f64 = 16.0;
/// The most cells along an axis.
const CELLS_ALONG_AXIS: f64 = 1024.0;
/// Outweighs the rounding of sums and differences of coordinates of at most [`LARGEST`], Å.
const MARGIN: f64 = 1e-6;
/// Beyond this, Å, rounding would matter.
const LARGEST: f64 = 1e6;

/// Rigid atoms around the chain, in the source's frame, Å.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    points: Vec<Point>,
    /// `None` where a coordinate is no number, or too large.
    cells: Option<Cells>,
}

impl Obstacles {
    /// These, in this order, by which violations name them.
    pub fn new(points: Vec<Point>) -> Obstacles {
        let is_small = points.iter().flatten().all(|value| value.abs() <= LARGEST);
        Obstacles { cells: (is_small && !points.is_empty()).then(|| Cells::new(&points)), points }
    }

    /// Their positions.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Calls `each` with the numbers of all obstacles that lie within `reach`, Å, of the box between two corners along every axis,
    /// and of others, once each; the order is the same everywhere. Where a coordinate of the box is no number it is all of
    /// them. Stops with the first break.
    pub(super) fn near<B>(
        &self,
        [low, high]: [Point; 2],
        reach: f64,
        mut each: impl FnMut(usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let is_small = low.iter().chain(&high).all(|value| value.abs() <= LARGEST);
        let Some(cells) = self.cells.as_ref().filter(|_| is_small) else {
            return (0..self.points.len()).try_for_each(each);
        };
        let reach = Point::repeat(reach + MARGIN);
        let Some([x, y, z]) = cells.between(&(low - reach), &(high + reach)) else {
            return ControlFlow::Continue(());
        };
        for x in x {
            for y in y.clone() {
                let row = (x * cells.counts[1] + y) * cells.counts[2];
                let [from, to] = [z.start, z.end].map(|z| cells.begins[row + z] as usize);
                for number in &cells.sorted[from..to] {
                    each(*number as usize)?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

/// Cells and the points in them.
#[derive(Clone, Debug)]
struct Cells {
    /// The least corner of the box around all points.
    low: Point,
    /// The greatest.
    high: Point,
    /// One over the edge of a cell, 1/Å.
    per_edge: f64,
    /// How many cells there are along x, y and z.
    counts: [usize; 3],
    /// For each cell, those along z standing side by side, where its points begin in `sorted`; and the end of all.
    begins: Vec<u32>,
    /// The numbers of the points, by their cells, and within a cell ascending.
    sorted: Vec<u32>,
}

impl Cells {
    /// Of some points, at least one, all coordinates of which are numbers.
    fn new(points: &[Point]) -> Cells {
        let first = points[0];
        let low = points.iter().fold(first, |low, point| low.inf(point));
        let high = points.iter().fold(first, |high, point| high.sup(point));
        let mut edge = EDGE;
        let most = CELLS_PER_POINT * points.len() as f64;
        let counts = loop {
            let counts = (high - low).map(|length| (length / edge).floor() + 1.0);
            if counts.product() <= most && counts.max() <= CELLS_ALONG_AXIS {
                break counts;
            }
            edge *= 1.25;
        };
        let counts = [0, 1, 2].map(|axis| counts[axis] as usize);
        let mut cells = Cells {
            low,
            high,
            per_edge: 1.0 / edge,
            counts,
            begins: Vec::new(),
            sorted: Vec::new(),
        };
        let cell = |point: &Point| {
            let [x, y, z] = [0, 1, 2].map(|axis| cells.along(axis, point[axis]));
            (x * counts[1] + y) * counts[2] + z
        };
        let mut begins = vec![0; counts.iter().product::<usize>() + 1];
        points.iter().for_each(|point| begins[cell(point) + 1] += 1);
        for at in 1..begins.len() {
            begins[at] += begins[at - 1];
        }
        let mut sorted: Vec<u32> = (0..points.len() as u32).collect();
        sorted.sort_by_key(|number| cell(&points[*number as usize]));
        (cells.begins, cells.sorted) = (begins, sorted);
        cells
    }

    /// The number of the cell that a coordinate is in; of the nearest where it is outside. It never falls as the coordinate
    /// grows, rounded or not.
    fn along(&self, axis: usize, value: f64) -> usize {
        let number = (value - self.low[axis]) * self.per_edge;
        // What is below 0 becomes 0.
        (number as usize).min(self.counts[axis] - 1)
    }

    /// The cells that a box has points of, by axis; `None` if all cells are outside.
    fn between(&self, low: &Point, high: &Point) -> Option<[Range<usize>; 3]> {
        let is_apart = |axis: usize| high[axis] < self.low[axis] || low[axis] > self.high[axis];
        if (0..3).any(is_apart) {
            return None;
        }
        Some([0, 1, 2].map(|axis| self.along(axis, low[axis])..self.along(axis, high[axis]) + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// How often each obstacle is visited.
    fn visits(obstacles: &Obstacles, corners: [Point; 2], reach: f64) -> Vec<usize> {
        let mut visits = vec![0; obstacles.points().len()];
        let flow = obstacles.near(corners, reach, |number| {
            visits[number] += 1;
            ControlFlow::<()>::Continue(())
        });
        assert!(flow.is_continue());
        visits
    }

    proptest! {
        #[test]
        fn all_that_are_near_are_visited_once(
            points in prop::collection::vec(prop::array::uniform3(-20f64..20.0), 0..120),
            stretch in prop::array::uniform3(0usize..3),
            low in prop::array::uniform3(-30f64..30.0),
            size in prop::array::uniform3(0f64..9.0),
            reach in 0f64..10.0,
        ) {
            // Some are flat, and some so long that cells become large.
            let factor = stretch.map(|k| [0.0, 1.0, 3e4][k]);
            let points = points.into_iter().map(Point::from);
            let points: Vec<Point> =
                points.map(|point| point.component_mul(&Point::from(factor))).collect();
            let obstacles = Obstacles::new(points.clone());
            let low = Point::from(low);
            let high = low + Point::from(size);
            let found = visits(&obstacles, [low, high], reach);
            for (point, visits) in points.iter().zip(found) {
                let away = (low - point).sup(&(point - high)).sup(&Point::zeros());
                prop_assert!(visits <= 1 && (visits == 1 || away.max() > reach), "{point}");
            }
        }
    }

    #[test]
    fn few_are_visited_far_from_most() {
        let grid = (0..20_000)
            .map(|k| Point::new((k % 20) as f64, ((k / 20) % 20) as f64, (k / 400) as f64) * 2.0);
        let obstacles = Obstacles::new(grid.collect());
        let place = Point::new(20.0, 20.0, 50.0);
        let near: usize = visits(&obstacles, [place; 2], 2.6).iter().sum();
        // Three points along every axis are within the reach; three cells, which are looked at, hold at most five.
        assert!((27..=125).contains(&near), "{near}");
        let outside = Point::new(200.0, 20.0, 50.0);
        assert_eq!(visits(&obstacles, [outside; 2], 2.6).iter().sum::<usize>(), 0);
    }

    #[test]
    fn what_is_no_number_is_near_everything() {
        let points = vec![Point::zeros(), Point::repeat(50.0)];
        let obstacles = Obstacles::new(points.clone());
        for odd in [f64::NAN, f64::INFINITY, 1e30] {
            let corner = Point::new(0.0, odd, 0.0);
            assert_eq!(visits(&obstacles, [Point::zeros(), corner], 1.0), [1, 1], "{odd}");
            let with_odd = Obstacles::new([&points[..], &[corner]].concat());
            assert_eq!(visits(&with_odd, [Point::zeros(); 2], 1.0), [1, 1, 1], "{odd}");
        }
        assert_eq!(visits(&Obstacles::default(), [Point::zeros(); 2], 1.0), []);
    }
}
