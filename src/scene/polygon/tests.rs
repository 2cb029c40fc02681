use super::*;
use crate::scene::Pose;
use crate::space::canonical;
use proptest::prelude::*;

/// Cuts a polygon in the plane z = 0.
fn cut_flat(points: &[Point]) -> Result<Vec<[u32; 3]>, String> {
    let vertices: Vec<[f64; 3]> = points.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
    let corners: Vec<u32> = (0..points.len() as u32).collect();
    let mut triangles = Vec::new();
    cut(&corners, &vertices, &mut triangles).map(|()| triangles)
}

/// Turns the corners' order so that another one is first.
fn from(points: &[Point], first: usize) -> Vec<Point> {
    let mut points = points.to_vec();
    points.rotate_left(first);
    points
}

/// Whether an odd number of sides is crossed on the way from a point to the right.
fn is_inside(polygon: &[Point], [x, y]: Point) -> bool {
    let next = polygon.iter().cycle().skip(1);
    let crossed = |(a, b): &(&Point, &Point)| {
        (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    polygon.iter().zip(next).filter(crossed).count() % 2 == 1
}

/// The triangles are as large together as the polygon, and hold exactly the points that it holds.
fn assert_covers(points: &[Point], triangles: &[[u32; 3]]) {
    let area = twice_area(points);
    let sum: f64 = triangles.iter().map(|t| twice_area(&t.map(|i| points[i as usize])).abs()).sum();
    assert!((sum - area.abs()).abs() <= 1e-9 * area.abs(), "{sum} {area} {points:?} {triangles:?}");
    for step in 0..400 {
        // Places off the coordinates that the tests use.
        let place = [step % 20, step / 20].map(|i| f64::from(i) * 0.417_3 - 4.137_9);
        let holding = triangles.iter().filter(|t| is_inside(&t.map(|i| points[i as usize]), place));
        assert_eq!(holding.count(), usize::from(is_inside(points, place)), "{place:?} {points:?}");
    }
}

const U: [Point; 8] = [
    [0.0, 0.0],
    [3.0, 0.0],
    [3.0, 3.0],
    [2.0, 3.0],
    [2.0, 1.0],
    [1.0, 1.0],
    [1.0, 3.0],
    [0.0, 3.0],
];

#[test]
fn a_notch_stays_open_whichever_corner_is_first() {
    for first in 0..U.len() {
        let mut points = from(&U, first);
        for _ in 0..2 {
            let triangles = cut_flat(&points).unwrap();
            assert_eq!(triangles.len(), 6);
            assert_covers(&points, &triangles);
            // And seen from the other side.
            points.reverse();
        }
    }
}

#[test]
fn where_a_fan_covers_the_polygon_it_stays() {
    let fan_of = |count: u32| (2..count).map(|i| [0, i - 1, i]).collect::<Vec<_>>();
    // Convex, with a corner in the middle of a side, which decimals put a little inside.
    let square = [[0.0, 0.0], [1.0, 1e-7], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    for first in 0..square.len() {
        assert_eq!(cut_flat(&from(&square, first)).unwrap(), fan_of(5));
    }
    // Not convex, but all of it is seen from the first corner.
    let dart = [[0.0, 0.5], [-1.0, 0.0], [0.0, 3.0], [1.0, 0.0]];
    assert_eq!(cut_flat(&dart).unwrap(), fan_of(4));
    assert_eq!(cut_flat(&from(&dart, 1)).unwrap().len(), 2);
    assert_covers(&from(&dart, 1), &cut_flat(&from(&dart, 1)).unwrap());
    // A polygon without an area, which joining vertices drops later.
    assert_eq!(cut_flat(&[[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [2.0, 0.0]]).unwrap(), fan_of(4));
}

#[test]
fn a_hole_with_a_bridge_to_it_stays_a_hole() {
    let hole = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [3.0, 3.0],
        [3.0, 1.0],
        [1.0, 1.0],
    ];
    for first in 0..hole.len() {
        let points = from(&hole, first);
        assert_covers(&points, &cut_flat(&points).unwrap());
    }
    // Two notches that meet in a point.
    let touching = [
        [-3.0, -3.0],
        [3.0, -3.0],
        [0.0, 0.0],
        [3.0, 3.0],
        [-3.0, 3.0],
        [-1.0, 1.0],
        [0.0, 0.0],
        [-1.0, -1.0],
    ];
    for first in 0..touching.len() {
        let points = from(&touching, first);
        assert_covers(&points, &cut_flat(&points).unwrap());
    }
}

#[test]
fn polygons_that_cross_themselves_or_are_bent_are_refused() {
    for crossing in [
        // The two halves as large as one another, or not.
        vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]],
        vec![[0.0, 0.0], [3.0, 2.0], [2.0, 0.0], [0.0, 2.0]],
        // A star of five points.
        vec![[0.0, 3.0], [1.8, -2.4], [-2.9, 0.9], [2.9, 0.9], [-1.8, -2.4]],
        // Through a corner, and through the middle of a side.
        vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [2.0, 0.0], [1.0, 1.0], [0.0, 2.0]],
        vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.0], [1.0, -1.0], [0.0, 2.0]],
    ] {
        for first in 0..crossing.len() {
            let error = cut_flat(&from(&crossing, first)).unwrap_err();
            assert!(error.starts_with("a face that crosses itself"), "{error}");
        }
    }
    // Along itself and off to the other side; and twice round.
    let along = [
        [-1.0, 1.0],
        [-2.0, 2.0],
        [2.0, 2.0],
        [0.0, -3.0],
        [-3.0, 3.0],
        [-1.0, 1.0],
        [0.0, -2.0],
        [-1.0, -1.0],
    ];
    for twisted in [along.to_vec(), [U, U].concat()] {
        for first in 0..twisted.len() {
            let error = cut_flat(&from(&twisted, first)).unwrap_err();
            assert!(error.contains("crosses"), "{error}");
        }
    }
    let bent = U.map(|[x, y]| [x, y, if x > 2.5 { 0.2 } else { 0.0 }]);
    let error = cut(&[0, 1, 2, 3, 4, 5, 6, 7], &bent, &mut Vec::new()).unwrap_err();
    assert!(
        error.starts_with("a face with 8 corners that is neither convex nor planar"),
        "{error}"
    );
    let little = bent.map(|[x, y, z]| [x, y, z / 10.0]);
    assert!(cut(&[0, 1, 2, 3, 4, 5, 6, 7], &little, &mut Vec::new()).is_ok());
    let comb: Vec<Point> = (0..10_000).map(|i| [f64::from(i), f64::from(i % 2)]).collect();
    let error = cut_flat(&[&comb[..], &[[5e3, 5e3]]].concat()).unwrap_err();
    assert!(error.starts_with("a face with 10001 corners that is not convex"), "{error}");
}

#[test]
fn a_comb_of_many_teeth_is_cut() {
    let mut comb: Vec<Point> = (0..2001).map(|i| [f64::from(i), f64::from(i % 2)]).collect();
    comb.extend([[2000.0, 5.0], [0.0, 5.0]]);
    comb.rotate_left(700);
    let triangles = cut_flat(&comb).unwrap();
    let sum: f64 = triangles.iter().map(|t| twice_area(&t.map(|i| comb[i as usize])).abs()).sum();
    assert!((sum - twice_area(&comb).abs()).abs() < 1e-9 * sum);
}

/// A simple polygon through points: two sides that cross are exchanged until none do, as in tours that are shortened.
fn untangled(mut points: Vec<Point>) -> Option<Vec<Point>> {
    for _ in 0..1000 {
        match crossings::first(&points, 0.0) {
            None => return Some(points),
            Some((a, b)) => points[a + 1..=b].reverse(),
        }
    }
    None
}

proptest! {
    #[test]
    fn simple_polygons_are_covered_exactly(points in proptest::collection::vec([-4.0f64..4.0, -4.0f64..4.0], 4..24), first in 0usize..24) {
        let Some(points) = untangled(points) else { return Ok(()) };
        let points = from(&points, first % points.len());
        let triangles = cut_flat(&points).map_err(TestCaseError::fail)?;
        prop_assert_eq!(triangles.len(), points.len() - 2);
        assert_covers(&points, &triangles);
    }

    /// In any plane, and at any size, the same triangles come out.
    #[test]
    fn turned_polygons_are_cut_as_they_are_in_their_plane(
        points in proptest::collection::vec([-4.0f64..4.0, -4.0f64..4.0], 4..16),
        turn in [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0], scale in prop::sample::select(vec![1e-3, 1.0, 300.0]),
    ) {
        let Some(points) = untangled(points) else { return Ok(()) };
        let Some(rotation) = canonical(turn) else { return Ok(()) };
        let pose = Pose { translation: [0.3, -0.7, 0.2], rotation };
        let vertices: Vec<[f64; 3]> =
            points.iter().map(|[x, y]| pose.apply([*x, *y, 0.0]).map(|value| value * scale)).collect();
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let mut triangles = Vec::new();
        cut(&corners, &vertices, &mut triangles).map_err(TestCaseError::fail)?;
        assert_covers(&points, &triangles);
    }

    /// Whatever the corners, what is cut is what the polygon holds. Others are refused, and nothing panics.
    #[test]
    fn any_corners_are_cut_or_refused(
        points in proptest::collection::vec([-4i8..5, -4i8..5].prop_map(|point| point.map(f64::from)), 4..12),
        untangle in any::<bool>(),
    ) {
        let points = if untangle { untangled(points.clone()).unwrap_or(points) } else { points };
        if let Ok(triangles) = cut_flat(&points)
            && twice_area(&points) != 0.0
        {
            assert_covers(&points, &triangles);
        }
    }
}
