//! The problem of a level of a relaxation.

use super::resolve::suits;
use super::{Limits, Problem, ProblemError};
use crate::connect::AmongKind;
use crate::context::{Context, Ends};
use crate::digest::Digest;
use crate::evaluate::{self, EvaluatorKind};
use crate::generator::{GeneratorKind, HintPath, Hints, Parent, Reuse};
use crate::model::{CannotRelax, RelaxedModel, Scratch};
use crate::numbers::StrategyIndex;
use crate::relaxation::{Settings, chain_begin};
use crate::roadmap::Roadmap;
use crate::seed::{Purpose, Seed};
use crate::source::value;
use crate::strategy::Strategy;
use crate::wire;

/// Milestones of a set that takes over something of an earlier level.
const NODES: u32 = 50;
/// How far from a node of the earlier level a milestone may lie, as a share of the largest distance in the space.
const SPREAD_SHARE: f64 = 0.005;
/// How far an end of the query is moved at most that is not valid at a level, as a share of the largest distance in the space; in how many
/// distances up to that a valid configuration is looked for, and how often in each.
const END_SHARE: f64 = 0.05;
const END_SHELLS: u32 = 50;
const END_TRIES: u32 = 40;
/// The relaxed levels of which one is looked at before anything is built: the first of these at which the ends of the query are valid.
const LOOKED_AT: [f64; 3] = [0.0, 0.25, 0.5];
/// The labels of the strategies that take over an earlier level's roadmap and its paths.
const REUSE: &str = "reuse";
const HINTS: &str = "hints";

/// What the problem of a level takes over from an earlier level that was solved.
#[derive(Clone, Copy, Debug)]
pub struct EarlierLevel<'a> {
    /// The earlier level.
    pub level: f64,
    /// Its problem.
    pub problem: &'a Problem,
    /// Its roadmap.
    pub roadmap: &'a Roadmap,
    /// Where its run is, for people to read.
    pub place: &'a str,
    /// Paths through its roadmap, each from its start to its goal.
    pub paths: &'a [Vec<Vec<f64>>],
}

/// Why there is no problem of a level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoLevel {
    /// An end of the query is not valid at this level, for the reason that is said, and no configuration near it is.
    InvalidEnds(String),
    /// Something that a person can put right: what was found and what is expected.
    Refused(String),
}

impl EarlierLevel<'_> {
    /// What the earlier level came to, as the problem of the next one names it. Unlike the hash of its ledger it is the same however
    /// often the build was interrupted.
    fn digest(&self) -> Digest {
        came_to(self.problem, self.roadmap.digest())
    }
}

/// One digest of a level's problem and of its roadmap.
fn came_to(problem: &Problem, roadmap: Digest) -> Digest {
    Digest::of(&wire::encode(&("roadmill level 1", problem.digest(), roadmap)))
}

impl Problem {
    /// How the problem is relaxed, if it says so.
    pub fn relaxation(&self) -> Option<&Settings> {
        self.relaxation.as_ref()
    }

    /// The problem relaxed in this way, by what [`Problem::at_level`] makes levels of.
    ///
    /// # Errors
    /// A setting is wrong, or the model cannot be relaxed so.
    pub fn with_relaxation(self, settings: Settings) -> Result<Problem, ProblemError> {
        let settings = self.checked_relaxation(settings).map_err(|(keys, message)| {
            ProblemError::pathless(format!("{}: {message}", keys.join(".")))
        })?;
        Ok(Problem { relaxation: Some(settings), ..self })
    }

    /// The settings with the kind that is usual for the model, if they name none; or the keys of the setting that is wrong, and how.
    pub(super) fn checked_relaxation(
        &self,
        mut settings: Settings,
    ) -> Result<Settings, (Vec<&'static str>, String)> {
        const TABLE: &str = "relaxation";
        if let Some(complaint) = settings.complaint() {
            return Err((vec![TABLE, complaint.key], complaint.to_string()));
        }
        let description = self.model.description();
        let Some(kind) = settings.kind.clone().or_else(|| description.usual_relaxation()) else {
            let message = "none found; how the model is relaxed expected, as it has no usual way";
            return Err((vec![TABLE, "kind"], message.to_owned()));
        };
        if let Some(complaint) = kind.complaint() {
            return Err((vec![TABLE, "kind", kind.name(), complaint.key], complaint.to_string()));
        }
        if let Err(CannotRelax { key, message }) = description.relaxed(&kind, 0.0) {
            let keys = match key {
                "" => vec![TABLE, "kind"],
                key => vec![TABLE, "kind", kind.name(), key],
            };
            return Err((keys, message));
        }
        settings.kind = Some(kind);
        let relaxing = Problem { relaxation: Some(settings.clone()), ..self.clone() };
        relaxing.expect_levels().map_err(|message| (vec![TABLE, "kind"], message))?;
        Ok(settings)
    }

    /// Whether the strategies suit relaxed levels, whose model may not have what a strategy asks for, or whose configurations may have more
    /// values. What is wrong at one relaxed level is wrong at all of them, so that it is told before any is built. A problem without a query has no
    /// levels; and where an end of the query is not valid at any of the levels that are looked at, that is told once they are tried.
    ///
    /// # Errors
    /// Says at which level what was found and what is expected.
    fn expect_levels(&self) -> Result<(), String> {
        if self.query.is_none() {
            return Ok(());
        }
        for level in LOOKED_AT {
            match self.at_level(2, level, None) {
                Ok(_) => return Ok(()),
                Err(NoLevel::Refused(why)) => return Err(format!("at level {level} {why}")),
                Err(NoLevel::InvalidEnds(_)) => {}
            }
        }
        Ok(())
    }

    /// What all levels begin with: a digest of the problem, its query and how it is relaxed.
    pub fn relaxation_digest(&self) -> Option<Digest> {
        let settings = self.relaxation.as_ref()?;
        let query = self.query.as_ref().map(|ends| ends.all().map(<[f64]>::to_vec).collect());
        let query: Vec<Vec<f64>> = query.unwrap_or_default();
        let evaluators = (wire::encode(&self.evaluators), wire::encode(&query));
        Some(chain_begin(self.digest(), &wire::encode(&evaluators), &value(settings)))
    }

    /// The model at a level of the problem's relaxation; at level 1 the model itself.
    ///
    /// # Errors
    /// The problem has no relaxation, or its model cannot be relaxed so.
    pub fn relaxed_model(&self, level: f64) -> Result<RelaxedModel, String> {
        if level >= 1.0 {
            return Ok(RelaxedModel::new(self.model.clone()));
        }
        let settings = self.relaxation.as_ref();
        let kind = settings.and_then(|settings| settings.kind.as_ref());
        let kind = kind.ok_or("no [relaxation] found; one expected")?;
        let relaxed = self.model.description().relaxed(kind, level);
        relaxed.map_err(|CannotRelax { message, .. }| format!("relaxation.kind: {message}"))
    }

    /// The problem of the level `level` of this problem's relaxation, the one that is tried as number `number`, the first of which is 1,
    /// with what it takes over from an earlier level.
    ///
    /// It has the relaxed model, the query, of which an end that is not valid at this level is moved to a valid configuration near it, the strategies of this problem, and as its one criterion that the query is solved. Where it
    /// takes something over, half of its sets are made by strategies more, in turn: what can be had of the paths, and of the roadmap.
    /// The limits are those of the relaxation. The first one tried has the base seed of this problem, so that it is, without help and at
    /// level 1, the very build of the problem; every other has a base seed derived from it and from its number.
    ///
    /// # Errors
    /// An end of the query is not valid at this level, and nothing near it is; or the problem cannot be relaxed so, or has no query.
    pub fn at_level(
        &self,
        number: u32,
        level: f64,
        earlier: Option<&EarlierLevel>,
    ) -> Result<Problem, NoLevel> {
        let refuse = |message: &str| NoLevel::Refused(message.to_owned());
        let settings = self.relaxation.as_ref();
        let settings = settings.ok_or_else(|| refuse("no [relaxation] found; one expected"))?;
        let ends = self.query.as_ref();
        let ends =
            ends.ok_or_else(|| refuse("no [query] found; one expected, whose path is sought"))?;
        if self.function.is_some() {
            return Err(refuse("a validity function found; a problem without one expected"));
        }
        let relaxed = self.relaxed_model(level).map_err(NoLevel::Refused)?;
        let lifted = |q: &Vec<f64>| relaxed.lifted(q);
        let query = Ends {
            start: lifted(&ends.start),
            goal: lifted(&ends.goal),
            other_goals: ends.other_goals.iter().map(lifted).collect(),
        };
        let is_query = |kind: &&EvaluatorKind| matches!(kind, EvaluatorKind::Query(_));
        let evaluator = self.evaluators.iter().find(is_query).cloned();
        let usual = || EvaluatorKind::Query(evaluate::Query::default());
        let sets = settings.sets.unwrap_or(u64::MAX);
        let mut problem = Problem {
            seed: if number <= 1 { self.seed } else { Seed::base_of_level(self.seed, number) },
            model: relaxed.model.clone(),
            query: Some(query),
            strategies: self.strategies_at(&relaxed),
            evaluators: vec![evaluator.unwrap_or_else(usual)],
            limits: Limits { nodes: settings.nodes_of(earlier.is_some()), sets, seconds: None },
            nodes_are_given: true,
            relaxation: None,
            ..self.clone()
        };
        problem.notes.push(format!("level {level} of a relaxation, tried as number {number}"));
        let mut cx = problem.context();
        problem.move_ends(&cx)?;
        cx.query.clone_from(&problem.query);
        if let Some(earlier) = earlier {
            self.take_over(&mut problem, &cx, (level, &relaxed), earlier)?;
        }
        problem.check_level(&cx)?;
        Ok(problem)
    }

    /// The strategies at a level: the approximate paths that they go by are of the problem's own configurations, and become ones of the relaxed
    /// model.
    fn strategies_at(&self, relaxed: &RelaxedModel) -> Vec<Strategy> {
        let mut strategies = self.strategies.clone();
        if relaxed.extra_value.is_none() {
            return strategies;
        }
        let own = self.space().len();
        // What has another number of values is told once the strategy is checked.
        let lifted = |q: &Vec<f64>| if q.len() == own { relaxed.lifted(q) } else { q.clone() };
        for strategy in &mut strategies {
            for path in strategy.generator.method_mut().hint_paths_mut() {
                *path = path.clone().with(path.configurations().iter().map(lifted).collect());
            }
        }
        strategies
    }

    /// Moves ends of the query that are not valid at this level to valid configurations near them: a shape that was made smaller may
    /// reach where it did not before. The path of a relaxed level is a hint, so that it need not begin just where that of the problem does.
    fn move_ends(&mut self, cx: &Context) -> Result<(), NoLevel> {
        let Some(ends) = &mut self.query else { return Ok(()) };
        let Ends { start, goal, other_goals } = ends;
        let goals = std::iter::once(goal).chain(other_goals).map(|goal| ("query.goal", goal));
        for (index, (name, q)) in std::iter::once(("query.start", start)).chain(goals).enumerate() {
            let Err(why) = cx.accept(q) else { continue };
            let seed = Seed::of_calibration(self.seed, "ends").part(index as u64);
            let Some((valid, distance)) = valid_near(cx, q, &seed) else {
                return Err(NoLevel::InvalidEnds(format!("{name}: {why}")));
            };
            *q = valid;
            self.notes
                .push(format!("{name}: moved by {distance:.3e}, as it is not valid at this level"));
        }
        Ok(())
    }

    /// Adds the strategies that take something over from an earlier level. `cx` is the problem of the level made ready for work.
    fn take_over(
        &self,
        problem: &mut Problem,
        cx: &Context,
        (level, relaxed): (f64, &RelaxedModel),
        earlier: &EarlierLevel,
    ) -> Result<(), NoLevel> {
        let before = self.relaxed_model(earlier.level).map_err(NoLevel::Refused)?;
        let mut guides: Vec<Strategy> = Vec::new();
        let here = |q: &Vec<f64>| carried(q, (&before, earlier.level), (relaxed, level));
        let paths: Vec<HintPath> = earlier
            .paths
            .iter()
            .filter(|path| path.len() > 1)
            .map(|path| HintPath::new(path.iter().map(here).collect()))
            .collect();
        if let Some((first, others)) = paths.split_first() {
            let hints = Hints { paths: others.to_vec(), ..Hints::new(first.clone()) };
            guides.push(Strategy {
                label: self.free_label(HINTS),
                nodes: NODES,
                generator: GeneratorKind::Hints(hints),
                among: AmongKind::default(),
            });
        }
        let spread = SPREAD_SHARE * problem.space().diameter();
        // Of the earlier roadmap what is valid here, too, so that no set is in want of milestones.
        let scratch = &mut Scratch::new();
        let is_valid = |q: &[f64]| cx.model.is_valid(q, scratch);
        let is_same_form = before.extra_value == relaxed.extra_value;
        let parent = is_same_form
            .then(|| Parent::of_some(earlier.place, earlier.digest(), earlier.roadmap, is_valid));
        if let Some(parent) = parent.filter(|parent| !parent.roadmap().is_empty()) {
            guides.push(Strategy {
                label: self.free_label(REUSE),
                nodes: NODES,
                generator: GeneratorKind::Reuse(Reuse::new(parent, spread)),
                among: AmongKind::default(),
            });
        }
        if guides.is_empty() {
            return Ok(());
        }
        for guide in &mut guides {
            let seed = Seed::of_calibration(problem.seed, &guide.label);
            guide.generator.method_mut().calibrate(cx, &seed);
        }
        let first = problem.strategies.len() as u32;
        let added: Vec<StrategyIndex> =
            (first..first + guides.len() as u32).map(StrategyIndex).collect();
        problem.strategies.extend(guides);
        let own = std::mem::take(&mut problem.schedule);
        problem.schedule = match problem.adaptive {
            // The schedule that adapts finds out which of them are worth their while.
            Some(_) => own.into_iter().chain(added).collect(),
            None => {
                let periods = added.len().div_ceil(gcd(added.len(), own.len()));
                let own = own.iter().cycle().take(periods.max(1) * own.len());
                own.zip(added.iter().cycle()).flat_map(|(own, added)| [*added, *own]).collect()
            }
        };
        Ok(())
    }

    /// Checks what depends on the relaxed model.
    fn check_level(&mut self, cx: &Context) -> Result<(), NoLevel> {
        for strategy in &self.strategies {
            for (key, found) in suits(strategy, true, cx) {
                let label = &strategy.label;
                found
                    .map_err(|why| NoLevel::Refused(format!("strategy `{label}`: {key}: {why}")))?;
            }
        }
        for evaluator in &mut self.evaluators {
            evaluator.method_mut().accept(cx).map_err(NoLevel::Refused)?;
        }
        Ok(())
    }

    /// A label that no strategy has, made of this one.
    fn free_label(&self, label: &str) -> String {
        let is_taken = |label: &str| self.strategies.iter().any(|known| known.label == label);
        let numbered = (2u32..).map(|number| format!("{label}-{number}"));
        let mut labels = std::iter::once(label.to_owned()).chain(numbered);
        labels.find(|label| !is_taken(label)).expect("there are more labels than strategies")
    }
}

/// A valid configuration near `q`, with its distance: the first that is found at random in growing distances.
fn valid_near(cx: &Context, q: &[f64], seed: &Seed) -> Option<(Vec<f64>, f64)> {
    let (mut stream, scratch) = (seed.stream(Purpose::Sampling), &mut Scratch::new());
    let farthest = END_SHARE * cx.space.diameter();
    let mut near = vec![0.0; q.len()];
    for shell in 1..=END_SHELLS {
        let distance = farthest * f64::from(shell) / f64::from(END_SHELLS);
        for _ in 0..END_TRIES {
            cx.space.step(q, distance, &mut stream, &mut near);
            if cx.model.is_valid(&near, scratch) {
                return Some((near, distance));
            }
        }
    }
    None
}

/// What a configuration of one level is at another: its own values, and that of the extra joint, where both levels have one, in proportion
/// to its range, which shrinks with the level.
fn carried(
    q: &[f64],
    (from, from_level): (&RelaxedModel, f64),
    (to, to_level): (&RelaxedModel, f64),
) -> Vec<f64> {
    let mut carried = to.lifted(&from.dropped(q));
    if let (Some(old), Some(new)) = (from.extra_value, to.extra_value) {
        carried[new] = q[old] * ((1.0 - to_level) / (1.0 - from_level));
    }
    carried
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
