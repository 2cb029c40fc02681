//! The search of the index for all configurations within a radius, known as fixed-radius near neighbours
//! (J. L. Bentley, *A survey of techniques for fixed radius near neighbor searching*, 1975).

use super::ball::Ball;
use super::best::Neighbor;
use super::embedding::{ErrorBounds, Point, length};
use super::index::Index;
use super::searched::Searched;
use super::seek::{Search, Seeker};
use crate::space::Space;

impl Index {
    /// The eligible configurations within a radius of `q`: all whose [`Space::distance`] to `q` is at most `radius`,
    /// a length in the scene's unit, nearest first, ties by name. With `most`, at most that many, the nearest ones.
    /// There are none if the radius is negative or not a number; an infinite radius has all configurations in it.
    ///
    /// `q` is in stored form. Ids from [`Index::len`] up to, but without, `end` are searched too, one by one.
    pub fn in_radius(
        &self,
        space: &Space,
        searched: &impl Searched,
        end: u32,
        q: &[f64],
        radius: f64,
        most: Option<usize>,
    ) -> Vec<Neighbor> {
        let Some(ball) = Ball::new(radius, most) else { return Vec::new() };
        let mut point = Point::new();
        self.embedding.embed(q, &mut point);
        let longest = self.segments.iter().map(|tree| tree.longest()).fold(0.0, f64::max);
        let error_bounds = self.embedding.error_bounds(length(&point) + longest);
        let pruning_bound = error_bounds.pruning_bound(radius * radius);
        let mut seeker = InRadius { space, searched, q, error_bounds, ball, pruning_bound };
        (self.len()..end).filter(|id| searched.is_eligible(*id)).for_each(|id| seeker.measure(id));
        // If only the nearest are wanted, those in short segments bound the search of the long ones.
        for tree in self.segments.iter().rev() {
            Search::new(tree, &self.embedding, &point, end, &mut seeker).search_from_root();
        }
        seeker.ball.into_neighbors()
    }
}

/// Seeks the eligible configurations within a radius of a query.
struct InRadius<'a, S> {
    space: &'a Space,
    searched: &'a S,
    q: &'a [f64],
    error_bounds: ErrorBounds,
    ball: Ball,
    pruning_bound: f32,
}

impl<S: Searched> InRadius<'_, S> {
    /// Measures an eligible configuration and keeps it if it is near enough.
    fn measure(&mut self, id: u32) {
        let config = self.searched.config(id);
        if let Some(distance) = self.space.distance_unless_above(self.q, config, self.ball.bound())
            && self.ball.offer(Neighbor { distance, id: self.searched.name(id) })
        {
            let bound = self.ball.bound();
            self.pruning_bound = self.error_bounds.pruning_bound(bound * bound);
        }
    }
}

impl<S: Searched> Seeker for InRadius<'_, S> {
    fn pruning_bound(&self) -> f32 {
        self.pruning_bound
    }

    fn offer(&mut self, id: u32, _: f32, eligible: bool) {
        if eligible || self.searched.is_eligible(id) {
            self.measure(id);
        }
    }

    fn label_is_eligible(&self, id: u32) -> Option<bool> {
        self.searched.label_is_eligible(id)
    }
}
