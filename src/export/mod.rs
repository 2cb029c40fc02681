//! Formats that other programs read, and pictures of roadmaps.

mod animation;
mod csv;
mod drawing;
mod graphml;
mod journey;
mod markup;
mod npz;
mod paint_order;
mod parasol;
mod path_csv;
mod solid;
mod svg;
mod tessellate;
mod union;
mod vector;
mod view;

pub use animation::animation;
pub use csv::{edges_csv, nodes_csv};
pub use graphml::graphml;
pub use npz::npz;
pub use parasol::{parasol_map, parasol_path};
pub use path_csv::path_csv;
pub use svg::svg;

use crate::local::Planner;

/// The name of the local planner that a tag stands for.
fn planner_name(tag: u8) -> String {
    Planner::from_tag(tag).map_or_else(|| format!("unknown-{tag}"), |planner| planner.to_string())
}

#[cfg(test)]
mod tests;
