//! The rules of a possible conformation.
//!
//! The papers test side chains alone (K. Nath's thesis, ch. 3), and of what passes them half or more has a backbone that runs
//! through itself. The other rules exclude that; each can be switched off, to repeat the papers.

use crate::methods::Complaint;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The largest least distance, Å.
const LEAST_MAX: f64 = 10.0;

/// Least distances in Å; 0 switches a rule off. i and j count residues.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Rules {
    /// Of two CA, |i − j| > 2. Native chains have 4.0.
    pub alpha_carbons: f64,
    /// Of the centroids of two side chains.
    pub side_chains: f64,
    /// Of an N and an O, |i − j| ≥ 3. The least in seven native chains is 2.42.
    pub nitrogen_oxygen: f64,
    /// Of any other two of N, CA, C, O and CB, |i − j| ≥ 3. The least in seven native chains is 2.61.
    pub backbone: f64,
    /// Of one of N, CA, C, O and CB, and an obstacle.
    pub obstacle_backbone: f64,
    /// Of the centroid of a side chain and an obstacle.
    pub obstacle_side_chains: f64,
    /// Of two CA along a motion, |i − j| > 2: the greater of this and of L/√2, L being the longest distance of two CA that
    /// follow one another. Two chains that keep it cannot pass through one another.
    pub motion_alpha_carbons: f64,
    /// Of the centroids of two side chains along a motion.
    pub motion_side_chains: f64,
}

impl Default for Rules {
    fn default() -> Rules {
        Rules {
            alpha_carbons: 3.0,
            side_chains: 2.4,
            nitrogen_oxygen: 2.4,
            backbone: 2.6,
            obstacle_backbone: 2.6,
            obstacle_side_chains: 2.4,
            motion_alpha_carbons: 2.7,
            motion_side_chains: 1.0,
        }
    }
}

/// The least distances, in Å, that hold at one moment; a rule that is switched off has 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// See [`Rules`].
    pub alpha_carbons: f64,
    /// See [`Rules`].
    pub side_chains: f64,
    /// See [`Rules`].
    pub nitrogen_oxygen: f64,
    /// See [`Rules`].
    pub backbone: f64,
    /// See [`Rules`].
    pub obstacle_backbone: f64,
    /// See [`Rules`].
    pub obstacle_side_chains: f64,
}

impl Rules {
    /// All rules switched off.
    pub fn none() -> Rules {
        Rules {
            alpha_carbons: 0.0,
            side_chains: 0.0,
            nitrogen_oxygen: 0.0,
            backbone: 0.0,
            obstacle_backbone: 0.0,
            obstacle_side_chains: 0.0,
            motion_alpha_carbons: 0.0,
            motion_side_chains: 0.0,
        }
    }

    /// What is wrong with the distances.
    pub(in crate::model::protein) fn complaint(&self) -> Option<Complaint> {
        let Rules {
            alpha_carbons,
            side_chains,
            nitrogen_oxygen,
            backbone,
            obstacle_backbone,
            obstacle_side_chains,
            motion_alpha_carbons,
            motion_side_chains,
        } = *self;
        let all = [
            ("alpha-carbons", alpha_carbons),
            ("side-chains", side_chains),
            ("nitrogen-oxygen", nitrogen_oxygen),
            ("backbone", backbone),
            ("obstacle-backbone", obstacle_backbone),
            ("obstacle-side-chains", obstacle_side_chains),
            ("motion-alpha-carbons", motion_alpha_carbons),
            ("motion-side-chains", motion_side_chains),
        ];
        let wrong = all.into_iter().find(|(_, least)| !(0.0..=LEAST_MAX).contains(least));
        wrong.map(|(key, least)| {
            Complaint::new(key, least, "a distance from 0, which switches the rule off, to 10 Å")
        })
    }

    /// What holds at the ends of motions.
    pub fn at_nodes(&self) -> Limits {
        Limits {
            alpha_carbons: self.alpha_carbons,
            side_chains: self.side_chains,
            nitrogen_oxygen: self.nitrogen_oxygen,
            backbone: self.backbone,
            obstacle_backbone: self.obstacle_backbone,
            obstacle_side_chains: self.obstacle_side_chains,
        }
    }

    /// What holds all along a motion, given the longest distance of two CA that follow one another, Å.
    pub fn along_motions(&self, longest_virtual_bond: f64) -> Limits {
        let uncrossed = longest_virtual_bond / std::f64::consts::SQRT_2;
        let on = |least: f64, instead: f64| if least > 0.0 { instead } else { 0.0 };
        let side_chains = self.motion_side_chains;
        Limits {
            alpha_carbons: on(self.motion_alpha_carbons, self.motion_alpha_carbons.max(uncrossed)),
            side_chains,
            nitrogen_oxygen: 0.0,
            backbone: 0.0,
            obstacle_backbone: self.obstacle_backbone,
            obstacle_side_chains: on(self.obstacle_side_chains, side_chains),
        }
    }
}
