//! Nearest neighbours among configurations that only become more.

use super::best::{NearPair, Neighbor, Ranked};
use super::build::Source;
use super::embedding::{Embedding, length};
use super::places;
use super::seek::{Leaves, Search, Seeker};
use super::shortlist::{Met, Shortlist};
use super::tree::Tree;
use crate::shelf::{self, Shelf};
use crate::space::{Configs, Space};
use std::sync::Arc;

/// Finds the configurations near a place among those numbered from 0 to [`Index::len`]: what brute
/// force finds, bit for bit, whatever the segments.
///
/// The configurations lie in segments with a tree each that never change, so a copy shares them. Each
/// segment is at least twice as long as the next: when configurations are added, shorter segments are
/// built anew together with them, which costs each configuration O(log n) buildings (J. L. Bentley,
/// J. B. Saxe, *Decomposable searching problems*, 1980).
///
/// Of an index with a shelf the first segments lie at fixed places, so that they are the same for all who
/// share it; only the last few configurations lie in segments of its own.
#[derive(Clone, Debug)]
pub struct Index {
    embedding: Arc<Embedding>,
    segments: Vec<Arc<Tree>>,
    /// So many of them lie at fixed places.
    settled: usize,
    shelf: Option<Arc<dyn Shelf>>,
}

/// What an index is searched for.
pub trait Candidates {
    /// The configuration of an id that counts.
    fn config(&self, id: u32) -> &[f64];

    /// Whether an id counts.
    fn counts(&self, _id: u32) -> bool {
        true
    }

    /// What the id is called in what is found, where ties are broken by that name.
    fn name(&self, id: u32) -> u32 {
        id
    }

    /// Whether all ids count that have the label of `id`, or none. `None` where labels do not decide.
    fn label_counts(&self, _id: u32) -> Option<bool> {
        None
    }
}

impl Index {
    /// The index of nothing.
    pub fn new(space: &Space) -> Index {
        Index::with_shelf(space, None)
    }

    /// The index of nothing, with a place for what it will have in common with others.
    pub fn with_shelf(space: &Space, shelf: Option<Arc<dyn Shelf>>) -> Index {
        let embedding = Arc::new(Embedding::new(space));
        Index { embedding, segments: Vec::new(), settled: 0, shelf }
    }

    /// Number of configurations.
    pub fn len(&self) -> u32 {
        self.segments.last().map_or(0, |last| last.end())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Forgets all configurations.
    pub fn clear(&mut self) {
        self.segments.clear();
        self.settled = 0;
    }

    #[cfg(test)]
    pub(super) fn segment_lengths(&self) -> Vec<u32> {
        self.segments.iter().map(|segment| segment.len()).collect()
    }

    /// Adds the configurations from [`Index::len`] up to `end`. Configurations with one label keep one
    /// label for ever; among those who share a shelf, who has as many configurations has the same labels.
    pub fn extend<'a>(
        &mut self,
        end: u32,
        config_of: impl Fn(u32) -> &'a [f64],
        label_of: impl Fn(u32) -> u32,
    ) {
        if end <= self.len() {
            return;
        }
        let embedding = self.embedding.clone();
        let source =
            Source { embedding: &embedding, config_of: &config_of, label_of: &label_of, time: end };
        if let Some(shelf) = &self.shelf {
            let settled = places::settled(&self.segments[..self.settled], &**shelf, &source);
            let loose = self.segments.split_off(self.settled);
            self.settled = settled.len();
            self.segments = settled;
            // Those that do not go on where the others end cover what these do now.
            let next = self.len();
            self.segments.extend(loose.into_iter().skip_while(|tree| tree.first() != next));
        }
        let mut count = end - self.len();
        let loose = &self.segments[self.settled..];
        let kept = loose.iter().rposition(|segment| {
            let keep = segment.len() >= 2 * count;
            count += if keep { 0 } else { segment.len() };
            keep
        });
        self.segments.truncate(self.settled + kept.map_or(0, |last| last + 1));
        if count > 0 {
            let own = Tree::new(&source, (end - count, count), shelf::private);
            self.segments.push(Arc::new(own));
        }
    }

    /// The at most `k` candidates nearest to `q`, nearest first, ties by id. Ids from [`Index::len`] up
    /// to `end` are searched too, one by one.
    pub fn k_nearest(
        &self,
        space: &Space,
        candidates: &impl Candidates,
        end: u32,
        q: &[f64],
        k: usize,
    ) -> Vec<Neighbor> {
        self.search((space, candidates, end), &[q], k, |_, near| near)
    }

    /// The at most `count` closest pairs of a configuration of `first` and a candidate, closest first,
    /// ties by the first id, then by the second. `end` is as in [`Index::k_nearest`].
    pub fn closest_pairs(
        &self,
        space: &Space,
        first: (&Configs, &[u32]),
        candidates: &impl Candidates,
        end: u32,
        count: usize,
    ) -> Vec<NearPair> {
        let queries: Vec<_> = first.1.iter().map(|id| first.0.get(*id as usize)).collect();
        self.search((space, candidates, end), &queries, count, |query, near| NearPair {
            distance: near.distance,
            first: first.1[query as usize],
            second: near.id,
        })
    }

    /// The best of what all queries find. Short segments come first, for all queries: what they give
    /// bounds the search of the long ones.
    fn search<T: Ranked>(
        &self,
        (space, candidates, end): (&Space, &impl Candidates, u32),
        queries: &[&[f64]],
        most: usize,
        item: impl Fn(u32, Neighbor) -> T,
    ) -> Vec<T> {
        let most = most.min(queries.len().saturating_mul(end as usize));
        if most == 0 {
            return Vec::new();
        }
        let axes = self.embedding.axes();
        let mut points = Vec::with_capacity(queries.len() * axes);
        queries.iter().for_each(|q| self.embedding.embed(q, &mut points));
        let rest = (self.len()..end).filter(|id| candidates.counts(*id));
        let rest = Leaves::new(&self.embedding, rest, |id| candidates.config(id));
        let longest = points.chunks_exact(axes.max(1)).map(length).fold(0.0, f64::max);
        let of_segments = self.segments.iter().map(|segment| segment.longest());
        let bounds = self.embedding.bounds(longest + of_segments.fold(rest.longest, f64::max));
        let item = |met: &Met| {
            let distance = space.distance(queries[met.query as usize], candidates.config(met.id));
            item(met.query, Neighbor { distance, id: candidates.name(met.id) })
        };
        let near = Shortlist::new(most, bounds);
        let mut visitor = Visitor { candidates, query: 0, near, item };
        let mut each = |visit: &mut dyn FnMut(&[f32], &mut Visitor<_, _>)| {
            for query in 0..queries.len() {
                visitor.query = query as u32;
                visit(&points[query * axes..(query + 1) * axes], &mut visitor);
            }
        };
        each(&mut |point, visitor| rest.look(&self.embedding, point, visitor));
        for tree in self.segments.iter().rev() {
            each(&mut |point, visitor| {
                Search::new(tree, &self.embedding, point, end, visitor).everywhere();
            });
        }
        let Visitor { mut near, item, .. } = visitor;
        near.nearest(item).into_iter().map(|(_, item)| item).collect()
    }
}

struct Visitor<'a, C, I> {
    candidates: &'a C,
    query: u32,
    near: Shortlist,
    item: I,
}

impl<C: Candidates, T: Ranked, I: Fn(&Met) -> T> Seeker for Visitor<'_, C, I> {
    fn limit(&self) -> f32 {
        self.near.limit()
    }

    fn meet(&mut self, id: u32, square: f32, counts: bool) {
        if counts || self.candidates.counts(id) {
            self.near.offer(self.query, id, square);
            self.near.clear_up(&self.item);
        }
    }

    fn label_counts(&self, id: u32) -> Option<bool> {
        self.candidates.label_counts(id)
    }
}
