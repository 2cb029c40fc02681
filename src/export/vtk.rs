//! A roadmap as a file of the Visualization Toolkit, for ParaView and what else reads its legacy format.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use std::fmt::{Arguments, Write};

/// Lines and points in space (*VTK File Formats*, simple legacy formats, `DATASET POLYDATA`, as text).
///
/// Points are the nodes in order of their ids, each where a picture draws its configuration; planar ones have z = 0.
/// They carry `component` (the smallest node id in the node's connected component) and the values that the
/// model gives every milestone. Lines are the edges in the roadmap's order, from the lower node to the higher. They
/// carry `weight`, and where costs depend on the direction `weight_back` and `peak` as in the table of the edges.
pub(super) struct Vtk;

impl RoadmapFormat for Vtk {
    fn name(&self) -> &'static str {
        "vtk"
    }

    fn about(&self) -> &'static str {
        "Points and lines in space for ParaView (legacy VTK)"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let Exported { problem, roadmap, .. } = *exported;
        let description = problem.model.description();
        let figure = description.figure();
        let figure = figure.ok_or_else(|| CannotExport("this model cannot be drawn".to_owned()))?;
        let (nodes, edges) = (roadmap.configs().len(), roadmap.edges().len());
        let mut out = String::new();
        // The second line holds at most 256 characters; a name has at most 100 bytes.
        put(&mut out, format_args!("# vtk DataFile Version 3.0\n{}\nASCII", problem.name));
        put(&mut out, format_args!("DATASET POLYDATA\nPOINTS {nodes} double"));
        for q in roadmap.configs().iter() {
            let [x, y, z] = figure.marker(q);
            put(&mut out, format_args!("{x} {y} {z}"));
        }
        if edges > 0 {
            put(&mut out, format_args!("LINES {edges} {}", 3 * edges));
            for edge in roadmap.edges().iter() {
                put(&mut out, format_args!("2 {} {}", edge.low, edge.high));
            }
        }

        put(&mut out, format_args!("POINT_DATA {nodes}"));
        let components = roadmap.nodes().map(|node| roadmap.components().of_node(node).name);
        column(&mut out, "component unsigned_int", components);
        let values = description.node_values();
        for (index, value) in values.iter().enumerate() {
            // Names are single words.
            let name = value.name.replace(char::is_whitespace, "_");
            let numbers = roadmap.nodes().map(|node| roadmap.values_of(node, values.len())[index]);
            column(&mut out, &format!("{name} double"), numbers);
        }
        if edges > 0 {
            put(&mut out, format_args!("CELL_DATA {edges}"));
            column(&mut out, "weight double", roadmap.edges().iter().map(|edge| edge.weight()));
            if roadmap.edges().is_directed() {
                let costs = || roadmap.edges().iter().filter_map(|edge| edge.cost.directed());
                column(&mut out, "weight_back double", costs().map(|cost| cost.backward));
                column(&mut out, "peak double", costs().map(|cost| cost.peak));
            }
        }
        Ok(vec![ExportFile::named(out)])
    }
}

/// A number for every point or line; `heading` is its name and its type.
fn column(out: &mut String, heading: &str, numbers: impl Iterator<Item = impl std::fmt::Display>) {
    put(out, format_args!("SCALARS {heading} 1\nLOOKUP_TABLE default"));
    for number in numbers {
        put(out, format_args!("{number}"));
    }
}

fn put(out: &mut String, text: Arguments) {
    out.write_fmt(text).expect("writing to memory cannot fail");
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::img::{Grown, Setup, build};
    use crate::problem::Problem;
    use crate::roadmap::Roadmap;
    use std::collections::BTreeMap;
    use std::path::Path;
    use std::sync::Arc;

    fn built(text: &str) -> (Problem, Roadmap) {
        let problem = Problem::parse(Path::new("p.toml"), text).expect("a sound problem");
        let Grown { roadmap, .. } = build(&Arc::new(Setup::new(problem.clone())));
        (problem, roadmap)
    }

    fn vtk(problem: &Problem, roadmap: &Roadmap) -> String {
        let files = Vtk.files(&Exported { problem, roadmap, path: None }).expect("it can be drawn");
        let [file] = &files[..] else { panic!("one file") };
        assert!(file.extension.is_none());
        String::from_utf8(file.contents.clone()).expect("it is text")
    }

    /// A file taken apart word by word, as readers of the format do: points, lines, and the columns of numbers.
    struct Parsed {
        points: Vec<[f64; 3]>,
        lines: Vec<[u32; 2]>,
        columns: BTreeMap<String, Vec<f64>>,
    }

    fn parse(text: &str) -> Parsed {
        let mut parsed = Parsed { points: Vec::new(), lines: Vec::new(), columns: BTreeMap::new() };
        let mut head = text.splitn(5, '\n');
        assert_eq!(head.next(), Some("# vtk DataFile Version 3.0"));
        assert_eq!(head.next(), Some("p"));
        assert_eq!((head.next(), head.next()), (Some("ASCII"), Some("DATASET POLYDATA")));
        let mut words = head.next().expect("a body").split_whitespace();
        let mut count = 0;
        while let Some(word) = words.next() {
            let mut next = || words.next().expect("a word");
            match word {
                "POINTS" => {
                    count = next().parse().expect("a number");
                    assert_eq!(next(), "double");
                    let mut number = || next().parse().expect("a number");
                    parsed.points = (0..count).map(|_| [number(), number(), number()]).collect();
                }
                "LINES" => {
                    let [lines, size] = [next(), next()].map(|n| n.parse::<usize>().unwrap());
                    assert_eq!(size, 3 * lines);
                    for _ in 0..lines {
                        assert_eq!(next(), "2");
                        parsed.lines.push([next(), next()].map(|id| id.parse().unwrap()));
                    }
                }
                "POINT_DATA" | "CELL_DATA" => count = next().parse().expect("a number"),
                "SCALARS" => {
                    let name = next().to_owned();
                    assert!(["double", "unsigned_int"].contains(&next()));
                    assert_eq!([next(), next(), next()], ["1", "LOOKUP_TABLE", "default"]);
                    let numbers = (0..count).map(|_| next().parse().expect("a number")).collect();
                    assert_eq!(parsed.columns.insert(name, numbers), None);
                }
                other => panic!("`{other}` is no keyword"),
            }
        }
        parsed
    }

    #[test]
    fn an_energy_leaves_with_its_values_and_directed_costs() {
        let (problem, roadmap) = built(
            "[landscape]\nmin = [-1.5, -0.5]\nmax = [1.2, 2.0]\nenergy = { muller-brown = {} }\n\
             [limits]\nsets = 2\n",
        );
        let text = vtk(&problem, &roadmap);
        assert_eq!(text, vtk(&problem, &roadmap));
        let Parsed { points, lines, columns } = parse(&text);
        let names: Vec<&str> = columns.keys().map(|name| &**name).collect();
        assert_eq!(names, ["component", "energy", "peak", "weight", "weight_back"]);
        for (node, q) in roadmap.nodes().zip(roadmap.configs().iter()) {
            assert_eq!(points[node.index()], [q[0], q[1], 0.0]);
            assert_eq!(columns["energy"][node.index()], roadmap.values_of(node, 1)[0]);
            let component = roadmap.components().of_node(node).name;
            assert_eq!(columns["component"][node.index()], f64::from(component.0));
        }
        assert_eq!(points.len(), roadmap.configs().len());
        for (index, edge) in roadmap.edges().iter().enumerate() {
            assert_eq!(lines[index], [edge.low.0, edge.high.0]);
            let cost = edge.cost.directed().expect("it depends on the direction");
            let found = ["weight", "weight_back", "peak"].map(|name| columns[name][index]);
            assert_eq!(found, [cost.forward, cost.backward, cost.peak]);
        }
        assert_eq!(lines.len(), roadmap.edges().len());
    }

    #[test]
    fn bodies_leave_with_lengths_and_an_empty_roadmap_without_lines() {
        let (problem, roadmap) = built(
            "[space]\nmotion = \"translation-3d\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nbounds = \"body\"\n\
             [robot]\nbodies = [{ shape = { sphere = { radius = 0.1 } } }]\n[limits]\nsets = 1\n",
        );
        let Parsed { points, lines, columns } = parse(&vtk(&problem, &roadmap));
        assert_eq!(columns.len(), 2, "component and weight");
        for ([low, high], weight) in lines.iter().zip(&columns["weight"]) {
            let [a, b] = [low, high].map(|node| points[*node as usize]);
            let length = (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt();
            assert!((length - weight).abs() < 1e-12, "{length}, not {weight}");
        }
        assert!(!lines.is_empty());
        let empty = parse(&vtk(&problem, &Roadmap::new(&problem.space())));
        assert_eq!((empty.points.len(), empty.lines.len(), empty.columns.len()), (0, 0, 1));
    }
}
