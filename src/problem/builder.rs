//! Problems from values: what a problem file says, said by a program.

use super::file::{File, PolicyTable, QueryTable, ScheduleTable};
use super::goals::GoalsSpec;
use super::{ConfigurationSpec, Problem, ProblemError, StrategySpec, resolve};
use crate::evaluate::EvaluatorKind;
use crate::generator::{NoRuns, Runs};
use crate::model::ModelSpec;
use crate::relaxation::Settings;
use crate::schedule::Adaptive;
use crate::source::Source;
use std::path::PathBuf;

/// A problem made from values, without a file. What is not said has the defaults that it has in a problem file, and
/// [`build`](ProblemBuilder::build) makes the checks that a file goes through, so that a problem is the same by either
/// way: it has the same digest and the same notes, and what is wrong has the same error, without a line.
///
/// ```
/// use roadmill::model::bodies::validity::BoundsMeaning;
/// use roadmill::model::bodies::{BodiesSpec, BodySpec, RobotSpec, ShapeSpec, SpaceSpec};
/// use roadmill::{Build, problem::Problem, space::BaseJoint};
///
/// // A bar in the plane, which has to get past a ball.
/// let space = SpaceSpec::new(BaseJoint::Rigid2d, [0.0, 0.0], [8.0, 8.0], BoundsMeaning::Body);
/// let robot = RobotSpec::new().body(ShapeSpec::Box { size: [1.0, 0.2, 0.2] });
/// let ball = BodySpec::new(ShapeSpec::Sphere { radius: 2.0 }).at([4.0, 4.0, 0.0]);
/// let problem = Problem::builder("ball", BodiesSpec::new(space, robot).obstacle(ball))
///     .query([1.0, 1.0, 0.0], [7.0, 7.0, 1.5])
///     .build()?;
/// let built = Build::new(problem).run()?;
/// for q in built.path().expect("there is a way round the ball") {
///     println!("{q:?}");
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
#[must_use = "nothing is made before `build`"]
pub struct ProblemBuilder {
    file: File,
    model: ModelSpec,
    folder: PathBuf,
}

impl Problem {
    /// A problem to be made from values: its name, and what is planned for, a
    /// [`BodiesSpec`](crate::model::bodies::BodiesSpec) or a
    /// [`LandscapeSpec`](crate::model::landscape::LandscapeSpec).
    pub fn builder(name: impl Into<String>, model: impl Into<ModelSpec>) -> ProblemBuilder {
        let file = File { name: Some(name.into()), ..File::default() };
        ProblemBuilder { file, model: model.into(), folder: PathBuf::new() }
    }

    /// A builder that makes the problem again, so that something of it can be changed. What it builds is equal to this
    /// problem but for [`notes`](Problem::notes), [`sources`](Problem::sources) and [`earlier`](Problem::earlier)
    /// schedules, which it has none of; of a problem that was continued without one of its strategies, that strategy
    /// has to be taken out before anything can be built.
    pub fn to_builder(&self) -> ProblemBuilder {
        let builder = Problem::builder(self.name.clone(), self.model.to_spec())
            .seed(self.seed)
            .strategies(self.strategies.iter().map(StrategySpec::from))
            .sets_per_round(self.sets_per_round.into())
            .evaluators(self.evaluators.clone())
            .most_sets(self.limits.sets);
        let builder = match self.adaptive {
            Some(adaptive) => builder.adaptive(adaptive),
            None => builder.schedule(
                self.schedule.iter().map(|index| self.strategies[index.index()].label.clone()),
            ),
        };
        let builder = match &self.query {
            Some(query) => {
                let builder = builder.query(query.start.clone(), query.goal.clone());
                query.other_goals.iter().cloned().fold(builder, ProblemBuilder::or_goal)
            }
            None => builder,
        };
        let builder = match self.nodes_to_say() {
            Some(nodes) => builder.most_nodes(nodes),
            None => builder,
        };
        let builder = match &self.relaxation {
            Some(settings) => builder.relaxation(settings.clone()),
            None => builder,
        };
        match self.limits.seconds {
            Some(seconds) => builder.most_seconds(seconds),
            None => builder,
        }
    }
}

impl ProblemBuilder {
    /// The name.
    pub fn name(mut self, name: impl Into<String>) -> ProblemBuilder {
        self.file.name = Some(name.into());
        self
    }

    /// The base seed; 1 if nothing is said.
    pub fn seed(mut self, seed: u64) -> ProblemBuilder {
        self.file.seed = Some(seed);
        self
    }

    /// What is planned for, instead of what was given before.
    pub fn model(self, model: impl Into<ModelSpec>) -> ProblemBuilder {
        ProblemBuilder { model: model.into(), ..self }
    }

    /// Changes what is planned for.
    pub fn change_model(self, change: impl FnOnce(ModelSpec) -> ModelSpec) -> ProblemBuilder {
        ProblemBuilder { model: change(self.model), ..self }
    }

    /// The folder where relative paths of meshes, URDFs and runs start; the process's own if nothing is said.
    pub fn folder(self, folder: impl Into<PathBuf>) -> ProblemBuilder {
        ProblemBuilder { folder: folder.into(), ..self }
    }

    /// The configurations between which a path is wanted, each a [`ConfigurationSpec`]: one value per degree of freedom, in
    /// the order that `docs/problems.md` says; the name of a state of the robot's SRDF; or values by names of joints.
    pub fn query(
        mut self,
        start: impl Into<ConfigurationSpec>,
        goal: impl Into<ConfigurationSpec>,
    ) -> ProblemBuilder {
        self.file.query =
            Some(QueryTable { start: start.into(), goal: GoalsSpec::One(goal.into()) });
        self
    }

    /// Adds a goal to the query, which is as good as those before; without a query it is none.
    pub fn or_goal(mut self, goal: impl Into<ConfigurationSpec>) -> ProblemBuilder {
        self.file.query = self.file.query.map(|QueryTable { start, goal: goals }| {
            let goal = goals.or(goal.into());
            QueryTable { start, goal }
        });
        self
    }

    /// No query.
    pub fn without_query(mut self) -> ProblemBuilder {
        self.file.query = None;
        self
    }

    /// Sets per round (TR05-007: *k*); 5 if nothing is said.
    pub fn sets_per_round(mut self, sets: u64) -> ProblemBuilder {
        self.file.img.sets_per_round = Some(sets);
        self
    }

    /// Labels of strategies: which makes the next set, over and over. If nothing is said, the strategies take turns.
    pub fn schedule<L: Into<String>>(
        mut self,
        labels: impl IntoIterator<Item = L>,
    ) -> ProblemBuilder {
        let labels = labels.into_iter().map(Into::into).collect();
        self.file.img.schedule = Some(ScheduleTable::Labels(labels));
        self
    }

    /// A schedule by what the strategies united for their cost.
    pub fn adaptive(mut self, adaptive: Adaptive) -> ProblemBuilder {
        self.file.img.schedule = Some(ScheduleTable::Policy(PolicyTable::Adaptive(adaptive)));
        self
    }

    /// The schedule that is taken if nothing is said: the strategies take turns.
    pub fn default_schedule(mut self) -> ProblemBuilder {
        self.file.img.schedule = None;
        self
    }

    /// Adds a strategy. A problem without any has one that samples uniformly.
    pub fn strategy(mut self, strategy: StrategySpec) -> ProblemBuilder {
        self.file.strategies.push(strategy);
        self
    }

    /// Takes these strategies instead of those given before.
    pub fn strategies(
        mut self,
        strategies: impl IntoIterator<Item = StrategySpec>,
    ) -> ProblemBuilder {
        self.file.strategies = strategies.into_iter().collect();
        self
    }

    /// Changes each strategy that was given before.
    pub fn change_strategies(
        mut self,
        change: impl FnMut(StrategySpec) -> StrategySpec,
    ) -> ProblemBuilder {
        self.file.strategies = self.file.strategies.into_iter().map(change).collect();
        self
    }

    /// Adds a criterion that a finished roadmap meets.
    pub fn evaluator(mut self, evaluator: EvaluatorKind) -> ProblemBuilder {
        self.file.evaluators.get_or_insert_default().push(evaluator);
        self
    }

    /// The criteria that a finished roadmap meets, all of them, instead of those given before. If nothing is said, a
    /// problem with a query has the evaluator `query`, and one without has none.
    pub fn evaluators(
        mut self,
        evaluators: impl IntoIterator<Item = EvaluatorKind>,
    ) -> ProblemBuilder {
        self.file.evaluators = Some(evaluators.into_iter().collect());
        self
    }

    /// The build stops at the end of the first round with so many nodes. If nothing is said: with as many as take about
    /// 4 GiB of memory, or, where seconds are limited, with the most that there may be.
    pub fn most_nodes(mut self, nodes: u64) -> ProblemBuilder {
        self.file.limits.nodes = Some(nodes);
        self
    }

    /// The build stops at the end of the first round with so many sets.
    pub fn most_sets(mut self, sets: u64) -> ProblemBuilder {
        self.file.limits.sets = Some(sets);
        self
    }

    /// A build in worker processes stops at the end of the first round after so many seconds.
    pub fn most_seconds(mut self, seconds: f64) -> ProblemBuilder {
        self.file.limits.seconds = Some(seconds);
        self
    }

    /// How the problem is relaxed where it is too hard: see [`relaxation`](crate::relaxation). It changes nothing of what the problem
    /// itself builds.
    pub fn relaxation(mut self, settings: Settings) -> ProblemBuilder {
        self.file.relaxation = Some(settings);
        self
    }

    /// Checks all that was given and makes the problem.
    ///
    /// # Errors
    /// The first thing that is wrong, by the key that it has in a problem file: `obstacles[2].shape: …`.
    pub fn build(&self) -> Result<Problem, ProblemError> {
        self.build_with(&NoRuns)
    }

    /// [`ProblemBuilder::build`] with a reader of the runs whose roadmaps the problem's generators read.
    ///
    /// # Errors
    /// As [`ProblemBuilder::build`].
    pub fn build_with(&self, runs: &dyn Runs) -> Result<Problem, ProblemError> {
        resolve::resolve(Source::of_values(&self.folder), &self.file, &self.model, runs)
    }
}
