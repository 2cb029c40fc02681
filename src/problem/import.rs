//! Problems that files of other programs describe, with the defaults that a problem file would have.

use super::building::{self, Sets};
use super::{DEFAULT_SEED, Limits, Problem};
use crate::context::Ends;
use crate::evaluate::{EvaluatorKind, Query};
use crate::internal::plain::plain;
use crate::model::ForeignProblem;
use crate::seed::Seed;
use crate::source::ProblemError;
use std::path::Path;

/// The problem of what was read from the file `path`.
pub(super) fn problem_of(path: &Path, imported: ForeignProblem) -> Result<Problem, ProblemError> {
    let ForeignProblem { name, model, query, notes, sources } = imported;
    let notes = notes.iter().map(|note| plain(note).into_owned()).collect();
    let Sets { strategies, schedule, adaptive, sets_per_round } =
        building::default_sets(query.is_some());
    let limits = Limits::left_open(&model.description().space());
    let mut problem = Problem {
        name,
        seed: DEFAULT_SEED,
        model,
        function: None,
        query: None,
        strategies,
        schedule,
        adaptive,
        sets_per_round,
        evaluators: Vec::new(),
        limits,
        nodes_are_given: false,
        notes,
        sources,
        earlier: Vec::new(),
        relaxation: None,
    };
    if let Some([mut start, mut goal]) = query {
        let cx = problem.context();
        for (name, q) in [("start", &mut start), ("goal", &mut goal)] {
            cx.accept(q).map_err(|error| ProblemError::file(path, format!("{name}: {error}")))?;
        }
        problem.query = Some(Ends::new(start, goal));
        problem.evaluators = vec![EvaluatorKind::Query(Query::default())];
        let cx = problem.context();
        building::add_gaps(&mut problem, &cx);
        for strategy in &mut problem.strategies {
            let calibrating = Seed::of_calibration(DEFAULT_SEED, &strategy.label);
            strategy.generator.method_mut().calibrate(&cx, &calibrating);
        }
    }
    Ok(problem)
}
