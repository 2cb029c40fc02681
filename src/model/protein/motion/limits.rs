use crate::model::protein::validity::Rules;
use crate::structure::{Point, Residue};

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
    /// What rules ask of the motions of a chain, after whose residues `gaps`, counted from 0 and ascending, there is no bond: L, the
    /// longest virtual bond, from one Cα to the next, is not taken across them.
    ///
    /// Two virtual bonds that meet have ends that are at most L/√2 apart, so that a chain that keeps more never passes
    /// through itself. Proof: let the bonds be PQ and RS, and let them meet in O, which divides PQ into a and q, RS into
    /// r and s. By Stewart's theorem s·PR² + r·PS² = (r + s)(PO² + r·s), and likewise for Q. So the squares PR², PS², QR²
    /// and QS², weighted by q·s, q·r, a·s and a·r, have the mean a·q + r·s. A product of two parts is at most a quarter of
    /// the square of the whole, so that the mean is at most L²/2, and the least of the four distances at most L/√2.
    pub fn of(rules: &Rules, residues: &[Residue], gaps: &[usize]) -> Limits {
        let alphas: Vec<Point> =
            residues.iter().filter_map(|residue| residue.position("CA")).collect();
        let bonds = alphas.windows(2).enumerate().filter(|(at, _)| !gaps.contains(at));
        let lengths = bonds.map(|(_, pair)| (pair[1] - pair[0]).norm());
        let limits = rules.along_motions(lengths.fold(0.0, f64::max));
        Limits {
            alpha: limits.alpha_carbons,
            side_chain: limits.side_chains,
            alpha_obstacle: limits.obstacle_backbone,
            side_chain_obstacle: limits.obstacle_side_chains,
        }
    }
}
