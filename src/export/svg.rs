use super::drawing::{Drawing, FLOOR, INK, PAPER, RULE, WARM, blend, decimal};
use super::extent::Extent;
use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use super::markup::escaped;
use super::view::{Direction, MARGIN_PX, View};
use crate::numbers::NodeId;
use crate::problem::Problem;
use crate::query;
use crate::roadmap::{Configs, Roadmap};
use std::collections::BTreeSet;

/// See [`svg`].
pub(super) struct Svg;

impl RoadmapFormat for Svg {
    fn name(&self) -> &'static str {
        "svg"
    }

    fn about(&self) -> &'static str {
        "A picture of the scene, the roadmap and the path"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let Exported { problem, roadmap, path } = *exported;
        let picture = svg(problem, roadmap, path);
        let picture =
            picture.ok_or_else(|| CannotExport("this model cannot be drawn".to_owned()))?;
        Ok(vec![ExportFile::named(picture)])
    }
}

/// Height of the line of text below the scene, in pixels.
const CAPTION_PX: f64 = 30.0;
pub(super) const FONT: &str = "font-family=\"Inter, Helvetica, Arial, sans-serif\"";
/// The most nodes and edges that are drawn.
const NODES_MAX: usize = 2500;
const EDGES_MAX: usize = 6000;
/// The colour of the largest component, and those of the others, which take turns.
const CALM: &str = "#4f7ea8";
const OTHERS: [&str; 8] =
    ["#3f9b6c", "#8460b5", "#c9a21f", "#2c9fa3", "#c0629e", "#7b8a2e", "#6b6fc9", "#9a6a45"];

/// A picture of a problem and its roadmap: an SVG file without references to others, at most 1192
/// pixels wide, the same bytes for the same arguments.
///
/// Planar problems are seen from above, others by a parallel projection aslant. Nodes and edges
/// stand at the robot's reference points; the largest connected component has one calm colour and
/// the others brighter ones. Of a large roadmap 2500 nodes are drawn, those of small components
/// first and then the earliest, and of the edges between them the first 6000; the caption counts
/// all. Along the path the robot is drawn at 18 poses, evenly by length in the metric, and in 3D
/// what is nearer to the eye covers what it hides. Meshes of more than 4000 triangles are drawn
/// coarser. An energy over the plane is shown by contour lines.
///
/// `None` where the problem's model cannot be drawn.
pub fn svg(problem: &Problem, roadmap: &Roadmap, path: Option<&query::Path>) -> Option<String> {
    svg_from(problem, roadmap, path, Direction::default())
}

/// [`svg`] as seen from a direction; planar problems are seen from above all the same.
///
/// `None` where the problem's model cannot be drawn.
pub fn svg_from(
    problem: &Problem,
    roadmap: &Roadmap,
    path: Option<&query::Path>,
    direction: Direction,
) -> Option<String> {
    let mut drawing = Drawing::begun(problem, Some(roadmap), path, direction)?;
    if drawing.planar {
        drawing.obstacles();
        drawing.roadmap(roadmap);
        drawing.journey(path);
    } else {
        drawing.roadmap(roadmap);
        drawing.solids_and_journey(path);
    }
    drawing.ends();
    drawing.caption(&counts(roadmap, path));
    drawing.out.push_str("</svg>\n");
    Some(drawing.out)
}

/// A picture of a problem's scene with the robot at the configuration `q`, valid or not, as [`svg`] draws it; `text` stands
/// below it. `None` where the problem's model cannot be drawn.
pub fn svg_at(problem: &Problem, q: &[f64], text: &str) -> Option<String> {
    let mut configs = Configs::new(q.len());
    configs.push(q);
    let alone = Some(query::Path { configs, length: 0.0 });
    let mut drawing = Drawing::begun(problem, None, alone.as_ref(), Direction::default())?;
    if drawing.planar {
        drawing.obstacles();
        drawing.journey(alone.as_ref());
    } else {
        drawing.solids_and_journey(alone.as_ref());
    }
    drawing.caption(text);
    drawing.out.push_str("</svg>\n");
    Some(drawing.out)
}

impl<'a> Drawing<'a> {
    /// A picture with the floor and what lies on it; `None` where the problem's model cannot be drawn.
    fn begun(
        problem: &'a Problem,
        roadmap: Option<&Roadmap>,
        path: Option<&query::Path>,
        direction: Direction,
    ) -> Option<Drawing<'a>> {
        let figure = problem.model.description().figure()?;
        let planar = figure.is_planar();
        let extent = Extent::of(problem, figure, roadmap, path.as_slice());
        let view = View::new((!planar).then_some(direction), &extent.corners());
        let mut drawing = Drawing { problem, figure, view, extent, planar, out: String::new() };
        drawing.head();
        drawing.floor();
        if let Some(roadmap) = roadmap {
            drawing.contours(roadmap);
        }
        Some(drawing)
    }

    fn head(&mut self) {
        let [width, height] = self.view.size_px;
        let height = height + CAPTION_PX;
        let (width, height) = (width.ceil(), height.ceil());
        self.put(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" stroke-linejoin=\"round\" stroke-linecap=\"round\">"
        ));
        self.put(format_args!(
            "<rect width=\"{width}\" height=\"{height}\" rx=\"10\" fill=\"{PAPER}\"/>"
        ));
    }

    fn floor(&mut self) {
        let corners = self.extent.floor_corners();
        let outline = self.line([0, 1, 3, 2].map(|i| corners[i]));
        self.put(format_args!(
            "<path class=\"bounds\" d=\"{outline}Z\" fill=\"{FLOOR}\" stroke=\"{INK}\" \
             stroke-width=\"{}\"/>",
            if self.planar { "2.5" } else { "1" }
        ));
        // Grid lines, their spacing a round number: about a dozen along the longer side.
        let extent = [0, 1].map(|axis| corners[3][axis] - corners[0][axis]);
        let step = round_length(extent[0].max(extent[1]) / 12.0);
        let mut lines = String::new();
        for axis in 0..2 {
            let count = (extent[axis] / step).ceil() as usize;
            for i in 1..count {
                let (mut from, mut to) = (corners[0], corners[3]);
                from[axis] = corners[0][axis] + step * i as f64;
                to[axis] = from[axis];
                from[2] = corners[0][2];
                lines.push_str(&self.line([from, to]));
            }
        }
        self.put(format_args!(
            "<path class=\"grid\" d=\"{lines}\" stroke=\"{RULE}\" stroke-width=\"0.8\" fill=\"none\"/>"
        ));
        if !self.planar {
            // The eight edges of the bounds besides those of the floor, all equally faint.
            let rest = [[0, 4], [1, 5], [2, 6], [3, 7], [4, 5], [5, 7], [7, 6], [6, 4]];
            let lines: String =
                rest.iter().map(|pair| self.line(pair.map(|i| corners[i]))).collect();
            self.put(format_args!(
                "<path class=\"bounds\" d=\"{lines}\" stroke=\"{INK}\" stroke-opacity=\"0.35\" \
                 stroke-width=\"0.9\" stroke-dasharray=\"2 4\" fill=\"none\"/>"
            ));
        }
    }

    /// Nodes and edges, one element per component: the largest below, the others above it.
    fn roadmap(&mut self, roadmap: &Roadmap) {
        let components = roadmap.components();
        let mut ranked: Vec<(usize, NodeId)> =
            components.iter().map(|c| (c.members.len(), c.name)).collect();
        ranked.sort_by_key(|(size, name)| (usize::MAX - size, *name));
        let Some((_, largest)) = ranked.first().copied() else {
            return;
        };

        let mut drawn: BTreeSet<NodeId> = roadmap
            .nodes()
            .filter(|node| components.of_node(*node).name != largest)
            .take(NODES_MAX / 2)
            .collect();
        for node in roadmap.nodes() {
            if drawn.len() >= NODES_MAX {
                break;
            }
            drawn.insert(node);
        }
        let place = |node: NodeId| self.figure.marker(roadmap.configs().get(node.index()));
        let mut layers = vec![(String::new(), String::new()); ranked.len()];
        let rank_of = |node: NodeId| {
            let component = components.of_node(node);
            let key = |(size, name): (usize, NodeId)| (usize::MAX - size, name);
            let own = key((component.members.len(), component.name));
            ranked.partition_point(|other| key(*other) < own)
        };
        let edges = roadmap.edges().iter();
        let shown = edges.filter(|edge| drawn.contains(&edge.low) && drawn.contains(&edge.high));
        for edge in shown.take(EDGES_MAX) {
            layers[rank_of(edge.low)].0.push_str(&self.line([place(edge.low), place(edge.high)]));
        }
        for node in &drawn {
            let dot = format!("M{}h0", self.at(place(*node)));
            layers[rank_of(*node)].1.push_str(&dot);
        }
        // The more there is to draw, the fainter and smaller it is drawn.
        let crowd = (drawn.len() as f64 / 600.0).clamp(0.0, 1.0);
        let (faint, dot) = (0.5 - 0.28 * crowd, 4.4 - 1.6 * crowd);
        for (rank, (edges, nodes)) in layers.into_iter().enumerate() {
            let (colour, faint) = match rank {
                0 => (CALM, faint),
                _ => (OTHERS[(rank - 1) % OTHERS.len()], 1.5 * faint),
            };
            if nodes.is_empty() {
                continue;
            }
            self.put(format_args!(
                "<g class=\"component\" stroke=\"{colour}\" fill=\"none\">\
                 <path class=\"edges\" d=\"{edges}\" stroke-width=\"0.8\" stroke-opacity=\"{faint:.2}\"/>\
                 <path class=\"nodes\" d=\"{nodes}\" stroke-width=\"{dot:.1}\"/></g>"
            ));
        }
    }

    /// Start and goal: a ring at the reference point and the word beside it.
    fn ends(&mut self) {
        let Some(ends) = &self.problem.query else {
            return;
        };
        let goals = ends.goals().map(|goal| ("goal", goal, 1.0));
        for (name, q, share) in std::iter::once(("start", &ends.start[..], 0.0)).chain(goals) {
            let [x, y] = self.view.px(self.figure.marker(q));
            // Of a linkage with a fixed base the last link is marked, so that the word stands above that link rather
            // than above the highest one.
            let bodies = match self.figure.placement(q).marked {
                Some(link) => self.figure.bodies_of_link(link, q),
                None => self.figure.bodies_at(q),
            };
            let standing = self.stand(&bodies);
            let points = standing.iter().flat_map(|solid| &solid.points);
            let top = points.map(|point| self.view.px(*point)[1]).fold(y - 6.0, f64::min);
            let (x, y, above) = (decimal(x), decimal(y), decimal(top - 8.0));
            let colour = blend(WARM, share);
            self.put(format_args!(
                "<circle class=\"{name}\" cx=\"{x}\" cy=\"{y}\" r=\"6\" fill=\"{PAPER}\" \
                 stroke=\"{colour}\" stroke-width=\"4\"/>"
            ));
            self.put(format_args!(
                "<text x=\"{x}\" y=\"{above}\" text-anchor=\"middle\" {FONT} font-size=\"15\" \
                 font-weight=\"600\" fill=\"{INK}\" stroke=\"{PAPER}\" stroke-width=\"4\" \
                 paint-order=\"stroke\">{name}</text>"
            ));
        }
    }

    /// The name of the problem and a text, below the scene.
    fn caption(&mut self, text: &str) {
        let (name, text) = (escaped(&self.problem.name), escaped(text));
        let (x, y) = (decimal(MARGIN_PX), decimal(self.view.size_px[1] + 8.0));
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" {FONT} font-size=\"16\" fill=\"{INK}\">\
             <tspan font-weight=\"600\">{name}</tspan><tspan dx=\"14\" fill-opacity=\"0.75\">{text}</tspan></text>"
        ));
    }
}

/// What is counted of a roadmap and its path, for the caption.
fn counts(roadmap: &Roadmap, path: Option<&query::Path>) -> String {
    let count = |number: usize, noun: &str| {
        format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
    };
    let mut text = [
        count(roadmap.configs().len(), "node"),
        count(roadmap.edges().len(), "edge"),
        count(roadmap.components().count(), "component"),
    ]
    .join(" · ");
    if let Some(path) = path {
        let directed = roadmap.edges().is_directed();
        let length = if directed { "path with climbs of" } else { "path of length" };
        text += &format!(" · {length} {:.2}", path.length);
    }
    text
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`.
pub(super) fn round_length(length: f64) -> f64 {
    let mut unit = 1.0;
    while unit > length {
        unit /= 10.0;
    }
    while unit * 10.0 <= length {
        unit *= 10.0;
    }
    [5.0, 2.0].into_iter().map(|times| times * unit).find(|round| *round <= length).unwrap_or(unit)
}
