//! One energy of a chain that has two native structures.

use super::constraints::{Constraint, Constraints};
use super::hydrophobic::Hydrophobic;
use crate::math;
use crate::model::protein::placed::Placed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// How the constraints of two native structures become one energy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub enum Mixing {
    /// −kT′ ln(e^(−U_A/kT′) + e^(−U_B/kT′)): at either structure its own energy, between them a barrier that is rounded the
    /// more the greater kT′ is, in kJ/mol (R. B. Best, Y.-G. Chen and G. Hummer, Structure 13, 2005).
    SmoothMinimum {
        /// kT′, kJ/mol; greater than 0.
        kt: f64,
    },
    /// All constraints of either at once.
    Union {},
    /// The constraints that both have.
    Intersection {},
}

/// The energy of a conformation.
#[derive(Clone, Debug)]
pub struct Mixture {
    /// One set of constraints, or two whose smooth minimum is taken.
    basins: Vec<Constraints>,
    kt: f64,
    hydrophobic: Option<Hydrophobic>,
}

/// −kT ln(e^(−a/kT) + e^(−b/kT)), from the smaller of the two, so that nothing overflows; symmetric to the bit.
pub fn smooth_minimum(a: f64, b: f64, kt: f64) -> f64 {
    let (low, high) = if b < a { (b, a) } else { (a, b) };
    low - kt * math::ln(1.0 + math::exp((low - high) / kt))
}

impl Mixture {
    /// Of a chain with one native structure.
    pub fn single(constraints: Constraints, hydrophobic: Option<Hydrophobic>) -> Mixture {
        Mixture { basins: vec![constraints], kt: 1.0, hydrophobic }
    }

    /// Of a chain with two. A constraint of both is one whose kind and residues are the same; with `union` it counts once,
    /// at the first structure's distance, and so it does with `intersection`.
    pub fn of_two(
        a: Constraints,
        b: Constraints,
        mixing: Mixing,
        hydrophobic: Option<Hydrophobic>,
    ) -> Mixture {
        let key = |c: &Constraint| (c.kind, c.first, c.second);
        let is_in = |c: &Constraint, of: &Constraints| of.list().iter().any(|o| key(o) == key(c));
        let (basins, kt) = match mixing {
            Mixing::SmoothMinimum { kt } => (vec![a, b], kt),
            Mixing::Union {} => {
                let more = b.list().iter().filter(|c| !is_in(c, &a));
                (vec![Constraints::new(a.list().iter().chain(more).copied().collect())], 1.0)
            }
            Mixing::Intersection {} => {
                let both = a.list().iter().filter(|c| is_in(c, &b));
                (vec![Constraints::new(both.copied().collect())], 1.0)
            }
        };
        Mixture { basins, kt, hydrophobic }
    }

    /// The energy of each set of constraints on its own, model kJ/mol.
    pub fn basins(&self, placed: &Placed) -> Vec<f64> {
        self.basins.iter().map(|constraints| constraints.energy(placed)).collect()
    }

    /// The energy, model kJ/mol: that of the constraints, and then that of hydrophobic pairs.
    pub fn energy(&self, placed: &Placed) -> f64 {
        let constraints = match &self.basins[..] {
            [] => 0.0,
            [one] => one.energy(placed),
            [a, b, ..] => smooth_minimum(a.energy(placed), b.energy(placed), self.kt),
        };
        constraints + self.hydrophobic.as_ref().map_or(0.0, |term| term.energy(placed))
    }
}
