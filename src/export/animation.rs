use super::markup::{escaped, quoted};
use crate::problem::Problem;
use crate::query::Path;
use crate::scene::{Body, Pose, tessellate};
use std::fmt::Write;

/// The page without its data.
const PAGE: &str = include_str!("animation.html");
/// Poses along the path, both ends included.
const FRAMES: usize = 301;

/// A page that plays the robot along a path: HTML without references to other files, for any browser
/// with WebGL 2. The same bytes for the same arguments.
///
/// The robot's links are placed here, at 301 poses evenly along the path by its length in the metric;
/// the page turns, zooms and plays. Lengths are in the problem's unit, numbers rounded to the 24 bits
/// that graphics cards draw with.
///
/// `None` where the problem's model cannot be drawn.
pub fn animation(problem: &Problem, path: &Path) -> Option<String> {
    let space = problem.space();
    let figure = problem.model.description().figure()?;
    let (planar, [min, max]) = (figure.is_planar(), figure.bounds());
    let sampled = path.sampled(&space, FRAMES);
    let square = |i: usize| (max[i] - min[i]) * (max[i] - min[i]);
    let diagonal = (0..3).map(square).sum::<f64>().sqrt();
    let dot = diagonal / 150.0;

    let dofs = space.dofs().iter().map(|dof| format!("[{},\"{}\"]", quoted(&dof.name), dof.unit));
    let links = figure.links().into_iter().map(|bodies| surfaces(bodies, dot));
    let frames: Vec<String> = (sampled.iter())
        .map(|q| {
            let placed = figure.placement(q).poses;
            let values =
                placed.iter().flat_map(|pose| pose.translation.into_iter().chain(pose.rotation));
            numbers(values)
        })
        .collect();
    let mut data = String::from("{");
    let mut put = |key: &str, value: &str| {
        let comma = if key == "name" { "" } else { "," };
        writeln!(data, "{comma}\"{key}\":{value}").expect("writing to memory cannot fail");
    };
    put("name", &quoted(&problem.name));
    put("planar", if planar { "true" } else { "false" });
    put("min", &numbers(min));
    put("max", &numbers(max));
    put("length", &number(path.length));
    put("dofs", &list(dofs));
    put("obstacles", &surfaces(figure.obstacles(), dot));
    put("links", &list(links));
    put("frames", &list(frames));
    put("configs", &list(sampled.iter().map(|q| numbers(q.iter().copied()))));
    put("way", &list(sampled.iter().map(|q| numbers(figure.marker(q)))));
    data.push('}');
    let page = PAGE.replacen("ROADMILL_NAME", &escaped(&problem.name), 1);
    Some(page.replacen("ROADMILL_DATA", &data, 1))
}

/// Bodies in the frame of their owner, each as its vertices and triangles.
fn surfaces(bodies: &[Body], dot: f64) -> String {
    list(bodies.iter().map(|body| {
        let surface = tessellate(&body.shape, dot);
        let pose: &Pose = &body.pose;
        let vertices = numbers(surface.vertices.iter().flat_map(|vertex| pose.apply(*vertex)));
        let corners = surface.triangles.iter().flatten().map(u32::to_string);
        format!("{{\"v\":{vertices},\"t\":{}}}", list(corners))
    }))
}

fn list(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(","))
}

fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    list(values.into_iter().map(number))
}

fn number(value: f64) -> String {
    (value as f32 + 0.0).to_string()
}
