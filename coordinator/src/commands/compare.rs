//! Strategies side by side: one build per strategy and seed, each in a run folder of its own.

use super::build::bounded_problem;
use super::load::load;
use crate::cli::CompareArguments;
use crate::exit::{Code, Failure};
use crate::files::{cannot_write, write_whole};
use crate::output::{json, line, note};
use crate::progress::Reporter;
use crate::run::ledger::LEDGER;
use crate::run::{Scan, outside_of_runs, run_cpu_seconds_in};
use crate::signals::Signals;
use crate::work::{Recorded, Run, Workers};
use roadmill::evaluate::{Coverage, Evaluator, EvaluatorKind, Not};
use roadmill::export::{ComparedBuild, ComparedStrategy, Comparison, RoundOutcome};
use roadmill::model::Scratch;
use roadmill::problem::{Problem, StrategySpec};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The word that stands for the problem's own strategies.
const OWN: &str = "own";
/// The evaluator that judges each roadmap at its end draws by a stream of its own.
const COVERAGE_PATH: &str = "compare";

/// A build of a comparison.
struct Asked<'a> {
    seed: u64,
    label: &'a str,
    problem: &'a Problem,
    /// Its run folder.
    folder: PathBuf,
}

/// Compares strategies on a problem.
pub fn compare(arguments: &CompareArguments) -> Result<Code, Failure> {
    let problem = load(&arguments.problem)?;
    let out = &arguments.out;
    outside_of_runs(out)?;
    if problem.evaluators().is_empty() {
        return Err(Failure::usage(
            "the problem has no evaluators, so that nothing says when a roadmap is large enough; \
             a [query] or [[evaluators]] expected",
        ));
    }
    let mut compared: Vec<(String, Problem)> = Vec::new();
    for text in &arguments.strategies {
        let (label, changed) = changed(&problem, text, arguments.go_on)?;
        if compared.iter().any(|(known, _)| *known == label) {
            return Err(Failure::usage(format!("--strategies: `{label}` found twice")));
        }
        compared.push((label, changed));
    }
    // What cannot be used of the command line is said before anything is grown.
    let (_, workers) = bounded_problem(problem.clone(), &arguments.growth)?;
    let runs = out.join("runs");
    fs::create_dir_all(&runs).map_err(|error| cannot_write(&runs, &error))?;
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let mut comparison = Comparison {
        problem: problem.name().to_owned(),
        strategies: compared.iter().map(|(label, _)| label.clone()).collect(),
        evaluators: Vec::new(),
        builds: Vec::new(),
    };
    // Seed after seed, so that a comparison that is cut off has about as many builds of each strategy.
    let mut builds = Vec::new();
    for seed in arguments.each_seed() {
        for (label, problem) in &compared {
            let folder = runs.join(format!("{label}-{seed}"));
            builds.push(Asked { seed, label, problem, folder });
        }
    }
    // Builds that have ended come first and are told together, so that the tables never have less than there is.
    let (ended, open): (Vec<_>, Vec<_>) =
        builds.iter().enumerate().partition(|(_, asked)| has_ended(&asked.folder));
    let mut done: BTreeMap<usize, ComparedBuild> = BTreeMap::new();
    for (index, asked) in ended.iter().chain(&open) {
        let run = grown(asked, arguments, &workers, &signals)?;
        let built = read(&run, asked)?;
        if comparison.evaluators.is_empty() {
            comparison.evaluators = evaluators(&run);
        }
        say(&built, arguments.growth.json);
        done.insert(*index, built);
        if done.len() >= ended.len() {
            comparison.builds = done.values().cloned().collect();
            write(&comparison, out)?;
        }
    }
    if !arguments.growth.json {
        say_summary(&comparison.summary());
        note(format_args!("tables and charts: {}", out.join("compare.html").display()));
    }
    Ok(Code::Done)
}

/// Whether a build in this folder has ended, and would end at once if it went on.
fn has_ended(folder: &Path) -> bool {
    let scan = folder.join(LEDGER).is_file().then(|| Scan::read(folder).ok());
    let stopped = scan.flatten().and_then(|scan| scan.stopped);
    stopped.is_some_and(|stopped| stopped.is_final())
}

/// Grows a build, or takes the one that is there.
fn grown(
    asked: &Asked,
    arguments: &CompareArguments,
    workers: &Workers,
    signals: &Arc<Signals>,
) -> Result<Recorded, Failure> {
    let (folder, growth) = (&asked.folder, &arguments.growth);
    let (problem, _) = bounded_problem(asked.problem.clone().with_seed(asked.seed), growth)?;
    let mut reporter = Reporter::new(false);
    let growing = Run::begin(problem.clone()).folder(folder).or_resume().workers(workers);
    let growing = growing.signals(signals).max_seconds(growth.max_time);
    let growing = growing.max_memory(growth.max_memory);
    let ended = growing.progress(|status| reporter.report(status)).grow();
    reporter.finish();
    let ended = ended.map_err(|failure| explained(failure, folder, &problem))?;
    if let (Code::Interrupted, _) = ended.outcome() {
        let message = "a signal came; the same command goes on where it was";
        return Err(Failure::new(Code::Interrupted, message));
    }
    Run::at(folder).read()
}

/// The failure of a build, with what to do where the run that is there was asked for otherwise.
fn explained(failure: Failure, folder: &Path, problem: &Problem) -> Failure {
    let scan = Scan::read(folder).ok().filter(|_| failure.code == Code::Usage);
    let Some(there) = scan.and_then(|scan| scan.problem().ok()) else { return failure };
    let limits = |problem: &Problem| (problem.limits().nodes, problem.limits().sets);
    let otherwise = if there.evaluators() != problem.evaluators() {
        "by other criteria, or with or without --go-on"
    } else if limits(&there) != limits(problem) {
        "within other limits"
    } else if there.scene_difference(problem).is_some()
        || there.strategies() != problem.strategies()
    {
        "of another problem or strategy"
    } else {
        return failure;
    };
    Failure::usage(format!(
        "{}: a build {otherwise} found; the runs of a comparison are all of one kind, so another --out is expected",
        folder.display()
    ))
}

/// The problem with another strategy, and the strategy's label.
fn changed(problem: &Problem, text: &str, go_on: bool) -> Result<(String, Problem), Failure> {
    let refuse = |error: String| Failure::usage(format!("--strategies: {error}"));
    let mut builder = problem.to_builder();
    let label = if text.trim() == OWN {
        OWN.to_owned()
    } else {
        let strategy = StrategySpec::parse(text).map_err(refuse)?;
        let label = strategy.name().to_owned();
        if label == OWN {
            return Err(refuse(format!(
                "`{OWN} = …` found; `{OWN}` alone stands for the problem's strategies, another label expected"
            )));
        }
        builder = builder.default_schedule().strategies([strategy]);
        label
    };
    if !label.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c))
        || label.starts_with('.')
    {
        let expected =
            "a label of letters, digits, `-`, `_` and `.` expected, since a folder has its name";
        return Err(refuse(format!("`{label}` found; {expected}")));
    }
    if go_on {
        // A criterion and its opposite: together they are never met, so that only limits end the build.
        let first = problem.evaluators()[0].clone();
        builder = builder.evaluator(EvaluatorKind::Not(Not(Box::new(first))));
    }
    let built = builder.build_with(&crate::run::Ledgers);
    Ok((label, built.map_err(|error| refuse(error.to_string()))?))
}

/// What a run came to.
fn read(run: &Recorded, asked: &Asked) -> Result<ComparedBuild, Failure> {
    let coverage = Coverage::default().evaluate(
        run.context(),
        COVERAGE_PATH,
        run.roadmap(),
        &mut Scratch::new(),
    );
    let own = own_evaluators(run.problem());
    let is_met = |round: &&RoundOutcome| {
        !round.satisfied.is_empty() && round.satisfied.iter().take(own.len()).all(|met| *met)
    };
    let values = |round: &RoundOutcome| {
        let values = round.numbers.iter().filter(|number| number.threshold.is_some());
        values.map(|number| number.value).take(leaves(own)).collect()
    };
    let judged_rounds = run.rounds().iter().filter(|round| !round.numbers.is_empty());
    Ok(ComparedBuild {
        strategy: asked.label.to_owned(),
        seed: asked.seed,
        nodes: run.roadmap().configs().len() as u64,
        edges: run.roadmap().edges().len() as u64,
        cpu_seconds: run_cpu_seconds_in(&asked.folder, run.digest()),
        enough: run.rounds().iter().find(is_met).map(|round| round.nodes),
        coverage: coverage.value,
        rounds: judged_rounds.map(|round| (round.nodes, values(round))).collect(),
    })
}

/// The evaluators that decide, without the opposite of the first that keeps a build going.
fn own_evaluators(problem: &Problem) -> &[EvaluatorKind] {
    match problem.evaluators() {
        [first, between @ .., EvaluatorKind::Not(Not(last))] if **last == *first => {
            &problem.evaluators()[..between.len() + 1]
        }
        all => all,
    }
}

/// How many evaluators there are that are not made of others.
fn leaves(evaluators: &[EvaluatorKind]) -> usize {
    let count = |evaluator: &EvaluatorKind| match evaluator.method().parts() {
        [] => 1,
        parts => leaves(parts),
    };
    evaluators.iter().map(count).sum()
}

/// The names of these evaluators, each with the value that it asks for, as the first judged round has them.
fn evaluators(run: &Recorded) -> Vec<(String, f64)> {
    let count = leaves(own_evaluators(run.problem()));
    let numbers = run.rounds().iter().find(|round| !round.numbers.is_empty());
    let numbers = numbers.map_or(&[][..], |round| &round.numbers);
    let asked = numbers.iter().filter_map(|number| Some((number.name.clone(), number.threshold?)));
    asked.take(count).collect()
}

fn say(built: &ComparedBuild, is_json: bool) {
    let ComparedBuild { strategy, seed, nodes, edges, cpu_seconds, enough, coverage, .. } = built;
    if is_json {
        json(&serde_json::json!({
            "event": "build", "strategy": strategy, "seed": seed, "nodes": nodes, "edges": edges,
            "cpu_seconds": cpu_seconds, "nodes_when_met": enough, "coverage": coverage,
        }));
        return;
    }
    let met = match enough {
        None => format!("criteria not met with {nodes} nodes"),
        Some(enough) => format!("criteria met with {enough} nodes"),
    };
    let cpu = cpu_seconds.map_or("CPU s not known".to_owned(), |known| format!("{known:.2} CPU s"));
    note(format_args!("{strategy}, seed {seed}: {met}, {cpu}, coverage {coverage:.2}"));
}

fn say_summary(summary: &[ComparedStrategy]) {
    let width = summary.iter().map(|of| of.strategy.len()).max().unwrap_or(0).max(8);
    let three = |spread: Option<[f64; 3]>, decimals: usize| match spread {
        None => "-".to_owned(),
        Some([least, median, most]) => {
            format!("{median:.decimals$} ({least:.decimals$} to {most:.decimals$})")
        }
    };
    line(format_args!(
        "{:width$}  {:>9}  {:>24}  {:>24}  {:>8}",
        "strategy", "met", "nodes", "cpu seconds", "coverage"
    ));
    for of in summary {
        let ComparedStrategy { strategy, builds, enough, nodes, cpu_seconds, coverage } = of;
        line(format_args!(
            "{strategy:width$}  {:>9}  {:>24}  {:>24}  {coverage:>8.2}",
            format!("{enough} of {builds}"),
            three(*nodes, 0),
            three(*cpu_seconds, 2)
        ));
    }
}

/// Writes the tables and the page, after every build, so that what there is can be looked at.
fn write(comparison: &Comparison, out: &Path) -> Result<(), Failure> {
    write_whole(&out.join("compare.csv"), comparison.csv())?;
    write_whole(&out.join("curves.csv"), comparison.curves_csv())?;
    write_whole(&out.join("compare.html"), comparison.html())
}
