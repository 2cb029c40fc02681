//! The eye: a parallel projection from the world's frame to the picture, and what hides what.

use super::solid::Solid;
use crate::math;
use std::f64::consts::PI;

/// Largest width and height of the scene in the picture, in pixels.
const EXTENT_PX: [f64; 2] = [1120.0, 800.0];
/// Room around the scene, in pixels.
pub(super) const MARGIN_PX: f64 = 36.0;
/// Where the eye stands around a 3D scene: the angle about z from the x axis, and above the
/// horizon; in radians.
const AZIMUTH: f64 = -64.0 / 180.0 * PI;
const ELEVATION: f64 = 25.0 / 180.0 * PI;

/// A parallel projection. Directions are unit vectors in the world's frame.
pub(super) struct View {
    pub right: [f64; 3],
    pub up: [f64; 3],
    /// From the scene to the eye.
    pub toward: [f64; 3],
    /// Pixels per unit of length.
    scale: f64,
    /// The picture's upper left corner along `right` and `up`, in the scene's unit.
    corner: [f64; 2],
    /// Width and height of the picture in pixels.
    pub size_px: [f64; 2],
}

impl View {
    /// The view from above (planar) or aslant that holds all `points`.
    pub fn new(planar: bool, points: &[[f64; 3]]) -> View {
        let (right, toward) = if planar {
            ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
        } else {
            let (sine, cosine) = (math::sin(AZIMUTH), math::cos(AZIMUTH));
            let (height, flat) = (math::sin(ELEVATION), math::cos(ELEVATION));
            ([-sine, cosine, 0.0], [flat * cosine, flat * sine, height])
        };
        let up = cross(toward, right);
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for (axis, direction) in [right, up].into_iter().enumerate() {
                low[axis] = low[axis].min(dot(direction, *point));
                high[axis] = high[axis].max(dot(direction, *point));
            }
        }
        let extent = [high[0] - low[0], high[1] - low[1]];
        let scale = (EXTENT_PX[0] / extent[0]).min(EXTENT_PX[1] / extent[1]);
        let margin = MARGIN_PX / scale;
        View {
            right,
            up,
            toward,
            scale,
            corner: [low[0] - margin, high[1] + margin],
            size_px: extent.map(|length| length * scale + 2.0 * MARGIN_PX),
        }
    }

    /// Where a point of the world appears, in pixels from the upper left corner.
    pub fn px(&self, point: [f64; 3]) -> [f64; 2] {
        [
            (dot(self.right, point) - self.corner[0]) * self.scale,
            (self.corner[1] - dot(self.up, point)) * self.scale,
        ]
    }

    /// The length in the scene that so many pixels show.
    pub fn length_of(&self, pixels: f64) -> f64 {
        pixels / self.scale
    }

    /// Whether two frames in the picture, each from its least to its largest corner, overlap.
    fn overlap(a: &[[f64; 2]; 2], b: &[[f64; 2]; 2]) -> bool {
        (0..2).all(|axis| a[0][axis] <= b[1][axis] && b[0][axis] <= a[1][axis])
    }

    /// The order in which solids are painted: what is hidden first. Two solids are told apart by
    /// a face of the box around either; where none does, or where solids hide one another in a
    /// ring, the distance of their middles decides.
    pub fn paint_order(&self, solids: &[&Solid]) -> Vec<usize> {
        let frames: Vec<_> = solids.iter().map(|solid| self.frame_px(solid)).collect();
        let depth: Vec<f64> = solids
            .iter()
            .map(|solid| {
                let sum: f64 = solid.points.iter().map(|p| dot(self.toward, *p)).sum();
                sum / solid.points.len() as f64
            })
            .collect();
        let mut hidden_by = vec![Vec::new(); solids.len()];
        let mut waits_for = vec![0usize; solids.len()];
        for a in 0..solids.len() {
            for b in a + 1..solids.len() {
                if !View::overlap(&frames[a], &frames[b]) {
                    continue;
                }
                let nearer = self.nearer(solids[a], solids[b]);
                if nearer > 0.0 {
                    hidden_by[b].push(a);
                    waits_for[a] += 1;
                } else if nearer < 0.0 {
                    hidden_by[a].push(b);
                    waits_for[b] += 1;
                }
            }
        }
        let mut left: Vec<usize> = (0..solids.len()).collect();
        let mut order = Vec::new();
        while !left.is_empty() {
            let place = (0..left.len())
                .min_by(|i, j| {
                    let (i, j) = (left[*i], left[*j]);
                    let ready = (waits_for[i] > 0).cmp(&(waits_for[j] > 0));
                    ready.then(depth[i].total_cmp(&depth[j])).then(i.cmp(&j))
                })
                .expect("some are left");
            let next = left.remove(place);
            for nearer in &hidden_by[next] {
                waits_for[*nearer] = waits_for[*nearer].saturating_sub(1);
            }
            order.push(next);
        }
        order
    }

    fn frame_px(&self, solid: &Solid) -> [[f64; 2]; 2] {
        let mut frame = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for point in &solid.points {
            let at = self.px(*point);
            for axis in 0..2 {
                frame[0][axis] = frame[0][axis].min(at[axis]);
                frame[1][axis] = frame[1][axis].max(at[axis]);
            }
        }
        frame
    }

    /// Positive where `a` is nearer to the eye than `b`, negative where `b` is, 0 where no face
    /// separates them. The face seen most squarely decides.
    fn nearer(&self, a: &Solid, b: &Solid) -> f64 {
        let mut best = 0.0f64;
        for (solid, other, sign) in [(a, b, -1.0), (b, a, 1.0)] {
            for (normal, offset) in &solid.planes {
                let squarely = dot(*normal, self.toward) * sign;
                if squarely.abs() > best.abs()
                    && other.points.iter().all(|p| dot(*normal, *p) >= offset - 1e-9)
                {
                    best = squarely;
                }
            }
        }
        best
    }
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
