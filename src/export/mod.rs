//! Formats that other programs read.

mod path_csv;

pub use path_csv::path_csv;
