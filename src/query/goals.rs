//! Queries that any of several goals solves.

use super::{Answer, Attachment, solve};
use crate::context::{Context, Ends};
use crate::model::Scratch;
use crate::roadmap::Roadmap;

/// [`solve`] for every goal of a problem's query: the better of the answers, by [`Answer::or`] in the order of the goals.
pub fn solve_any(
    cx: &Context,
    roadmap: &Roadmap,
    ends: &Ends,
    attachment: &Attachment,
    scratch: &mut Scratch,
) -> Answer {
    let mut to = |goal: &[f64]| solve(cx, roadmap, (&ends.start, goal), attachment, scratch);
    let first = to(&ends.goal);
    ends.other_goals.iter().fold(first, |best, goal| best.or(to(goal)))
}

impl Answer {
    /// The better of the answers for two goals: that with a path, of two paths the one that costs less, of two that cost the
    /// same the first. Where neither has a path, the goal counts as attached to as many nodes as both together, and as
    /// connected where either is. Edges that were left out are counted for both.
    pub fn or(self, other: Answer) -> Answer {
        let dropped_edges = self.dropped_edges + other.dropped_edges;
        let better = match (&self.path, &other.path) {
            (Some(one), Some(path)) if path.length < one.length => other,
            (Some(_), _) => self,
            (None, Some(_)) => other,
            (None, None) => {
                let [start, goal] = self.attached;
                let [other_start, other_goal] = other.attached;
                Answer {
                    attached: [start.max(other_start), goal.saturating_add(other_goal)],
                    connected: self.connected || other.connected,
                    path: None,
                    dropped_edges,
                }
            }
        };
        Answer { dropped_edges, ..better }
    }
}
