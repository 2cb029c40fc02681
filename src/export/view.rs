//! The parallel projection from the world's frame to the picture.

use super::vector::{cross, dot};
use crate::math;
use std::f64::consts::PI;

/// Largest width and height of the scene in the picture, in pixels.
const EXTENT_PX: [f64; 2] = [1120.0, 800.0];
/// Room around the scene, in pixels.
pub(super) const MARGIN_PX: f64 = 36.0;
/// Direction from a 3D scene to the eye: azimuth (about z, from the x axis) and elevation above the xy
/// plane, in radians.
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
    /// The view in which all `points` appear: straight from above for planar problems, else aslant.
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

    /// The length, in the scene's unit, that `pixels` pixels show.
    pub fn length_of(&self, pixels: f64) -> f64 {
        pixels / self.scale
    }
}
