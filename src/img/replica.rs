use super::{Job, Setup, Task};
use crate::connect::{Built, JoinInput};
use crate::roadmap::{Edge, Increment, Roadmap};
use std::sync::Arc;

/// The state that jobs read: the roadmap folded so far and the increments of the round that comes
/// next. Every process keeps one, fed with the same increments and folds in the same order.
#[derive(Clone, Debug)]
pub struct Replica {
    roadmap: Arc<Roadmap>,
    increments: Vec<Arc<Built>>,
    /// Place of the first of `increments`.
    first: u64,
}

impl Replica {
    /// The state before the first round.
    pub fn new(setup: &Setup) -> Replica {
        let roadmap = Arc::new(Roadmap::new(&setup.cx.space));
        Replica { roadmap, increments: Vec::new(), first: 0 }
    }

    /// Takes in the increment at the next place.
    pub fn publish(&mut self, setup: &Setup, increment: Arc<Increment>) {
        self.increments.push(Arc::new(Built::new(&setup.cx, increment)));
    }

    /// Folds the published increments with the edges that join each.
    pub fn fold<'a>(&mut self, setup: &Setup, joins: impl Iterator<Item = &'a [Edge]>) {
        let increments = std::mem::take(&mut self.increments);
        self.first += increments.len() as u64;
        let kept: Vec<_> = increments.iter().map(|built| built.increment.clone()).collect();
        // Copies are made only where a job that no longer matters still reads what was.
        let components = increments.into_iter().map(|built| match Arc::try_unwrap(built) {
            Ok(built) => built.components,
            Err(shared) => shared.components.clone(),
        });
        let sets = kept.iter().zip(components).zip(joins);
        let sets = sets.map(|((increment, components), joins)| (&**increment, components, joins));
        Arc::make_mut(&mut self.roadmap).fold_components(&setup.cx.space, sets);
    }

    /// The roadmap at the end.
    pub fn into_roadmap(self) -> Roadmap {
        Arc::unwrap_or_clone(self.roadmap)
    }

    /// The roadmap after the last fold.
    pub fn roadmap(&self) -> &Arc<Roadmap> {
        &self.roadmap
    }

    /// The increments published since the last fold.
    pub fn increments(&self) -> &[Arc<Built>] {
        &self.increments
    }

    /// The job with its inputs as they are now. `None` where they are gone: the job was handed out
    /// again after a loss, but done by the worker believed dead, and the build has moved on.
    pub fn task(&self, setup: &Setup, job: Job) -> Option<Task> {
        match job {
            Job::Generate { strategy, ordinal, .. } => Some(Task::Generate { strategy, ordinal }),
            Job::Join { place, strategy, .. } => {
                let index = usize::try_from(place.checked_sub(self.first)?).ok()?;
                let increments = self.increments.get(..=index)?.to_vec();
                let input = JoinInput { roadmap: self.roadmap.clone(), increments };
                Some(Task::Join { strategy, input })
            }
            Job::Evaluate { round, evaluator } => {
                let current = setup.plan.places_of(round).end == self.first;
                current.then(|| Task::Evaluate { evaluator, roadmap: self.roadmap.clone() })
            }
        }
    }
}
