use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use super::markup::escaped;
use super::planner_name;
use crate::problem::Problem;
use crate::roadmap::Roadmap;
use std::fmt::Write;

/// See [`graphml`].
pub(super) struct Graphml;

impl RoadmapFormat for Graphml {
    fn name(&self) -> &'static str {
        "graphml"
    }

    fn about(&self) -> &'static str {
        "The graph with typed attributes, for networkx, Gephi, igraph, …"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        Ok(vec![ExportFile::named(graphml(exported.problem, exported.roadmap))])
    }
}

/// The attribute of nodes that is no degree of freedom.
const COMPONENT: &str = "component";

/// A roadmap as GraphML (U. Brandes et al. 2002), an undirected graph with typed attributes.
///
/// Of a node: a double per degree of freedom under its name, lengths in the problem's unit and
/// angles in radians, and `component` (int), the smallest node id in its connected component. Of an
/// edge, whose source is the lower node: `weight` (double, length in the space's metric), `planner`
/// (string) and `planner_tag` (int); where costs depend on the direction also `weight_back` and `peak` (doubles).
/// Nodes also have a double for each value that the model gives them. The graph itself has `problem` (string), `seed` (string, since it
/// may need 64 bits) and `digest` (string). Numbers are written so that reading them back gives the
/// same bits.
pub fn graphml(problem: &Problem, roadmap: &Roadmap) -> String {
    let space = problem.space();
    let mut xml = String::new();
    let mut put = |text: std::fmt::Arguments| {
        xml.write_fmt(text).expect("writing to memory cannot fail");
        xml.push('\n');
    };
    put(format_args!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>"));
    put(format_args!(
        "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\" \
         xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
         xsi:schemaLocation=\"http://graphml.graphdrawing.org/xmlns \
         http://graphml.graphdrawing.org/xmlns/1.0/graphml.xsd\">"
    ));
    let mut key = |id: &str, of: &str, name: &str, kind: &str, unit: &str| {
        let desc = if unit.is_empty() { String::new() } else { format!("<desc>{unit}</desc>") };
        put(format_args!(
            "<key id=\"{id}\" for=\"{of}\" attr.name=\"{}\" attr.type=\"{kind}\">{desc}</key>",
            escaped(name)
        ));
    };
    for name in ["problem", "seed", "digest"] {
        key(name, "graph", name, "string", "");
    }
    for (index, dof) in space.dofs().iter().enumerate() {
        // Programs that read attributes by name could not tell two of the same name apart.
        let clash = if dof.name == COMPONENT { "dof " } else { "" };
        key(&format!("q{index}"), "node", &format!("{clash}{}", dof.name), "double", dof.unit);
    }
    key(COMPONENT, "node", COMPONENT, "int", "");
    let (values, unit) = {
        let model = problem.model.description();
        (model.node_values(), model.cost_unit())
    };
    for value in values {
        key(value.name, "node", value.name, "double", value.unit);
    }
    key("weight", "edge", "weight", "double", unit);
    if roadmap.edges().is_directed() {
        key("weight_back", "edge", "weight_back", "double", unit);
        key("peak", "edge", "peak", "double", unit);
    }
    key("planner", "edge", "planner", "string", "");
    key("planner_tag", "edge", "planner_tag", "int", "");
    put(format_args!("<graph id=\"roadmap\" edgedefault=\"undirected\">"));
    put(format_args!("<data key=\"problem\">{}</data>", escaped(&problem.name)));
    put(format_args!("<data key=\"seed\">{}</data>", problem.seed));
    put(format_args!("<data key=\"digest\">{}</data>", roadmap.digest()));
    for (node, q) in roadmap.nodes().zip(roadmap.configs().iter()) {
        let component = roadmap.components().of_node(node).name;
        let dofs: String = (q.iter().enumerate())
            .map(|(index, value)| format!("<data key=\"q{index}\">{value}</data>"))
            .collect();
        let numbers = values.iter().zip(roadmap.values_of(node, values.len()));
        let numbers: String = numbers
            .map(|(value, number)| format!("<data key=\"{}\">{number}</data>", value.name))
            .collect();
        put(format_args!(
            "<node id=\"{node}\">{dofs}<data key=\"component\">{component}</data>{numbers}</node>"
        ));
    }
    for edge in roadmap.edges().iter() {
        let directed = edge.cost.directed().map_or_else(String::new, |cost| {
            format!(
                "<data key=\"weight_back\">{}</data><data key=\"peak\">{}</data>",
                cost.backward, cost.peak
            )
        });
        put(format_args!(
            "<edge source=\"{}\" target=\"{}\"><data key=\"weight\">{}</data>\
             <data key=\"planner\">{}</data><data key=\"planner_tag\">{}</data>{directed}</edge>",
            edge.low,
            edge.high,
            edge.weight(),
            planner_name(edge.planner),
            edge.planner
        ));
    }
    put(format_args!("</graph>"));
    put(format_args!("</graphml>"));
    xml
}
