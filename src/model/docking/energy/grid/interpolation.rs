//! Values between the points of a grid.

use super::shape::Place;
use crate::structure::Point;

/// The values of one map, `N` numbers at every point.
pub(super) struct Map<'a> {
    /// All values of the grid.
    pub values: &'a [f32],
    /// Where the map's begin in a layer.
    pub begin: usize,
    /// How many points there are along each axis.
    pub counts: [usize; 3],
    /// How many values a layer has.
    pub layer: usize,
    /// One over the spacing, in 1/Å.
    pub per: f64,
}

impl Map<'_> {
    /// Where the numbers of a point stand.
    #[inline(always)]
    fn index<const N: usize>(&self, [x, y, z]: [usize; 3]) -> usize {
        z * self.layer + self.begin + (y * self.counts[0] + x) * N
    }

    /// The numbers of a point.
    #[inline(always)]
    pub fn at<const N: usize>(&self, point: [usize; 3]) -> [f64; N] {
        let first = self.index::<N>(point);
        let values = &self.values[first..first + N];
        std::array::from_fn(|number| f64::from(values[number]))
    }

    /// The numbers of a point, and how much larger those of the next one along x are.
    #[inline(always)]
    fn along_x<const N: usize>(&self, point: [usize; 3]) -> ([f64; N], [f64; N]) {
        let first = self.index::<N>(point);
        let values = &self.values[first..first + 2 * N];
        let low: [f64; N] = std::array::from_fn(|number| f64::from(values[number]));
        (low, std::array::from_fn(|number| f64::from(values[N + number]) - low[number]))
    }
}

/// The value at the nearest point, and the slopes between the points on either side of it (at the grid's faces: between it
/// and the one inwards).
#[inline(always)]
pub(super) fn nearest(map: &Map, place: &Place) -> (f64, Point) {
    let point = place.nearest();
    let [value] = map.at::<1>(point);
    let slope = |axis: usize| {
        let (mut before, mut after) = (point, point);
        before[axis] = point[axis].saturating_sub(1);
        after[axis] = (point[axis] + 1).min(map.counts[axis] - 1);
        let ([low], [high]) = (map.at::<1>(before), map.at::<1>(after));
        (high - low) * map.per / (after[axis] - before[axis]) as f64
    };
    (value, Point::new(slope(0), slope(1), slope(2)))
}

/// Linear along each axis between the eight points around: the values, and their gradients.
#[inline(always)]
pub(super) fn linear<const N: usize>(map: &Map, place: &Place) -> ([f64; N], [Point; N]) {
    let [x, y, z] = place.point;
    let [along_x, along_y, along_z] = place.part;
    let (low00, step00) = map.along_x::<N>([x, y, z]);
    let (low10, step10) = map.along_x::<N>([x, y + 1, z]);
    let (low01, step01) = map.along_x::<N>([x, y, z + 1]);
    let (low11, step11) = map.along_x::<N>([x, y + 1, z + 1]);
    let (mut values, mut gradients) = ([0.0; N], [Point::zeros(); N]);
    for number in 0..N {
        let (x00, x10, x01, x11) = (step00[number], step10[number], step01[number], step11[number]);
        let v00 = low00[number] + along_x * x00;
        let v10 = low10[number] + along_x * x10;
        let v01 = low01[number] + along_x * x01;
        let v11 = low11[number] + along_x * x11;
        let (y0, y1) = (v10 - v00, v11 - v01);
        let (v0, v1) = (v00 + along_y * y0, v01 + along_y * y1);
        let (x0, x1) = (x00 + along_y * (x10 - x00), x01 + along_y * (x11 - x01));
        values[number] = v0 + along_z * (v1 - v0);
        gradients[number] =
            Point::new(x0 + along_z * (x1 - x0), y0 + along_z * (y1 - y0), v1 - v0) * map.per;
    }
    (values, gradients)
}

/// The weights of four points for a place `t` (0 to 1) between the inner two, each with its derivative by `t`.
///
/// E. Catmull, R. Rom, "A class of local interpolating splines", in Computer Aided Geometric Design, 1974, 317-326.
#[inline(always)]
fn catmull_rom(t: f64) -> [[f64; 2]; 4] {
    let square = t * t;
    let cube = square * t;
    [
        [0.5 * (2.0 * square - cube - t), 0.5 * (4.0 * t - 3.0 * square - 1.0)],
        [0.5 * (3.0 * cube - 5.0 * square + 2.0), 0.5 * (9.0 * square - 10.0 * t)],
        [0.5 * (4.0 * square - 3.0 * cube + t), 0.5 * (8.0 * t - 9.0 * square + 1.0)],
        [0.5 * (cube - square), 0.5 * (3.0 * square - 2.0 * t)],
    ]
}

/// Catmull-Rom splines along each axis through the 64 points around: the values, and their gradients. At the grid's faces
/// the outermost point stands for the one that would be beyond.
#[inline(always)]
pub(super) fn cubic<const N: usize>(map: &Map, place: &Place) -> ([f64; N], [Point; N]) {
    let [weights_x, weights_y, weights_z] = place.part.map(catmull_rom);
    let index = |axis: usize, step: usize| {
        (place.point[axis] + step).saturating_sub(1).min(map.counts[axis] - 1)
    };
    let (mut values, mut gradients) = ([0.0; N], [Point::zeros(); N]);
    for (step_z, [weight_z, slope_z]) in weights_z.into_iter().enumerate() {
        // The plane's values, and its slopes along x and y.
        let mut plane = [[0.0; N]; 3];
        for (step_y, [weight_y, slope_y]) in weights_y.into_iter().enumerate() {
            let mut line = [[0.0; N]; 2];
            for (step_x, [weight_x, slope_x]) in weights_x.into_iter().enumerate() {
                let point = [index(0, step_x), index(1, step_y), index(2, step_z)];
                let numbers = map.at::<N>(point);
                for number in 0..N {
                    line[0][number] += weight_x * numbers[number];
                    line[1][number] += slope_x * numbers[number];
                }
            }
            for number in 0..N {
                plane[0][number] += weight_y * line[0][number];
                plane[1][number] += weight_y * line[1][number];
                plane[2][number] += slope_y * line[0][number];
            }
        }
        for number in 0..N {
            values[number] += weight_z * plane[0][number];
            gradients[number] += Point::new(
                weight_z * plane[1][number],
                weight_z * plane[2][number],
                slope_z * plane[0][number],
            );
        }
    }
    (values, gradients.map(|gradient| gradient * map.per))
}
