use super::csv::header;
use crate::query::Path;
use crate::space::Space;
use std::fmt::Write;

/// A path as CSV: a header of the degrees of freedom with their units (`x [length]`,
/// `theta [rad]`, `qw [1]`, …), then a configuration per line, from start to goal. Numbers are
/// written so that reading them back gives the same bits.
pub fn path_csv(space: &Space, path: &Path) -> String {
    let mut csv = header(space).join(",");
    csv.push('\n');
    for q in path.configs.iter() {
        for (i, value) in q.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(csv, "{comma}{value}").expect("writing to memory cannot fail");
        }
        csv.push('\n');
    }
    csv
}
