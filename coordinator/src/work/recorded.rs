use crate::exit::Failure;
use crate::run::ledger::{Ledger, Stopped};
use roadmill::clearance::{self, AlongMotion};
use roadmill::export::RoundOutcome;
use roadmill::model::bodies::Bodies;
use roadmill::model::{Scratch, ValidityFunction};
use roadmill::problem::Problem;
use roadmill::query::{
    self, Answer, Attachment, ClearPath, Clearest, EndError, Path, PreparedRoadmap,
};
use roadmill::roadmap::{Digest, Roadmap};
use roadmill::{Context, Ends};
use std::sync::OnceLock;

/// A run as it is recorded: the roadmap, and the way to paths through it.
pub struct Recorded {
    problem: Problem,
    roadmap: PreparedRoadmap,
    path: Option<Path>,
    stopped: Option<Stopped>,
    rounds: Vec<RoundOutcome>,
    program: (String, u32),
    hash: Digest,
    cx: Context,
    attachment: Attachment,
    /// The clearance along every edge, found when it is first asked for; `None` of a model without clearances.
    clearances: OnceLock<Option<Vec<AlongMotion>>>,
}

impl Recorded {
    pub(super) fn new(ledger: Ledger) -> Recorded {
        let Ledger { hash, problem, roadmap, path, stopped, rounds, program } = ledger;
        let (cx, attachment) = (problem.context(), problem.attachment());
        let roadmap = PreparedRoadmap::new(roadmap);
        let clearances = OnceLock::new();
        Recorded {
            problem,
            roadmap,
            path,
            stopped,
            rounds,
            program,
            hash,
            cx,
            attachment,
            clearances,
        }
    }

    /// The run with the validity function of its problem, which the ledger only names: queries need it.
    ///
    /// # Errors
    /// Exit code 2: the ledger names another function, or none.
    pub fn with_validity_function(self, function: &ValidityFunction) -> Result<Recorded, Failure> {
        let problem = self.problem.supplied_with(Some(function)).map_err(Failure::usage)?;
        Ok(Recorded { cx: problem.context(), problem, ..self })
    }

    /// Whether queries can be answered.
    ///
    /// # Errors
    /// Exit code 2: the problem has a validity function, which is missing.
    pub fn expect_validity_function(&self) -> Result<(), Failure> {
        self.problem.clone().supplied_with(None).map(|_| ()).map_err(Failure::usage)
    }

    /// The problem, all chapters taken together.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The problem made ready for work: its space and its model.
    pub fn context(&self) -> &Context {
        &self.cx
    }

    /// The roadmap of the complete rounds.
    pub fn roadmap(&self) -> &Roadmap {
        self.roadmap.roadmap()
    }

    /// The roadmap's digest.
    pub fn digest(&self) -> Digest {
        self.roadmap().digest()
    }

    /// The hash of the ledger up to the last complete round.
    pub fn ledger(&self) -> Digest {
        self.hash
    }

    /// The path of the problem's own query, if the last judgement found one.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_ref()
    }

    /// Why the build stopped; `None` while it runs or where it was killed.
    pub fn stopped(&self) -> Option<&Stopped> {
        self.stopped.as_ref()
    }

    /// What the build came to at the end of every complete round, in their order.
    pub fn rounds(&self) -> &[RoundOutcome] {
        &self.rounds
    }

    /// The program that wrote the run, as `status` says it: `roadmill 0.1.0, bits 3`.
    pub fn program(&self) -> String {
        let (version, bits) = &self.program;
        format!("roadmill {version}, bits {bits}")
    }

    /// Looks for a path between two configurations, attached to the roadmap as the problem's first evaluator does it
    /// that attaches any. The first query prepares what later ones need too, so that these take far less time.
    ///
    /// # Errors
    /// When `start` or `goal` is no valid configuration.
    pub fn query(&self, start: &[f64], goal: &[f64]) -> Result<Answer, EndError> {
        self.roadmap.ask(&self.cx, (start, goal), &self.attachment, &mut Scratch::new())
    }

    /// [`Recorded::query`] for ends that were checked before.
    pub(crate) fn solve(&self, ends: (&[f64], &[f64]), scratch: &mut Scratch) -> Answer {
        self.roadmap.solve(&self.cx, ends, &self.attachment, scratch)
    }

    /// The clearance along every edge of the roadmap, in their order, certain to within the problem's resolution. It is found when
    /// it is first asked for.
    ///
    /// # Errors
    /// Exit code 2: the problem has no clearances, being about no bodies or without obstacles.
    pub fn clearances_of_edges(&self) -> Result<&[AlongMotion], Failure> {
        let found = self
            .clearances
            .get_or_init(|| clearance::of_edges(&self.cx, self.roadmap(), self.resolution()?));
        found.as_deref().ok_or_else(|| self.no_clearances())
    }

    /// The clearance at every node of the roadmap, in their order.
    ///
    /// # Errors
    /// As of [`Recorded::clearances_of_edges`].
    pub fn clearances_of_nodes(&self) -> Result<Vec<f64>, Failure> {
        clearance::of_nodes(&self.cx, self.roadmap()).ok_or_else(|| self.no_clearances())
    }

    /// The path that keeps away from obstacles best, as [`query::clearest`] finds it; `None` if there is none.
    ///
    /// # Errors
    /// Exit code 2: `start` or `goal` is no valid configuration, or the problem has no clearances.
    pub fn clearest(
        &self,
        ends: (&[f64], &[f64]),
        by: Clearest,
    ) -> Result<Option<ClearPath>, Failure> {
        let [start, goal] = query::accepted(&self.cx, ends).map_err(Failure::usage)?;
        self.expect_clearances(&start)?;
        let (of_edges, scratch) = (self.clearances_of_edges()?, &mut Scratch::new());
        let tolerance = self.resolution().ok_or_else(|| self.no_clearances())?;
        let (ends, by) = ([&start[..], &goal[..]], (by, tolerance));
        let (cx, roadmap) = (&self.cx, self.roadmap());
        Ok(query::clearest(cx, roadmap, ends, &self.attachment, of_edges, by, scratch))
    }

    /// Whether nodes have clearances, by the first of them; a roadmap without nodes lacks none.
    ///
    /// # Errors
    /// As of [`Recorded::clearances_of_edges`].
    pub fn expect_clearances_of_nodes(&self) -> Result<(), Failure> {
        self.roadmap().configs().iter().next().map_or(Ok(()), |q| self.expect_clearances(q))
    }

    /// Whether there is a clearance at a configuration: where there is one there is one everywhere.
    fn expect_clearances(&self, q: &[f64]) -> Result<(), Failure> {
        let clearances = self.cx.model().clearances();
        let found = clearances.and_then(|it| it.clearance(q, &mut Scratch::new()));
        found.map(|_| ()).ok_or_else(|| self.no_clearances())
    }

    fn no_clearances(&self) -> Failure {
        Failure::usage(match self.problem.validity_function() {
            None => "clearances: a problem of bodies among obstacles expected, this one has none",
            Some(_) => {
                "clearances: a problem without a validity function expected; a function tells no distances"
            }
        })
    }

    /// How far the robot may move between two checks of a sampled motion, to within which clearances are certain.
    fn resolution(&self) -> Option<f64> {
        self.problem.model().bodies().map(Bodies::resolution)
    }

    /// The better of the answers for the goals of a query, as [`query::solve_any`](roadmill::query::solve_any) has it.
    pub(crate) fn solve_any(&self, ends: &Ends, scratch: &mut Scratch) -> Answer {
        let mut to = |goal: &[f64]| self.solve((&ends.start, goal), scratch);
        let first = to(&ends.goal);
        ends.other_goals.iter().fold(first, |best, goal| best.or(to(goal)))
    }
}
