//! A roadmap as two tables.

use super::planner_name;
use crate::roadmap::Roadmap;
use crate::space::Space;
use std::fmt::Write;

/// The nodes as CSV: `node` (id), the degrees of freedom with their units as in a path, and
/// `component` (the smallest node id in the node's connected component). A line per node, in order
/// of their ids. Numbers are written so that reading them back gives the same bits.
pub fn nodes_csv(space: &Space, roadmap: &Roadmap) -> String {
    let mut csv = format!("node,{},component\n", header(space).join(","));
    for (node, q) in roadmap.configs().iter().enumerate() {
        let node = node as u32;
        put(&mut csv, format_args!("{node}"));
        for value in q {
            put(&mut csv, format_args!(",{value}"));
        }
        let component = roadmap.components().of_node(node).name;
        put(&mut csv, format_args!(",{component}\n"));
    }
    csv
}

/// The edges as CSV: `low` and `high` (node ids), `weight [length]` (the motion's length in the
/// space's metric), `planner` (name) and `planner_tag` of the local planner whose motion from `low`
/// to `high` the edge is. A line per edge, in the roadmap's order.
pub fn edges_csv(roadmap: &Roadmap) -> String {
    let mut csv = "low,high,weight [length],planner,planner_tag\n".to_owned();
    for edge in roadmap.edges().iter() {
        let (tag, name) = (edge.planner, planner_name(edge.planner));
        put(&mut csv, format_args!("{},{},{},{name},{tag}\n", edge.low, edge.high, edge.weight()));
    }
    csv
}

/// The degrees of freedom with their units, as in the first line of a file.
pub(super) fn header(space: &Space) -> Vec<String> {
    space.dofs().iter().map(|dof| field(&format!("{} [{}]", dof.name, dof.unit))).collect()
}

/// A text as a field: quoted where it would not stay one field.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn put(csv: &mut String, text: std::fmt::Arguments) {
    csv.write_fmt(text).expect("writing to memory cannot fail");
}
