//! The environments of TR05-007, Figure 2, the strategies of its §4.1, and what its Table 1 says.

use roadmill::sampler::SamplerKind;
use std::path::{Path, PathBuf};

/// A row of Table 1: nodes, and the percentages connected and solved.
pub type Row = [f64; 3];

pub struct Environment {
    /// The problem in `problems/`.
    pub name: &'static str,
    pub title: &'static str,
    /// About the width of what is narrow in it; deviations and steps follow from it.
    pub width: f64,
    /// Table 1, in its order: predefined query, coverage, connectivity.
    pub paper: [Row; 3],
}

pub const STRATEGIES: [&str; 5] = ["uniform", "gaussian", "bridge", "obprm", "maprm"];

pub const ENVIRONMENTS: [Environment; 4] = [
    Environment {
        name: "maze3d",
        title: "Maze",
        width: 1.8,
        paper: [[2600.0, 98.7, 89.7], [250.0, 96.7, 41.4], [2971.7, 99.4, 94.7]],
    },
    Environment {
        name: "cage",
        title: "Cage",
        width: 0.73,
        paper: [[3261.7, 91.6, 81.4], [250.0, 89.1, 47.3], [403.3, 90.4, 52.6]],
    },
    Environment {
        name: "hook",
        title: "Hook",
        width: 0.8,
        paper: [[18368.0, 90.4, 69.7], [250.0, 87.4, 25.0], [16717.2, 90.9, 69.3]],
    },
    Environment {
        name: "stick2",
        title: "Walls with 2 links",
        width: 0.8,
        paper: [[14453.7, 83.8, 63.7], [250.0, 82.6, 16.0], [12460.1, 79.4, 62.5]],
    },
];

impl Environment {
    pub fn path(&self) -> PathBuf {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems");
        folder.join(self.name).with_extension("toml")
    }

    /// A strategy's sampler, as a problem file names it; `None` if this program has none of that name.
    pub fn sampler(&self, strategy: &str) -> Option<SamplerKind> {
        let width = self.width;
        let text = match strategy {
            "gaussian" => format!("gaussian = {{ deviation = {} }}", width / 2.0),
            "bridge" => format!("bridge = {{ deviation = {width} }}"),
            "obprm" => format!("obprm = {{ step = {} }}", width / 4.0),
            "maprm" => {
                format!("maprm = {{ step = {}, tolerance = {} }}", width / 4.0, width / 20.0)
            }
            other => format!("{other} = {{}}"),
        };
        toml::from_str(&text).ok()
    }
}
