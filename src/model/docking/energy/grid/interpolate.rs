//! Interpolation.

use crate::structure::Point;

/// A place in the grid: its cell, and how far it is into it along each axis, 0 to 1.
pub(super) struct Cell {
    pub base: [usize; 3],
    pub part: [f64; 3],
}

pub(super) struct Shape {
    pub counts: [usize; 3],
    pub layer: usize,
    pub per: f64,
}

#[inline(always)]
fn at<const N: usize>(values: &[f32], shape: &Shape, begin: usize, [x, y, z]: [usize; 3]) -> [f64; N] {
    let first = z * shape.layer + begin + (y * shape.counts[0] + x) * N;
    let values = &values[first..first + N];
    std::array::from_fn(|channel| f64::from(values[channel]))
}

#[inline(always)]
pub(super) fn nearest(values: &[f32], shape: &Shape, begin: usize, cell: &Cell) -> (f64, Point) {
    let place = |axis: usize| cell.base[axis] + usize::from(cell.part[axis] >= 0.5);
    let place = [place(0), place(1), place(2)];
    let [value] = at::<1>(values, shape, begin, place);
    let slope = |axis: usize| {
        let (mut before, mut after) = (place, place);
        before[axis] = place[axis].saturating_sub(1);
        after[axis] = (place[axis] + 1).min(shape.counts[axis] - 1);
        let [b] = at::<1>(values, shape, begin, before);
        let [a] = at::<1>(values, shape, begin, after);
        (a - b) * shape.per / (after[axis] - before[axis]) as f64
    };
    (value, Point::new(slope(0), slope(1), slope(2)))
}

#[inline(always)]
pub(super) fn linear<const N: usize>(
    values: &[f32],
    shape: &Shape,
    begin: usize,
    Cell { base, part }: &Cell,
) -> ([f64; N], [Point; N]) {
    let [x, y, z] = *base;
    let row = |y: usize, z: usize| {
        let first = z * shape.layer + begin + (y * shape.counts[0] + x) * N;
        let values = &values[first..first + 2 * N];
        let low: [f64; N] = std::array::from_fn(|c| f64::from(values[c]));
        let step: [f64; N] = std::array::from_fn(|c| f64::from(values[N + c]) - f64::from(values[c]));
        (low, step)
    };
    let (r00, r10, r01, r11) = (row(y, z), row(y + 1, z), row(y, z + 1), row(y + 1, z + 1));
    let mut out = ([0.0; N], [Point::zeros(); N]);
    let [px, py, pz] = *part;
    for c in 0..N {
        let v00 = r00.0[c] + px * r00.1[c];
        let v10 = r10.0[c] + px * r10.1[c];
        let v01 = r01.0[c] + px * r01.1[c];
        let v11 = r11.0[c] + px * r11.1[c];
        let (v0, d0) = (v00 + py * (v10 - v00), v10 - v00);
        let (v1, d1) = (v01 + py * (v11 - v01), v11 - v01);
        let x0 = r00.1[c] + py * (r10.1[c] - r00.1[c]);
        let x1 = r01.1[c] + py * (r11.1[c] - r01.1[c]);
        out.0[c] = v0 + pz * (v1 - v0);
        out.1[c] = Point::new(x0 + pz * (x1 - x0), d0 + pz * (d1 - d0), v1 - v0) * shape.per;
    }
    out
}

/// Catmull-Rom weights and their derivatives.
#[inline(always)]
fn weights(t: f64) -> ([f64; 4], [f64; 4]) {
    let (t2, t3) = (t * t, t * t * t);
    (
        [
            0.5 * (2.0 * t2 - t3 - t),
            0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
            0.5 * (4.0 * t2 - 3.0 * t3 + t),
            0.5 * (t3 - t2),
        ],
        [
            0.5 * (4.0 * t - 3.0 * t2 - 1.0),
            0.5 * (9.0 * t2 - 10.0 * t),
            0.5 * (8.0 * t - 9.0 * t2 + 1.0),
            0.5 * (3.0 * t2 - 2.0 * t),
        ],
    )
}

#[inline(always)]
pub(super) fn cubic<const N: usize>(
    values: &[f32],
    shape: &Shape,
    begin: usize,
    Cell { base, part }: &Cell,
) -> ([f64; N], [Point; N]) {
    let [wx, wy, wz] = [0, 1, 2].map(|axis: usize| weights(part[axis]));
    let index = |axis: usize, step: usize| {
        (base[axis] + step).saturating_sub(1).min(shape.counts[axis] - 1)
    };
    let mut out = ([0.0; N], [Point::zeros(); N]);
    for k in 0..4 {
        let z = index(2, k);
        let (mut plane, mut plane_x, mut plane_y) = ([0.0; N], [0.0; N], [0.0; N]);
        for j in 0..4 {
            let y = index(1, j);
            let (mut line, mut line_x) = ([0.0; N], [0.0; N]);
            for i in 0..4 {
                let value = at::<N>(values, shape, begin, [index(0, i), y, z]);
                for c in 0..N {
                    line[c] += wx.0[i] * value[c];
                    line_x[c] += wx.1[i] * value[c];
                }
            }
            for c in 0..N {
                plane[c] += wy.0[j] * line[c];
                plane_x[c] += wy.0[j] * line_x[c];
                plane_y[c] += wy.1[j] * line[c];
            }
        }
        for c in 0..N {
            out.0[c] += wz.0[k] * plane[c];
            out.1[c] += Point::new(wz.0[k] * plane_x[c], wz.0[k] * plane_y[c], wz.1[k] * plane[c]) * shape.per;
        }
    }
    out
}
