use crate::exit::Failure;
use crate::run::ledger::{Ledger, Stopped};
use roadmill::export::RoundOutcome;
use roadmill::model::{Scratch, ValidityFunction};
use roadmill::problem::Problem;
use roadmill::query::{Answer, Attachment, EndError, Path, PreparedRoadmap};
use roadmill::roadmap::{Digest, Roadmap};
use roadmill::{Context, Ends};

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
}

impl Recorded {
    pub(super) fn new(ledger: Ledger) -> Recorded {
        let Ledger { hash, problem, roadmap, path, stopped, rounds, program } = ledger;
        let (cx, attachment) = (problem.context(), problem.attachment());
        let roadmap = PreparedRoadmap::new(roadmap);
        Recorded { problem, roadmap, path, stopped, rounds, program, hash, cx, attachment }
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

    /// The better of the answers for the goals of a query, as [`query::solve_any`](roadmill::query::solve_any) has it.
    pub(crate) fn solve_any(&self, ends: &Ends, scratch: &mut Scratch) -> Answer {
        let mut to = |goal: &[f64]| self.solve((&ends.start, goal), scratch);
        let first = to(&ends.goal);
        ends.other_goals.iter().fold(first, |best, goal| best.or(to(goal)))
    }
}
