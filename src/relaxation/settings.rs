use crate::methods::Complaint;
use crate::model::Relaxation;
use crate::numbers::NODES_MAX;
use serde::{Deserialize, Serialize};

/// How a problem is relaxed and strengthened again: the table `[relaxation]` of a problem file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Which constraints are relaxed; if nothing is said, as is usual for the model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<Relaxation>,
    /// The level that is tried first: above 0, at most 1, which is the problem itself.
    #[serde(default = "default_start")]
    pub start: f64,
    /// The smallest step from a level that is solved to the next: where a step of less would be made, other help is tried.
    #[serde(default = "default_finest")]
    pub finest: f64,
    /// How many levels are tried at most, each time that one is tried again included.
    #[serde(default = "default_levels")]
    pub levels: u32,
    /// A level counts as not solved at the end of the first round with so many nodes; one that is helped by another with fewer, see
    /// [`Settings::nodes_of`].
    #[serde(default = "default_nodes")]
    pub nodes: u64,
    /// A level counts as not solved at the end of the first round with so many sets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sets: Option<u64>,
    /// How many paths of the last solved level help at most, once its one path did not.
    #[serde(default = "default_paths")]
    pub paths: u32,
}

/// The most levels that can be tried.
const LEVELS_MAX: u32 = 1000;
/// The most paths that help.
const PATHS_MAX: u32 = 100;

fn default_start() -> f64 {
    1.0
}

fn default_finest() -> f64 {
    1.0 / 128.0
}

fn default_levels() -> u32 {
    40
}

fn default_nodes() -> u64 {
    100_000
}

fn default_paths() -> u32 {
    4
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            kind: None,
            start: default_start(),
            finest: default_finest(),
            levels: default_levels(),
            nodes: default_nodes(),
            sets: None,
            paths: default_paths(),
        }
    }
}

/// A level that is helped by another has this share of the nodes of one that is not.
const HELPED_SHARE: u64 = 20;
/// But at least so many, where one that is not helped has as many.
const HELPED_NODES: u64 = 3000;

impl Settings {
    /// The limit of nodes of a level, helped by another or not. Help shows soon or not at all, and a node that is made by pushing a hint
    /// free costs some twenty times as much as one that is drawn: with a twentieth of the nodes either kind of level costs about the same.
    pub fn nodes_of(&self, is_helped: bool) -> u64 {
        if is_helped {
            (self.nodes / HELPED_SHARE).max(HELPED_NODES).min(self.nodes)
        } else {
            self.nodes
        }
    }

    /// What is wrong with the settings beside the kind of relaxation, if anything is.
    pub fn complaint(&self) -> Option<Complaint> {
        let Settings { kind: _, start, finest, levels, nodes, sets, paths } = self;
        // Written so that NaN fails them.
        let checks = [
            (*start > 0.0 && *start <= 1.0)
                .then_some(())
                .ok_or_else(|| Complaint::new("start", start, "a level above 0, at most 1")),
            (*finest >= 1e-6 && *finest <= 0.5)
                .then_some(())
                .ok_or_else(|| Complaint::new("finest", finest, "a step from 1e-6 to 0.5")),
            (1..=LEVELS_MAX)
                .contains(levels)
                .then_some(())
                .ok_or_else(|| Complaint::new("levels", levels, "1 to 1000")),
            (1..=NODES_MAX)
                .contains(nodes)
                .then_some(())
                .ok_or_else(|| Complaint::new("nodes", nodes, "1 to 4294967293")),
            (*sets != Some(0)).then_some(()).ok_or_else(|| Complaint::new("sets", 0, "at least 1")),
            (1..=PATHS_MAX)
                .contains(paths)
                .then_some(())
                .ok_or_else(|| Complaint::new("paths", paths, "1 to 100")),
        ];
        checks.into_iter().find_map(Result::err)
    }
}
