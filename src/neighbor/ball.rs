use super::best::{Neighbor, Ranked};

/// With this many neighbours, in addition to twice as many as are wanted, the farther ones are removed.
const CROWD: usize = 32;

/// Keeps the neighbours in a closed ball around a query: of those offered all that are at most as far away as the
/// ball's radius, or a given number of the nearest, in whatever order they are offered.
///
/// An offer takes constant time on average, so it serves for many neighbours. Nothing is allocated but the list
/// that is returned.
#[derive(Debug)]
pub(super) struct Ball {
    most: usize,
    /// The radius, or less once there are more neighbours than wanted.
    bound: f64,
    found: Vec<Neighbor>,
}

impl Ball {
    /// Has no neighbours yet, and will keep at most `most`, if there is such a number. `None` where no neighbour can
    /// be kept: where the radius is negative or not a number, or `most` is 0.
    pub fn new(radius: f64, most: Option<usize>) -> Option<Ball> {
        let most = most.unwrap_or(usize::MAX);
        (radius >= 0.0 && most > 0).then_some(Ball { most, bound: radius, found: Vec::new() })
    }

    /// The pruning bound: neighbours farther away than this are not kept any more.
    pub fn bound(&self) -> f64 {
        self.bound
    }

    /// Keeps a neighbour unless it is too far away. Says whether the pruning bound has become less.
    pub fn offer(&mut self, neighbor: Neighbor) -> bool {
        let near = neighbor.distance <= self.bound;
        if !near {
            return false;
        }
        self.found.push(neighbor);
        let crowded = self.found.len() >= self.most.saturating_mul(2).saturating_add(CROWD);
        if crowded {
            let (_, farthest, _) = self.found.select_nth_unstable_by(self.most - 1, Ranked::rank);
            self.bound = farthest.distance;
            self.found.truncate(self.most);
        }
        crowded
    }

    /// The neighbours kept, nearest first, ties by id.
    pub fn into_neighbors(mut self) -> Vec<Neighbor> {
        self.found.sort_unstable_by(Ranked::rank);
        self.found.truncate(self.most);
        self.found
    }
}
