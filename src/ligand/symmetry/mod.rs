//! RMSD between poses of a ligand over all the ways in which its atoms are alike.
//!
//! # Which atoms are alike
//!
//! A symmetry maps heavy atoms to heavy atoms of the same element, and bonds to bonds. Hydrogens do not count, nor do
//! charges, and the order of a bond counts unless both its atoms can share electrons: atoms that are not carbon, or have a double,
//! triple, aromatic or unknown bond. So the oxygens of carboxylates, the nitrogens of amidines and both Kekulé structures of a ring are
//! alike, and the CH₂ and CH₃ of isobutene are not. Stereochemistry does not count: enantiotopic groups are alike, as in spyrmsd (R. Meli,
//! P. C. Biggin, J. Cheminform. 12 (2020) 49) and RDKit's `CalcRMS`.
//!
//! # How the least RMSD is found
//!
//! Bonds that are part of no ring join ring systems and single atoms, the *blocks*, to a tree, whose middle every symmetry keeps.
//! In place the least sum of squares over all symmetries is found exactly without listing them: from the leaves to the middle, each pair of blocks
//! that are alike has a least sum, which takes the best assignment of what hangs on their atoms. So a ligand with thirty
//! trifluoromethyl groups, 6³⁰ symmetries, takes no longer than another. Only the symmetries of one block are listed.
//!
//! After the best rotation sums no longer separate, and all symmetries are tried, up to [`LISTED_MAX`]. Where there are
//! more, a rotation and a symmetry are improved in turns, which ends at an upper bound: [`Symmetries::is_listed`] tells.

mod assignment;
mod block;
mod least;
mod list;
#[cfg(test)]
mod tests;
mod tree;

use super::Ligand;
use crate::structure::Point;
use crate::structure::measure::superpose;
use std::fmt;
use tree::Tree;

/// At most so many symmetries are listed.
pub const LISTED_MAX: usize = 10_000;

/// Up to so many symmetries are tried one by one in place, too, which is faster for few.
const TRIED_MAX: usize = 24;

/// Rounds of improving rotation and symmetry in turns; few are needed.
const ROUNDS_MAX: usize = 100;

/// The symmetries of a ligand's heavy atoms.
#[derive(Clone, Debug)]
pub struct Symmetries {
    tree: Tree,
    /// To which blocks of the tree each of them can go.
    images: least::Images,
    /// How many atoms the ligand has.
    atoms: usize,
    /// For every symmetry, to which atom each of the tree's goes; `None` where there are too many.
    listed: Option<Vec<Vec<usize>>>,
}

/// A ring system with more symmetries than are listed, or one in which they are not found in bounded time. Molecules have
/// none: the most symmetric of them, fullerenes, have 120.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooSymmetric {
    /// How many atoms the ring system has.
    pub atoms: usize,
}

impl fmt::Display for TooSymmetric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "a ring system of {} atoms with too many symmetries found; at most {} expected",
            self.atoms,
            block::SYMMETRIES_MAX
        )
    }
}

impl std::error::Error for TooSymmetric {}

impl Symmetries {
    /// The symmetries of a ligand.
    ///
    /// # Errors
    /// A ring system with too many.
    pub fn of(ligand: &Ligand) -> Result<Symmetries, TooSymmetric> {
        let tree = Tree::of(ligand)?;
        let (images, listed) = (least::images(&tree), list::all(&tree));
        Ok(Symmetries { tree, images, atoms: ligand.atoms().len(), listed })
    }

    /// How many symmetries there are, the identity among them; infinite beyond the largest `f64`.
    pub fn count(&self) -> f64 {
        self.tree.symmetries()
    }

    /// All symmetries, the identity among them: for every atom of the ligand the one to which it goes; hydrogens stay. None where they are not
    /// [listed](Symmetries::is_listed).
    pub fn listed(&self) -> &[Vec<usize>] {
        self.listed.as_deref().unwrap_or_default()
    }

    /// Whether all symmetries are listed, so that [`Symmetries::rmsd_superposed`] is exact.
    pub fn is_listed(&self) -> bool {
        self.listed.is_some()
    }

    /// The least RMSD of the heavy atoms of `a` from those of `b`, in Å, over all symmetries, both as they stand: what
    /// docking calls the RMSD of a pose.
    ///
    /// Both have the positions of all the ligand's atoms, in Å. NaN if they have not, or if one is not finite; 0 of a ligand
    /// without heavy atoms.
    pub fn rmsd(&self, a: &[Point], b: &[Point]) -> f64 {
        if !self.fits(a, b) {
            return f64::NAN;
        }
        match self.listed.as_ref().filter(|listed| listed.len() <= TRIED_MAX) {
            Some(listed) => {
                let sums = listed.iter().map(|to| self.squares(to, a, b));
                self.root_mean(sums.fold(f64::INFINITY, f64::min))
            }
            None => self.root_mean(least::sum(&self.tree, &self.images, a, b)),
        }
    }

    /// The least RMSD of the heavy atoms of `a` from those of `b`, in Å, over all symmetries and rigid motions: how
    /// different the shapes are, wherever the ligand is.
    ///
    /// Arguments as of [`Symmetries::rmsd`]. Where not all symmetries are [listed](Symmetries::is_listed), this is an upper
    /// bound.
    pub fn rmsd_superposed(&self, a: &[Point], b: &[Point]) -> f64 {
        self.superposed(a, b).map_or(f64::NAN, |(rmsd, _)| rmsd)
    }

    /// The symmetry of [`Symmetries::rmsd_superposed`]: for every atom of `a` the one of `b` with which it is compared. Hydrogens stay.
    /// `None` where the RMSD is NaN.
    pub fn nearest_shape(&self, a: &[Point], b: &[Point]) -> Option<Vec<usize>> {
        self.superposed(a, b).map(|(_, to)| to)
    }

    /// The least RMSD over symmetries and rigid motions, and the symmetry.
    fn superposed(&self, a: &[Point], b: &[Point]) -> Option<(f64, Vec<usize>)> {
        if !self.fits(a, b) {
            return None;
        }
        let heavy = self.tree.heavy();
        let from: Vec<Point> = heavy.iter().map(|atom| a[*atom]).collect();
        let shape = |to: &[usize]| {
            let fixed: Vec<Point> = heavy.iter().map(|atom| b[to[*atom]]).collect();
            superpose(&from, &fixed)
        };
        if let Some(listed) = &self.listed {
            let rmsds = listed.iter().map(|to| (shape(to).rmsd, to));
            let least = rmsds.min_by(|(one, _), (other, _)| one.total_cmp(other));
            return least.map(|(rmsd, to)| (rmsd, to.clone()));
        }
        // From the best symmetry in place, so that the bound is never above `rmsd`, and from the identity.
        let itself: Vec<usize> = (0..self.atoms).collect();
        let starts = [least::symmetry(&self.tree, &self.images, a, b), itself];
        let ends = starts.map(|start| {
            let (mut best, mut to) = (shape(&start), start);
            for _ in 0..ROUNDS_MAX {
                let moved: Vec<Point> = a.iter().map(|point| best.apply(point)).collect();
                let next_to = least::symmetry(&self.tree, &self.images, &moved, b);
                let next = shape(&next_to);
                if next.rmsd < best.rmsd {
                    (best, to) = (next, next_to);
                } else {
                    break;
                }
            }
            (best.rmsd, to)
        });
        ends.into_iter().min_by(|(one, _), (other, _)| one.total_cmp(other))
    }

    fn fits(&self, a: &[Point], b: &[Point]) -> bool {
        let is_finite = |points: &[Point]| points.iter().flatten().all(|x| x.is_finite());
        a.len() == self.atoms && b.len() == self.atoms && is_finite(a) && is_finite(b)
    }

    /// The sum of the squared distances of the heavy atoms from those to which a symmetry takes them.
    fn squares(&self, to: &[usize], a: &[Point], b: &[Point]) -> f64 {
        self.tree.heavy().iter().map(|atom| (a[*atom] - b[to[*atom]]).norm_squared()).sum()
    }

    fn root_mean(&self, sum: f64) -> f64 {
        match self.tree.heavy().len() {
            0 => 0.0,
            count => (sum / count as f64).sqrt(),
        }
    }
}
