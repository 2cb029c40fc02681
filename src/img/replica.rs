use super::{Job, Setup, Task};
use crate::connect::{Built, JoinInput};
use crate::numbers::SetNumber;
use crate::roadmap::{Edge, Increment, Roadmap, SetToFold};
use crate::seed::Seed;
use crate::shelf::Shelf;
use std::sync::Arc;

/// Where a build stands: which jobs have what they read.
#[derive(Clone, Copy, Debug, Default)]
pub struct Front {
    /// The first set of the round that comes next.
    first: SetNumber,
    /// Sets of it that are published.
    published: u64,
}

impl Front {
    /// The set that is published next.
    pub fn next(&self) -> SetNumber {
        self.first + self.published
    }

    /// Whether a job makes a set that is still to be published.
    pub fn is_ahead(&self, job: Job) -> bool {
        matches!(job, Job::Generate { number, .. } if number >= self.next())
    }

    /// Takes note of the increment of the next set.
    pub fn publish(&mut self) {
        self.published += 1;
    }

    /// Takes note of the end of the round.
    pub fn fold(&mut self) {
        *self = Front { first: self.next(), published: 0 };
    }

    /// Whether a job has its inputs. Where they are gone, it was handed out again after a loss, but done
    /// by the worker believed dead, and the build has moved on.
    pub fn has(&self, setup: &Setup, job: Job) -> bool {
        match job {
            Job::Generate { number, strategy, .. } => {
                !setup.grows(strategy) || setup.plan.round_start(number) == self.first
            }
            Job::Join { number, .. } => (self.first..self.next()).contains(&number),
            Job::Evaluate { round, .. } => setup.plan.sets_of(round).end == self.first,
        }
    }
}

/// The state that jobs read: the roadmap folded so far and the increments of the round that comes
/// next. Every process keeps one, fed with the same increments and folds in the same order.
#[derive(Clone, Debug)]
pub struct Replica {
    roadmap: Arc<Roadmap>,
    increments: Vec<Arc<Built>>,
    front: Front,
}

impl Replica {
    /// The state before the first round.
    pub fn new(setup: &Setup) -> Replica {
        let roadmap = Arc::new(Roadmap::new(&setup.cx.space));
        Replica { roadmap, increments: Vec::new(), front: Front::default() }
    }

    /// The same for one of several workers, that has no more than its jobs read (edges only where something reads
    /// the whole roadmap, an evaluator or a strategy that grows it),
    /// and on a shelf what all of them have.
    pub fn of_worker(setup: &Setup, shelf: Arc<dyn Shelf>) -> Replica {
        setup.cx.model.keep_on(&shelf);
        let grows = setup.problem.strategies.iter().any(|strategy| strategy.generator.grows());
        let keeps_edges = grows || !setup.problem.evaluators.is_empty();
        let roadmap = Roadmap::of_worker(&setup.cx.space, shelf, keeps_edges);
        Replica { roadmap: Arc::new(roadmap), ..Replica::new(setup) }
    }

    /// Takes in the increment of the next set.
    pub fn publish(&mut self, setup: &Setup, increment: Arc<Increment>) {
        self.front.publish();
        self.increments.push(Arc::new(Built::new(&setup.cx, increment)));
    }

    /// Folds the published increments with the edges that join each.
    pub fn fold<'a>(&mut self, setup: &Setup, joins: impl Iterator<Item = &'a [Edge]>) {
        let increments = std::mem::take(&mut self.increments);
        self.front.fold();
        let kept: Vec<_> = increments.iter().map(|built| built.increment.clone()).collect();
        // Copies are made only where a job that no longer matters still reads what was.
        let components = increments.into_iter().map(|built| match Arc::try_unwrap(built) {
            Ok(built) => built.components,
            Err(shared) => shared.components.clone(),
        });
        let sets = kept.iter().zip(components).zip(joins);
        let sets =
            sets.map(|((increment, components), joins)| SetToFold { increment, components, joins });
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

    /// The job with its inputs as they are now. `None` where they are gone, see [`Front::has`].
    pub fn task(&self, setup: &Setup, job: Job) -> Option<Task> {
        self.front.has(setup, job).then(|| match job {
            Job::Generate { strategy, ordinal, .. } => {
                let frozen = setup.grows(strategy).then(|| self.roadmap.clone());
                Task::Generate { strategy, ordinal, frozen }
            }
            Job::Join { number, strategy, ordinal } => {
                let offset = number.since(self.front.first) as usize;
                let increments = self.increments[..=offset].to_vec();
                let label = setup.problem.strategies[strategy.index()].label();
                let seed = Seed::of_set(setup.cx.base_seed, label, ordinal);
                let input = JoinInput { roadmap: self.roadmap.clone(), increments, seed };
                Task::Join { strategy, input }
            }
            Job::Evaluate { evaluator, .. } => {
                Task::Evaluate { evaluator, roadmap: self.roadmap.clone() }
            }
        })
    }
}
