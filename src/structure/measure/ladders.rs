//! Bridges between strands, and the ladders that they make: W. Kabsch & C. Sander, *Dictionary of protein secondary
//! structure*, Biopolymers 22 (1983) 2577, with the bounds on bulges of DSSP 2.2.

use std::collections::VecDeque;

/// Of what a residue is part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rung {
    /// Of no bridge.
    None,
    /// Of a bridge that stands alone.
    Bridge,
    /// Of bridges in a row, or of a bulge between two.
    Ladder,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Direction {
    Parallel,
    Antiparallel,
}

/// Bridges in a row: the residues on the one strand and, ascending like them, those on the other.
struct Ladder {
    direction: Direction,
    one: VecDeque<usize>,
    other: VecDeque<usize>,
}

/// Of what each residue is part, given the residues' unbroken pieces of chain, and all bonds: which residue's N–H is bonded
/// to which one's C=O, ascending.
pub(super) fn rungs(segments: &[usize], bonds: &[(usize, usize)]) -> Vec<Rung> {
    let mut ladders = join_bridges(segments, bonds);
    join_ladders(segments, &mut ladders);
    let mut rungs = vec![Rung::None; segments.len()];
    for ladder in &ladders {
        let rung = if ladder.one.len() > 1 { Rung::Ladder } else { Rung::Bridge };
        for strand in [&ladder.one, &ladder.other] {
            let (Some(first), Some(last)) = (strand.front(), strand.back()) else { continue };
            for of_residue in &mut rungs[*first..=*last] {
                if *of_residue != Rung::Ladder {
                    *of_residue = rung;
                }
            }
        }
    }
    rungs
}

/// Where bridges may be, ascending: each has one of the bonds that [`bridge`] asks for first.
fn candidates(count: usize, bonds: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let of_bond = |&(donor, acceptor): &(usize, usize)| {
        let before = donor.checked_sub(1);
        [
            before.map(|before| (before, acceptor)),
            before.map(|before| (acceptor, before)),
            before.map(|before| (before, acceptor + 1)),
            Some((acceptor, donor)),
        ]
    };
    let is_within = |&(i, j): &(usize, usize)| i >= 1 && j >= i + 3 && j + 1 < count;
    let mut candidates: Vec<(usize, usize)> =
        bonds.iter().flat_map(of_bond).flatten().filter(is_within).collect();
    candidates.sort_unstable();
    candidates.dedup();
    candidates
}

/// All bridges, those that follow on one another without a gap joined.
fn join_bridges(segments: &[usize], bonds: &[(usize, usize)]) -> Vec<Ladder> {
    let is_bonded = |donor, acceptor| bonds.binary_search(&(donor, acceptor)).is_ok();
    let mut ladders: Vec<Ladder> = Vec::new();
    for (i, j) in candidates(segments.len(), bonds) {
        let Some(direction) = bridge(segments, is_bonded, i, j) else { continue };
        let before = ladders.iter_mut().find(|ladder| {
            let next = match direction {
                Direction::Parallel => ladder.other.back().map(|last| last + 1),
                Direction::Antiparallel => ladder.other.front().map(|first| first - 1),
            };
            ladder.direction == direction && ladder.one.back() == Some(&(i - 1)) && next == Some(j)
        });
        match (before, direction) {
            (None, _) => {
                ladders.push(Ladder { direction, one: [i].into(), other: [j].into() });
            }
            (Some(ladder), Direction::Parallel) => {
                ladder.one.push_back(i);
                ladder.other.push_back(j);
            }
            (Some(ladder), Direction::Antiparallel) => {
                ladder.one.push_back(i);
                ladder.other.push_front(j);
            }
        }
    }
    ladders
}

/// The bridge between residues i and j, neither the first nor the last, if there is one.
fn bridge(
    segments: &[usize],
    is_bonded: impl Fn(usize, usize) -> bool,
    i: usize,
    j: usize,
) -> Option<Direction> {
    if segments[i - 1] != segments[i + 1] || segments[j - 1] != segments[j + 1] {
        return None;
    }
    if is_bonded(i + 1, j) && is_bonded(j, i - 1) || is_bonded(j + 1, i) && is_bonded(i, j - 1) {
        Some(Direction::Parallel)
    } else if is_bonded(i + 1, j - 1) && is_bonded(j + 1, i - 1)
        || is_bonded(j, i) && is_bonded(i, j)
    {
        Some(Direction::Antiparallel)
    } else {
        None
    }
}

/// Joins ladders between which there is but a bulge: on one strand at most one residue, on the other at most four.
fn join_ladders(segments: &[usize], ladders: &mut Vec<Ladder>) {
    ladders.sort_by_key(|ladder| ladder.one.front().copied());
    let mut i = 0;
    while i < ladders.len() {
        let mut j = i + 1;
        while j < ladders.len() {
            if is_bulge(segments, &ladders[i], &ladders[j]) {
                let next = ladders.remove(j);
                let ladder = &mut ladders[i];
                ladder.one.extend(next.one);
                match ladder.direction {
                    Direction::Parallel => ladder.other.extend(next.other),
                    Direction::Antiparallel => {
                        next.other.into_iter().rev().for_each(|at| ladder.other.push_front(at));
                    }
                }
            } else {
                j += 1;
            }
        }
        i += 1;
    }
}

/// Whether `b` goes on where `a` ends, but for a bulge.
fn is_bulge(segments: &[usize], a: &Ladder, b: &Ladder) -> bool {
    let ends = |strand: &VecDeque<usize>| Some((*strand.front()?, *strand.back()?));
    let (Some((a_first, a_last)), Some((b_first, b_last))) = (ends(&a.one), ends(&b.one)) else {
        return false;
    };
    let (Some(a_other), Some(b_other)) = (ends(&a.other), ends(&b.other)) else { return false };
    let in_one_segment = |(first, last): (usize, usize), (from, to): (usize, usize)| {
        segments[first.min(from)] == segments[last.max(to)]
    };
    if a.direction != b.direction
        || !in_one_segment((a_first, a_last), (b_first, b_last))
        || !in_one_segment(a_other, b_other)
        || b_first <= a_last
    {
        return false;
    }
    // The steps from the last bridge of `a` to the first of `b`; on the other strand they may overlap.
    let step = b_first - a_last;
    let (runs_on, other_step) = match a.direction {
        Direction::Parallel => (b_other.0 > a_other.0, b_other.0.saturating_sub(a_other.1)),
        Direction::Antiparallel => (b_other.0 < a_other.0, a_other.0.saturating_sub(b_other.1)),
    };
    runs_on && step < 6 && (other_step < 3 || other_step < 6 && step < 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rungs of residues in one piece with these bonds, donors first: `-`, `B` or `E` each.
    fn letters(count: usize, bonds: &[(usize, usize)]) -> String {
        let mut bonds = bonds.to_vec();
        bonds.sort_unstable();
        let rungs = rungs(&vec![0; count], &bonds);
        let letter = |rung| match rung {
            Rung::None => '-',
            Rung::Bridge => 'B',
            Rung::Ladder => 'E',
        };
        rungs.into_iter().map(letter).collect()
    }

    #[test]
    fn two_bonds_make_a_bridge() {
        // Antiparallel: both bonds between 2 and 9 themselves, or between their neighbours.
        assert_eq!(letters(14, &[(2, 9), (9, 2)]), "--B------B----");
        assert_eq!(letters(14, &[(3, 8), (10, 1)]), "--B------B----");
        // Parallel: 2 between the bonds of 9, or 9 between those of 2.
        assert_eq!(letters(14, &[(3, 9), (9, 1)]), "--B------B----");
        assert_eq!(letters(14, &[(10, 2), (2, 8)]), "--B------B----");
        assert_eq!(letters(14, &[(2, 9)]), "-".repeat(14));
        assert_eq!(letters(14, &[]), "-".repeat(14));
        for count in 0..6 {
            assert_eq!(letters(count, &[(0, 4), (4, 0)]), "-".repeat(count));
        }
    }

    /// Whatever the bonds are, no bridge is missed.
    #[test]
    fn all_bridges_have_a_bond_to_be_found_by() {
        let (count, mut state) = (24, 1_u64);
        let mut below = |end: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as usize % end
        };
        let mut found = 0;
        for round in 0..200 {
            let mut bonds: Vec<(usize, usize)> =
                (0..2 * round).map(|_| (below(count), below(count))).collect();
            bonds.sort_unstable();
            let is_bonded = |donor, acceptor| bonds.contains(&(donor, acceptor));
            let candidates = candidates(count, &bonds);
            for i in 1..count - 4 {
                for j in i + 3..count - 1 {
                    if bridge(&vec![0; count], is_bonded, i, j).is_some() {
                        assert!(candidates.contains(&(i, j)), "{i} {j} {bonds:?}");
                        found += 1;
                    }
                }
            }
        }
        assert!(found > 1000, "{found}");
    }

    #[test]
    fn bridges_in_a_row_make_a_ladder() {
        // Bridges 2–11 and 4–9 by their own bonds, and so 3–10 by its neighbours'.
        let antiparallel = [(2, 11), (11, 2), (4, 9), (9, 4)];
        assert_eq!(letters(14, &antiparallel), "--EEE----EEE--");
        // Bridges 2–9 by the bonds of 9, 3–10 by those of 3, 4–11 by those of 11.
        let parallel = [(3, 9), (9, 1), (11, 3), (3, 9), (5, 11)];
        assert_eq!(letters(14, &parallel), "--EEE----EEE--");
    }

    #[test]
    fn bulges_of_one_residue_and_four_are_part_of_a_ladder() {
        // From the bridge 2–18 to one `step` and `other` residues on.
        let bulge = |step: usize, other: usize| {
            let (i, j) = (2 + step, 18 - other);
            let text = letters(22, &[(2, 18), (18, 2), (i, j), (j, i)]);
            let strand =
                |from: usize, to: usize| text[from..=to].chars().all(|letter| letter == 'E');
            strand(2, i) && strand(j, 18)
        };
        for (step, other) in [(1, 2), (2, 2), (2, 5), (5, 2), (5, 1)] {
            assert!(bulge(step, other), "{step} {other}");
        }
        for (step, other) in [(3, 3), (2, 6), (6, 2), (3, 5)] {
            assert!(!bulge(step, other), "{step} {other}");
        }
    }

    #[test]
    fn nothing_reaches_over_a_break() {
        let segments: Vec<usize> = (0..14).map(|i| usize::from(i >= 3)).collect();
        let bonds = [(2, 9), (5, 11), (9, 2), (11, 5)];
        let rungs = rungs(&segments, &bonds);
        let expected = |i| if matches!(i, 5 | 11) { Rung::Bridge } else { Rung::None };
        assert_eq!(rungs, (0..14).map(expected).collect::<Vec<_>>());
    }
}
