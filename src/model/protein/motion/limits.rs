use crate::structure::Point;

/// The least distance of two Cα atoms along a motion whatever the chain's bonds, Å.
const ALPHA_LEAST: f64 = 2.7;

/// The least distances that a motion has to keep, in Å. A limit of 0 switches its rule off.
///
/// Residues are i and j, counted along the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of two Cα atoms with |i − j| > 2.
    pub alpha: f64,
    /// Of the centroids of two side chains, whatever their residues (K. Nath's thesis, ch. 3: 1.0 Å while connecting).
    pub side_chain: f64,
    /// Of a Cα atom and an obstacle.
    pub alpha_obstacle: f64,
    /// Of a side chain's centroid and an obstacle.
    pub side_chain_obstacle: f64,
}

impl Limits {
    /// The limits for a chain with these Cα atoms, in Å: 1.0 Å for side chains, 2.6 Å and 1.0 Å to obstacles, and for
    /// Cα atoms the larger of 2.7 Å and L/√2, where L is the longest virtual bond, from one Cα to the next.
    ///
    /// Two virtual bonds that meet have ends that are at most L/√2 apart, so that a chain that keeps more never passes
    /// through itself. Proof: let the bonds be PQ and RS, and let them meet in O, which divides PQ into a and q, RS into
    /// r and s. By Stewart's theorem s·PR² + r·PS² = (r + s)(PO² + r·s), and likewise for Q. So the squares PR², PS², QR²
    /// and QS², weighted by q·s, q·r, a·s and a·r, have the mean a·q + r·s. A product of two parts is at most a quarter of
    /// the square of the whole, so that the mean is at most L²/2, and the least of the four distances at most L/√2.
    pub fn of(alphas: &[Point]) -> Limits {
        let bonds = alphas.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        let longest = bonds.fold(0.0, f64::max);
        Limits {
            alpha: ALPHA_LEAST.max(longest * std::f64::consts::FRAC_1_SQRT_2),
            side_chain: 1.0,
            alpha_obstacle: 2.6,
            side_chain_obstacle: 1.0,
        }
    }
}
