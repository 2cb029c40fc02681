//! The rules pair by pair: what they say of every pair of atoms, and who violates them.

use super::rules::{Limits, Rules};
use crate::model::protein::placed::{Coordinates, Placed};
use crate::structure::Point;
use std::ops::ControlFlow;

/// Rigid atoms around the chain, in the source's frame, Å.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    /// Their positions.
    pub points: Vec<Point>,
}

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

/// The backbone atoms of a conformation, CB among them.
pub(super) fn backbone(placed: &Placed) -> [(Atom, &Coordinates); 5] {
    let Placed { n, ca, c, o, cb, .. } = placed;
    [(Atom::N, n), (Atom::CA, ca), (Atom::C, c), (Atom::O, o), (Atom::CB, cb)]
}

/// Everybody who looks at violations: goes on, or not.
pub(super) type Flow = ControlFlow<Violation>;

impl Limits {
    /// Calls `each` for every violation by two residues i < j.
    pub(super) fn of_pair(
        &self,
        placed: &Placed,
        (i, j): (usize, usize),
        each: &mut impl FnMut(Violation) -> Flow,
    ) -> Flow {
        let mut test = |rule, least: f64, one: Atom, a: &Point, other: Atom, b: &Point| {
            // A distance that is no number is a violation, so nothing is asked the other way round.
            let square = square(a, b);
            if least <= 0.0 || square >= least * least {
                return Flow::Continue(());
            }
            each(Violation { rule, first: (i, one), second: (j, other), distance: square.sqrt() })
        };
        if j - i > 2 {
            let (a, b) = (placed.ca.at(i), placed.ca.at(j));
            test(Rule::AlphaCarbons, self.alpha_carbons, Atom::CA, &a, Atom::CA, &b)?;
        }
        if placed.has_centroid[i] && placed.has_centroid[j] {
            let (a, b) = (placed.centroid.at(i), placed.centroid.at(j));
            let side = Atom::SideChain;
            test(Rule::SideChains, self.side_chains, side, &a, side, &b)?;
        }
        if j - i < 3 {
            return Flow::Continue(());
        }
        let is_lacking = |atom, residue: usize| atom == Atom::CB && !placed.has_cb[residue];
        for (one, a) in backbone(placed) {
            for (other, b) in backbone(placed) {
                if [(one, i), (other, j)].iter().any(|(atom, residue)| is_lacking(*atom, *residue))
                {
                    continue;
                }
                let (a, b) = (a.at(i), b.at(j));
                let (rule, least) = match (one, other) {
                    (Atom::N, Atom::O) | (Atom::O, Atom::N) => {
                        (Rule::NitrogenOxygen, self.nitrogen_oxygen)
                    }
                    _ => (Rule::Backbone, self.backbone),
                };
                test(rule, least, one, &a, other, &b)?;
            }
        }
        Flow::Continue(())
    }

    /// Calls `each` for every violation by a residue and an obstacle.
    pub(super) fn of_obstacle(
        &self,
        placed: &Placed,
        residue: usize,
        (number, obstacle): (usize, &Point),
        each: &mut impl FnMut(Violation) -> Flow,
    ) -> Flow {
        let mut test = |rule, least: f64, atom, a: &Point| {
            let square = square(a, obstacle);
            if least <= 0.0 || square >= least * least {
                return Flow::Continue(());
            }
            let second = (number, Atom::Obstacle);
            each(Violation { rule, first: (residue, atom), second, distance: square.sqrt() })
        };
        for (atom, at) in backbone(placed) {
            let at = at.at(residue);
            if atom != Atom::CB || placed.has_cb[residue] {
                test(Rule::ObstacleBackbone, self.obstacle_backbone, atom, &at)?;
            }
        }
        if placed.has_centroid[residue] {
            let at = placed.centroid.at(residue);
            test(Rule::ObstacleSideChains, self.obstacle_side_chains, Atom::SideChain, &at)?;
        }
        Flow::Continue(())
    }

    /// Calls `each` for every violation, pair by pair: i, then j, then obstacles; of a pair in the order of [`Rule`].
    fn of_all(
        &self,
        placed: &Placed,
        obstacles: &Obstacles,
        each: &mut impl FnMut(Violation) -> Flow,
    ) -> Flow {
        for i in 0..placed.len() {
            for j in i + 1..placed.len() {
                self.of_pair(placed, (i, j), each)?;
            }
            for obstacle in obstacles.points.iter().enumerate() {
                self.of_obstacle(placed, i, obstacle, each)?;
            }
        }
        Flow::Continue(())
    }

    /// The first violation: that of the first residue along the chain, with the first residue after it, or, if it has none of
    /// these, with the first obstacle.
    pub fn first_violation(&self, placed: &Placed, obstacles: &Obstacles) -> Option<Violation> {
        self.of_all(placed, obstacles, &mut Flow::Break).break_value()
    }

    /// How many pairs violate each rule.
    pub fn count(&self, placed: &Placed, obstacles: &Obstacles) -> Counts {
        let mut counts = Counts::default();
        let _ = self.of_all(placed, obstacles, &mut |violation| {
            counts.add(violation.rule);
            Flow::Continue(())
        });
        counts
    }
}

impl Rules {
    /// The first violation of a conformation without obstacles.
    pub fn first_violation(&self, placed: &Placed) -> Option<Violation> {
        self.at_nodes().first_violation(placed, &Obstacles::default())
    }
}
