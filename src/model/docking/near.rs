//! The protein's atoms in cubic cells, to find those near a place without looking at all.

use crate::structure::Point;

/// The edge of a cell, Å: about what asks for atoms near a place looks so far.
const EDGE: f64 = 3.0;

/// Points sorted by their cells.
#[derive(Clone, Debug)]
pub(super) struct NearAtoms {
    /// The cells' numbers along x, y and z with the points in them.
    sorted: Vec<([i64; 3], Point)>,
}

impl NearAtoms {
    /// Sorts some points.
    pub fn new(points: &[Point]) -> NearAtoms {
        let mut sorted: Vec<_> = points.iter().map(|point| (cell(point), *point)).collect();
        // A stable sort: points of one cell keep their order.
        sorted.sort_by_key(|(cell, _)| *cell);
        NearAtoms { sorted }
    }

    /// Calls `visit` with every point that is at most `reach` from a place, and with others of the cells there.
    pub fn near(&self, at: &Point, reach: f64, visit: &mut dyn FnMut(&Point)) {
        let corner = |side: f64| cell(&(at + Point::from([side * reach; 3])));
        let ([x0, y0, z0], [x1, y1, z1]) = (corner(-1.0), corner(1.0));
        for x in x0..=x1 {
            for y in y0..=y1 {
                // The cells along z stand beside one another.
                let from = self.sorted.partition_point(|(cell, _)| *cell < [x, y, z0]);
                let of_row = self.sorted[from..].iter();
                of_row
                    .take_while(|(cell, _)| *cell <= [x, y, z1])
                    .for_each(|(_, point)| visit(point));
            }
        }
    }
}

fn cell(point: &Point) -> [i64; 3] {
    [point.x, point.y, point.z].map(|x| (x / EDGE).floor() as i64)
}
