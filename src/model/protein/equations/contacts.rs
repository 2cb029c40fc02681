//! Pairs of sites that are nearer than the rules allow.

use super::sites::{Kind, Sites};
use crate::model::protein::validity::Limits;
use crate::structure::Point;
use std::collections::BTreeMap;

/// Two sites that are too near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The number of the site of the earlier residue.
    pub first: usize,
    /// The number of the site of the later residue.
    pub second: usize,
    /// How far apart they are, Å.
    pub distance: f64,
    /// How far they ought to be, Å.
    pub required: f64,
}

/// Distances in Å that pairs of sites, by their numbers, need at most, whatever the rules say.
pub type Exceptions = BTreeMap<(usize, usize), f64>;

/// Finds the contacts of a chain.
#[derive(Clone, Debug)]
pub struct Contacts<'a> {
    limits: Limits,
    sites: &'a Sites,
    /// The farthest that a site of a residue is from the residue's CA, Å. No torsion changes it, since CA is on the axes of
    /// both of the residue's torsions.
    reach: Vec<f64>,
}

/// The kinds that rules are about.
const RULED: [Kind; 6] = [
    Kind::Nitrogen,
    Kind::AlphaCarbon,
    Kind::Carbon,
    Kind::Oxygen,
    Kind::BetaCarbon,
    Kind::SideChain,
];

/// The least distance in Å of two kinds in residues so far apart along the chain; 0 where there is none.
fn least(limits: &Limits, a: Kind, b: Kind, apart: usize) -> f64 {
    let (has_rule, least) = match (a, b) {
        (Kind::SideChain, Kind::SideChain) => (apart >= 1, limits.side_chains),
        (Kind::SideChain | Kind::Hydrogen, _) | (_, Kind::SideChain | Kind::Hydrogen) => {
            (false, 0.0)
        }
        (Kind::AlphaCarbon, Kind::AlphaCarbon) => {
            // These are also two atoms of the backbone.
            (apart >= 3, limits.alpha_carbons.max(limits.backbone))
        }
        (Kind::Nitrogen, Kind::Oxygen) | (Kind::Oxygen, Kind::Nitrogen) => {
            (apart >= 3, limits.nitrogen_oxygen)
        }
        _ => (apart >= 3, limits.backbone),
    };
    if has_rule { least } else { 0.0 }
}

impl<'a> Contacts<'a> {
    /// Ready to look for what violates these limits among sites.
    pub fn of(limits: Limits, sites: &'a Sites) -> Contacts<'a> {
        let positions = sites.source();
        let reach = |residue| {
            // Every residue has a CA.
            let center = positions[sites.number(residue, Kind::AlphaCarbon)?];
            let numbers = RULED.iter().filter_map(|kind| sites.number(residue, *kind));
            Some(numbers.map(|number| (positions[number] - center).norm()).fold(0.0, f64::max))
        };
        let reach = (0..sites.residues()).map(|residue| reach(residue).unwrap_or(0.0)).collect();
        Contacts { limits, sites, reach }
    }

    /// The pairs nearer than their limit and `margin` (Å), in the order of their residues. Pairs that `exceptions` names
    /// need at most the distance that it gives.
    pub fn find(&self, positions: &[Point], margin: f64, exceptions: &Exceptions) -> Vec<Contact> {
        let Limits { alpha_carbons, side_chains, nitrogen_oxygen, backbone, .. } = self.limits;
        let farthest = alpha_carbons.max(side_chains).max(nitrogen_oxygen).max(backbone) + margin;
        let centers = self.sites.of_kind(Kind::AlphaCarbon, positions);
        let mut found = Vec::new();
        for j in 0..centers.len() {
            for i in 0..j {
                // A thousandth of an ångström is more than what rounding can do.
                let near = self.reach[i] + self.reach[j] + farthest + 1e-3;
                if (centers[j] - centers[i]).norm_squared() <= near * near {
                    self.find_in(i, j, positions, margin, exceptions, &mut found);
                }
            }
        }
        found
    }

    /// The contacts of two residues.
    fn find_in(
        &self,
        i: usize,
        j: usize,
        positions: &[Point],
        margin: f64,
        exceptions: &Exceptions,
        found: &mut Vec<Contact>,
    ) {
        for a in RULED {
            for b in RULED {
                let least = least(&self.limits, a, b, j - i);
                let (true, Some(first), Some(second)) =
                    (least > 0.0, self.sites.number(i, a), self.sites.number(j, b))
                else {
                    continue;
                };
                let wanted = least + margin;
                let exception = exceptions.get(&(first, second));
                let required = exception.map_or(wanted, |distance| distance.min(wanted));
                let distance = (positions[second] - positions[first]).norm();
                if distance < required {
                    found.push(Contact { first, second, distance, required });
                }
            }
        }
    }
}
