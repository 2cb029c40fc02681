//! What is known of the conformation that was valid last: where one that differs from it in few torsions has to be looked at.
//!
//! If the first torsion that differs is of residue a and the last of residue b, all residues before a stand where they stood,
//! and all residues after b have moved as one. So only pairs of which one side moved against the other are looked at: residues
//! i < j with i ≤ b and j ≥ a.
//!
//! The verdict is the one of a check from the beginning, to the last bit. Before a no coordinate has changed. After b
//! distances have changed by rounding, by less than 2 · 10⁻⁷ Å in the longest chains that a problem may have: 5000 residues,
//! 10⁵ Å from the origin, so some thousand roundings of 10⁻¹¹ Å. Single precision passed over a pair only if it is farther
//! apart than its rule asks, and by more than that: of [`Screen::margin`], 64 ε (M² + M d + 1), rounding in single precision
//! needs less than an eighth, and what is left is 3 · 10⁻⁶ Å² of half the square of a distance at least; the looser tests
//! before it leave more. The few pairs that were not passed over are kept, and double precision looks at them again.
//!
//! Unlike the rest of a [`Screen`]'s memory this is no guess that a check would put right, so it has to be true. It is about
//! one chain, which a [`Placed`] names that this chain's `place` made and nobody changed since.

use super::pairs::Flow;
use super::rules::Limits;
use super::screen::{BLOCK, Screen};
use crate::model::protein::placed::{Placed, SEGMENTS, Turn};
use std::sync::Arc;

/// Blocks between which pairs are looked at: those of i and j with i ≤ `last` and j ≥ `first`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub first: usize,
    pub last: usize,
}

impl Window {
    /// All pairs.
    pub const ALL: Window = Window { first: 0, last: usize::MAX };

    /// Whether pairs of these residues i < j are looked at.
    fn has(&self, i: usize, j: usize) -> bool {
        i / BLOCK <= self.last && j / BLOCK >= self.first
    }
}

/// The valid conformation.
#[derive(Clone, Debug)]
pub(super) struct Known {
    chain: Arc<()>,
    limits: Limits,
    /// As in [`Turn`].
    angles: Vec<[f64; 2 * SEGMENTS]>,
    /// All pairs of residues that single precision did not pass over.
    suspects: Vec<(u32, u32)>,
    /// The picture of so many residues, counted from the first, is this conformation's.
    pictured: usize,
}

impl Known {
    /// Of nothing.
    fn none(chain: &Arc<()>, limits: &Limits) -> Known {
        Known {
            chain: chain.clone(),
            limits: *limits,
            angles: Vec::new(),
            suspects: Vec::new(),
            pictured: 0,
        }
    }

    /// Between which residues the torsions are that differ: first and last; `None` if they are too many, or another chain's.
    fn difference(&self, placed: &Placed, limits: &Limits) -> Option<(usize, usize)> {
        let is_same = placed.chain.as_ref().is_some_and(|chain| Arc::ptr_eq(chain, &self.chain));
        if !is_same || *limits != self.limits || self.angles.len() != placed.turns.len() {
            return None;
        }
        let (count, most) = (placed.turns.len(), placed.len() / 2);
        let (mut first, mut last) = (usize::MAX, 0);
        for (number, (angles, turn)) in self.angles.iter().zip(&placed.turns).enumerate() {
            let differ = |slot: usize| angles[slot].to_bits() != turn.angles[slot].to_bits();
            if !(0..2 * SEGMENTS).fold(false, |any, slot| any | differ(slot)) {
                continue;
            }
            for slot in (0..2 * SEGMENTS).filter(|slot| differ(*slot)) {
                let residue = slot % SEGMENTS * count + number;
                (first, last) = (first.min(residue), last.max(residue));
            }
            if last - first > most {
                return None;
            }
        }
        // The same conformation: nothing but its last residue is looked at.
        Some((first.min(placed.len().saturating_sub(1)), last))
    }
}

/// What a check may leave out.
pub(super) struct Shortcut {
    /// Which pairs are looked at.
    pub window: Window,
    /// From which residue on the picture is taken anew.
    pub from: usize,
}

impl Screen {
    /// What can be left out of the check of a conformation.
    pub(super) fn shortcut(&mut self, placed: &Placed, limits: &Limits) -> Shortcut {
        let known = self.known.as_mut();
        let difference = known.as_ref().and_then(|known| known.difference(placed, limits));
        let Some((known, (first, last))) = known.zip(difference) else {
            return self.everything();
        };
        // Until the conformation has proved valid, the picture is in part of neither.
        let from = known.pictured.min(first);
        known.pictured = from;
        Shortcut { window: Window { first: first / BLOCK, last: last / BLOCK }, from }
    }

    /// Nothing is left out.
    pub(super) fn everything(&mut self) -> Shortcut {
        self.known.iter_mut().for_each(|known| known.pictured = 0);
        Shortcut { window: Window::ALL, from: 0 }
    }

    /// Calls `look` for the pairs outside a window that single precision did not pass over.
    pub(super) fn look_again(
        &self,
        window: Window,
        look: &mut dyn FnMut((usize, usize)) -> Flow,
    ) -> Flow {
        let pairs = self.known.iter().flat_map(|known| &known.suspects);
        let pairs = pairs.map(|(i, j)| (*i as usize, *j as usize));
        pairs.filter(|(i, j)| !window.has(*i, *j)).try_for_each(look)
    }

    /// Remembers a conformation that is valid, those pairs of a window being the suspects that were looked at now.
    pub(super) fn know(&mut self, placed: &Placed, limits: &Limits, window: Window) {
        let (Some(chain), true) = (&placed.chain, self.is_taken) else {
            self.known = None;
            return;
        };
        let known = self.known.get_or_insert_with(|| Known::none(chain, limits));
        if !Arc::ptr_eq(&known.chain, chain) {
            known.chain = chain.clone();
        }
        known.limits = *limits;
        known.angles.resize(placed.turns.len(), [0.0; 2 * SEGMENTS]);
        for (angles, Turn { angles: to, .. }) in known.angles.iter_mut().zip(&placed.turns) {
            *angles = *to;
        }
        known.suspects.retain(|(i, j)| !window.has(*i as usize, *j as usize));
        known.suspects.extend(&self.suspects);
        known.pictured = placed.len();
    }
}
