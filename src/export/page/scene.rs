//! Scenes and paths as the data of a page.

use super::json::{list, number, numbers, object};
use crate::export::markup::quoted;
use crate::model::Figure;
use crate::problem::Problem;
use crate::query::Path;
use crate::scene::{Body, Pose, tessellate};
use crate::space::BaseJoint;

/// Poses along a path, both ends included.
const FRAMES: usize = 301;

/// A path that a page plays.
#[derive(Clone, Copy)]
pub struct NamedPath<'a> {
    /// What it is called where it is chosen among several.
    pub name: &'a str,
    /// The path.
    pub path: &'a Path,
}

/// Surfaces of bodies in the frame of their owner, each as its vertices and triangles; a point becomes a ball of the radius
/// `dot`.
pub(in crate::export) fn surfaces(bodies: &[Body], dot: f64) -> String {
    list(bodies.iter().map(|body| {
        let surface = tessellate(&body.shape, dot);
        let pose: &Pose = &body.pose;
        let vertices = numbers(surface.vertices.iter().flat_map(|vertex| pose.apply(*vertex)));
        let corners = surface.triangles.iter().flatten().map(u32::to_string);
        format!("{{\"v\":{vertices},\"t\":{}}}", list(corners))
    }))
}

/// The frames of all links at a configuration, seven numbers each: position and quaternion.
pub(super) fn poses(figure: &dyn Figure, q: &[f64]) -> impl Iterator<Item = f64> {
    let placed = figure.placement(q).poses;
    placed.into_iter().flat_map(|pose| pose.translation.into_iter().chain(pose.rotation))
}

/// What the page needs to move the robot by hand: by how many translations its base moves, whether it turns, and the start of the problem's query with the
/// poses of the links and the marker there. `None` of a robot whose base stands still.
pub(super) fn hand(problem: &Problem, figure: &dyn Figure) -> Option<String> {
    let base = figure.base();
    let start = problem.query.as_ref().map(|ends| &ends.start[..]);
    let start = start.map(|q| {
        object(&[
            ("config", list(q.iter().map(f64::to_string))),
            ("poses", numbers(poses(figure, q))),
            ("marker", numbers(figure.marker(q))),
        ])
    });
    (base != BaseJoint::Fixed).then(|| {
        object(&[
            ("translations", base.translations().to_string()),
            ("turns", base.rotates().to_string()),
            ("start", start.unwrap_or_else(|| "null".to_owned())),
        ])
    })
}

/// A path by 301 configurations evenly along it by its length in the metric.
pub(super) fn played(problem: &Problem, figure: &dyn Figure, named: NamedPath) -> String {
    let NamedPath { name, path } = named;
    let sampled = path.sampled(&problem.space(), FRAMES);
    object(&[
        ("name", quoted(name)),
        ("length", number(path.length)),
        ("frames", list(sampled.iter().map(|q| numbers(poses(figure, q))))),
        ("configs", list(sampled.iter().map(|q| numbers(q.iter().copied())))),
        ("way", list(sampled.iter().map(|q| numbers(figure.marker(q))))),
    ])
}
