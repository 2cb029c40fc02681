//! What every part of a picture is drawn with.

use super::extent::Extent;
use super::view::View;
use crate::model::Figure;
use crate::problem::Problem;
use std::fmt::Write;

pub(super) const PAPER: &str = "#fbfaf6";
pub(super) const FLOOR: &str = "#f1efe8";
pub(super) const RULE: &str = "#d9d5c8";
pub(super) const INK: &str = "#33393f";
/// Colour of obstacles in the shade and in the light.
pub(super) const STONE: [[f64; 3]; 2] = [[74.0, 82.0, 92.0], [150.0, 158.0, 168.0]];
/// Colour of the robot at the start and at the goal.
pub(super) const WARM: [[f64; 3]; 2] = [[240.0, 165.0, 60.0], [178.0, 38.0, 74.0]];
pub(super) const WAY: &str = "#9d1f41";

/// A picture that is being drawn: the problem, how it is seen, and the text of the file so far.
pub(super) struct Drawing<'a> {
    pub problem: &'a Problem,
    pub figure: &'a dyn Figure,
    pub view: View,
    /// How much of the world is shown.
    pub extent: Extent,
    pub planar: bool,
    pub out: String,
}

impl Drawing<'_> {
    /// Appends a line to the file.
    pub fn put(&mut self, text: std::fmt::Arguments) {
        self.out.write_fmt(text).expect("writing to memory cannot fail");
        self.out.push('\n');
    }

    /// A place in the picture, as SVG writes it.
    pub fn at(&self, point: [f64; 3]) -> String {
        let [x, y] = self.view.px(point);
        format!("{} {}", decimal(x), decimal(y))
    }

    /// A polyline through points of the world, as the data of an SVG path.
    pub fn line(&self, points: impl IntoIterator<Item = [f64; 3]>) -> String {
        let mut line = String::new();
        for (index, point) in points.into_iter().enumerate() {
            line.push(if index == 0 { 'M' } else { 'L' });
            line.push_str(&self.at(point));
        }
        line
    }
}

/// A colour between two, as `#rrggbb`.
pub(super) fn blend([from, to]: [[f64; 3]; 2], share: f64) -> String {
    let [r, g, b] = [0, 1, 2].map(|i| (from[i] + (to[i] - from[i]) * share).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A number of pixels with one decimal, never a negative zero.
pub(super) fn decimal(value: f64) -> String {
    let text = format!("{value:.1}");
    if text == "-0.0" { "0.0".to_owned() } else { text }
}
