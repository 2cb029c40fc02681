//! What `paths` and `report` share: which paths are looked for.

use super::query::ends;
use crate::cli::{RankBy, SearchArguments};
use crate::exit::Failure;
use crate::output::note;
use crate::work::Recorded;
use roadmill::model::{Molecule, Scratch};
use roadmill::pathways::topology::Topology;
use roadmill::pathways::{
    DISTANCE, Dissimilar, Distinct, KBest, Pathways, Rank, SPACING, dissimilar, distinct, k_best,
};
use roadmill::{Cancel, Context, Ends};

/// How many candidates of dissimilar paths are shortened, and how often a shortcut is tried on each, if nothing is said.
pub(super) const TRIES: u32 = 40;
const SHORTEN_TRIES: u32 = 200;

/// How far apart dissimilar paths are at least in the metric of a model without Cα, unless told otherwise.
pub(super) fn usual_distance(cx: &Context) -> f64 {
    cx.space().diameter() / 20.0
}

/// How far apart frames are at most in the metric of a model without Cα, unless told otherwise.
pub(super) fn usual_spacing(cx: &Context) -> f64 {
    cx.space().diameter() / 100.0
}

/// The ends with one goal: of several the one that the path which costs least ends at, or the first where there is none.
fn with_one_goal(run: &Recorded, ends: Ends) -> Ends {
    if ends.other_goals.is_empty() {
        return ends;
    }
    let answer = run.solve_any(&ends, &mut Scratch::new());
    let reached = answer.path.and_then(|path| ends.goal_number(path.configs.iter()));
    let number = reached.unwrap_or(1);
    note(format_args!("goal {number} of {}, to which the way costs least", ends.goals().count()));
    let goal = ends.goals().nth(number - 1).unwrap_or(&ends.goal).to_vec();
    Ends::new(ends.start, goal)
}

/// What is asked for, with what the model says of it.
pub(super) struct Asked<'a> {
    pub run: &'a Recorded,
    arguments: &'a SearchArguments,
    /// Where the paths begin and end.
    pub ends: Ends,
    pub rank: Rank,
    spacing: f64,
    pub molecule: Option<&'a dyn Molecule>,
    /// Units of energies, of costs, and of lengths and distances.
    pub energy: &'static str,
    pub cost: &'static str,
    pub length: &'static str,
}

impl<'a> Asked<'a> {
    /// # Errors
    /// Exit code 2: what the model does not have is asked for, or an end that cannot be used.
    pub fn of(run: &'a Recorded, arguments: &'a SearchArguments) -> Result<Asked<'a>, Failure> {
        let ends = with_one_goal(run, ends(run, &arguments.start, &arguments.goal)?);
        let (cx, description) = (run.context(), run.problem().model().description());
        let scratch = &mut Scratch::new();
        let has_energies = cx.model().energy(&ends.start, scratch).is_some();
        let has_alphas = cx.model().shape(&ends.start, scratch).is_some();
        let rank = match arguments.by {
            Some(RankBy::Barrier) if !has_energies => {
                let message = "--by: barrier found; this model has no energies, cost expected";
                return Err(Failure::usage(message));
            }
            Some(RankBy::Cost) => Rank::Cost,
            None if !has_energies => Rank::Cost,
            _ => Rank::Barrier,
        };
        let molecule = description.molecule();
        if molecule.is_none() && !arguments.angles.is_empty() {
            return Err(Failure::usage("--angle: this model is no molecule"));
        }
        let usual = if has_alphas { SPACING } else { usual_spacing(cx) };
        let energy = description.node_values().iter().find(|value| value.name == "energy");
        Ok(Asked {
            run,
            arguments,
            ends,
            rank,
            spacing: arguments.spacing.unwrap_or(usual),
            molecule,
            energy: energy.map_or("1", |value| value.unit),
            cost: description.cost_unit(),
            length: if has_alphas { "Å" } else { "length" },
        })
    }

    /// The least distance of dissimilar paths, unless told otherwise.
    pub fn usual_distance(&self) -> f64 {
        if self.length == "Å" { DISTANCE } else { usual_distance(self.run.context()) }
    }

    /// The best paths, however alike; or, with a distance or `Some(None)` for the usual one, dissimilar ones. Of either those
    /// that are found by then where `cancel` ends the search.
    ///
    /// # Errors
    /// Exit code 2: a path would have too many frames.
    pub fn find(
        &self,
        distance: Option<Option<f64>>,
        cancel: &Cancel,
    ) -> Result<Pathways, Failure> {
        let Asked { run, arguments, ref ends, rank, spacing, .. } = *self;
        let (cx, roadmap, scratch) = (run.context(), run.roadmap(), &mut Scratch::new());
        let attachment = run.problem().attachment();
        let count = arguments.count as usize;
        let too_fine = |error| Failure::usage(format!("--spacing: {error}"));
        let Some(distance) = distance else {
            let asked = KBest { count, rank, spacing };
            let found = k_best(cx, roadmap, ends, &attachment, &asked, cancel, scratch);
            return found.map_err(too_fine);
        };
        let asked = Dissimilar {
            count,
            rank,
            distance: distance.unwrap_or_else(|| self.usual_distance()),
            spacing,
            tries: arguments.tries.unwrap_or(TRIES) as usize,
            shortcuts: arguments.shorten_tries.unwrap_or(SHORTEN_TRIES),
        };
        let found = dissimilar(cx, roadmap, ends, &attachment, &asked, cancel, scratch);
        found.map_err(too_fine)
    }

    /// The shortest path of each class of paths that pass the obstacles alike, and the classes as people read them; those that are
    /// found by then where `cancel` ends the search.
    ///
    /// # Errors
    /// Exit code 2: the model has no obstacles, or a path would have too many frames.
    pub fn find_distinct(&self, cancel: &Cancel) -> Result<(Pathways, Vec<String>), Failure> {
        let Asked { run, arguments, ref ends, spacing, .. } = *self;
        let (cx, roadmap, scratch) = (run.context(), run.roadmap(), &mut Scratch::new());
        let description = run.problem().model().description();
        let Some(topology) = Topology::of(cx, description, scratch) else {
            let message = "--distinct: this model knows of no obstacles, bodies expected";
            return Err(Failure::usage(message));
        };
        let left_out = topology.punctures().map_or(0, |punctures| punctures.left_out());
        if left_out > 0 {
            note(format_args!(
                "{left_out} obstacles, or parts of them, do not count: the robot's reference point can be where they are"
            ));
        }
        let asked = Distinct {
            count: arguments.count as usize,
            spacing,
            tries: arguments.tries.unwrap_or(TRIES) as usize,
            shortcuts: arguments.shorten_tries.unwrap_or(SHORTEN_TRIES),
        };
        let attachment = run.problem().attachment();
        let found = distinct(cx, roadmap, ends, &attachment, &topology, &asked, cancel, scratch);
        let found = found.map_err(|error| Failure::usage(format!("--spacing: {error}")))?;
        let classes = found.classes.iter().map(|class| topology.text(class)).collect();
        Ok((found.pathways, classes))
    }
}
