use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use crate::problem::Problem;
use crate::roadmap::Roadmap;
use std::io::{self, Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// See [`npz`].
pub(super) struct Npz;

impl RoadmapFormat for Npz {
    fn name(&self) -> &'static str {
        "npz"
    }

    fn about(&self) -> &'static str {
        "NumPy arrays"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let arrays = npz(exported.problem, exported.roadmap);
        let arrays = arrays.map_err(|error| CannotExport(error.to_string()))?;
        Ok(vec![ExportFile::named(arrays)])
    }
}

/// A roadmap as NumPy arrays in an `.npz` file, the same bytes for the same roadmap. The arrays are not compressed, and their
/// data begin at multiples of 64 bytes, so that the file can be mapped into memory and read in place.
///
/// | array | shape and type | what |
/// | --- | --- | --- |
/// | `nodes` | n × dofs, `<f8` | configurations; lengths in the problem's unit, angles in radians |
/// | `components` | n, `<u4` | smallest node id in the node's connected component |
/// | `edges` | m × 2, `<u4` | node ids, the lower first |
/// | `weights` | m, `<f8` | costs of the edges: of most models their lengths in the space's metric |
/// | `planners` | m, `u1` | tags of the local planners |
/// | `values` | n × values, `<f8` | what the model gives every milestone; only where it gives something |
/// | `value_names` | values, `<U…` | names of these; as `values` |
/// | `weights_back` | m, `<f8` | costs from the higher node to the lower; only where costs depend on the direction |
/// | `peaks` | m, `<f8` | the highest energies on the edges; as `weights_back` |
/// | `dof_names` | dofs, `<U…` | names of the degrees of freedom |
/// | `dof_units` | dofs, `<U…` | `length`, `rad` or `1` |
///
/// # Errors
/// None that memory does not give.
pub fn npz(problem: &Problem, roadmap: &Roadmap) -> io::Result<Vec<u8>> {
    let space = problem.space();
    let (nodes, edges) = (roadmap.configs(), roadmap.edges());
    let names = space.dofs().iter().map(|dof| dof.name.as_str()).collect::<Vec<_>>();
    let units = space.dofs().iter().map(|dof| dof.unit).collect::<Vec<_>>();
    let mut archive = Archive(ZipWriter::new(Cursor::new(Vec::new())));
    let shape = format!("({}, {})", nodes.len(), nodes.dofs());
    let bytes = nodes.values().flat_map(|value| value.to_le_bytes());
    archive.add("nodes", "<f8", &shape, bytes)?;
    let components = roadmap.nodes().map(|node| roadmap.components().of_node(node).name.0);
    let shape = format!("({},)", nodes.len());
    archive.add("components", "<u4", &shape, components.flat_map(u32::to_le_bytes))?;
    let shape = format!("({}, 2)", edges.len());
    let ends = edges.iter().flat_map(|edge| [edge.low.0, edge.high.0]);
    archive.add("edges", "<u4", &shape, ends.flat_map(u32::to_le_bytes))?;
    let shape = format!("({},)", edges.len());
    let bytes = edges.iter().flat_map(|edge| edge.weight().to_le_bytes());
    archive.add("weights", "<f8", &shape, bytes)?;
    archive.add("planners", "|u1", &shape, edges.iter().map(|edge| edge.planner))?;
    let values = problem.model.description().node_values();
    if !values.is_empty() {
        let numbers = roadmap.values().iter().flat_map(|value| value.to_le_bytes());
        archive.add("values", "<f8", &format!("({}, {})", nodes.len(), values.len()), numbers)?;
        let names = values.iter().map(|value| value.name).collect::<Vec<_>>();
        archive.texts("value_names", &names)?;
    }
    if edges.is_directed() {
        let costs = || edges.iter().filter_map(|edge| edge.cost.directed());
        let bytes = costs().flat_map(|cost| cost.backward.to_le_bytes());
        archive.add("weights_back", "<f8", &shape, bytes)?;
        let bytes = costs().flat_map(|cost| cost.peak.to_le_bytes());
        archive.add("peaks", "<f8", &shape, bytes)?;
    }
    archive.texts("dof_names", &names)?;
    archive.texts("dof_units", &units)?;
    Ok(archive.0.finish()?.into_inner())
}

/// The arrays' data begin at multiples of this many bytes of the file, so that whoever maps the file into memory finds numbers
/// where processors want them. NumPy fills the header of an array to the same multiple.
const ALIGNMENT: u16 = 64;

struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    /// Adds an array in NumPy's format 1.0, C order.
    fn add(
        &mut self,
        name: &str,
        kind: &str,
        shape: &str,
        data: impl Iterator<Item = u8>,
    ) -> io::Result<()> {
        // The bytes must not depend on the time of day, on the version of a compressor or on the system.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .last_modified_time(DateTime::DEFAULT)
            .unix_permissions(0o644)
            .large_file(true)
            .with_alignment(ALIGNMENT);
        self.0.start_file(format!("{name}.npy"), options)?;
        let mut header =
            format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
        // Magic, version, length and header together fill blocks.
        while (10 + header.len() + 1) % usize::from(ALIGNMENT) != 0 {
            header.push(' ');
        }
        header.push('\n');
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(data);
        self.0.write_all(&bytes)
    }

    /// Adds an array of texts, four bytes per character, all as long as the longest.
    fn texts(&mut self, name: &str, texts: &[&str]) -> io::Result<()> {
        let length = |text: &&str| text.chars().count();
        let longest = texts.iter().map(length).max().unwrap_or(0).max(1);
        let padded = texts
            .iter()
            .flat_map(|text| text.chars().chain(std::iter::repeat_n('\0', longest - length(text))));
        let bytes = padded.flat_map(|c| u32::from(c).to_le_bytes());
        self.add(name, &format!("<U{longest}"), &format!("({},)", texts.len()), bytes)
    }
}
