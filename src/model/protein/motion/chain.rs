//! A chain as motions see it: points that torsions carry, in blocks of residues, and segments of blocks.

use super::limits::Limits;
use crate::model::protein::linkage::{Linkage, TorsionKind};
use crate::structure::{Point, Residue};
use std::ops::Range;

/// Residues of a block. Points of a block are looked at together, and whole blocks that are far apart not at all.
pub(super) const BLOCK: usize = 8;

/// Frames are at residues that are multiples of it.
pub(super) const STRIDE: usize = BLOCK / 2;

/// A torsion.
#[derive(Clone, Debug)]
pub(super) struct Turning {
    /// Which degree of freedom.
    pub number: usize,
    /// The axis in the source, of unit length.
    pub axis: Point,
    /// A point of the axis in the source, Å.
    pub through: Point,
    /// The source's value, in radians.
    pub source: f64,
}

/// A residue: its Cα stands on the axes of both torsions, its side chain is between them.
#[derive(Clone, Debug)]
pub(super) struct Link {
    /// The Cα in the source, Å from the first residue's.
    pub alpha: Point,
    /// The side chain's centroid in the source.
    pub side_chain: Option<Point>,
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
    /// The frame's residue, a multiple of [`STRIDE`]: the frame moves with the bonds before that residue's phi, and its origin is the Cα.
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
    pub links: Vec<Link>,
    /// For each residue, and at the end: how many side chains there are before it.
    pub side_chains_before: Vec<usize>,
    /// The residue of every side chain.
    pub side_chain_residues: Vec<usize>,
    pub segments: Vec<Segment>,
    pub torsions: usize,
    /// Points that stand still with the bonds before the first torsion, Å from the first residue's Cα in the source.
    pub obstacles: Vec<Point>,
    pub limits: Limits,
    /// Allowed for the rounding of distances, Å.
    pub rounding: f64,
}

/// Rounding errors of a position, as a share of the chain's length by torsion: a few units in the last place each.
const ROUNDING: f64 = 1e-15;

impl Chain {
    /// The chain of a linkage and the residues that it was made of. `None` where a residue has no Cα.
    pub fn of(
        linkage: &Linkage,
        residues: &[Residue],
        obstacles: &[Point],
        limits: Limits,
    ) -> Option<Chain> {
        let origin = residues.first()?.position("CA")?;
        let mut links: Vec<Link> = Vec::with_capacity(residues.len());
        let mut turnings = linkage.torsions.iter().enumerate().peekable();
        let mut before = 0;
        for (number, residue) in residues.iter().enumerate() {
            let mut turning = |kind| {
                let (number, torsion) =
                    turnings.next_if(|(_, next)| next.residue == number && next.kind == kind)?;
                let through = torsion.through - origin;
                let axis = torsion.axis.into_inner();
                Some(Turning { number, axis, through, source: torsion.source })
            };
            let phi = turning(TorsionKind::Phi);
            let psi = turning(TorsionKind::Psi);
            let first = before + usize::from(phi.is_some());
            let second = first + usize::from(psi.is_some());
            links.push(Link {
                alpha: residue.position("CA")? - origin,
                side_chain: residue.side_chain_centroid().map(|centroid| centroid - origin),
                phi,
                psi,
                before: [before, first, second],
                folds: false,
            });
            before = second;
        }
        for next in 1..links.len().saturating_sub(1) {
            let nearest = nearest_beyond(&links[next - 1], &links[next], &links[next + 1]);
            links[next - 1].folds = nearest < limits.alpha + 1e-6;
        }
        let mut side_chains_before = vec![0];
        let mut side_chain_residues = Vec::new();
        for (number, link) in links.iter().enumerate() {
            if link.side_chain.is_some() {
                side_chain_residues.push(number);
            }
            side_chains_before.push(side_chain_residues.len());
        }
        let bonds = links.windows(2).map(|pair| (pair[1].alpha - pair[0].alpha).norm());
        let reach = bonds.sum::<f64>()
            + 10.0
            + obstacles.iter().map(|obstacle| (obstacle - origin).norm()).fold(0.0, f64::max);
        let obstacles: Vec<Point> = obstacles.iter().map(|obstacle| obstacle - origin).collect();
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
            obstacles,
            limits,
            rounding: ROUNDING * reach * (before + 10) as f64,
            links,
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

/// The least distance, whatever the torsions, of the Cα atoms on either side of a residue, Å.
///
/// The bond back lies on a cone about the axis of phi, that forth on a cone about the axis of psi.
fn nearest_beyond(before: &Link, link: &Link, after: &Link) -> f64 {
    let (back, forth) = (before.alpha - link.alpha, after.alpha - link.alpha);
    // A bond that nothing turns is a cone about itself.
    let to_n = link.phi.as_ref().map_or(back, |phi| -phi.axis);
    let to_c = link.psi.as_ref().map_or(forth, |psi| psi.axis);
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
