mod files;
mod penetrating;
mod scaled;
mod surface;

use super::*;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::seed::{Purpose, Stream};
use std::path::Path;

/// A brick with a ball at its end among a wall and a pillar.
const BODIES: &str = r#"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [6.0, 4.0, 4.0]
bounds = "body"
[robot]
bodies = [
    { shape = { box = { size = [1.2, 0.6, 0.4] } } },
    { shape = { sphere = { radius = 0.3 } }, position = [0.7, 0.0, 0.0] },
]
padding = 0.05
[[obstacles]]
shape = { box = { size = [0.4, 4.0, 2.2] } }
position = [3.0, 2.0, 1.1]
[[obstacles]]
shape = { cylinder = { radius = 0.6, height = 4.0 } }
position = [5.0, 2.0, 2.0]
"#;

fn parse(text: &str) -> Result<Problem, String> {
    Problem::parse(Path::new("p.toml"), text).map_err(|error| error.to_string())
}

/// The bodies above with the lines of a table `[deformable]`.
fn with(lines: &str) -> String {
    format!("{BODIES}[deformable]\n{lines}")
}

fn deformable(text: &str) -> Deformable {
    let problem = parse(text).unwrap_or_else(|error| panic!("{error}"));
    problem.model().deformable().expect("it has the table").clone()
}

fn draws(name: &str) -> Stream {
    Seed::of_set(1, name, Ordinal(0)).stream(Purpose::Sampling)
}
