//! Secondary structure by patterns of hydrogen bonds: W. Kabsch & C. Sander, *Dictionary of protein secondary structure*,
//! Biopolymers 22 (1983) 2577 (DSSP).
//!
//! - An *n-turn* at residue i is a bond from the N–H of i + n to the C=O of i, with n of 3, 4 or 5.
//! - Two turns in a row, at i − 1 and i, make a *helix* of the residues i to i + n − 1: G, H and I.
//! - A *bridge* joins residues i and j, parallel or antiparallel, by two bonds of theirs or of their neighbours'.
//!   Bridges in a row make a *ladder*, whose residues are E, those of a bridge alone B; a *bulge* is where two ladders go on
//!   in one another with at most one more residue on one strand and four on the other, which are E too.
//! - Inside a turn that is no helix is T, and S where the chain bends by more than 70° over five residues.
//!
//! A residue that could be several things is the first of H, E, B, G, I, T and S, and there is no helix G or I where one of
//! its residues is of an earlier kind. DSSP since 2.1, and mdtraj with it, prefer I to H; the paper does not. As in the
//! paper's program only the two strongest bonds of every N–H count.

use super::hydrogen_bonds::bonds_of_dssp;
use super::ladders::{Rung, rungs};
use super::segments::segments;
use crate::math;
use crate::structure::Residue;
use std::f64::consts::PI;

/// The angle between the directions i − 2 → i and i → i + 2 above which a residue is a bend, in radians.
const BEND: f64 = 70.0 / 180.0 * PI;

/// What a residue is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SecondaryStructure {
    /// `H`: a helix with bonds over four residues.
    AlphaHelix,
    /// `B`: a single bridge between two strands.
    Bridge,
    /// `E`: a strand in a ladder of bridges.
    Strand,
    /// `G`: a helix with bonds over three residues.
    Helix310,
    /// `I`: a helix with bonds over five residues.
    PiHelix,
    /// `T`: a turn, held by a hydrogen bond.
    Turn,
    /// `S`: a bend of the chain.
    Bend,
    /// A blank: nothing of these.
    Loop,
}

use SecondaryStructure::*;

/// Secondary structure of three kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the names say it")]
pub enum ThreeStates {
    Helix,
    Strand,
    Coil,
}

impl SecondaryStructure {
    /// DSSP's letter: one of `HBEGITS`, and a blank.
    pub fn letter(self) -> char {
        match self {
            AlphaHelix => 'H',
            Bridge => 'B',
            Strand => 'E',
            Helix310 => 'G',
            PiHelix => 'I',
            Turn => 'T',
            Bend => 'S',
            Loop => ' ',
        }
    }

    /// Helix for H, G and I, strand for E and B, coil for the rest.
    pub fn three_states(self) -> ThreeStates {
        match self {
            AlphaHelix | Helix310 | PiHelix => ThreeStates::Helix,
            Strand | Bridge => ThreeStates::Strand,
            Turn | Bend | Loop => ThreeStates::Coil,
        }
    }
}

impl ThreeStates {
    /// `H`, `E` or `C`.
    pub fn letter(self) -> char {
        match self {
            ThreeStates::Helix => 'H',
            ThreeStates::Strand => 'E',
            ThreeStates::Coil => 'C',
        }
    }
}

/// The secondary structure of each residue of one chain, or of several one after another.
///
/// A backbone atom that was not seen has no bonds, and the chain is broken there.
pub fn secondary_structure(residues: &[Residue]) -> Vec<SecondaryStructure> {
    let segments = segments(residues);
    let bonds: Vec<(usize, usize)> =
        bonds_of_dssp(residues).iter().map(|bond| (bond.donor, bond.acceptor)).collect();
    let is_bonded = |donor: usize, acceptor: usize| bonds.binary_search(&(donor, acceptor)).is_ok();
    let of_rung = |rung| match rung {
        Rung::None => Loop,
        Rung::Bridge => Bridge,
        Rung::Ladder => Strand,
    };
    let mut assigned: Vec<_> = rungs(&segments, &bonds).into_iter().map(of_rung).collect();

    // At which residues a turn of 3, 4 or 5 starts.
    let turns = [3, 4, 5].map(|length| {
        let starts = |i: usize| {
            let end = segments.get(i + length);
            end == Some(&segments[i]) && is_bonded(i + length, i)
        };
        (0..residues.len()).map(starts).collect::<Vec<bool>>()
    });
    let [turns_3, turns_4, turns_5] = &turns;
    mark_helices(turns_4, 4, AlphaHelix, &[Loop, Bridge, Strand, AlphaHelix], &mut assigned);
    mark_helices(turns_3, 3, Helix310, &[Loop, Helix310], &mut assigned);
    mark_helices(turns_5, 5, PiHelix, &[Loop, PiHelix], &mut assigned);

    for (i, kind) in assigned.iter_mut().enumerate().filter(|(_, kind)| **kind == Loop) {
        let is_in_turn = |(turns, length): (&Vec<bool>, usize)| {
            (1..length).any(|back| i.checked_sub(back).is_some_and(|start| turns[start]))
        };
        if turns.iter().zip(3..).any(is_in_turn) {
            *kind = Turn;
        } else if bends(residues, &segments, i) {
            *kind = Bend;
        }
    }
    assigned
}

/// Marks the helices of this length: where turns start at two residues in a row, and where all residues may become it.
fn mark_helices(
    turns: &[bool],
    length: usize,
    kind: SecondaryStructure,
    may_become: &[SecondaryStructure],
    assigned: &mut [SecondaryStructure],
) {
    for i in 1..turns.len() {
        if turns[i - 1] && turns[i] {
            let helix = &mut assigned[i..i + length];
            if helix.iter().all(|before| may_become.contains(before)) {
                helix.fill(kind);
            }
        }
    }
}

/// Whether the chain bends at residue i.
fn bends(residues: &[Residue], segments: &[usize], i: usize) -> bool {
    let (Some(before), after) = (i.checked_sub(2), i + 2) else { return false };
    if segments.get(after).is_none_or(|segment| *segment != segments[before]) {
        return false;
    }
    let [Some(a), Some(b), Some(c)] = [before, i, after].map(|at| residues[at].position("CA"))
    else {
        return false;
    };
    let (to, from) = (b - a, c - b);
    math::acos(to.dot(&from) / (to.norm() * from.norm())) > BEND
}

#[cfg(test)]
mod tests {
    use super::super::tests::ideal_chain;
    use super::*;

    fn letters(residues: &[Residue]) -> String {
        secondary_structure(residues).into_iter().map(SecondaryStructure::letter).collect()
    }

    #[test]
    fn ideal_helices_are_helices_and_stretched_chains_are_nothing() {
        assert_eq!(letters(&ideal_chain(14, -57.0, -47.0)), " HHHHHHHHHHHH ");
        assert_eq!(letters(&ideal_chain(14, -49.0, -26.0)), " GGGGGGGGGGGG ");
        assert_eq!(letters(&ideal_chain(14, -139.0, 135.0)), " ".repeat(14));
        assert_eq!(letters(&[]), "");
    }

    #[test]
    fn a_break_ends_a_helix() {
        let mut broken = ideal_chain(20, -57.0, -47.0);
        for residue in &mut broken[10..] {
            residue.atoms.iter_mut().for_each(|atom| atom.position.y += 3.0);
        }
        // The hydrogen of the first residue after the break is missing, and with it one bond more.
        assert_eq!(letters(&broken), " HHHHHHHH  HHHHHHHH ");
    }

    #[test]
    fn bad_atoms_are_no_part_of_anything() {
        let mut bad = ideal_chain(14, -57.0, -47.0);
        bad[6].atoms.iter_mut().for_each(|atom| atom.position.x = f64::NAN);
        assert_eq!(letters(&bad), " HHHH   HHHHH ");
        bad.iter_mut()
            .for_each(|residue| residue.atoms.iter_mut().for_each(|atom| atom.position.fill(0.0)));
        letters(&bad);
        bad.iter_mut().for_each(|residue| residue.atoms.clear());
        assert_eq!(letters(&bad), " ".repeat(14));
    }

    #[test]
    fn three_states_have_three_letters() {
        let all = [AlphaHelix, Bridge, Strand, Helix310, PiHelix, Turn, Bend, Loop];
        let letters =
            |letter: fn(SecondaryStructure) -> char| all.map(letter).iter().collect::<String>();
        assert_eq!(letters(SecondaryStructure::letter), "HBEGITS ");
        assert_eq!(letters(|kind| kind.three_states().letter()), "HEEHHCCC");
    }
}
