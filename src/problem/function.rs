//! Problems of which a function judges configurations, beside the model.

use super::resolve::suits;
use super::{Problem, ProblemError};
use crate::model::{Model, ValidityFunction, with_functions};

impl Problem {
    /// The problem, of whose valid configurations a function allows some: a milestone, and every step of a motion, is valid if the
    /// model and the function say so. The function's identity enters the [digest](Problem::digest). Of motions nothing is
    /// proved, so that the problem must not ask for it; and it is built in threads, since a function cannot be sent to other
    /// processes.
    ///
    /// # Errors
    /// When the model is none of bodies with `edges = "sampled"`, or a method does not suit it any more; when the function forbids
    /// an end of the query, or fails.
    pub fn with_validity_function(
        self,
        function: ValidityFunction,
    ) -> Result<Problem, ProblemError> {
        let refuse = ProblemError::pathless;
        self.expect_function_suits().map_err(refuse)?;
        let problem = Problem { function: Some(function), ..self };
        let check = || {
            let cx = problem.context();
            if let Some(ends) = &problem.query {
                let start = ("query.start", &ends.start[..]);
                let goals = ends.goals().map(|goal| ("query.goal", goal));
                for (name, q) in std::iter::once(start).chain(goals) {
                    cx.accept(&mut q.to_vec()).map_err(|error| format!("{name}: {error}"))?;
                }
            }
            for (index, strategy) in problem.strategies.iter().enumerate() {
                for (key, found) in suits(strategy, false, &cx) {
                    found.map_err(|message| format!("strategies[{index}].{key}: {message}"))?;
                }
            }
            let mut evaluators = problem.evaluators.clone();
            for (index, evaluator) in evaluators.iter_mut().enumerate() {
                let accepted = evaluator.method_mut().accept(&cx);
                accepted.map_err(|message| format!("evaluators[{index}]: {message}"))?;
            }
            Ok(())
        };
        with_functions(check).map_err(|failed| refuse(failed.message))?.map_err(refuse)?;
        Ok(problem)
    }

    /// The function that judges configurations beside the model, if there is one.
    pub fn validity_function(&self) -> Option<&ValidityFunction> {
        self.function.as_ref()
    }

    /// The problem as it comes out of a ledger, with the validity function that the ledger only names, or without one where it
    /// names none.
    ///
    /// # Errors
    /// Says what is wrong: the function is missing, it has another identity, or there is one where none is named.
    pub fn supplied_with(self, function: Option<&ValidityFunction>) -> Result<Problem, String> {
        let given = function.or(self.function.as_ref().filter(|own| own.is_given()));
        match (&self.function, given) {
            (None, None) => Ok(self),
            (Some(own), Some(given)) if own == given => {
                let function = Some(given.clone());
                Ok(Problem { function, ..self })
            }
            (Some(own), Some(given)) => Err(format!(
                "the validity function `{}` found, `{}` expected",
                given.identity(),
                own.identity()
            )),
            (Some(own), None) => Err(format!(
                "its configurations are judged by the validity function `{}` too, which no file has; this function expected \
                 (in Python: Roadmap(run, validity=…))",
                own.identity()
            )),
            (None, Some(given)) => {
                Err(format!("the validity function `{}` found, none expected", given.identity()))
            }
        }
    }

    /// Whether a validity function can be added.
    pub(super) fn expect_function_suits(&self) -> Result<(), String> {
        let takes = self.model.description().takes_function();
        takes.map_err(|found| {
            format!(
                "{found}; bodies with edges = \"sampled\" expected, since a validity function judges single configurations, and \
                 nothing is proved of what lies between them"
            )
        })
    }

    /// The model made ready for work.
    pub(super) fn prepared_model(&self) -> Box<dyn Model> {
        let description = self.model.description();
        match &self.function {
            Some(function) => description.prepare_with(function),
            None => description.prepare(),
        }
    }
}
