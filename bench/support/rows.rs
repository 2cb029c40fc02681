//! Rows of a table of runs, kept in a file as runs end.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::PathBuf;

/// Rows by the run that they belong to.
pub struct Rows {
    path: Option<PathBuf>,
    lines: Vec<String>,
}

impl Rows {
    /// Those of a file, which may not be there yet; without a file, none.
    pub fn open(path: Option<&str>) -> Rows {
        let path = path.map(PathBuf::from);
        let text = path.as_ref().and_then(|path| fs::read_to_string(path).ok());
        let lines = text.unwrap_or_default().lines().map(str::to_owned).collect();
        Rows { path, lines }
    }

    /// The rows that begin with these words, each cut at its commas after them; where there are none, those of `make`, which are kept.
    pub fn of(
        &mut self,
        head: &str,
        key: &str,
        make: impl FnOnce() -> Vec<Vec<f64>>,
    ) -> Vec<Vec<f64>> {
        let begin = format!("{key},");
        let known: Vec<Vec<f64>> = self
            .lines
            .iter()
            .filter_map(|line| line.strip_prefix(&begin))
            .map(|rest| {
                let number = |text: &str| text.parse().expect("rows have numbers");
                rest.split(',').map(number).collect()
            })
            .collect();
        if !known.is_empty() {
            return known;
        }
        let made = make();
        let line = |row: &Vec<f64>| {
            let numbers: Vec<String> = row.iter().map(|number| format!("{number:.4}")).collect();
            format!("{begin}{}", numbers.join(","))
        };
        let lines: Vec<String> = made.iter().map(line).collect();
        if let Some(path) = &self.path {
            let is_new = !path.exists();
            let mut file = OpenOptions::new().create(true).append(true).open(path).expect("a file");
            let head = if is_new { format!("{head}\n") } else { String::new() };
            writeln!(file, "{head}{}", lines.join("\n")).expect("it can be written");
        }
        self.lines.extend(lines);
        made
    }
}

/// The median; NaN of none.
pub fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    match numbers.len() {
        0 => f64::NAN,
        count if count % 2 == 1 => numbers[count / 2],
        count => (numbers[count / 2 - 1] + numbers[count / 2]) / 2.0,
    }
}
