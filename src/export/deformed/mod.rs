//! Paths of deformed robots for people and other programs: shapes as OBJ files, energies as CSV, and a page that plays the deformation.
//!
//! The page is drawn by the renderer of the pages in which a scene can be walked around in, has the styles of the pages of results, and is
//! played as these are. `data.rs` makes what it shows, `chart.rs` the picture of the energies.

mod chart;
mod csv;
mod data;
mod obj;
#[cfg(test)]
mod tests;

pub use csv::energies_csv;
pub use obj::{frame_name, frame_obj, obstacles_obj};

use super::markup::escaped;
use super::page::{RENDERER, SCENE};
use super::report::shell;
use crate::deformation::{Between, DeformedPath, SoftBody};
use crate::scene::Body;
use std::fmt::Write;

/// Styles beside those of all pages.
const STYLE: &str = include_str!("style.css");
/// The canvas and the controls.
const STAGE: &str = include_str!("stage.html");
/// The script after the renderer, part by part: each part uses only what parts before it have when it is read.
const DATA: &str = include_str!("data.js");
const SCRIPT: [&str; 4] = [
    include_str!("body.js"),
    include_str!("frame.js"),
    include_str!("pointer.js"),
    include_str!("start.js"),
];

/// What a page is made of that plays a deformed robot's path.
#[derive(Clone, Copy, Debug)]
pub struct DeformedPage<'a> {
    /// What the page is about: the problem.
    pub title: &'a str,
    /// What there is to say beside what the path itself tells: terms, each with a text.
    pub facts: &'a [(&'a str, String)],
    /// The robot at rest.
    pub body: &'a SoftBody,
    /// The obstacles, in the world's frame.
    pub obstacles: &'a [Body],
    /// The path; its frames have as many vertices as the robot at rest.
    pub path: &'a DeformedPath,
}

impl DeformedPage<'_> {
    /// How far the vertices of a frame are from their places at rest, in the robot's frame.
    fn displacements(&self, frame: usize) -> impl Iterator<Item = f64> {
        let shape = self.path.frames[frame].vertices.iter();
        shape.zip(self.body.vertices()).map(|(now, rest)| {
            let [x, y, z] = [0, 1, 2].map(|axis| now[axis] - rest[axis]);
            (x * x + y * y + z * z).sqrt()
        })
    }
}

/// A page that plays the deformation: HTML without references to other files, for any browser with WebGL 2. The same bytes for the
/// same arguments.
///
/// Coordinates are rounded to a 65 535th of the sides of the box around the whole path, displacements to a 255th of the largest. A page has at most
/// 301 frames, and fewer of a robot of more than 1500 vertices, so that the vertices take at most 4 MiB; it says how many there are.
pub fn deformed_page(page: &DeformedPage) -> String {
    let path = page.path;
    let kept = data::kept(path.frames.len(), page.body.vertices().len());
    let mut body = format!("<header><h1>{}</h1>\n<dl>\n", escaped(page.title));
    let [least, greatest] = path.volumes().map(|share| 100.0 * share);
    let own = [
        ("triangles of the robot", page.body.triangles().len().to_string()),
        ("highest energy", format!("{:.6}", path.highest_energy())),
        ("volume, % of that at rest", format!("{least:.1} to {greatest:.1}")),
        ("largest movement of a vertex between frames", format!("{:.4}", path.largest_movement())),
    ];
    let given = page.facts.iter().map(|(term, text)| (*term, text.as_str()));
    for (term, text) in given.chain(own.iter().map(|(term, text)| (*term, text.as_str()))) {
        put(
            &mut body,
            format_args!("<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(term), escaped(text)),
        );
    }
    body += "</dl>\n";
    match path.between {
        Between::Proved { clearance } => put(
            &mut body,
            format_args!(
                "<p class=\"meaning\">Proved: between any two frames as well the surface keeps a distance of {clearance:.3e} from the obstacles.</p>\n"
            ),
        ),
        Between::Sampled => {
            body += "<p class=\"warning\">Sampled: the robot is free at the frames, and nothing is promised of the motion between two of them.</p>\n";
        }
    }
    body += "</header>\n<main>\n";
    body += STAGE;
    if kept.len() < path.frames.len() {
        put(
            &mut body,
            format_args!(
                "<p><small>The page has {} of the {} frames, at even distances, the first and the last among them. \
                 What is drawn between two of them is a blend, which may touch obstacles that the path itself avoids.</small></p>\n",
                kept.len(),
                path.frames.len()
            ),
        );
    }
    body += "</section>\n";
    body += &chart::energies(path, &kept);
    body += "</main>\n";
    let parts = [&RENDERER[..], &[DATA], &SCENE, &[shell::PLAYER], &SCRIPT].concat();
    put(
        &mut body,
        format_args!(
            "<script type=\"application/json\" id=\"data\">{}</script>\n<script>\"use strict\";\n{}</script>\n",
            data::json(page, &kept),
            parts.concat()
        ),
    );
    shell::page(page.title, STYLE, &body)
}

/// Appends a text.
fn put(out: &mut String, text: std::fmt::Arguments) {
    out.write_fmt(text).expect("writing to memory cannot fail");
}
