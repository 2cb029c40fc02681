use super::bent_trees::BentTrees;
use super::growth::needs_query;
use super::{Generator, Reads};
use crate::context::{Context, Ends};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Trees from both ends of the query as [`RetractionTrees`](super::RetractionTrees) grows them, whose blocked extensions slide along what blocks
/// them and around its corners: a problem with a query that names no strategies has this one beside uniform sampling.
///
/// Where [`RetractionTrees`](super::RetractionTrees) looks for one straight motion to a configuration nearer to where the extension was to lead, a
/// slide goes on from what it has found, and leaves a milestone wherever the straight motion from the last one is blocked. It is tried longer the
/// better it goes, begins with steps of very different lengths, since a passage may be of any width, and likes to go on in the direction in which it got on last. The
/// configurations come ever nearer to where the extension was to lead, as in L. Zhang, D. Manocha, *An efficient retraction-based RRT planner*, ICRA
/// 2008; sliding through narrow passages in many small steps is what S. Rodriguez, X. Tang, J.-M. Lien and N. M. Amato (*An
/// obstacle-based rapidly-exploring random tree*, ICRA 2006) do along obstacles. Nothing but motions is asked for, so that the method is defined for every model.
///
/// A slide may try `trials` motions before it has got on; each valid one allows two more, up to 100 in all.
///
/// In half of the sets (two in turn for each goal, then not in two) the trees are made of the ends and of nodes that grew, so that sampled nodes which are connected with
/// them are no part of them: in a trap these would be the nearest to most of what is drawn, and the few nodes from which a tree gets on would hardly have a turn. In the
/// other half, and always with `nearby` 0, all that is connected with an end is its tree, for where sampled nodes are near the way out, trees need not grow there first.
///
/// The first set extends straight only, and draws from the whole space: it costs least where a query is solved in the open, and others follow.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(transparent)]
pub struct SlidingTrees(pub BentTrees);

impl Generator for SlidingTrees {
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
        // Sets begin with the tree of the start and with that of the goal by turns, and take the goals in turn: what changes here changes more slowly.
        let goals = cx.query.as_ref().map_or(1, Ends::goal_count);
        let grown_only = self.0.nearby > 0.0 && seed.ordinal().0 / (2 * goals) % 2 == 1;
        self.0.generate((cx, seed, count), frozen, scratch, |set| {
            let set = set.with_sliding();
            if grown_only { set.of_grown_only() } else { set }
        })
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        self.0.calibrate(cx);
    }

    fn complaint(&self) -> Option<Complaint> {
        self.0.complaint()
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_query(cx)
    }
}
