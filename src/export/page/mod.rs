//! Pages in which a scene can be walked around in: they show a roadmap, and play the robot along paths.

pub(super) mod json;
mod roadmap;
mod sample;
pub(super) mod scene;

pub use scene::NamedPath;

use super::contours::relief;
use super::extent::Extent;
use super::markup::{escaped, quoted};
use crate::digest::Digest;
use crate::problem::Problem;
use crate::query::Path;
use crate::roadmap::Roadmap;
use json::{list, numbers, object};
use scene::{played, surfaces};

/// The page without its styles, its script and its data.
const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("style.css");
/// The renderer, without data: vectors, WebGL, surfaces, and columns of numbers.
pub(super) const RENDERER: [&str; 4] = [
    include_str!("vectors.js"),
    include_str!("graphics.js"),
    include_str!("surface.js"),
    include_str!("column.js"),
];
/// What stands still, once there are data, and the eye that looks at it.
pub(super) const SCENE: [&str; 2] = [include_str!("scene.js"), include_str!("eye.js")];
/// The script, part by part: each part uses only what parts before it have.
const SCRIPT: &[&str] = &[
    RENDERER[0],
    RENDERER[1],
    RENDERER[2],
    RENDERER[3],
    include_str!("data.js"),
    SCENE[0],
    SCENE[1],
    include_str!("path.js"),
    include_str!("colours.js"),
    include_str!("roadmap.js"),
    include_str!("milestone.js"),
    include_str!("hint.js"),
    include_str!("touch.js"),
    include_str!("frame.js"),
    include_str!("panel.js"),
    include_str!("player.js"),
    include_str!("pointer.js"),
    include_str!("start.js"),
    include_str!("live.js"),
];

/// A page that plays the robot along a path: HTML without references to other files, for any browser
/// with WebGL 2. The same bytes for the same arguments.
///
/// The robot's links are placed here, at 301 poses evenly along the path by its length in the metric;
/// the page turns, zooms and plays. Lengths are in the problem's unit, numbers rounded to the 24 bits
/// that graphics cards draw with.
///
/// `None` where the problem's model cannot be drawn.
pub fn animation(problem: &Problem, path: &Path) -> Option<String> {
    let data = data(problem, None, &[NamedPath { name: "path", path }], (None, false))?;
    Some(page(&problem.name, &data))
}

/// What a page shows in which a roadmap can be walked around in: the roadmap in its scene, and the robot along paths.
///
/// Nodes stand at the robot's reference points, edges are straight lines between them. A page holds at most 50 000 nodes,
/// fewer where a node has many numbers, and 100 000 edges; it says how many there are of each. If it holds all nodes it
/// connects what the roadmap connects. Paths are as [`animation`] has them; `docs/viewer.md` says what can be done in a page.
///
/// ```
/// use roadmill::export::{NamedPath, Viewer};
/// use roadmill::{Build, problem::Problem};
///
/// let built = Build::new(Problem::load("problems/maze.toml".as_ref())?).run()?;
/// let paths: Vec<_> = built.path().map(|path| NamedPath { name: "path", path }).into_iter().collect();
/// let viewer = Viewer { problem: built.problem(), roadmap: built.roadmap(), paths: &paths, live: None, clearance: false };
/// assert!(viewer.page().expect("a maze can be drawn").starts_with("<!DOCTYPE html>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy)]
pub struct Viewer<'a> {
    /// The problem with its scene.
    pub problem: &'a Problem,
    /// The roadmap.
    pub roadmap: &'a Roadmap,
    /// The paths that are played; the first one is shown at first.
    pub paths: &'a [NamedPath<'a>],
    /// Of a page that follows a build.
    pub live: Option<Live>,
    /// Whether nodes can be coloured by their clearance, which has to be found first. It is left out of a model that has none.
    pub clearance: bool,
}

/// What a page that follows a build is told of the build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Live {
    /// The number of the data; the page asks for data of another number.
    pub version: u64,
    /// Whether the build has ended, so that no more data are to come.
    pub has_ended: bool,
}

impl Viewer<'_> {
    /// The page: HTML without references to other files, for any browser with WebGL 2. The same bytes for the same values.
    ///
    /// `None` where the problem's model cannot be drawn.
    pub fn page(&self) -> Option<String> {
        Some(page(&self.problem.name, &self.data()?))
    }

    /// What of the page depends on the problem, the roadmap and the paths, as JSON: a page that follows a build asks for it.
    ///
    /// `None` where the problem's model cannot be drawn.
    pub fn data(&self) -> Option<String> {
        data(self.problem, Some(self.roadmap), self.paths, (self.live, self.clearance))
    }
}

/// All parts of a page put together.
///
/// The browser runs the page's own script and nothing else: scripts and styles need a number that follows from the data, so that
/// no text in the data can know it, and nothing is fetched but, where the page comes from a server, from that server.
fn page(name: &str, data: &str) -> String {
    let number = &Digest::of(data.as_bytes()).to_string()[..32];
    let parts = [
        ("ROADMILL_STYLE", STYLE.to_owned()),
        ("ROADMILL_SCRIPT", SCRIPT.concat()),
        ("ROADMILL_NUMBER", number.to_owned()),
        ("ROADMILL_NAME", escaped(name)),
        ("ROADMILL_DATA", data.to_owned()),
    ];
    let (mut page, mut rest) = (String::new(), PAGE);
    // Only the page's own text is searched for the places of its parts, never a part that was put in.
    while let Some(at) = rest.find("ROADMILL_") {
        page.push_str(&rest[..at]);
        rest = &rest[at..];
        let part = parts.iter().find_map(|(key, part)| Some((rest.strip_prefix(key)?, part)));
        let (after, part) = part.expect("the page names its parts");
        page.push_str(part);
        rest = after;
    }
    page + rest
}

fn data(
    problem: &Problem,
    roadmap: Option<&Roadmap>,
    paths: &[NamedPath],
    (live, has_clearance): (Option<Live>, bool),
) -> Option<String> {
    let space = problem.space();
    let figure = problem.model.description().figure()?;
    let all: Vec<&Path> = paths.iter().map(|named| named.path).collect();
    let extent = Extent::of(problem, figure, roadmap, &all);
    let dot = extent.diagonal() / 150.0;
    let dofs =
        space.dofs().iter().map(|dof| format!("[{},{}]", quoted(&dof.name), quoted(dof.unit)));
    let links = figure.links().into_iter().map(|bodies| surfaces(bodies, dot));
    let null = || "null".to_owned();
    let live = live.map(|Live { version, has_ended }| {
        object(&[("version", version.to_string()), ("ended", has_ended.to_string())])
    });
    Some(object(&[
        ("live", live.unwrap_or_else(null)),
        ("name", quoted(&problem.name)),
        ("planar", figure.is_planar().to_string()),
        ("min", numbers(extent.floor[0])),
        ("max", numbers(extent.floor[1])),
        ("low", numbers(extent.all[0])),
        ("high", numbers(extent.all[1])),
        ("dofs", list(dofs)),
        ("obstacles", surfaces(figure.obstacles(), dot)),
        ("links", list(links)),
        ("energy", relief(figure, roadmap).map_or_else(null, |relief| relief_data(&relief))),
        ("paths", list(paths.iter().map(|named| played(problem, figure, *named)))),
        ("hand", scene::hand(problem, figure).unwrap_or_else(null)),
        (
            "roadmap",
            roadmap.map_or_else(null, |it| {
                roadmap::roadmap_data(problem, figure, (it, has_clearance))
            }),
        ),
    ]))
}

/// An energy over the plane, on a grid that goes from one corner of the bounds to the other.
fn relief_data(relief: &super::contours::Relief) -> String {
    object(&[
        ("columns", relief.columns.to_string()),
        ("energies", json::floats(relief.energies.iter().copied())),
        ("step", json::number(relief.step)),
        ("lowest", json::number(relief.lowest)),
        ("highest", json::number(relief.highest)),
    ])
}

#[cfg(test)]
mod tests;
