//! The rules pair by pair: what they say of every pair of atoms, and who violates them.

use super::obstacles::Obstacles;
use super::rules::Limits;
use crate::model::protein::placed::{Placed, Site};
use crate::structure::Point;
use std::ops::ControlFlow;

/// A rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// Two CA.
    AlphaCarbons,
    /// Two side chains.
    SideChains,
    /// N and O.
    NitrogenOxygen,
    /// Two other atoms of the backbone.
    Backbone,
    /// An atom of the backbone and an obstacle.
    ObstacleBackbone,
    /// A side chain and an obstacle.
    ObstacleSideChains,
}

/// An atom that rules know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Atom {
    N,
    CA,
    C,
    O,
    CB,
    SideChain,
    Obstacle,
}

/// Two atoms that are too close. A coordinate that is no number violates every rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation {
    /// The rule.
    pub rule: Rule,
    /// The residue that comes first along the chain, counted from 0, and its atom.
    pub first: (usize, Atom),
    /// The other residue, or the number of the obstacle.
    pub second: (usize, Atom),
    /// Their distance, Å.
    pub distance: f64,
}

/// How many pairs violate each rule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names are the rules'")]
pub struct Counts {
    pub alpha_carbons: usize,
    pub side_chains: usize,
    pub nitrogen_oxygen: usize,
    pub backbone: usize,
    pub obstacle_backbone: usize,
    pub obstacle_side_chains: usize,
}

impl Counts {
    /// Of all rules together.
    pub fn total(&self) -> usize {
        self.alpha_carbons
            + self.side_chains
            + self.nitrogen_oxygen
            + self.backbone
            + self.obstacle_backbone
            + self.obstacle_side_chains
    }

    /// Counts a violation.
    pub(super) fn add(&mut self, rule: Rule) {
        *match rule {
            Rule::AlphaCarbons => &mut self.alpha_carbons,
            Rule::SideChains => &mut self.side_chains,
            Rule::NitrogenOxygen => &mut self.nitrogen_oxygen,
            Rule::Backbone => &mut self.backbone,
            Rule::ObstacleBackbone => &mut self.obstacle_backbone,
            Rule::ObstacleSideChains => &mut self.obstacle_side_chains,
        } += 1;
    }
}

/// The square of the distance of two points.
#[inline(always)]
pub(super) fn square(a: &Point, b: &Point) -> f64 {
    let (x, y, z) = (a.x - b.x, a.y - b.y, a.z - b.z);
    x * x + y * y + z * z
}

/// The backbone atoms of a residue, CB among them.
pub(super) const BACKBONE: [(Atom, Site); 5] = [
    (Atom::N, Site::N),
    (Atom::CA, Site::CA),
    (Atom::C, Site::C),
    (Atom::O, Site::O),
    (Atom::CB, Site::CB),
];

/// Everybody who looks at violations: goes on, or not.
pub(super) type Flow = ControlFlow<Violation>;

impl Limits {
    /// Calls `each` for every violation by the backbones of two residues i < j.
    pub(super) fn of_backbones(
        &self,
        placed: &Placed,
        (i, j): (usize, usize),
        each: &mut dyn FnMut(Violation) -> Flow,
    ) -> Flow {
        if j - i < 3 {
            return Flow::Continue(());
        }
        let mut test = |rule, least: f64, one: Atom, a: &Point, other: Atom, b: &Point| {
            // A distance that is no number is a violation, so nothing is asked the other way round.
            let square = square(a, b);
            if least <= 0.0 || square >= least * least {
                return Flow::Continue(());
            }
            each(Violation { rule, first: (i, one), second: (j, other), distance: square.sqrt() })
        };
        let (a, b) = (placed.at(Site::CA, i), placed.at(Site::CA, j));
        test(Rule::AlphaCarbons, self.alpha_carbons, Atom::CA, &a, Atom::CA, &b)?;
        let is_lacking = |atom, residue: usize| atom == Atom::CB && !placed.has_cb[residue];
        for (one, a) in BACKBONE {
            for (other, b) in BACKBONE {
                if is_lacking(one, i) || is_lacking(other, j) {
                    continue;
                }
                let (rule, least) = match (one, other) {
                    (Atom::N, Atom::O) | (Atom::O, Atom::N) => {
                        (Rule::NitrogenOxygen, self.nitrogen_oxygen)
                    }
                    _ => (Rule::Backbone, self.backbone),
                };
                test(rule, least, one, &placed.at(a, i), other, &placed.at(b, j))?;
            }
        }
        Flow::Continue(())
    }

    /// Calls `each` if the side chains of two residues i < j violate their rule.
    pub(super) fn of_side_chains(
        &self,
        placed: &Placed,
        (i, j): (usize, usize),
        each: &mut dyn FnMut(Violation) -> Flow,
    ) -> Flow {
        let least = self.side_chains;
        if least <= 0.0 || !placed.has_centroid[i] || !placed.has_centroid[j] {
            return Flow::Continue(());
        }
        let square = square(&placed.at(Site::Centroid, i), &placed.at(Site::Centroid, j));
        if square >= least * least {
            return Flow::Continue(());
        }
        let (first, second) = ((i, Atom::SideChain), (j, Atom::SideChain));
        each(Violation { rule: Rule::SideChains, first, second, distance: square.sqrt() })
    }

    /// Calls `each` for every violation by a residue and an obstacle.
    pub(super) fn of_obstacle(
        &self,
        placed: &Placed,
        residue: usize,
        (number, obstacle): (usize, &Point),
        each: &mut dyn FnMut(Violation) -> Flow,
    ) -> Flow {
        let mut test = |rule, least: f64, atom, a: &Point| {
            let square = square(a, obstacle);
            if least <= 0.0 || square >= least * least {
                return Flow::Continue(());
            }
            let second = (number, Atom::Obstacle);
            each(Violation { rule, first: (residue, atom), second, distance: square.sqrt() })
        };
        for (atom, site) in BACKBONE {
            let at = placed.at(site, residue);
            if atom != Atom::CB || placed.has_cb[residue] {
                test(Rule::ObstacleBackbone, self.obstacle_backbone, atom, &at)?;
            }
        }
        if placed.has_centroid[residue] {
            let at = placed.at(Site::Centroid, residue);
            test(Rule::ObstacleSideChains, self.obstacle_side_chains, Atom::SideChain, &at)?;
        }
        Flow::Continue(())
    }

    /// Calls `each` for every violation: those of the first residue with every residue after it, of these first the
    /// backbones and then the side chains, and with every obstacle; then those of the second; and so on.
    pub(super) fn of_all(
        &self,
        placed: &Placed,
        obstacles: &Obstacles,
        each: &mut dyn FnMut(Violation) -> Flow,
    ) -> Flow {
        for i in 0..placed.len() {
            for j in i + 1..placed.len() {
                self.of_backbones(placed, (i, j), each)?;
                self.of_side_chains(placed, (i, j), each)?;
            }
            for obstacle in obstacles.points().iter().enumerate() {
                self.of_obstacle(placed, i, obstacle, each)?;
            }
        }
        Flow::Continue(())
    }
}
