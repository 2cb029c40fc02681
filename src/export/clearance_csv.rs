//! The clearances of a roadmap as two tables.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use crate::clearance;
use std::fmt::Write;

/// How far obstacles are: a table of the nodes, and one of the edges.
pub(super) struct ClearanceCsv;

impl RoadmapFormat for ClearanceCsv {
    fn name(&self) -> &'static str {
        "clearance"
    }

    fn about(&self) -> &'static str {
        "Two tables, of how far obstacles are from nodes and along edges"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let Exported { problem, roadmap, .. } = *exported;
        let none = || CannotExport("clearances are of bodies among obstacles".to_owned());
        let tolerance = problem.model.bodies().ok_or_else(none)?.resolution();
        let cx = problem.context();
        let of_nodes = clearance::of_nodes(&cx, roadmap).ok_or_else(none)?;
        let of_edges = clearance::of_edges(&cx, roadmap, tolerance).ok_or_else(none)?;
        let mut nodes = "node,clearance [length]\n".to_owned();
        for (node, distance) in roadmap.nodes().zip(of_nodes) {
            put(&mut nodes, format_args!("{node},{distance}\n"));
        }
        let mut edges = "low,high,length [length],least [length],mean [length]\n".to_owned();
        for (edge, along) in roadmap.edges().iter().zip(of_edges) {
            let clearance::AlongMotion { least, mean, length } = along;
            put(&mut edges, format_args!("{},{},{length},{least},{mean}\n", edge.low, edge.high));
        }
        let edges = ExportFile { extension: Some("edges.csv"), contents: edges.into() };
        Ok(vec![ExportFile::named(nodes), edges])
    }
}

fn put(csv: &mut String, text: std::fmt::Arguments) {
    csv.write_fmt(text).expect("writing to a string works");
}
