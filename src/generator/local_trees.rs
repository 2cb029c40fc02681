use super::bent_trees::{self, BentTrees};
use super::end_trees::{calibrated, draw_rest, step_of};
use super::growth::{Exploration, GrowingSet, GrowingTree, explore, needs_query};
use super::rrt_connect::reach_for;
use super::{Generator, Reads, SlidingTrees};
use crate::context::{Context, Ends};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::numbers::NodeId;
use crate::roadmap::{Configs, Increment, Roadmap};
use crate::sampler::{Gaps, GaveUp, SamplerKind};
use crate::seed::{Purpose, Seed, Stream};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// How often a tree other than those of the query's ends is extended, and how often any tree, in the place of one of the ends' two, is
/// then extended toward what has grown.
const LOCAL: f64 = 0.7;
const ANY: f64 = 0.5;
/// The parts of a set's seed by which roots are drawn, and trees are chosen.
const ROOTS: u64 = 1;
const CHOICES: u64 = 2;

/// Trees from both ends of the query and from many places between them, which grow toward one another (M. Strandberg, *Augmenting RRT-planners with local
/// trees*, ICRA 2004).
///
/// A passage that is narrow is found sooner from within than from without: a tree that grows in it comes out at both sides, where a tree outside has
/// to find the way in. So some milestones of every set are roots, drawn by `sampler`, and every connected component of the roadmap is a tree. One is chosen by
/// chance, mostly one that contains no end of the query, and extended toward a random configuration as [`SlidingTrees`](super::SlidingTrees) extends its trees; then
/// another one is extended toward what has grown, step by step, for as long as it comes nearer. Trees that meet are one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct LocalTrees {
    /// What draws the roots. If it finds none the set goes on without.
    #[serde(default = "default_sampler")]
    pub sampler: SamplerKind,
    /// How many of a set's milestones are roots.
    #[serde(default = "default_roots")]
    pub roots: u32,
    /// From how many nodes of the roadmap on there are local trees. Until then sets are those of [`SlidingTrees`](super::SlidingTrees), so that a query which is
    /// easy is solved before anything is spent on them.
    #[serde(default)]
    pub after: u64,
    /// The most by which a straight extension moves, in the space's metric. If none is given, a twentieth of the largest distance in the
    /// space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// How many motions are tried before a slide has got on; each valid one allows two more.
    #[serde(default = "bent_trees::default_trials")]
    pub trials: u32,
    /// Which share of the configurations that trees are extended toward is drawn from the box around the tree's nodes and a
    /// step more.
    #[serde(default = "bent_trees::default_nearby")]
    pub nearby: f64,
    /// The most extensions tried for one milestone.
    #[serde(default = "bent_trees::default_attempts")]
    pub attempts: u64,
}

fn default_sampler() -> SamplerKind {
    SamplerKind::Gaps(Gaps::default())
}

fn default_roots() -> u32 {
    3
}

impl Default for LocalTrees {
    fn default() -> LocalTrees {
        let BentTrees { step, trials, nearby, attempts } = BentTrees::default();
        let (sampler, roots) = (default_sampler(), default_roots());
        LocalTrees { sampler, roots, after: 0, step, trials, nearby, attempts }
    }
}

impl LocalTrees {
    /// The settings by which trees grow, which are those of [`SlidingTrees`](super::SlidingTrees).
    fn growing(&self) -> BentTrees {
        let LocalTrees { step, trials, nearby, attempts, .. } = *self;
        BentTrees { step, trials, nearby, attempts }
    }
}

impl Generator for LocalTrees {
    fn reads(&self) -> Reads {
        Reads::Roadmap
    }

    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        // What is refused in a problem file can still come in bytes.
        let Some(query) = cx.query.as_ref().filter(|_| self.complaint().is_none()) else {
            return Err(GaveUp { attempts: 0 });
        };
        let nodes = frozen.map_or(0, |frozen| frozen.configs().len() as u64);
        if nodes < self.after {
            return SlidingTrees(self.growing()).generate(cx, seed, count, frozen, scratch);
        }
        let limits = (step_of(self.step, cx), self.attempts);
        let mut set = GrowingSet::new(cx, seed, scratch, frozen, count, limits)
            .with_bending(self.trials, self.nearby)
            .with_sliding();
        let grown = grow(&mut set, seed, query, |scratch| {
            let mut roots = Configs::new(cx.space.len());
            let wanted = (self.roots as usize).min(count / 2);
            // A sampler that gives up has found fewer.
            let _ =
                self.sampler.method().sample(cx, &seed.part(ROOTS), wanted, scratch, &mut roots);
            roots
        });
        let mut made = set.made;
        if grown.is_err() {
            draw_rest(cx, seed, count, scratch, &mut made)?;
        }
        Ok(made)
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, seed: &Seed) {
        self.sampler.method_mut().calibrate(cx, seed);
        self.step = calibrated(self.step, cx);
    }

    fn complaint(&self) -> Option<Complaint> {
        self.sampler.method().complaint().or_else(|| self.growing().complaint())
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_query(cx)?;
        match &self.sampler {
            // A model without gaps has no roots; there are the other trees.
            SamplerKind::Gaps(_) => Ok(()),
            sampler => sampler.method().suits(cx),
        }
    }
}

/// Grows all trees until the set is full; once the query's ends are in one tree, that alone, for which no roots are drawn.
fn grow<'a>(
    set: &mut GrowingSet<'a>,
    seed: &Seed,
    query: &'a Ends,
    draw_roots: impl FnOnce(&mut Scratch) -> Configs,
) -> Result<(), GaveUp> {
    let mut choices = seed.part(CHOICES).stream(Purpose::Accepting);
    let [start, goal] = GrowingTree::of(set, seed, query.of_set(seed.ordinal()));
    let plain = Exploration { neighbors: None, directions: 1, trials: 1 };
    if start.is_same(&goal) {
        let mut tree = start;
        return explore(set, &mut tree, None, &plain);
    }
    let mut trees = vec![start, goal];
    trees.extend(local_trees(set, &trees));
    for root in draw_roots(set.scratch).iter() {
        if !set.is_full() {
            let mut tree = GrowingTree::empty();
            let number = set.add(root);
            tree.add(set, number);
            trees.push(tree);
        }
    }
    while !set.is_full() {
        set.attempt()?;
        let one = chosen(&mut choices, trees.len(), LOCAL);
        let toward = trees[one].draw(set);
        let Some(near) = trees[one].nearest(set, &toward) else { continue };
        let Some(new) = trees[one].extend(set, near, &toward).milestone() else { continue };
        if set.is_full() {
            break;
        }
        let other = match choices.unit() < ANY {
            true => choices.below(trees.len() as u64) as usize,
            false => choices.below(2) as usize,
        };
        let other = if other == one { (one + 1) % trees.len() } else { other };
        if reach_for(set, &mut trees[other], new) {
            let (low, high) = (one.min(other), one.max(other));
            let gone = trees.remove(high);
            trees[low].unite(gone);
            if high == 1 {
                return explore(set, &mut trees[0], None, &plain);
            }
        }
    }
    Ok(())
}

/// A tree's place among all: one of the two of the ends, or with the probability `local` one of the others, if there are any.
fn chosen(choices: &mut Stream, trees: usize, local: f64) -> usize {
    match trees > 2 && choices.unit() < local {
        true => 2 + choices.below(trees as u64 - 2) as usize,
        false => choices.below(2) as usize,
    }
}

/// The trees of all components of the roadmap at the start of the round but for those of these trees, by the names of the components.
fn local_trees<'a>(set: &GrowingSet<'a>, ends: &[GrowingTree<'a>]) -> Vec<GrowingTree<'a>> {
    let Some(frozen) = set.frozen else { return Vec::new() };
    let mut names: Vec<NodeId> =
        frozen.components().iter().map(|component| component.name).collect();
    names.sort();
    let trees = names.into_iter().map(|name| GrowingTree::of_node(set, name));
    trees.filter(|tree| !ends.iter().any(|end| end.is_same(tree))).collect()
}
