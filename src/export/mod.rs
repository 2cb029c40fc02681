//! Formats that other programs read, and pictures of roadmaps.
//!
//! ```
//! use roadmill::export::{Exported, FORMATS, path_csv};
//! use roadmill::{Build, problem::Problem};
//!
//! let problem = Problem::load("problems/maze.toml".as_ref())?;
//! let built = Build::new(problem).run()?;
//! let (problem, roadmap, path) = (built.problem(), built.roadmap(), built.path());
//! let csv = path_csv(built.context().space(), path.expect("the maze has a way through"));
//! assert!(csv.starts_with("x"));
//! // A roadmap in every format that `roadmill export` has and that can say it: a maze is no molecule.
//! for format in FORMATS {
//!     match format.files(&Exported { problem, roadmap, path }) {
//!         Ok(files) => println!("{}: {} files", format.name(), files.len()),
//!         Err(why) => println!("{}: {why}", format.name()),
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chimerax;
mod clearance_csv;
mod coarse;
mod contours;
mod csv;
mod dcd;
mod deformed;
mod drawing;
mod extent;
mod format;
mod graphml;
mod journey;
mod markup;
mod npz;
mod page;
mod paint_order;
mod palette;
mod parasol;
mod path_csv;
mod pdb;
mod poses;
mod pymol;
mod report;
mod solid;
mod svg;
mod union;
mod vector;
mod view;
mod vtk;
mod xtc;

pub use chimerax::chimerax;
pub use csv::{edges_csv, nodes_csv};
pub use dcd::dcd;
pub use deformed::{
    DeformedPage, deformed_page, energies_csv, frame_name, frame_obj, obstacles_obj,
};
pub use format::{CannotExport, ExportFile, Exported, RoadmapFormat};
pub use graphml::graphml;
pub use npz::npz;
pub use page::{Live, NamedPath, Viewer, animation};
pub use parasol::{parasol_map, parasol_path};
pub use path_csv::path_csv;
pub use pdb::{pdb, structure_pdb};
pub use poses::{Minimum, PosesPage, ShownPose, WayFrame, poses_page};
pub use pymol::pymol;
pub use report::{
    ComparedBuild, ComparedStrategy, Comparison, Folding, Report, RoundOutcome, RoundValue, report,
};
pub use svg::{svg, svg_at, svg_from};
pub use view::Direction;
pub use xtc::xtc;

use crate::local::Planner;

/// The formats of roadmaps.
pub const FORMATS: &[&dyn RoadmapFormat] = &[
    &graphml::Graphml,
    &csv::Csv,
    &npz::Npz,
    &parasol::Map,
    &pdb::Pdb,
    &dcd::Dcd,
    &xtc::Xtc,
    &svg::Svg,
    &vtk::Vtk,
    &clearance_csv::ClearanceCsv,
];

/// The name of the local planner that a tag stands for.
fn planner_name(tag: u8) -> String {
    Planner::from_tag(tag).map_or_else(|| format!("unknown-{tag}"), |planner| planner.to_string())
}

#[cfg(test)]
mod tests;
