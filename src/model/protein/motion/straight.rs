//! The straight motion between two configurations: every torsion turns at a constant rate, the short way round.

use crate::math;

/// A motion from its first end, at the time 0, to its other end, at the time 1.
///
/// Of the two ends the first is always the one that is less in lexicographic order, so that a motion and its reverse are
/// the same to the bit.
#[derive(Clone, Debug, Default)]
pub(super) struct Straight {
    /// The torsions at the time 0, in radians.
    pub first: Vec<f64>,
    /// By how much each torsion turns, in radians, in [−π, π).
    pub turns: Vec<f64>,
    /// For every number of torsions, from none to all: the sum of the sizes of that many first turns.
    pub sums: Vec<f64>,
}

/// Whether the motion from `a` to `b` is looked at from `b` to `a`.
pub(super) fn is_backward(a: &[f64], b: &[f64]) -> bool {
    let differing = a.iter().zip(b).find(|(a, b)| a != b);
    differing.is_some_and(|(a, b)| b < a)
}

impl Straight {
    /// Makes it the motion between two configurations of the same number of torsions. Says whether all of it is finite.
    pub fn set(&mut self, a: &[f64], b: &[f64]) -> bool {
        let (from, to) = if is_backward(a, b) { (b, a) } else { (a, b) };
        self.first.clear();
        self.first.extend_from_slice(from);
        self.turns.clear();
        self.turns.extend(from.iter().zip(to).map(|(from, to)| math::wrap_angle(to - from)));
        self.sums.clear();
        self.sums.push(0.0);
        let mut sum = 0.0;
        for turn in &self.turns {
            sum += turn.abs();
            self.sums.push(sum);
        }
        sum.is_finite() && self.first.iter().all(|value| value.is_finite())
    }

    /// The torsions at a time.
    pub fn torsions(&self, time: f64) -> impl Iterator<Item = f64> {
        self.first.iter().zip(&self.turns).map(move |(first, turn)| first + time * turn)
    }
}
