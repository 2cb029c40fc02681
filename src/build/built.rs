use super::Build;
use crate::context::Context;
use crate::evaluate::{EvaluatorKind, Verdict};
use crate::img::{Judgement, Round, Setup, Stop};
use crate::model::Scratch;
use crate::problem::Problem;
use crate::query::{self, Answer, EndError, Path};
use crate::roadmap::{Digest, Roadmap};
use std::sync::Arc;

/// What a build came to: the roadmap of its complete rounds, and what was said of it.
///
/// It keeps the node sets as they were made too, which is what [`Built::resume`] goes on from;
/// [`Built::into_roadmap`] lets go of them.
pub struct Built {
    pub(super) setup: Arc<Setup>,
    pub(super) roadmap: Roadmap,
    pub(super) stop: Stop,
    pub(super) judgement: Option<Judgement>,
    pub(super) rounds: Vec<Round>,
}

impl Built {
    /// The roadmap.
    pub fn roadmap(&self) -> &Roadmap {
        &self.roadmap
    }

    /// The roadmap alone.
    pub fn into_roadmap(self) -> Roadmap {
        self.roadmap
    }

    /// The roadmap's digest: the same for the same problem and seed, however and wherever it is built.
    pub fn digest(&self) -> Digest {
        self.roadmap.digest()
    }

    /// Why the build stopped.
    pub fn stop(&self) -> &Stop {
        &self.stop
    }

    /// Whether every evaluator of the problem was satisfied.
    pub fn is_satisfied(&self) -> bool {
        self.stop == Stop::Satisfied
    }

    /// The problem that was built.
    pub fn problem(&self) -> &Problem {
        &self.setup.problem
    }

    /// The problem made ready for work: its space and its model.
    pub fn context(&self) -> &Context {
        &self.setup.cx
    }

    /// The answer to the problem's own query, if the problem has one and an evaluator asked it.
    pub fn answer(&self) -> Option<&Answer> {
        self.verdicts().find_map(|(_, verdict)| verdict.answer())
    }

    /// The path that solves the problem's own query, if one was found.
    pub fn path(&self) -> Option<&Path> {
        self.answer()?.path.as_ref()
    }

    /// The problem's evaluators by name, each with what it said last; none before the first round was judged.
    pub fn verdicts(&self) -> impl Iterator<Item = (&'static str, &Verdict)> {
        let verdicts = self.judgement.iter().flat_map(|judgement| &judgement.verdicts);
        let names = self.setup.problem.evaluators.iter().map(|kind| kind.method().name());
        names.zip(verdicts)
    }

    /// What the first evaluator of this name said last (`"query"`, say), be it a part of a combined one.
    pub fn verdict(&self, name: &str) -> Option<&Verdict> {
        let verdicts = &self.judgement.as_ref()?.verdicts;
        named(&self.setup.problem.evaluators, verdicts, name)
    }

    /// Looks for a path between two configurations through the roadmap, as the problem's evaluators would.
    ///
    /// # Errors
    /// When `start` or `goal` is no valid configuration.
    pub fn query(&self, start: &[f64], goal: &[f64]) -> Result<Answer, EndError> {
        let attachment = self.setup.problem.attachment();
        query::ask(&self.setup.cx, &self.roadmap, (start, goal), &attachment, &mut Scratch::new())
    }

    /// Goes on with a build that was cancelled. What comes of it is what would have come without the interruption;
    /// a build that stopped for another reason stops again at once.
    pub fn resume<'a>(&self) -> Build<'a> {
        Build::after(self.setup.clone(), self.rounds.clone(), self.judgement.clone())
    }

    /// Goes on with a build under the query, the evaluators, the limits and the strategies of another problem; see
    /// [`Problem::continued`].
    ///
    /// # Errors
    /// Says what differs that must not.
    pub fn resume_with<'a>(&self, changed: &Problem) -> Result<Build<'a>, String> {
        let mut problem = self.setup.problem.continued(changed, self.rounds.len() as u64)?;
        problem.limits = problem.limits_without_clock();
        // What the evaluators of before said is no verdict of those of now.
        let same = problem.evaluators == self.setup.problem.evaluators
            && problem.query == self.setup.problem.query;
        let judgement = self.judgement.clone().filter(|_| same);
        Ok(Build::after(Arc::new(Setup::new(problem)), self.rounds.clone(), judgement))
    }
}

fn named<'a>(kinds: &[EvaluatorKind], verdicts: &'a [Verdict], name: &str) -> Option<&'a Verdict> {
    kinds.iter().zip(verdicts).find_map(|(kind, verdict)| {
        let method = kind.method();
        if method.name() == name {
            return Some(verdict);
        }
        named(method.parts(), &verdict.parts, name)
    })
}
