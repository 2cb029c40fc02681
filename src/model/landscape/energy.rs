use crate::math;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// An energy over the plane.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub enum Energy {
    /// The potential of K. Müller and L. D. Brown, *Location of saddle points and minimum energy paths by a
    /// constrained simplex optimization procedure*, 1979. Minima: −146.700 at (−0.558, 1.442), −108.167 at
    /// (0.623, 0.028), −80.768 at (−0.050, 0.467); saddles: −40.665 at (−0.822, 0.624), −72.249 at
    /// (0.212, 0.293).
    MullerBrown,
    /// The sum of some terms.
    Terms(Vec<Term>),
}

/// One term of an energy: `height · exp(xx·u² + xy·u·v + yy·v²)`, u and v being x and y from the centre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// Its value at the centre.
    pub height: f64,
    /// The centre.
    pub centre: [f64; 2],
    /// Coefficient of u².
    pub xx: f64,
    /// Coefficient of u·v.
    #[serde(default)]
    pub xy: f64,
    /// Coefficient of v².
    pub yy: f64,
}

impl Energy {
    /// The terms of which the energy is the sum.
    pub fn terms(&self) -> Vec<Term> {
        match self {
            Energy::MullerBrown => MULLER_BROWN.to_vec(),
            Energy::Terms(terms) => terms.clone(),
        }
    }
}

const MULLER_BROWN: [Term; 4] = [
    Term { height: -200.0, centre: [1.0, 0.0], xx: -1.0, xy: 0.0, yy: -10.0 },
    Term { height: -100.0, centre: [0.0, 0.5], xx: -1.0, xy: 0.0, yy: -10.0 },
    Term { height: -170.0, centre: [-0.5, 1.5], xx: -6.5, xy: 11.0, yy: -6.5 },
    Term { height: 15.0, centre: [-1.0, 1.0], xx: 0.7, xy: 0.6, yy: 0.7 },
];

impl Term {
    /// The exponent at a point.
    pub fn exponent(&self, [x, y]: [f64; 2]) -> f64 {
        let (u, v) = (x - self.centre[0], y - self.centre[1]);
        self.xx * u * u + self.xy * u * v + self.yy * v * v
    }
}

/// The energy at a point.
pub(super) fn energy(terms: &[Term], point: [f64; 2]) -> f64 {
    terms.iter().map(|term| term.height * math::exp(term.exponent(point))).sum()
}

/// The energy's derivatives by x and y at a point.
pub(super) fn gradient(terms: &[Term], point: [f64; 2]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for term in terms {
        let value = term.height * math::exp(term.exponent(point));
        let (u, v) = (point[0] - term.centre[0], point[1] - term.centre[1]);
        sum[0] += value * (2.0 * term.xx * u + term.xy * v);
        sum[1] += value * (term.xy * u + 2.0 * term.yy * v);
    }
    sum
}
