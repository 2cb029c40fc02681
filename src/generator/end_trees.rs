use super::growth::{Complaints, GrowingSet, needs_query};
use super::rrt_connect::grow_from_ends;
use super::{ATTEMPTS_MAX, Generator, Reads};
use crate::context::{Context, Ends};
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::{Increment, Roadmap};
use crate::sampler::{GaveUp, Sampler, Uniform};
use crate::seed::Seed;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The step of a problem that names none, of [`RetractionTrees`](super::RetractionTrees) as well, as a share of the largest distance in the space. Of a fifth, a tenth, a twentieth and a
/// fiftieth it was never far from the best in `cargo bench --bench trees` (`docs/growth.md`).
const STEP_SHARE: f64 = 0.05;

/// The part of a set's seed from which milestones are drawn where trees cannot grow.
const REST: u64 = 0;

/// Trees from both ends of the query as [`RrtConnect`](super::RrtConnect) grows them, in shorter steps, for builds that are not to end
/// where trees cannot grow.
///
/// When too many extensions in a row have come to nothing, because both ends lie in places that motions of a step do not leave, the
/// rest of the set is drawn uniformly, as [`Uniform`] does, and left to the connection among sets. So a build with
/// this strategy ends where one with uniform sampling does, and nowhere else.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct EndTrees {
    /// The most by which an extension moves, in the space's metric. If none is given, a twentieth of the largest distance in the
    /// space, found when the problem is read: a greedy extension comes as far in several short steps as in a long one,
    /// and through narrower places.
    #[serde(default)]
    pub step: Option<f64>,
    /// The most extensions tried for one milestone before the rest of the set is drawn.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

fn default_attempts() -> u64 {
    1000
}

impl Default for EndTrees {
    fn default() -> EndTrees {
        EndTrees { step: None, attempts: default_attempts() }
    }
}

/// The step of a method that names one or none.
pub(super) fn step_of(step: Option<f64>, cx: &Context) -> f64 {
    step.unwrap_or_else(|| STEP_SHARE * cx.space.diameter())
}

/// The step as it becomes part of a problem: always a number, unless all configurations of the space are one.
pub(super) fn calibrated(step: Option<f64>, cx: &Context) -> Option<f64> {
    step.or_else(|| Some(step_of(None, cx)).filter(|step| *step > 0.0))
}

/// Fills a set with what grows from both ends of a query, and, where nothing grows, with configurations drawn uniformly.
///
/// # Errors
/// [`GaveUp`] where nothing can be drawn either.
pub(super) fn grow_or_draw<'a>(
    mut set: GrowingSet<'a>,
    seed: &Seed,
    query: &'a Ends,
    count: usize,
) -> Result<Increment, GaveUp> {
    let grown = grow_from_ends(&mut set, seed, query);
    let (cx, mut made) = (set.cx, set.made);
    if grown.is_err() {
        draw_rest(cx, seed, count, set.scratch, &mut made)?;
    }
    Ok(made)
}

/// Draws what a set lacks of its `count` milestones uniformly.
///
/// # Errors
/// [`GaveUp`] where nothing can be drawn.
pub(super) fn draw_rest(
    cx: &Context,
    seed: &Seed,
    count: usize,
    scratch: &mut Scratch,
    made: &mut Increment,
) -> Result<(), GaveUp> {
    let left = count - made.configs.len();
    Uniform::default().sample(cx, &seed.part(REST), left, scratch, &mut made.configs)
}

impl Generator for EndTrees {
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
        let limits = (step_of(self.step, cx), self.attempts);
        let set = GrowingSet::new(cx, seed, scratch, frozen, count, limits);
        grow_or_draw(set, seed, query, count)
    }

    fn reads_query(&self) -> bool {
        true
    }

    fn calibrate(&mut self, cx: &Context, _seed: &Seed) {
        self.step = calibrated(self.step, cx);
    }

    fn complaint(&self) -> Option<Complaint> {
        Complaints::of_step(self.step)
            .or_else(|| Complaint::of_attempts(self.attempts, ATTEMPTS_MAX))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        needs_query(cx)
    }
}
