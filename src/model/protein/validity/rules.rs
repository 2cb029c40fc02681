//! The rules of a possible conformation.
//!
//! The papers test side chains alone (K. Nath's thesis, ch. 3), and of what passes them half or more has a backbone that runs
//! through itself. The other rules exclude that; each can be switched off, to repeat the papers.

use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Least distances in Å; `None` switches a rule off. i and j count residues.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Rules {
    /// Of two CA, |i − j| > 2. Native chains have 4.0.
    pub alpha_carbons: Option<f64>,
    /// Of the centroids of two side chains.
    pub side_chains: Option<f64>,
    /// Of an N and an O, |i − j| ≥ 3. The least in seven native chains is 2.42.
    pub nitrogen_oxygen: Option<f64>,
    /// Of any other two of N, CA, C, O and CB, |i − j| ≥ 3. The least in seven native chains is 2.61.
    pub backbone: Option<f64>,
    /// Of one of N, CA, C, O and CB, and an obstacle.
    pub obstacle_backbone: Option<f64>,
    /// Of the centroid of a side chain and an obstacle.
    pub obstacle_side_chains: Option<f64>,
    /// Of two CA along a motion, |i − j| > 2: the greater of this and of L/√2, L being the longest distance of two CA that
    /// follow one another. Two chains that keep it cannot pass through one another.
    pub motion_alpha_carbons: Option<f64>,
    /// Of the centroids of two side chains along a motion.
    pub motion_side_chains: Option<f64>,
}

impl Default for Rules {
    fn default() -> Rules {
        Rules {
            alpha_carbons: Some(3.0),
            side_chains: Some(2.4),
            nitrogen_oxygen: Some(2.4),
            backbone: Some(2.6),
            obstacle_backbone: Some(2.6),
            obstacle_side_chains: Some(2.4),
            motion_alpha_carbons: Some(2.7),
            motion_side_chains: Some(1.0),
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
            alpha_carbons: None,
            side_chains: None,
            nitrogen_oxygen: None,
            backbone: None,
            obstacle_backbone: None,
            obstacle_side_chains: None,
            motion_alpha_carbons: None,
            motion_side_chains: None,
        }
    }

    /// What holds at the ends of motions.
    pub fn at_nodes(&self) -> Limits {
        Limits {
            alpha_carbons: self.alpha_carbons.unwrap_or(0.0),
            side_chains: self.side_chains.unwrap_or(0.0),
            nitrogen_oxygen: self.nitrogen_oxygen.unwrap_or(0.0),
            backbone: self.backbone.unwrap_or(0.0),
            obstacle_backbone: self.obstacle_backbone.unwrap_or(0.0),
            obstacle_side_chains: self.obstacle_side_chains.unwrap_or(0.0),
        }
    }

    /// What holds all along a motion, given the longest distance of two CA that follow one another, Å.
    pub fn along_motions(&self, longest_virtual_bond: f64) -> Limits {
        let uncrossed = longest_virtual_bond * std::f64::consts::FRAC_1_SQRT_2;
        let side_chains = self.motion_side_chains.unwrap_or(0.0);
        Limits {
            alpha_carbons: self.motion_alpha_carbons.map_or(0.0, |least| least.max(uncrossed)),
            side_chains,
            nitrogen_oxygen: 0.0,
            backbone: 0.0,
            obstacle_backbone: self.obstacle_backbone.unwrap_or(0.0),
            obstacle_side_chains: self.obstacle_side_chains.map_or(0.0, |_| side_chains),
        }
    }
}
