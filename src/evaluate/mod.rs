//! Evaluators: is the roadmap large enough? One file per method (TR05-007 §3.2).
//!
//! An evaluator is a pure function of the problem and the folded roadmap: it remembers nothing
//! from round to round, so that a resumed build judges as an undisturbed one.
//!
//! ```
//! use roadmill::evaluate::{Evaluator, Query};
//! use roadmill::{Build, model::Scratch, problem::Problem};
//!
//! let problem = Problem::load("problems/maze.toml".as_ref())?;
//! let built = Build::new(problem).run()?;
//! let (cx, roadmap) = (built.context(), built.roadmap());
//! let verdict = Query::default().evaluate(cx, "by hand", roadmap, &mut Scratch::new());
//! assert!(verdict.satisfied);
//! assert!(verdict.answer().is_some_and(|answer| answer.path.is_some()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod all;
mod any;
mod attaching;
mod barrier_trend;
mod connectivity;
mod coverage;
mod disjoint_paths;
mod expansion;
mod exposed_surface;
mod flow;
mod flow_ratio;
mod formation_order;
mod information_gain;
mod lowest_barrier;
mod max_flow;
mod network;
mod not;
mod query;
mod samples;
mod verdict;

methods! {
    /// The evaluators, as a problem file names them.
    pub enum EvaluatorKind: dyn Evaluator {
        Query(query::Query),
        Coverage(coverage::Coverage),
        Connectivity(connectivity::Connectivity),
        All(all::All),
        Any(any::Any),
        Not(not::Not), // new ones at the end, since ledgers know methods by number
        Expansion(expansion::Expansion),
        MaxFlow(max_flow::MaxFlow),
        InformationGain(information_gain::InformationGain),
        LowestBarrier(lowest_barrier::LowestBarrier),
        FlowRatio(flow_ratio::FlowRatio),
        BarrierTrend(barrier_trend::BarrierTrend),
        DisjointPaths(disjoint_paths::DisjointPaths),
        FormationOrder(formation_order::FormationOrder),
        ExposedSurface(exposed_surface::ExposedSurface),
    }
}

pub use all::All;
pub use any::Any;
pub use barrier_trend::BarrierTrend;
pub use connectivity::Connectivity;
pub use coverage::Coverage;
pub use disjoint_paths::DisjointPaths;
pub use expansion::Expansion;
pub use exposed_surface::ExposedSurface;
pub use flow_ratio::FlowRatio;
pub use formation_order::FormationOrder;
pub use information_gain::InformationGain;
pub use lowest_barrier::LowestBarrier;
pub use max_flow::MaxFlow;
pub use not::Not;
pub use query::Query;
pub use samples::{Drawn, Samples};
pub use verdict::{Bound, CutEdge, Verdict};

use crate::context::Context;
use crate::methods::{BRACKETS_OF_SETTINGS, Complaint, methods};
use crate::model::{Asked, Scratch};
use crate::query::Attachment;
use crate::roadmap::Roadmap;

/// A criterion on roadmaps.
pub trait Evaluator {
    /// The criterion's name in progress reports and summaries.
    fn name(&self) -> &'static str;

    /// Judges the roadmap. Randomness, if any, comes from the seed that [`Seed::of_evaluator`](crate::seed::Seed::of_evaluator) gives
    /// for `path`, the evaluator's place in the tree of evaluators.
    fn evaluate(
        &self,
        cx: &Context,
        path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict;

    /// The names of [`Verdict::measures`], in their order.
    fn measures(&self) -> &'static [&'static str] {
        &[]
    }

    /// The criteria that a combined criterion is made of.
    fn parts(&self) -> &[EvaluatorKind] {
        &[]
    }

    /// Whether the criterion, as a problem file writes it, has at most so many brackets within one another.
    fn is_within(&self, brackets: u32) -> bool {
        // { all = [ …
        let rest = brackets.checked_sub(2);
        let parts = |rest| self.parts().iter().all(|part| part.method().is_within(rest));
        brackets >= BRACKETS_OF_SETTINGS && rest.is_some_and(parts)
    }

    /// Whether the criterion needs the problem to have a query.
    fn needs_query(&self) -> bool {
        self.parts().iter().any(|part| part.method().needs_query())
    }

    /// Whether the criterion is defined for a query with several goals.
    fn knows_several_goals(&self) -> bool {
        match self.parts() {
            [] => !self.needs_query(),
            parts => parts.iter().all(|part| part.method().knows_several_goals()),
        }
    }

    /// How the evaluator attaches configurations to the roadmap, if it does.
    fn attachment(&self) -> Option<Attachment> {
        self.parts().iter().find_map(|part| part.method().attachment())
    }

    /// What is wrong with the settings.
    fn complaint(&self) -> Option<Complaint> {
        self.parts().iter().find_map(|part| part.method().complaint())
    }

    /// Checks what depends on the problem, and brings configurations among the settings into stored
    /// form.
    fn accept(&mut self, _cx: &Context) -> Result<(), String> {
        Ok(())
    }
}

/// What is wrong with a criterion, `name`, made of any number of `parts`.
fn complaint_of_parts(name: &'static str, parts: &[EvaluatorKind]) -> Option<Complaint> {
    if parts.is_empty() {
        return Some(Complaint::new(name, "[]", "at least one criterion"));
    }
    parts.iter().find_map(|part| part.method().complaint())
}

/// Brings configurations among the settings of `parts` into stored form, and checks what depends on the problem.
fn accept_parts(parts: &mut [EvaluatorKind], cx: &Context) -> Result<(), String> {
    parts.iter_mut().try_for_each(|part| part.method_mut().accept(cx))
}

/// Refuses a model without energies, for which the criterion, for people to read, is not defined.
fn accept_energies(cx: &Context, criterion: &str) -> Result<(), String> {
    let energy = |q: &[f64]| cx.model.energy(q, &mut Scratch::new());
    match cx.query.as_ref().and_then(|query| energy(&query.start)) {
        Some(_) => Ok(()),
        None => Err(format!("{criterion} found, a model with energies expected")),
    }
}

/// What is wrong with a percentage at which a change counts as none.
fn complaint_of_change(percent: f64) -> Option<Complaint> {
    let fits = percent > 0.0 && percent < 100.0;
    (!fits).then(|| Complaint::new("percent", percent, "more than 0, less than 100"))
}

/// The verdict of a criterion made of `parts`, at least `needed` of which must be satisfied.
fn combined(
    parts: &[EvaluatorKind],
    needed: usize,
    cx: &Context,
    path: &str,
    roadmap: &Roadmap,
    scratch: &mut Scratch,
) -> Verdict {
    let mut verdicts = Vec::new();
    let mut asked = Asked::default();
    // Every part is evaluated in every round, so that its values can be followed over the rounds.
    for (index, part) in parts.iter().enumerate() {
        let verdict = part.method().evaluate(cx, &format!("{path}/{index}"), roadmap, scratch);
        asked += verdict.asked;
        verdicts.push(verdict);
    }
    let satisfied = verdicts.iter().filter(|verdict| verdict.satisfied).count();
    Verdict { parts: verdicts, ..Verdict::at_least(needed as f64, satisfied as f64, asked) }
}

#[cfg(test)]
mod tests;
