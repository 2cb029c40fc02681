use super::growth::{
    Complaints, Exploration, GrowingSet, GrowingTree, calibrated, default_attempts, explore,
    needs_query, step_of,
};
use super::{ATTEMPTS_MAX, Generator, Reads};
use crate::context::{Context, Ends};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// By how much of a step a tree that slides has to come nearer to a milestone of the other to go on toward it.
const LEAST: f64 = 0.02;

/// Two trees, from the query's start and from its goal, that grow toward each other until they meet (J. J. Kuffner,
/// S. M. LaValle, *RRT-Connect: an efficient approach to single-query path planning*, ICRA 2000, Figures 2 and 5).
///
/// One tree is extended by a step toward a configuration drawn uniformly, as [`Rrt`](super::Rrt) is. If it got a node q_new,
/// the other is extended toward q_new, from its node nearest to q_new, step by step for as long as the motions are valid; each
/// step becomes a node. If that leads to q_new, the trees are one. Otherwise they change their parts.
///
/// The trees are the connected components of the roadmap at the start of the round that contain the start and the goal, and what
/// the set has added to them. Once they are one, as from the beginning of later sets, it goes on as an RRT of no goal. Where
/// neither tree can grow the build ends; with [`EndTrees`](super::EndTrees) it goes on.
///
/// The first set makes the ends milestones where no nodes lie there. Other sets of its round grow from the ends as well, but
/// the edges of what they grow first would lead to nodes that they do not know: the connection among sets joins it. Sets with
/// odd numbers begin with the tree of the goal. A set ends when it is full, also in the midst of a greedy
/// extension, which the next set does not take up again; so sets should have more than a few nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct RrtConnect {
    /// The most by which an extension moves, in the space's metric (the paper: ε). If none is given, a fifth of the largest
    /// distance in the space, found when the problem is read.
    #[serde(default)]
    pub step: Option<f64>,
    /// The most extensions tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Default for RrtConnect {
    fn default() -> RrtConnect {
        RrtConnect { step: None, attempts: default_attempts() }
    }
}

impl Generator for RrtConnect {
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
        let limits = (step_of(self.step, &cx.space), self.attempts);
        let mut set = GrowingSet::new(cx, seed, scratch, frozen, count, limits);
        grow_from_ends(&mut set, seed, query)?;
        Ok(set.made)
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        self.step = calibrated(self.step, &cx.space);
    }

    fn complaint(&self) -> Option<Complaint> {
        Complaints::of_step(self.step)
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_query(cx)
    }
}

/// Grows the trees of a query's ends, of several goals one, toward each other until they meet, and then as one, until the set is full.
///
/// # Errors
/// [`GaveUp`] where too many extensions since the last milestone came to nothing; what has grown until then stays in the set.
pub(super) fn grow_from_ends<'a>(
    set: &mut GrowingSet<'a>,
    seed: &Seed,
    query: &'a Ends,
) -> Result<(), GaveUp> {
    let [start, goal] = GrowingTree::of(set, seed, query.of_set(seed.ordinal()));
    let mut tree = if start.is_same(&goal) {
        start
    } else {
        let goal_is_next = seed.ordinal().0 % 2 == 1;
        let trees = if goal_is_next { [goal, start] } else { [start, goal] };
        meet(set, trees)?
    };
    let plain = Exploration { neighbors: None, directions: 1, trials: 1 };
    explore(set, &mut tree, None, &plain)
}

/// Grows two trees, of which the first has its turn, until they meet or the set is full. They are one then, or the set has
/// no room left for what the other is needed for.
fn meet<'a>(
    set: &mut GrowingSet<'a>,
    [mut one, mut other]: [GrowingTree<'a>; 2],
) -> Result<GrowingTree<'a>, GaveUp> {
    while !set.is_full() {
        set.attempt()?;
        let toward = one.draw(set);
        let near = one.nearest(set, &toward);
        let extended = near.and_then(|near| one.extend(set, near, &toward).milestone());
        if extended.is_some_and(|new| reach_for(set, &mut other, new)) {
            one.unite(other);
            break;
        }
        std::mem::swap(&mut one, &mut other);
    }
    Ok(one)
}

/// Extends a tree toward the milestone `target` of the other, step by step; whether it got there.
pub(super) fn reach_for(set: &mut GrowingSet, tree: &mut GrowingTree, target: u32) -> bool {
    let q = set.config(target).to_vec();
    loop {
        let Some(near) = tree.nearest(set, &q) else { return false };
        if set.is_a_step(near) {
            return set.join(near.number, target);
        }
        if set.is_full() {
            return false;
        }
        match tree.extend(set, near, &q).milestone() {
            // A slide may come nearer by ever so little.
            Some(new) if set.slides() => {
                let left = set.cx.space.distance(set.config(new), &q);
                if left > near.distance - LEAST * set.step.min(near.distance) {
                    return false;
                }
            }
            Some(_) => {}
            None => return false,
        }
    }
}
