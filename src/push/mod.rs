//! Pushes: how colliding configurations of an approximate path are moved to valid configurations near them. One file per method.
//!
//! An approximate path, such as the solution of an easier version of a problem, has stretches that collide. Somewhere near such a
//! stretch a valid path may lead; a push looks for valid configurations there (O. B. Bayazit, *Solving motion planning
//! problems by iterative relaxation of constraints*, dissertation, Texas A&M University 2003, chapter IV D).
//!
//! Every push promises two things of what it gives: the configuration is valid, and it is no farther from the colliding configuration that
//! it was pushed from than [`Search::reach`], in the space's metric.

mod filter;
mod retraction;
mod search;
mod shortest;
mod simple;
mod workspace;

pub use filter::{is_held, thinned};
pub use retraction::retract;
pub use search::{Pushed, Run, Search};

use crate::context::Context;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The ways of pushing, as a problem file names them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Push {
    /// Toward the straight line between the valid configurations before and after the stretch.
    Simple,
    /// In the direction in which valid configurations are nearest.
    Shortest,
    /// By translation along the normals of the contacts.
    Workspace,
    /// Along the normals of all contacts at once, turning and bending as they demand.
    Retraction,
    /// All of these, one after another; of a model without contacts the first two.
    #[default]
    All, // new ones at the end, since ledgers know pushes by number
}

/// Those that are tried one after another for [`Push::All`].
const ALL: [Push; 4] = [Push::Shortest, Push::Retraction, Push::Simple, Push::Workspace];

impl Push {
    /// Whether the push is defined for the problem.
    ///
    /// # Errors
    /// Says what it cannot work with.
    pub fn suits(self, cx: &Context) -> Result<(), String> {
        let name = match self {
            Push::Simple | Push::Shortest | Push::All => return Ok(()),
            Push::Workspace => "workspace",
            Push::Retraction => "retraction",
        };
        if cx.model().contacts().is_none() {
            let expected = "a robot among obstacles, without a validity function, expected";
            return Err(format!(
                "the push {name} found, but the model knows no contacts; {expected}"
            ));
        }
        if self == Push::Workspace && cx.space().translations() == 0 {
            let expected = "a base that can be translated expected";
            return Err(format!(
                "the push {name} found, but the robot's base stands still; {expected}"
            ));
        }
        Ok(())
    }

    /// Pushes the colliding configurations of a stretch. What is given is in the order of the stretch, and of several that lie close together there is
    /// one.
    pub fn push(self, run: &Run, search: &mut Search) -> Vec<Pushed> {
        let found = match self {
            Push::Simple => filter::held(simple::push(run, search), search),
            Push::Shortest => shortest::push(run, search),
            Push::Workspace => filter::held(workspace::push(run, search), search),
            Push::Retraction => retraction::push(run, search),
            Push::All => {
                let mut found = ALL.map(|push| push.push(run, search)).concat();
                found.sort_by_key(|pushed| pushed.from);
                found
            }
        };
        thinned(search.cx.space(), found, search.step / 2.0)
    }
}

#[cfg(test)]
mod tests;
