use super::best::{NearPair, Neighbor, Ranked};
use super::brute::Subset;
use super::build::Source;
use super::embedding::{Embedding, length};
use super::searched::Searched;
use super::seek::{Leaves, Search, Seeker};
use super::shared_segments;
use super::shortlist::{Candidate, Shortlist};
use super::tree::Tree;
use crate::shelf::{self, Shelf};
use crate::space::Space;
use std::sync::Arc;

/// An index of configurations, numbered from 0 to [`Index::len`], to which more can be added. Its searches return
/// what brute force returns, bit for bit.
///
/// The configurations lie in segments, in the order of ids: each is a bounding-volume hierarchy over consecutive
/// ids that never changes, so copies of an index share it. Segments follow the logarithmic method (J. L. Bentley,
/// J. B. Saxe, *Decomposable searching problems I: static-to-dynamic transformation*, 1980): each is at least
/// twice as long as the next, and shorter ones are built anew together with configurations that are added. Each
/// configuration is thereby built into O(log n) trees over time.
///
/// An index with a shelf shares its first segments with all indices on the same shelf. Which configurations a
/// shared segment holds is fixed, so only the last few configurations lie in segments of the index's own.
#[derive(Clone, Debug)]
pub struct Index {
    pub(super) embedding: Arc<Embedding>,
    /// The shared segments, then those of the index's own.
    pub(super) segments: Vec<Arc<Tree>>,
    /// Number of shared segments.
    shared: usize,
    shelf: Option<Arc<dyn Shelf>>,
}

impl Index {
    /// An index without configurations.
    pub fn new(space: &Space) -> Index {
        Index::with_shelf(space, None)
    }

    /// An index without configurations that, if it has a shelf, shares segments with others on that shelf.
    pub fn with_shelf(space: &Space, shelf: Option<Arc<dyn Shelf>>) -> Index {
        let embedding = Arc::new(Embedding::new(space));
        Index { embedding, segments: Vec::new(), shared: 0, shelf }
    }

    /// Number of configurations.
    pub fn len(&self) -> u32 {
        self.segments.last().map_or(0, |last| last.end())
    }

    /// Whether there are no configurations.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Removes all configurations.
    pub fn clear(&mut self) {
        self.segments.clear();
        self.shared = 0;
    }

    #[cfg(test)]
    pub(super) fn segment_lengths(&self) -> Vec<u32> {
        self.segments.iter().map(|segment| segment.len()).collect()
    }

    /// Adds the configurations with ids from [`Index::len`] up to, but without, `end`. `config_of` gives the
    /// configuration of any id below `end`, in stored form; it is always the same one.
    ///
    /// `label_of` gives the label of any id below `end`, which [`Searched::label_is_eligible`] is asked about.
    /// Labels may unite but never part: ids with the same label have the same one for ever. Indices on the same
    /// shelf have the same labels when they have the same number of configurations.
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
        let (config_of, label_of) = (&config_of, &label_of);
        let source = Source { embedding: &embedding, config_of, label_of, configs: end };
        if let Some(shelf) = &self.shelf {
            let own = self.segments.split_off(self.shared);
            self.segments = shared_segments::update(&self.segments, &**shelf, &source);
            self.shared = self.segments.len();
            // The shared segments may reach further than before. The own segments that begin where they now end
            // are kept; configurations of the others that are not in shared segments are built in anew below.
            let next = self.len();
            self.segments.extend(own.into_iter().skip_while(|tree| tree.first() != next));
        }
        let mut count = end - self.len();
        let own = &self.segments[self.shared..];
        let kept = own.iter().rposition(|segment| {
            let keep = segment.len() >= 2 * count;
            count += if keep { 0 } else { segment.len() };
            keep
        });
        self.segments.truncate(self.shared + kept.map_or(0, |last| last + 1));
        if count > 0 {
            let tree = Tree::new(&source, end - count..end, shelf::private);
            self.segments.push(Arc::new(tree));
        }
    }

    /// The at most `k` eligible configurations nearest to `q` by [`Space::distance`], nearest first, ties by name.
    /// `q` is in stored form. Ids from [`Index::len`] up to, but without, `end` are searched too, without a tree.
    pub fn k_nearest(
        &self,
        space: &Space,
        searched: &impl Searched,
        end: u32,
        q: &[f64],
        k: usize,
    ) -> Vec<Neighbor> {
        self.nearest(space, searched, end, &[q], k, |_, near| near)
    }

    /// The at most `count` closest pairs of a configuration of `first` and an eligible configuration of the index. Closest first, ties by the id of the first configuration, then by the
    /// name of the second. `end` is as in [`Index::k_nearest`].
    pub fn closest_pairs(
        &self,
        space: &Space,
        first: Subset,
        searched: &impl Searched,
        end: u32,
        count: usize,
    ) -> Vec<NearPair> {
        let queries: Vec<_> = first.configs().collect();
        self.nearest(space, searched, end, &queries, count, |query, near| NearPair {
            distance: near.distance,
            first: first.ids[query as usize],
            second: near.id,
        })
    }

    /// The `most` nearest of what all queries together find, as items made of the query's number and the neighbour.
    /// Short segments are searched first, for all queries: what they give bounds the search of the long ones.
    fn nearest<T: Ranked>(
        &self,
        space: &Space,
        searched: &impl Searched,
        end: u32,
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
        let rest = (self.len()..end).filter(|id| searched.is_eligible(*id));
        let rest = Leaves::new(&self.embedding, rest, |id| searched.config(id));
        let longest = points.chunks_exact(axes.max(1)).map(length).fold(0.0, f64::max);
        let of_segments = self.segments.iter().map(|segment| segment.longest());
        let longest_found = of_segments.fold(rest.longest, f64::max);
        let error_bounds = self.embedding.error_bounds(longest + longest_found);
        let measure = |candidate: &Candidate| {
            let q = queries[candidate.query as usize];
            let distance = space.distance(q, searched.config(candidate.id));
            item(candidate.query, Neighbor { distance, id: searched.name(candidate.id) })
        };
        let shortlist = Shortlist::new(most, error_bounds);
        let mut seeker = Nearest { searched, query: 0, shortlist, measure };
        let mut for_each_query = |search: &mut dyn FnMut(&[f32], &mut Nearest<_, _>)| {
            for query in 0..queries.len() {
                seeker.query = query as u32;
                search(&points[query * axes..(query + 1) * axes], &mut seeker);
            }
        };
        for_each_query(&mut |point, seeker| rest.search(&self.embedding, point, seeker));
        for tree in self.segments.iter().rev() {
            for_each_query(&mut |point, seeker| {
                Search::new(tree, &self.embedding, point, end, seeker).search_from_root();
            });
        }
        let Nearest { mut shortlist, measure, .. } = seeker;
        shortlist.nearest(measure).into_iter().map(|(_, item)| item).collect()
    }
}

/// Seeks the nearest eligible configurations of several queries.
struct Nearest<'a, S, M> {
    searched: &'a S,
    /// Number of the query that is being searched for.
    query: u32,
    shortlist: Shortlist,
    measure: M,
}

impl<S: Searched, T: Ranked, M: Fn(&Candidate) -> T> Seeker for Nearest<'_, S, M> {
    fn pruning_bound(&self) -> f32 {
        self.shortlist.pruning_bound()
    }

    fn offer(&mut self, id: u32, square: f32, eligible: bool) {
        if eligible || self.searched.is_eligible(id) {
            self.shortlist.offer(self.query, id, square);
            self.shortlist.trim(&self.measure);
        }
    }

    fn label_is_eligible(&self, id: u32) -> Option<bool> {
        self.searched.label_is_eligible(id)
    }
}
