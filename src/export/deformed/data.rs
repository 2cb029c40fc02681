//! What the page is given: the obstacles, and the robot's vertices in every frame that the page has.

use super::super::page::json::{bytes, integers, list, number, numbers, object};
use super::super::page::scene::surfaces;
use super::DeformedPage;
use crate::export::extent::Bounds;

/// The most frames that a page has.
const FRAMES_MAX: usize = 301;
/// The vertices of all frames together have at most about so many bytes as they are written.
const BYTES_MAX: usize = 4 << 20;
/// Bytes of a vertex in a frame: three numbers of 16 bits and one of 8, in base64.
const VERTEX_BYTES: usize = 28usize.div_ceil(3);
/// Largest whole number of a coordinate.
const STEPS: f64 = 65535.0;

/// Which frames of so many the page has: all, or as many as there is room for, at even distances, the first and the last
/// among them.
pub(super) fn kept(frames: usize, vertices: usize) -> Vec<usize> {
    let room = BYTES_MAX / (VERTEX_BYTES * vertices.max(1));
    let most = room.clamp(2, FRAMES_MAX);
    if frames <= most {
        return (0..frames).collect();
    }
    (0..most).map(|index| index * (frames - 1) / (most - 1)).collect()
}

/// The JSON text; `data.js` says what is in it.
pub(super) fn json(page: &DeformedPage, kept: &[usize]) -> String {
    let frames: Vec<Vec<[f64; 3]>> =
        (kept.iter()).map(|index| page.path.frames[*index].in_world()).collect();
    let shape = frames.iter().flatten();
    let box_ = shape.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |all: Bounds, point| {
        let least = [0, 1, 2].map(|axis| all[0][axis].min(point[axis]));
        [least, [0, 1, 2].map(|axis| all[1][axis].max(point[axis]))]
    });
    let sides = [0, 1, 2].map(|axis| (box_[1][axis] - box_[0][axis]).max(f64::MIN_POSITIVE));
    let places = frames.iter().flatten().flat_map(|point| {
        let share = |axis: usize| (point[axis] - box_[0][axis]) / sides[axis];
        // A coordinate that is no number becomes 0.
        [0, 1, 2].map(|axis| (STEPS * share(axis)).round() as u16)
    });
    let moved: Vec<f64> = kept.iter().flat_map(|index| page.displacements(*index)).collect();
    let largest = moved.iter().copied().filter(|far| far.is_finite()).fold(0.0, f64::max);
    let part = |far: &f64| if largest > 0.0 { (255.0 * far / largest).round() as u8 } else { 0 };
    let told = kept.iter().map(|index| {
        let frame = &page.path.frames[*index];
        let share = number((1000.0 * frame.share).round() / 10.0);
        let volume = number((1000.0 * frame.volume).round() / 10.0);
        list([(index + 1).to_string(), share, number(frame.energy), volume])
    });
    // The eye sees the whole path, and of the obstacles what is near it.
    let seen = crate::export::extent::with_obstacles(box_, page.obstacles);
    let diagonal = {
        let side = |axis: usize| seen[1][axis] - seen[0][axis];
        (0..3).map(|axis| side(axis) * side(axis)).sum::<f64>().sqrt()
    };
    let corners = page.body.triangles().iter().flatten().copied();
    object(&[
        ("planar", "false".to_owned()),
        ("min", numbers(seen[0])),
        ("max", numbers(seen[1])),
        ("low", numbers(seen[0])),
        ("high", numbers(seen[1])),
        ("obstacles", surfaces(page.obstacles, diagonal / 150.0)),
        ("links", list([])),
        ("energy", "null".to_owned()),
        ("all", page.path.frames.len().to_string()),
        ("origin", numbers(box_[0])),
        ("unit", numbers(sides.map(|side| side / STEPS))),
        ("triangles", integers(corners)),
        ("largest", number(largest)),
        ("told", list(told)),
        ("places", bytes(places.flat_map(u16::to_le_bytes))),
        ("moved", bytes(moved.iter().map(part))),
    ])
}
