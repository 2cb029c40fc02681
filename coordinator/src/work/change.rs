//! What a build that goes on may change.

use super::limits::limit;
use crate::run::{Scan, SetFiles};
use roadmill::problem::{Limits, Problem};

/// What a build that goes on may change.
pub(super) enum Change {
    /// Nothing: it must be that of this problem, of which sets may be imported.
    None(Box<Problem>, SetFiles),
    /// Criteria, limits and the schedule; a chapter is opened for it.
    Chapter(Chapter),
}

/// What a chapter changes.
#[derive(Default)]
pub(super) struct Chapter {
    pub with: Option<Box<Problem>>,
    pub accept_bits: bool,
    pub max_nodes: Option<u64>,
    pub max_sets: Option<u64>,
}

impl Change {
    /// The problem that the build goes on with.
    pub fn apply(&self, scan: &Scan, present: &Problem) -> Result<Problem, String> {
        match self {
            Change::None(problem, _) => {
                let known = &scan.chapter().sources;
                for file in problem.other_sources() {
                    let was = known.iter().find(|known| known.path == file.path);
                    if let Some(was) = was.filter(|was| was.digest != file.digest) {
                        let (now, then) = (file.digest, was.digest);
                        return Err(format!("{} has changed: {now}, {then} expected", file.path));
                    }
                }
                // A limit of time is one of this process.
                let mut limits = Limits { seconds: present.limits().seconds, ..problem.limits() };
                // What a problem leaves open depends on the version of the program, and on a limit of time.
                let (space, of_run) = (present.space(), present.limits());
                if problem.leaves_nodes_open() && of_run.may_have_left_nodes_open(&space) {
                    limits.nodes = of_run.nodes;
                }
                let problem = (**problem).clone().with_limits(limits);
                let problem = problem.map_err(|error| error.to_string())?;
                let next = present.continued(&problem, scan.rounds())?;
                match difference(present, &next) {
                    None => Ok(next),
                    Some(what) => Err(format!(
                        "{what} not those of the run; `resume --with` opens a chapter for others"
                    )),
                }
            }
            Change::Chapter(Chapter { with, max_nodes, max_sets, .. }) => {
                let next = match with {
                    Some(with) => present.continued(with, scan.rounds())?,
                    None => present.clone(),
                };
                limit(next, *max_nodes, *max_sets).map_err(|failure| failure.message)
            }
        }
    }

    pub fn accepts_bits(&self) -> bool {
        matches!(self, Change::Chapter(Chapter { accept_bits: true, .. }))
    }
}

/// What of a chapter differs; names, notes and files do not make one.
pub(super) fn difference(present: &Problem, next: &Problem) -> Option<&'static str> {
    let parts = [
        ("the strategies are", present.strategies() == next.strategies()),
        ("the schedule and the sets per round are", present.earlier() == next.earlier()),
        ("the ends of the query are", present.query() == next.query()),
        ("the criteria are", present.evaluators() == next.evaluators()),
        ("the limits are", present.limits() == next.limits()),
        // Of a chapter without rounds these differ alone.
        ("the schedule is", present.schedule() == next.schedule()),
        ("the policy of the schedule is", present.adaptive() == next.adaptive()),
        ("the sets per round are", present.sets_per_round() == next.sets_per_round()),
    ];
    parts.into_iter().find(|(_, same)| !same).map(|(what, _)| what)
}
