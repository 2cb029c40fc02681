//! The parallel projection from the world's frame to the picture.

use super::vector::{cross, dot};
use crate::math;
use std::f64::consts::PI;
use std::fmt;
use std::str::FromStr;

/// Largest width and height of the scene in the picture, in pixels.
const EXTENT_PX: [f64; 2] = [1120.0, 800.0];
/// Room around the scene, in pixels.
pub(super) const MARGIN_PX: f64 = 36.0;

/// The direction from a 3D scene to the eye, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// About the z axis, from the x axis on.
    pub azimuth: f64,
    /// Above the xy plane; 90 looks from above.
    pub elevation: f64,
}

/// Aslant from above.
impl Default for Direction {
    fn default() -> Direction {
        Direction { azimuth: -64.0, elevation: 25.0 }
    }
}

/// As `-64,25`: azimuth and elevation.
impl FromStr for Direction {
    type Err = String;

    fn from_str(text: &str) -> Result<Direction, String> {
        let expected = || {
            format!(
                "`{text}` found; an azimuth and an elevation in degrees expected, as -64,25, the elevation from -90 to 90"
            )
        };
        let (azimuth, elevation) = text.split_once(',').ok_or_else(expected)?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        match (number(azimuth), number(elevation)) {
            (Some(azimuth), Some(elevation)) if elevation.abs() <= 90.0 => {
                Ok(Direction { azimuth: azimuth % 360.0, elevation })
            }
            _ => Err(expected()),
        }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{},{}", self.azimuth, self.elevation)
    }
}

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
    /// The view in which all `points` appear: straight from above for planar problems, where there is no direction, else from
    /// the direction.
    pub fn new(direction: Option<Direction>, points: &[[f64; 3]]) -> View {
        let (right, toward) = match direction {
            None => ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
            Some(Direction { azimuth, elevation }) => {
                let [azimuth, elevation] = [azimuth, elevation].map(|angle| angle / 180.0 * PI);
                let (sine, cosine) = (math::sin(azimuth), math::cos(azimuth));
                let (height, flat) = (math::sin(elevation), math::cos(elevation));
                ([-sine, cosine, 0.0], [flat * cosine, flat * sine, height])
            }
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
        let scale = if scale.is_finite() { scale } else { 1.0 };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_read_as_they_are_written() {
        for text in ["-64,25", "0,90", "12.5,-90"] {
            assert_eq!(
                text.parse::<Direction>().map(|direction| direction.to_string()).as_deref(),
                Ok(text)
            );
        }
        for text in ["", "3", "1,2,3", "0,91", "nan,0", "0,inf"] {
            assert!(text.parse::<Direction>().unwrap_err().contains("expected"), "{text}");
        }
    }

    /// Seen along the y axis, x leads to the right and z up.
    #[test]
    fn a_direction_says_where_the_eye_is() {
        let points = [[0.0; 3], [2.0, 3.0, 1.0]];
        let view = View::new(Some(Direction { azimuth: -90.0, elevation: 0.0 }), &points);
        for (found, expected) in [
            (view.right, [1.0, 0.0, 0.0]),
            (view.up, [0.0, 0.0, 1.0]),
            (view.toward, [0.0, -1.0, 0.0]),
        ] {
            assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-15), "{found:?}");
        }
        assert_eq!(view.px([0.0, 0.0, 1.0]), [MARGIN_PX; 2]);
    }
}
