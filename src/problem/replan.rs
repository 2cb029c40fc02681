//! Going on from another run's roadmap after the obstacles have changed.

use super::{EarlierSchedule, Problem, ProblemError};
use crate::cancel::Cancel;
use crate::connect::AmongKind;
use crate::digest::{Digest, SourceFile};
use crate::generator::{GeneratorKind, Parent, Start, Survived, Survivors};
use crate::model::{SceneChange, Scratch};
use crate::numbers::StrategyIndex;
use crate::roadmap::Roadmap;
use crate::strategy::Strategy;
use std::sync::Arc;

/// The label of the strategy whose one set is what is left of the old roadmap.
const LABEL: &str = "survivors";

/// The most nodes that can be left: as many as a set may have.
const SURVIVORS_MAX: usize = 1_000_000;

/// The run whose roadmap is made use of.
#[derive(Clone, Copy, Debug)]
pub struct OldRun<'a> {
    /// Its problem.
    pub problem: &'a Problem,
    /// Its roadmap.
    pub roadmap: &'a Roadmap,
    /// The hash of its ledger up to the last complete round.
    pub ledger: Digest,
    /// Where its folder is, as whoever looks for it is to be told: a path from the new run's own folder, say.
    pub place: &'a str,
}

/// Which components of what is left are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Components {
    /// Those that contain the query's start as a node, or a node that it can be attached to (the thesis, §5.2.2.1: *"all
    /// the connected components that do not contain the start are removed"*).
    WithStart,
    /// All.
    All,
}

/// How a problem goes on from an old roadmap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replanning {
    /// Which components are kept; if nothing is said those with the start, or, in a problem without a query, all.
    pub components: Option<Components>,
    /// With how many nearest nodes each is tried again where obstacles went: 1 to [`Replanning::NEIGHBORS_MAX`].
    pub neighbors: u32,
}

impl Replanning {
    /// The most nearest nodes with which each is tried again. All pairs of nodes with these are held at once, 8 bytes each.
    pub const NEIGHBORS_MAX: u32 = 1000;
}

impl Default for Replanning {
    fn default() -> Replanning {
        Replanning { components: None, neighbors: 10 }
    }
}

/// A problem that begins with what is left of an old roadmap.
#[derive(Clone, Debug)]
pub struct Replanned {
    /// The problem. Its first round is the survivors, alone in one set; then it goes on as it would have without them.
    pub problem: Problem,
    /// How the scene has changed.
    pub change: Arc<SceneChange>,
    /// What became of the old roadmap: what the first round adds.
    pub survived: Survived,
}

impl Problem {
    /// This problem, to be begun with what is left of the roadmap of an old run, of the same robot among other obstacles
    /// (see [`replan`](crate::replan)). The survivors are the set of a strategy `survivors`, which becomes the last of the
    /// problem's, and makes the first round. The old run is named among the [sources](Problem::sources), with the hash of
    /// its ledger as the digest.
    ///
    /// # Errors
    /// Says what is in the way: the old run is of another robot or kind of model, or has no nodes; nothing is left of its
    /// roadmap, or too much; components with the start are asked for, but the problem has no query; a setting that cannot
    /// be, or a strategy called `survivors` already.
    pub fn replanned(&self, old: &OldRun, asked: &Replanning) -> Result<Replanned, ProblemError> {
        let replanned = self.replanned_until(old, asked, &Cancel::new())?;
        Ok(replanned.expect("nothing ends it before it is done"))
    }

    /// [`Problem::replanned`]; `None` where `cancel` ends it before it is known what is left of the old roadmap.
    ///
    /// # Errors
    /// As [`Problem::replanned`].
    pub fn replanned_until(
        &self,
        old: &OldRun,
        asked: &Replanning,
        cancel: &Cancel,
    ) -> Result<Option<Replanned>, ProblemError> {
        let refuse = |message: String| Err(ProblemError::pathless(message));
        let survivors = match self.survivors_of(old, asked) {
            Ok(survivors) => survivors,
            Err(message) => return refuse(message),
        };
        if self.strategies.iter().any(|strategy| strategy.label == LABEL) {
            return refuse(format!("a strategy `{LABEL}` found; other labels expected"));
        }
        let survived = survivors.survived_until(&self.context(), cancel, &mut Scratch::new());
        let Some(survived) = survived else { return Ok(None) };
        let nodes = survived.increment.configs.len();
        let was = format!("of the {} nodes of the old roadmap", old.roadmap.configs().len());
        if nodes == 0 {
            let valid = survived.valid_nodes;
            return refuse(format!(
                "{was} {valid} are valid, and none is kept: there is nothing to go on from, and a build begins anew"
            ));
        }
        if nodes > SURVIVORS_MAX {
            return refuse(format!("{was} {nodes} are kept; at most {SURVIVORS_MAX} expected"));
        }
        let mut problem = self.clone();
        let index = StrategyIndex(problem.strategies.len() as u32);
        let change = survivors.change.clone();
        problem.strategies.push(Strategy {
            label: LABEL.to_owned(),
            nodes: nodes as u32,
            generator: GeneratorKind::Survivors(survivors),
            // Nothing comes before them.
            among: AmongKind::default(),
        });
        let first =
            EarlierSchedule { rounds: 1, schedule: vec![index], adaptive: None, sets_per_round: 1 };
        problem.earlier.insert(0, first);
        let place = SourceFile { path: old.place.to_owned(), digest: old.ledger };
        problem.sources.push(place);
        Ok(Some(Replanned { problem, change, survived }))
    }

    /// What is left of an old run's roadmap, as a method.
    fn survivors_of(&self, old: &OldRun, asked: &Replanning) -> Result<Survivors, String> {
        if let Some(function) = self.function.as_ref().or(old.problem.function.as_ref()) {
            return Err(format!(
                "the validity function `{}` found; a problem without one expected, since it cannot be said what of a roadmap is \
                 left under another function",
                function.identity()
            ));
        }
        let change = old.problem.model.description().change(&self.model)?;
        if old.roadmap.configs().is_empty() {
            return Err("the old roadmap has no nodes; at least 1 expected".to_owned());
        }
        let most = Replanning::NEIGHBORS_MAX;
        if !(1..=most).contains(&asked.neighbors) {
            return Err(format!("{} neighbors found; 1 to {most} expected", asked.neighbors));
        }
        let start = match (asked.components, &self.query) {
            (Some(Components::WithStart), None) => {
                return Err("components with the start found, but no [query]".to_owned());
            }
            (Some(Components::All), _) | (None, None) => None,
            (_, Some(query)) => {
                let attachment = self.attachment();
                let (neighbors, planners) = (attachment.neighbors, attachment.planners);
                Some(Start { at: query.start.clone(), neighbors, planners })
            }
        };
        let edges = old.roadmap.edges();
        Ok(Survivors {
            parent: Parent::of(old.place, old.ledger, old.roadmap),
            planners: Arc::new(edges.iter().map(|edge| edge.planner).collect()),
            change: Arc::new(change),
            start,
            neighbors: asked.neighbors,
        })
    }

    /// What the problem begins with, if that is what is left of an old roadmap.
    pub fn survivors(&self) -> Option<&Survivors> {
        self.strategies.iter().find_map(|strategy| match &strategy.generator {
            GeneratorKind::Survivors(survivors) => Some(survivors),
            _ => None,
        })
    }

    /// How many rounds the problem is begun with before its own schedule, in its first chapter.
    pub fn opening_rounds(&self) -> u64 {
        u64::from(self.survivors().is_some())
    }

    /// Whether the problem's survivors are those of an old run.
    ///
    /// # Errors
    /// Says what is not as it is recorded: the hash of the run's ledger, its roadmap, or how the scene has changed.
    pub fn check_survivors(&self, old: &OldRun) -> Result<(), String> {
        let Some(survivors) = self.survivors() else { return Ok(()) };
        if survivors.parent.ledger != Some(old.ledger) {
            let expected =
                survivors.parent.ledger.map_or_else(String::new, |hash| hash.to_string());
            return Err(format!("its ledger has the hash {}; {expected} expected", old.ledger));
        }
        let asked = Replanning { components: Some(Components::All), neighbors: 1 };
        match self.survivors_of(old, &asked)?.is_of_same_parent(survivors) {
            true => Ok(()),
            false => {
                Err("the roadmap that is replanned, or the change of its scene, is not what it was"
                    .to_owned())
            }
        }
    }
}
