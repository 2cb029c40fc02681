//! Formats that other programs read, and pictures of roadmaps.

mod drawing;
mod journey;
mod path_csv;
mod solid;
mod svg;
mod union;
mod view;

pub use path_csv::path_csv;
pub use svg::svg;

#[cfg(test)]
mod tests;
