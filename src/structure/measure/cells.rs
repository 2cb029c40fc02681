//! Points in cubic cells, to find those near a place without looking at all.

use crate::structure::Point;

/// Points sorted by the cube that each lies in.
pub(super) struct Cells {
    edge: f64,
    /// The cubes' numbers along x, y and z with the points' indices, ascending.
    sorted: Vec<([i64; 3], usize)>,
}

impl Cells {
    /// Points in cubes whose edge is `reach`, in Å, which is larger than zero.
    pub(super) fn new(points: impl IntoIterator<Item = Point>, reach: f64) -> Cells {
        let points = points.into_iter().enumerate();
        let mut sorted: Vec<_> = points.map(|(i, point)| (cube(&point, reach), i)).collect();
        sorted.sort_unstable();
        Cells { edge: reach, sorted }
    }

    /// Calls `visit` with the index of every point that lies within the reach of `place`, and of others, once each. The
    /// order depends on the points' positions.
    pub(super) fn near(&self, place: &Point, mut visit: impl FnMut(usize)) {
        let [x, y, z] = cube(place, self.edge);
        for x in x.saturating_sub(1)..=x.saturating_add(1) {
            for y in y.saturating_sub(1)..=y.saturating_add(1) {
                // The three cubes along z stand beside one another.
                let [first, last] = [[x, y, z.saturating_sub(1)], [x, y, z.saturating_add(1)]];
                let from = self.sorted.partition_point(|(cube, _)| *cube < first);
                for (_, index) in self.sorted[from..].iter().take_while(|(cube, _)| *cube <= last) {
                    visit(*index);
                }
            }
        }
    }
}

/// The cube of a point. Numbers too large for it are cut off at the largest, and NaN counts as 0: such points are
/// nowhere near anything that is asked for, and whoever visits them measures the distance.
fn cube(point: &Point, edge: f64) -> [i64; 3] {
    [point.x, point.y, point.z].map(|x| (x / edge).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn all_that_are_near_are_visited_once(
            points in prop::collection::vec(prop::array::uniform3(-9f64..9.0), 0..80),
            place in prop::array::uniform3(-12f64..12.0),
            reach in 0.1f64..8.0,
        ) {
            let points: Vec<Point> = points.into_iter().map(Point::from).collect();
            let place = Point::from(place);
            let mut visited = vec![0; points.len()];
            Cells::new(points.iter().copied(), reach).near(&place, |index| visited[index] += 1);
            for (point, visits) in points.iter().zip(visited) {
                prop_assert!(visits <= 1 && (visits == 1 || (point - place).norm() > reach));
            }
        }
    }

    #[test]
    fn points_without_a_cube_of_their_own_do_no_harm() {
        let far = [f64::NAN, f64::INFINITY, f64::MAX, -f64::MAX].map(|x| Point::new(x, 0.0, 0.0));
        let cells = Cells::new(far, 2.0);
        let mut visited = Vec::new();
        for place in &far {
            cells.near(place, |index| visited.push(index));
        }
        assert!(visited.contains(&0));
    }
}
