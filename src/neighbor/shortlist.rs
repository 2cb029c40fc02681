//! The candidates of a search for the nearest: what the distances of points have not ruled out yet.

use super::best::Ranked;
use super::embedding::ErrorBounds;

/// With this many candidates, in addition to four times as many as are wanted, those ruled out meanwhile are
/// removed.
const CROWD: usize = 256;

/// A configuration that may be among the nearest to a query.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Squared distance of the points of the configuration and of the query, as computed.
    square: f32,
    /// Number of the query.
    pub query: u32,
    /// Id of the configuration.
    pub id: u32,
}

/// Keeps all candidates that can be among the `most` nearest of those offered, in whatever order they are offered.
///
/// Each squared distance of points gives an upper bound on the distance of the configurations. The least `most`
/// of these upper bounds say how far the wanted configurations can be, so points farther away are pruned.
#[derive(Debug)]
pub(super) struct Shortlist {
    most: usize,
    error_bounds: ErrorBounds,
    candidates: Vec<Candidate>,
    /// The `most` least squared distances offered, ascending; infinite as long as there are fewer.
    least_squares: Vec<f32>,
    pruning_bound: f32,
}

impl Shortlist {
    /// Has no candidates yet; at most `most` configurations, which is not 0, are wanted.
    pub fn new(most: usize, error_bounds: ErrorBounds) -> Shortlist {
        let (candidates, least_squares) = (Vec::new(), vec![f32::INFINITY; most]);
        Shortlist { most, error_bounds, candidates, least_squares, pruning_bound: f32::INFINITY }
    }

    /// Removes all candidates, for another search.
    pub fn clear(&mut self) {
        self.candidates.clear();
        self.least_squares.fill(f32::INFINITY);
        self.pruning_bound = f32::INFINITY;
    }

    /// Points with a larger squared distance belong to configurations that are not among the nearest.
    pub fn pruning_bound(&self) -> f32 {
        self.pruning_bound
    }

    /// Adds a candidate, given the squared distance of the points.
    pub fn offer(&mut self, query: u32, id: u32, square: f32) {
        self.candidates.push(Candidate { square, query, id });
        let Some(last) = self.least_squares.last_mut().filter(|last| square < **last) else {
            return;
        };
        *last = square;
        // Inserts without branches, which the processor could not predict.
        let mut before = f32::NEG_INFINITY;
        for at in &mut self.least_squares {
            let here = *at;
            *at = if here < square {
                here
            } else if before < square {
                square
            } else {
                before
            };
            before = here;
        }
        let farthest = self.error_bounds.largest_square(self.least_squares[self.most - 1]);
        self.pruning_bound = self.error_bounds.pruning_bound(farthest);
    }

    /// Bounds the number of candidates; to be called after offers. Where even those not ruled out are many, as
    /// in a crowd of equal configurations, it measures them by `measure` and keeps the nearest.
    pub fn trim<T: Ranked>(&mut self, measure: impl Fn(&Candidate) -> T) {
        let crowd = 4 * self.most + CROWD;
        if self.candidates.len() > crowd && self.remaining().len() > crowd / 2 {
            let nearest = self.nearest(measure).into_iter();
            self.candidates = nearest.map(|(candidate, _)| candidate).collect();
        }
    }

    /// The candidates that can still be among the nearest.
    pub fn remaining(&mut self) -> &[Candidate] {
        let bound = self.pruning_bound;
        // A squared distance that is not a number, because of overflow, rules nothing out.
        self.candidates.retain(|candidate| candidate.square <= bound || candidate.square.is_nan());
        &self.candidates
    }

    /// The at most `most` nearest by the distances that `measure` gives, nearest first.
    pub fn nearest<T: Ranked>(&mut self, measure: impl Fn(&Candidate) -> T) -> Vec<(Candidate, T)> {
        let remaining = self.remaining().iter();
        let mut items: Vec<_> =
            remaining.map(|candidate| (*candidate, measure(candidate))).collect();
        items.sort_unstable_by(|a, b| a.1.rank(&b.1));
        items.truncate(self.most);
        items
    }
}
