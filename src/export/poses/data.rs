//! What the viewer is given.

use super::super::markup::quoted;
use super::{PosesPage, ShownPose, colour};
use crate::structure::Point;
use base64::prelude::{BASE64_STANDARD, Engine};
use std::fmt::Write;

/// The finest unit of coordinates, Å.
const FINEST: f64 = 0.01;

/// The JSON text: `protein`, `reference` or null, and `poses`, each with its SDF record, its colour and its way out: `unit`, the
/// coordinates of every frame as whole multiples of it in 16 bits, x y z, and `told`, how far along and with which energy.
pub(super) fn json(page: &PosesPage) -> String {
    let mut json = format!("{{\"protein\":{},\n", quoted(page.protein));
    let reference = page.reference.map_or_else(|| "null".to_owned(), quoted);
    write!(json, "\"reference\":{reference},\n\"poses\":[").expect("writing to memory cannot fail");
    for (number, pose) in page.poses.iter().enumerate() {
        let comma = if number == 0 { "" } else { ",\n" };
        write!(
            json,
            "{comma}{{\"label\":{},\"colour\":{},\"sdf\":{}{}}}",
            quoted(&pose.label),
            quoted(colour(pose.cluster)),
            quoted(&pose.sdf),
            way(pose)
        )
        .expect("writing to memory cannot fail");
    }
    json + "]}"
}

/// The parts of a way out.
fn way(pose: &ShownPose) -> String {
    let positions = || pose.way_out.iter().flat_map(|frame| &frame.positions);
    let values = || positions().flat_map(|point: &Point| [point.x, point.y, point.z]);
    let farthest = values().filter(|x| x.is_finite()).fold(0.0f64, |far, x| far.max(x.abs()));
    let mut unit = FINEST;
    while farthest > unit * f64::from(i16::MAX) && unit < 1e6 {
        unit *= 2.0;
    }
    // A number that does not fit, or is none, becomes the nearest that is one, or 0.
    let bytes: Vec<u8> =
        values().flat_map(|value| ((value / unit).round() as i16).to_le_bytes()).collect();
    let told: Vec<String> = (pose.way_out.iter())
        .map(|frame| {
            let text = |value: f64| match value.is_finite() {
                true => quoted(&format!("{value:.1}").replace('-', "\u{2212}")),
                false => quoted("unknown"),
            };
            format!("[{},{}]", text(frame.along), text(frame.energy))
        })
        .collect();
    format!(
        ",\"unit\":{unit},\"told\":[{}],\"coordinates\":{}",
        told.join(","),
        quoted(&BASE64_STANDARD.encode(&bytes))
    )
}
