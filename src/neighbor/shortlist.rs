//! What can be among the nearest, told from squares of distances between points.

use super::best::Ranked;
use super::embedding::Bounds;

/// About so many may be in question before they are looked through.
const CROWD: usize = 256;

/// Something that was met on a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    /// The square of the distance of the points, as computed.
    square: f32,
    /// Which query met it.
    pub query: u32,
    /// Its id.
    pub id: u32,
}

/// All that can be among the `most` nearest of what was offered, whatever the order of the offers.
#[derive(Debug)]
pub(super) struct Shortlist {
    most: usize,
    bounds: Bounds,
    met: Vec<Met>,
    /// The least of the squares that were offered, in ascending order.
    squares: Vec<f32>,
    limit: f32,
}

impl Shortlist {
    /// Nothing yet, and at most `most`, which is not 0, later.
    pub fn new(most: usize, bounds: Bounds) -> Shortlist {
        let limit = f32::INFINITY;
        Shortlist { most, bounds, met: Vec::new(), squares: vec![limit; most], limit }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.met.clear();
        self.squares.fill(f32::INFINITY);
        self.limit = f32::INFINITY;
    }

    /// Points farther apart, their distance squared, are of no use any more.
    pub fn limit(&self) -> f32 {
        self.limit
    }

    /// Takes in what was met, given the square of the distance of the points.
    pub fn offer(&mut self, query: u32, id: u32, square: f32) {
        self.met.push(Met { square, query, id });
        let Some(last) = self.squares.last_mut().filter(|last| square < **last) else { return };
        *last = square;
        // Without branches that nobody can foresee.
        let mut before = f32::NEG_INFINITY;
        for at in &mut self.squares {
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
        self.limit = self.bounds.limit(self.bounds.most(self.squares[self.most - 1]));
    }

    /// To be called after offers: drops what cannot be among the nearest, where there is much of it.
    pub fn clear_up<T: Ranked>(&mut self, item: impl Fn(&Met) -> T) {
        let crowd = 4 * self.most + CROWD;
        if self.met.len() > crowd && self.left().len() > crowd / 2 {
            self.met = self.nearest(item).into_iter().map(|(met, _)| met).collect();
        }
    }

    /// What can still be among the nearest.
    pub fn left(&mut self) -> &[Met] {
        let limit = self.limit;
        // What is not a number says nothing.
        self.met.retain(|met| met.square <= limit || met.square.is_nan());
        &self.met
    }

    /// The nearest, nearest first.
    pub fn nearest<T: Ranked>(&mut self, item: impl Fn(&Met) -> T) -> Vec<(Met, T)> {
        let mut items: Vec<_> = self.left().iter().map(|met| (*met, item(met))).collect();
        items.sort_unstable_by(|a, b| a.1.rank(&b.1));
        items.truncate(self.most);
        items
    }
}
