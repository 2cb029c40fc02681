//! A roadmap as two tables.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use super::planner_name;
use crate::internal::csv_field::csv_field;
use crate::model::Directed;
use crate::problem::Problem;
use crate::roadmap::Roadmap;
use crate::space::{Dof, Space};
use std::fmt::Write;

/// See [`nodes_csv`] and [`edges_csv`].
pub(super) struct Csv;

impl RoadmapFormat for Csv {
    fn name(&self) -> &'static str {
        "csv"
    }

    fn about(&self) -> &'static str {
        "Two tables, of the nodes and of the edges"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let Exported { problem, roadmap, .. } = *exported;
        let edges = edges_csv(problem, roadmap).into();
        let edges = ExportFile { extension: Some("edges.csv"), contents: edges };
        Ok(vec![ExportFile::named(nodes_csv(problem, roadmap)), edges])
    }
}

/// The nodes as CSV: `node` (id), the degrees of freedom with their units as in a path, `component` (the smallest
/// node id in the node's connected component), and with their units the values that the model gives every
/// milestone (an energy, say). A line per node, in order of their ids. Numbers are written so that reading
/// them back gives the same bits.
pub fn nodes_csv(problem: &Problem, roadmap: &Roadmap) -> String {
    let values = problem.model.description().node_values();
    let mut names = header(&problem.space());
    names.push("component".to_owned());
    names.extend(
        values
            .iter()
            .map(|value| csv_field(&format!("{} [{}]", value.name, value.unit)).into_owned()),
    );
    let mut csv = format!("node,{}\n", names.join(","));
    for (node, q) in roadmap.nodes().zip(roadmap.configs().iter()) {
        put(&mut csv, format_args!("{node}"));
        for value in q {
            put(&mut csv, format_args!(",{value}"));
        }
        let component = roadmap.components().of_node(node).name;
        put(&mut csv, format_args!(",{component}"));
        for value in roadmap.values_of(node, values.len()) {
            put(&mut csv, format_args!(",{value}"));
        }
        csv.push('\n');
    }
    csv
}

/// The edges as CSV: `low` and `high` (node ids), `weight` with its unit (of most models the motion's length in
/// the space's metric), `planner` (name) and `planner_tag` of the local planner whose motion from `low` to
/// `high` the edge is. Where costs depend on the direction, `weight` is that from `low` to `high`, and
/// `weight_back` (from `high` to `low`) and `peak` (the highest energy on the way) follow. A line per edge,
/// in the roadmap's order.
pub fn edges_csv(problem: &Problem, roadmap: &Roadmap) -> String {
    let unit = problem.model.description().cost_unit();
    let mut csv = format!("low,high,weight [{unit}],planner,planner_tag");
    if roadmap.edges().is_directed() {
        put(&mut csv, format_args!(",weight_back [{unit}],peak [{unit}]"));
    }
    csv.push('\n');
    for edge in roadmap.edges().iter() {
        let (tag, name) = (edge.planner, planner_name(edge.planner));
        put(&mut csv, format_args!("{},{},{},{name},{tag}", edge.low, edge.high, edge.weight()));
        if let Some(Directed { backward, peak, .. }) = edge.cost.directed() {
            put(&mut csv, format_args!(",{backward},{peak}"));
        }
        csv.push('\n');
    }
    csv
}

/// The degrees of freedom with their units, as in the first line of a file.
pub(super) fn header(space: &Space) -> Vec<String> {
    let name = |dof: &Dof| csv_field(&format!("{} [{}]", dof.name, dof.unit)).into_owned();
    space.dofs().iter().map(name).collect()
}

fn put(csv: &mut String, text: std::fmt::Arguments) {
    csv.write_fmt(text).expect("writing to memory cannot fail");
}
