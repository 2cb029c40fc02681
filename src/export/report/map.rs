//! The roadmap on two order parameters, with the paths over it.

use super::super::markup::escaped;
use super::super::palette::{COLOURS, colour};
use super::Report;
use super::chart::{Axis, Frame, legend};
use super::order::OrderParameters;
use crate::model::Scratch;
use crate::numbers::NodeId;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Of a larger roadmap so many nodes are drawn.
const NODES_MAX: usize = 4000;

/// Edges are drawn where all nodes are, and no more edges than these are there.
const EDGES_MAX: usize = 8000;

/// So many of the largest components have a colour of their own.
const COLOURED: usize = 6;

/// Colours of components: lighter than the paths' that are drawn over them.
const PALE: [&str; COLOURED] = ["#8fb8d9", "#e0a07f", "#8cc4a8", "#c9a4d6", "#d3c07a", "#9aa3ad"];

const GREY: &str = "#8b8b86";

/// Colours of energies, from the lowest eighth of the nodes to the highest.
const ENERGY_COLOURS: [&str; 8] =
    ["#3b1f6b", "#443983", "#31688e", "#21918c", "#35b779", "#90d743", "#e8c51c", "#f28f1c"];

const SIZE: [f64; 2] = [620.0, 520.0];

/// The section of the map.
pub(super) fn section(report: &Report, scratch: &mut Scratch) -> String {
    let Report { roadmap, pathways, ends, .. } = *report;
    let parameters = OrderParameters::of(report, scratch);
    let nodes = roadmap.configs().len();
    let drawn = drawn(nodes);
    let places: BTreeMap<u32, [f64; 2]> = (drawn.iter())
        .map(|node| (*node, parameters.at(roadmap.configs().get(*node as usize), scratch)))
        .collect();
    let paths: Vec<Vec<[f64; 2]>> = (pathways.pathways.iter())
        .map(|pathway| pathway.frames.configs.iter().map(|q| parameters.at(q, scratch)).collect())
        .collect();
    let ends = [&ends.start, &ends.goal].map(|q| parameters.at(q, scratch));
    let picture = Picture { names: parameters.names(), places, paths, ends };

    let mut html = String::from("<section id=\"map\"><h2>The map</h2>\n<p>");
    let edges = roadmap.edges().len();
    let has_edges = drawn.len() == nodes && edges <= EDGES_MAX;
    write!(html, "Each dot is a node of the roadmap, which has {nodes} nodes and {edges} edges. ")
        .expect("writing to memory cannot fail");
    if drawn.len() < nodes {
        write!(
            html,
            "Drawn are {NODES_MAX} of them: those of which the number times the golden ratio has the smallest fractional part, which spreads them evenly over the build. "
        )
        .expect("writing to memory cannot fail");
    }
    html += if has_edges {
        "Thin lines are its edges. "
    } else {
        "Edges are left out, as of every map with more than 4000 nodes or 8000 edges. "
    };
    html += "Lines in colour are the paths, from A, the start, to B, the goal. What lies side by side here may still be \
        far apart: two numbers are little of a conformation.</p>\n<div class=\"maps\">\n";
    let lines: Vec<[u32; 2]> = match has_edges {
        true => roadmap.edges().iter().map(|edge| [edge.low, edge.high].map(|end| end.0)).collect(),
        false => Vec::new(),
    };
    html += &by_component(report, &picture, &lines);
    html += &by_energy(report, &picture, &lines);
    html + "</div></section>\n"
}

/// The ids of the nodes that are drawn, in their order.
fn drawn(nodes: usize) -> Vec<u32> {
    let mut ids: Vec<u32> = (0..nodes as u32).collect();
    if nodes > NODES_MAX {
        // 2^64 over the golden ratio: the product's 64 bits are the fractional part.
        ids.sort_by_key(|id| u64::from(*id).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        ids.truncate(NODES_MAX);
        ids.sort_unstable();
    }
    ids
}

/// What both pictures show.
struct Picture {
    names: [String; 2],
    /// By node.
    places: BTreeMap<u32, [f64; 2]>,
    paths: Vec<Vec<[f64; 2]>>,
    ends: [[f64; 2]; 2],
}

impl Picture {
    /// Draws the edges, then the nodes, class by class, then the paths.
    fn draw(&self, about: &str, classes: &[(&str, Vec<u32>)], edges: &[[u32; 2]]) -> String {
        let of = |axis: usize| {
            let places = self.places.values().chain(&self.ends);
            places.chain(self.paths.iter().flatten()).map(move |place| place[axis])
        };
        let (x, y) = (Axis::over(of(0)), Axis::over(of(1)));
        let mut frame = Frame::new(about, &self.names, x, y, SIZE);
        let at = |frame: &Frame, node: &u32| {
            let place = frame.place(self.places[node]);
            place.iter().all(|value| value.is_finite()).then_some(place)
        };
        let mut lines = String::new();
        for [low, high] in edges {
            if let (Some([a, b]), Some([c, d])) = (at(&frame, low), at(&frame, high)) {
                write!(lines, "M{a:.1} {b:.1}L{c:.1} {d:.1}").expect("memory");
            }
        }
        if !lines.is_empty() {
            frame.put(format_args!("<path class=\"edge\" d=\"{lines}\"/>"));
        }
        for (colour, nodes) in classes {
            let mut dots = String::new();
            for [x, y] in nodes.iter().filter_map(|node| at(&frame, node)) {
                write!(dots, "M{x:.1} {y:.1}h0").expect("memory");
            }
            if !dots.is_empty() {
                frame.put(format_args!("<path class=\"dots\" d=\"{dots}\" stroke=\"{colour}\"/>"));
            }
        }
        for (index, path) in self.paths.iter().enumerate().rev() {
            frame.line(path, "halo", "#ffffff", false);
            frame.line(path, "line", colour(index), index >= COLOURS.len());
        }
        for (name, end) in ["A", "B"].iter().zip(self.ends) {
            let [x, y] = frame.place(end);
            if x.is_finite() && y.is_finite() {
                frame.put(format_args!(
                    "<circle class=\"end\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\"/><text class=\"end\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{name}</text>",
                    y + 4.5
                ));
            }
        }
        frame.finish()
    }
}

/// The map with a colour for each of the largest components.
fn by_component(report: &Report, picture: &Picture, edges: &[[u32; 2]]) -> String {
    let components = report.roadmap.components();
    let mut sizes: Vec<(usize, NodeId)> =
        components.iter().map(|component| (component.members.len(), component.name)).collect();
    sizes.sort_by_key(|(size, name)| (std::cmp::Reverse(*size), *name));
    let largest = &sizes[..sizes.len().min(COLOURED)];
    // The largest is drawn first, so that small ones are seen; what has no colour lies below all.
    let mut classes: Vec<(&str, Vec<u32>)> = vec![(GREY, Vec::new())];
    classes.extend((0..largest.len()).map(|index| (PALE[index], Vec::new())));
    for node in picture.places.keys() {
        let name = components.of_node(NodeId(*node)).name;
        let class = largest.iter().position(|(_, of)| *of == name).map_or(0, |index| index + 1);
        classes[class].1.push(*node);
    }
    let mut entries: Vec<(String, &str, bool)> = (largest.iter().enumerate())
        .map(|(index, (size, name))| {
            (format!("component {name}: {size} nodes"), PALE[index], false)
        })
        .collect();
    if sizes.len() > COLOURED {
        entries.push((format!("{} smaller components", sizes.len() - COLOURED), GREY, false));
    }
    let about = "Nodes by connected component";
    figure(about, &entries, &picture.draw(about, &classes, edges))
}

/// The map with a colour for each eighth of the nodes by their energy; nothing where nodes have none.
fn by_energy(report: &Report, picture: &Picture, edges: &[[u32; 2]]) -> String {
    let values = report.problem.model.description().node_values();
    let Some(which) = values.iter().position(|value| value.name == "energy") else {
        return String::new();
    };
    let energy = |node: u32| report.roadmap.values_of(NodeId(node), values.len())[which];
    let mut nodes: Vec<u32> = picture.places.keys().copied().collect();
    nodes.sort_by(|a, b| energy(*a).total_cmp(&energy(*b)).then(a.cmp(b)));
    let parts = nodes.len().min(ENERGY_COLOURS.len());
    let unit = values[which].unit;
    let mut classes: Vec<(&str, Vec<u32>)> = Vec::new();
    let mut entries = Vec::new();
    for (index, colour) in ENERGY_COLOURS.iter().take(parts).enumerate() {
        let part = &nodes[index * nodes.len() / parts..(index + 1) * nodes.len() / parts];
        let highest = part.last().map_or(f64::NAN, |node| energy(*node));
        entries.push((format!("≤ {highest:.0}"), *colour, false));
        classes.push((colour, part.to_vec()));
    }
    let about = format!("Nodes by energy, an eighth of those drawn to each colour [{unit}]");
    // The lowest, of which there are few where paths are, are drawn last.
    classes.reverse();
    figure(&about, &entries, &picture.draw(&about, &classes, edges))
}

fn figure(title: &str, entries: &[(String, &str, bool)], svg: &str) -> String {
    let entries = entries.iter().map(|(name, colour, dashed)| (&**name, *colour, *dashed));
    let title = escaped(title);
    format!("<figure><figcaption>{title}{}</figcaption>\n{svg}</figure>\n", legend(entries))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_maps_are_thinned_evenly_and_always_alike() {
        assert_eq!(drawn(3), [0, 1, 2]);
        let ids = drawn(50_000);
        assert_eq!((ids.len(), &ids), (NODES_MAX, &drawn(50_000)));
        assert!(ids.is_sorted());
        // Each tenth of the build has its tenth of the dots, and so has every place within sets of a hundred.
        for part in 0..10 {
            let here = ids.iter().filter(|id| **id / 5000 == part).count();
            assert!((390..=410).contains(&here), "{part}: {here}");
        }
        for place in 0..100 {
            let here = ids.iter().filter(|id| **id % 100 == place).count();
            assert!((20..=60).contains(&here), "{place}: {here}");
        }
    }
}
