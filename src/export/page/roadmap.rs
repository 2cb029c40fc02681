//! Roadmaps as the data of a page.

use super::json::{floats, integers, list, object};
use super::sample::{EDGES_MAX, NODES_MAX, STOPS_MAX, Sample, Stop};
use super::scene::poses;
use crate::clearance;
use crate::export::markup::quoted;
use crate::model::Figure;
use crate::problem::Problem;
use crate::roadmap::Roadmap;

/// The numbers of all nodes of a page together have at most about so many bytes, before they are written as text.
const BYTES_MAX: usize = 12 << 20;

/// A roadmap: columns of its nodes and edges, or of as many as a page has room for, and how it grew; with the nodes' clearances if
/// they are asked for and the model has any.
pub(super) fn roadmap_data(
    problem: &Problem,
    figure: &dyn Figure,
    (roadmap, has_clearance): (&Roadmap, bool),
) -> String {
    let values = problem.model.description().node_values();
    let (dofs, links) = (problem.space().dofs().len(), figure.links().len());
    // The marker, the degrees of freedom, seven numbers for each link, the values, a clearance, id, component and degree.
    let bytes_of_node = 4 * (3 + dofs + 7 * links + values.len() + usize::from(has_clearance) + 3);
    let sample = Sample::of(roadmap, NODES_MAX.min(BYTES_MAX / bytes_of_node), EDGES_MAX);
    let configs = || sample.nodes.iter().map(|node| roadmap.configs().get(node.index()));
    let mut degrees = vec![0u32; roadmap.configs().len()];
    for edge in roadmap.edges().iter() {
        degrees[edge.low.index()] += 1;
        degrees[edge.high.index()] += 1;
    }
    let count = values.len();
    let values_of =
        |index: usize| sample.nodes.iter().map(move |node| roadmap.values_of(*node, count)[index]);
    let column = |name: &str, unit: &str, numbers: String| {
        object(&[("name", quoted(name)), ("unit", quoted(unit)), ("numbers", numbers)])
    };
    let values = values.iter().enumerate();
    let values =
        values.map(|(index, value)| column(value.name, value.unit, floats(values_of(index))));
    let shown: Vec<&[f64]> = if has_clearance { configs().collect() } else { Vec::new() };
    let clearances = clearance::of_configs(&problem.context(), &shown).filter(|_| has_clearance);
    let clearances = clearances.map(|found| column("clearance", "length", floats(found)));
    let name_of = |node| roadmap.components().of_node(node).name.0;
    object(&[
        ("nodes", roadmap.configs().len().to_string()),
        ("edges", roadmap.edges().len().to_string()),
        ("rounds", roadmap.rounds().len().to_string()),
        ("whole", sample.is_whole.to_string()),
        ("ids", integers(sample.nodes.iter().map(|node| node.0))),
        ("markers", floats(configs().flat_map(|q| figure.marker(q)))),
        ("configs", floats(configs().flatten().copied())),
        ("poses", floats(configs().flat_map(|q| poses(figure, q)))),
        ("components", integers(sample.nodes.iter().map(|node| name_of(*node)))),
        ("degrees", integers(sample.nodes.iter().map(|node| degrees[node.index()]))),
        ("values", list(values.chain(clearances))),
        ("pairs", integers(sample.edges.iter().flatten().copied())),
        ("stops", list(sample.stops.iter().map(stop))),
    ])
}

/// The end of a round: rounds, sets, nodes, edges and components until then, and of the nodes and edges those that the page
/// has.
fn stop(stop: &Stop) -> String {
    let Stop { rounds, sets, nodes, edges, components, shown_nodes, shown_edges } = stop;
    format!("[{rounds},{sets},{nodes},{edges},{components},{shown_nodes},{shown_edges}]")
}

const _: () = assert!(STOPS_MAX > 1 && NODES_MAX < EDGES_MAX);
