//! A chain as motions see it: points that torsions carry, in blocks of residues, and segments of blocks.

use super::limits::Limits;
use crate::model::protein::atoms::ResidueAtoms;
use crate::model::protein::kinematics::Conformer;
use crate::model::protein::linkage::{Linkage, TorsionKind, in_line};
use crate::structure::{Point, Residue};
use std::ops::Range;

/// Residues of a block. Points of a block are looked at together, and whole blocks that are far apart not at all.
pub(super) const BLOCK: usize = 8;

/// Frames are at residues that are multiples of it.
pub(super) const STRIDE: usize = BLOCK / 2;

/// A torsion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turning {
    /// Which degree of freedom.
    pub number: usize,
    /// The inverse of the length of the bond that it turns about, 1/Å.
    pub inverse: f64,
}

/// A residue: its Cα stands on the axes of both torsions, its side chain is between them.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub phi: Option<Turning>,
    pub psi: Option<Turning>,
    /// The numbers of torsions before phi, before psi and after psi.
    pub before: [usize; 3],
    /// Whether the Cα of this residue and that of the next but one could come closer than the limit, whatever the
    /// torsions, so that the pair has to be looked at.
    pub folds: bool,
}

/// A part of the chain with a frame in it, from which the points of the part are seen.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    /// Its residues.
    pub residues: Range<usize>,
    /// The frame's residue, a multiple of [`STRIDE`]: the frame moves with the bonds before that residue's
    /// phi, and its origin is the Cα.
    pub frame: usize,
    pub pairs: Pairs,
}

/// Which pairs of points a segment answers for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pairs {
    /// All pairs within it: it is one block.
    Within,
    /// A point before the frame's residue, and one at it or after.
    Across,
    /// Points with obstacles.
    Obstacles,
}

/// A chain.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub conformer: Conformer,
    /// The first residue's Cα, which stands still: all positions are seen from it, Å.
    pub origin: Point,
    pub links: Vec<Link>,
    /// For each residue, and at the end: how many side chains there are before it.
    pub side_chains_before: Vec<usize>,
    /// The residue of every side chain.
    pub side_chain_residues: Vec<usize>,
    pub segments: Vec<Segment>,
    pub torsions: usize,
    pub limits: Limits,
    /// Allowed for the rounding of distances, Å.
    pub rounding: f64,
}

/// Rounding errors of a position for every torsion, as a share of the largest coordinates: a few units in the last place.
const ROUNDING: f64 = 1e-15;
/// More than the centroid of a natural amino acid's side chain is away from the Cα, Å. Where one is farther, that counts.
const SIDE_CHAIN: f64 = 20.0;
/// Outweighs the rounding of the least distance of Cα atoms that are neighbours but one, Å.
const FOLDS_MARGIN: f64 = 1e-6;

impl Chain {
    /// The chain of a linkage and the residues that it was made of. `None` where a residue lacks N, CA, C or O, and where
    /// N stands in a line with CA and the C before it, so that frames have no axes.
    pub fn of(
        linkage: &Linkage,
        residues: &[Residue],
        obstacles: &[Point],
        limits: Limits,
    ) -> Option<Chain> {
        let conformer = Conformer::of(residues, linkage).filter(|_| in_line(residues).is_none())?;
        let atoms = conformer.atoms();
        let mut links: Vec<Link> = Vec::with_capacity(atoms.len());
        let mut turnings = linkage.torsions.iter().enumerate().peekable();
        let mut before = 0;
        for (number, atoms) in atoms.iter().enumerate() {
            let mut turning = |kind, bond: Point| {
                let (number, _) =
                    turnings.next_if(|(_, next)| next.residue == number && next.kind == kind)?;
                Some(Turning { number, inverse: 1.0 / bond.norm() })
            };
            let phi = turning(TorsionKind::Phi, atoms.ca - atoms.n);
            let psi = turning(TorsionKind::Psi, atoms.c - atoms.ca);
            let first = before + usize::from(phi.is_some());
            let second = first + usize::from(psi.is_some());
            links.push(Link { phi, psi, before: [before, first, second], folds: false });
            before = second;
        }
        for first in 0..links.len().saturating_sub(2) {
            let Link { phi, psi, .. } = links[first + 1];
            let nearest = nearest_beyond(&atoms[first..first + 3], [phi, psi]);
            links[first].folds = nearest < limits.alpha + FOLDS_MARGIN;
        }
        let mut side_chains_before = vec![0];
        let mut side_chain_residues = Vec::new();
        for (number, atoms) in atoms.iter().enumerate() {
            if atoms.centroid.is_some() {
                side_chain_residues.push(number);
            }
            side_chains_before.push(side_chain_residues.len());
        }
        let bonds = atoms.windows(2).map(|pair| (pair[1].ca - pair[0].ca).norm());
        let obstacles_reach = obstacles.iter().map(|obstacle| obstacle.norm()).fold(0.0, f64::max);
        let origin = atoms.first()?.ca;
        let side_chains =
            atoms.iter().filter_map(|atoms| Some((atoms.centroid? - atoms.ca).norm()));
        let side_chain = side_chains.fold(SIDE_CHAIN, f64::max);
        let reach = side_chain + origin.norm() + bonds.sum::<f64>() + obstacles_reach;
        let mut segments = Vec::new();
        split(0..links.len().div_ceil(BLOCK), links.len(), &mut segments);
        if !obstacles.is_empty() {
            segments.push(Segment { residues: 0..links.len(), frame: 0, pairs: Pairs::Obstacles });
        }
        Some(Chain {
            side_chains_before,
            side_chain_residues,
            segments,
            torsions: linkage.torsions.len(),
            limits,
            rounding: ROUNDING * reach * (before + 10) as f64,
            links,
            origin,
            conformer,
        })
    }

    /// How many points there are: first the Cα atoms, then the side chains' centroids.
    pub fn points(&self) -> usize {
        self.links.len() + self.side_chain_residues.len()
    }

    /// The point of a residue's side chain, if it has one.
    pub fn side_chain(&self, residue: usize) -> Option<usize> {
        let before = self.side_chains_before[residue];
        (before < self.side_chains_before[residue + 1]).then(|| self.links.len() + before)
    }

    /// The points of some residues' side chains.
    pub fn side_chains_of(&self, residues: &Range<usize>) -> Range<usize> {
        let point = |residue: usize| self.links.len() + self.side_chains_before[residue];
        point(residues.start)..point(residues.end)
    }

    /// Whether nothing is asked of the distance of two points of a kind, `first` before `second`: Cα atoms that are nearly
    /// neighbours.
    pub fn leaves_alone(&self, first: usize, second: usize) -> bool {
        second < self.links.len()
            && (second < first + 2 || second == first + 2 && !self.links[first].folds)
    }
}

/// The least distance, whatever phi and psi of the middle one of three residues, of the outer ones' Cα atoms, Å.
///
/// The bond back lies on a cone about the axis of phi, that forth on a cone about the axis of psi.
fn nearest_beyond(atoms: &[ResidueAtoms], [phi, psi]: [Option<Turning>; 2]) -> f64 {
    let middle = atoms[1];
    let (back, forth) = (atoms[0].ca - middle.ca, atoms[2].ca - middle.ca);
    // A bond that nothing turns is a cone about itself.
    let to_n = if phi.is_some() { middle.n - middle.ca } else { back };
    let to_c = if psi.is_some() { middle.c - middle.ca } else { forth };
    let (between, one, other) = (angle(&to_n, &to_c), angle(&back, &to_n), angle(&forth, &to_c));
    let least = (between - one - other).max(one - between - other).max(other - between - one);
    let (a, b) = (back.norm(), forth.norm());
    (a * a + b * b - 2.0 * a * b * crate::math::cos(least.max(0.0))).max(0.0).sqrt()
}

/// The angle of two vectors, in radians.
fn angle(a: &Point, b: &Point) -> f64 {
    crate::math::atan2(a.cross(b).norm(), a.dot(b))
}

/// Adds the segments of a range of blocks: the whole, then its halves and all that these are split into.
fn split(blocks: Range<usize>, residues: usize, segments: &mut Vec<Segment>) {
    let of = |blocks: &Range<usize>| blocks.start * BLOCK..(blocks.end * BLOCK).min(residues);
    match blocks.len() {
        0 => {}
        1 => {
            let residues = of(&blocks);
            let frame = residues.start + if residues.len() > STRIDE { STRIDE } else { 0 };
            segments.push(Segment { residues, frame, pairs: Pairs::Within });
        }
        length => {
            let middle = blocks.start + length / 2;
            let frame = middle * BLOCK;
            segments.push(Segment { residues: of(&blocks), frame, pairs: Pairs::Across });
            split(blocks.start..middle, residues, segments);
            split(middle..blocks.end, residues, segments);
        }
    }
}
