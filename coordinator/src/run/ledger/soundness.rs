//! Whether what a file says can be: sets, verdicts and problems of ledgers and files of sets are checked before
//! they are used, as problem files are. A file whose hashes are right may still have been made by anybody.

use super::record::Chapter;
use roadmill::Ends;
use roadmill::evaluate::Verdict;
use roadmill::img::Joined;
use roadmill::local::Planner;
use roadmill::model::Asked;
use roadmill::numbers::StrategyIndex;
use roadmill::problem::Problem;
use roadmill::roadmap::{Edge, Increment, SetForm};
use roadmill::space::{Configs, FactorKind, Space};
use std::f64::consts::PI;

/// The most nodes of a set, and the most sets of a round, as problem files may have them.
const SET_NODES_MAX: u32 = 1_000_000;
const SETS_PER_ROUND_MAX: u32 = 1_000_000;
const NAME_BYTES_MAX: usize = 100;
/// More than can be counted in years, and little enough to be added up.
const COUNT_MAX: u64 = 1 << 56;
/// By how much a value in stored form may be off: far more than rounding comes to.
const SLACK: f64 = 1e-9;

/// What the sets of a problem must be like.
#[derive(Debug)]
pub struct SetCheck {
    space: Space,
    form: SetForm,
    /// Nodes of the sets of each strategy.
    nodes: Vec<u64>,
}

impl SetCheck {
    /// For the sets of this problem.
    pub fn new(problem: &Problem) -> SetCheck {
        let strategies = problem.strategies().iter();
        SetCheck {
            space: problem.space(),
            form: SetForm::of(problem.model().description()),
            nodes: strategies.map(|strategy| u64::from(strategy.nodes())).collect(),
        }
    }

    /// What is wrong with an increment of a strategy; `before` is the number of nodes from which its root edges may
    /// lead.
    pub fn complaint(
        &self,
        strategy: StrategyIndex,
        increment: &Increment,
        before: u64,
    ) -> Option<&'static str> {
        if !increment.is_sound(self.form, before) {
            return Some("nodes and edges that do not fit together");
        }
        if Some(&(increment.configs.len() as u64)) != self.nodes.get(strategy.index()) {
            return Some("another number of nodes than its strategy makes");
        }
        if !are_in(&self.space, &increment.configs) {
            return Some("a configuration that is not in the space, or not in stored form");
        }
        if !increment.edges.iter().chain(&increment.root_edges).all(can_be) {
            return Some("an edge that no local planner makes");
        }
        counts_complaint(increment.asked)
    }

    /// What is wrong with the edges that join a set of `own` nodes to the `before` nodes that came before it.
    pub fn joins_complaint(&self, joined: &Joined, before: u64, own: u64) -> Option<&'static str> {
        let joins = |edge: &Edge| {
            u64::from(edge.low.0) < before
                && (before..before + own).contains(&u64::from(edge.high.0))
        };
        if !joined.edges.iter().all(|edge| joins(edge) && self.form.has_cost(edge)) {
            return Some("a joining edge that does not join the set to what came before it");
        }
        if !joined.edges.iter().all(can_be) {
            return Some("an edge that no local planner makes");
        }
        counts_complaint(joined.asked)
    }
}

/// What is wrong with verdicts on a roadmap over this space.
pub fn verdicts_complaint(space: &Space, verdicts: &[Verdict]) -> Option<&'static str> {
    verdicts.iter().find_map(|verdict| {
        let path = verdict.answer.as_ref().and_then(|answer| answer.path.as_ref());
        if path.is_some_and(|path| !is_path_in(space, &path.configs)) {
            return Some("a path that is not in the space");
        }
        counts_complaint(verdict.asked).or_else(|| verdicts_complaint(space, &verdict.parts))
    })
}

/// What is wrong with the problem of a chapter, or in which the chapter says otherwise.
pub fn problem_complaint(chapter: &Chapter, problem: &Problem) -> Option<String> {
    let same = [
        ("name", chapter.name == problem.name()),
        ("seed", chapter.seed == problem.seed()),
        ("number of degrees of freedom", chapter.dofs as usize == problem.space().len()),
        ("list of source files", chapter.sources == problem.sources()),
    ];
    if let Some((what, _)) = same.iter().find(|(_, same)| !same) {
        return Some(format!("the {what} of its chapter is not that of the problem in it"));
    }
    let rounds = problem.earlier().iter().try_fold(0u64, |sum, e| sum.checked_add(e.rounds));
    let opening = problem.opening_rounds();
    if rounds.is_none_or(|rounds| rounds > chapter.first_round.0.max(opening)) {
        return Some("earlier schedules for more rounds than come before its chapter".to_owned());
    }
    if !problem.schedule_is_sound()
        || problem.sets_per_round() > SETS_PER_ROUND_MAX
        || problem.adaptive().is_some_and(|adaptive| adaptive.rounds == 0)
    {
        return Some("a schedule that cannot be".to_owned());
    }
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    let name = problem.name();
    if name.is_empty() || name.len() > NAME_BYTES_MAX || !name.chars().all(is_part) {
        return Some(format!("a name that cannot be: {name:?}"));
    }
    strategies_complaint(problem).or_else(|| criteria_complaint(problem))
}

fn strategies_complaint(problem: &Problem) -> Option<String> {
    for (index, strategy) in problem.strategies().iter().enumerate() {
        let label = strategy.label();
        let is_twice = problem.strategies()[..index].iter().any(|other| other.label() == label);
        if label.is_empty() || label.len() > NAME_BYTES_MAX || is_twice {
            return Some(format!("a label that cannot be: {label:?}"));
        }
        if !(1..=SET_NODES_MAX).contains(&strategy.nodes()) {
            return Some(format!("sets of {} nodes", strategy.nodes()));
        }
        let generator = strategy.generator().method().complaint();
        let complaint = generator.or_else(|| strategy.among().method().complaint());
        if let Some(complaint) = complaint {
            return Some(complaint.to_string());
        }
    }
    None
}

fn criteria_complaint(problem: &Problem) -> Option<String> {
    for evaluator in problem.evaluators() {
        let method = evaluator.method();
        if let Some(complaint) = method.complaint() {
            return Some(complaint.to_string());
        }
        if method.needs_query() && problem.query().is_none() {
            return Some(format!("the {} evaluator without a query", method.name()));
        }
    }
    let space = problem.space();
    let mut ends = problem.query().into_iter().flat_map(Ends::all);
    if ends.any(|end| !is_in(&space, end)) {
        return Some("a query whose ends are not in the space".to_owned());
    }
    problem.limits().complaint().map(|(key, message)| format!("limits: {key}: {message}"))
}

fn counts_complaint(asked: Asked) -> Option<&'static str> {
    let largest = asked.configurations.max(asked.motions);
    (largest >= COUNT_MAX).then_some("more checks than can have been made")
}

/// Whether a local planner could have made the edge.
fn can_be(edge: &Edge) -> bool {
    Planner::from_tag(edge.planner).is_some() && edge.weight() >= 0.0
}

fn are_in(space: &Space, configs: &Configs) -> bool {
    configs.is_sound(space.len()) && configs.iter().all(|q| is_in(space, q))
}

/// Whether the configurations of a path are in the space. Between nodes they need not have the form of those.
fn is_path_in(space: &Space, configs: &Configs) -> bool {
    let is_in = |q: &[f64]| {
        space.factors().iter().all(|factor| match factor.kind {
            FactorKind::Real { min, max } => {
                let slack = SLACK * (1.0 + min.abs() + max.abs());
                (min - slack..=max + slack).contains(&q[factor.at])
            }
            FactorKind::Angle => q[factor.at].abs() <= 2.0 * PI,
            FactorKind::Rotation => {
                let quaternion = &q[factor.at..factor.at + 4];
                let square: f64 = quaternion.iter().map(|value| value * value).sum();
                (square - 1.0).abs() <= 1e-6
            }
        })
    };
    !configs.is_empty() && configs.is_sound(space.len()) && configs.iter().all(is_in)
}

/// Whether a configuration has finite values within the bounds and the form in which configurations are stored.
fn is_in(space: &Space, q: &[f64]) -> bool {
    q.len() == space.len()
        && q.iter().all(|value| value.is_finite())
        && space.within_bounds(q)
        && space.factors().iter().all(|factor| match factor.kind {
            FactorKind::Real { .. } => true,
            FactorKind::Angle => q[factor.at].abs() <= PI + SLACK,
            FactorKind::Rotation => {
                let quaternion = &q[factor.at..factor.at + 4];
                let square: f64 = quaternion.iter().map(|value| value * value).sum();
                let first = quaternion.iter().find(|value| **value != 0.0);
                (square - 1.0).abs() <= SLACK && first.is_some_and(|first| *first > 0.0)
            }
        })
}
