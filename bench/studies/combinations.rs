use super::Study;
use crate::support::median;
use crate::support::noting::{Noted, note};
use roadmill::evaluate::EvaluatorKind;
use roadmill::img::Setup;
use std::sync::Arc;

/// As a problem file names them.
const CRITERIA: [&str; 11] = [
    "query = {}",
    "coverage = {}",
    "connectivity = {}",
    "information-gain = {}",
    "expansion = {}",
    "max-flow = { flow = 4 }",
    "all = [{ coverage = {} }, { connectivity = {} }]",
    "any = [{ connectivity = {} }, { information-gain = {} }]",
    "all = [{ connectivity = {} }, { information-gain = {} }]",
    "all = [{ expansion = {} }, { max-flow = { flow = 4 } }]",
    "all = [{ information-gain = {} }, { not = { connectivity = {} } }]",
];

/// Prints at what size each criterion is first met, and what the roadmap is then worth.
pub fn run(study: &Study) {
    let criteria = CRITERIA.map(|text| {
        toml::from_str::<EvaluatorKind>(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    });
    let how = study.choices.attaching();
    println!("| environment | criterion | met | nodes | connectible % | solved % | CPU s |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for environment in &study.environments {
        let tests = study.choices.hundred(
            environment,
            &study.choices.problem(environment).context(),
            (0, "tests"),
        );
        let builds: Vec<Vec<Noted>> = (1..=study.seeds)
            .map(|seed| {
                let setup = Arc::new(Setup::new(study.problem(environment, seed)));
                note(&setup, &criteria, Some((&tests, &how)), study.choices.cap(), &mut |_| ()).0
            })
            .collect();
        for (index, text) in CRITERIA.iter().enumerate() {
            let noted = || builds.iter().map(|build| &build[index]);
            let middle =
                |of: &dyn Fn(&Noted) -> f64| median(&mut noted().map(of).collect::<Vec<f64>>());
            println!(
                "| {} | `{text}` | {} of {} | {} | {:.0} | {:.0} | {:.1} |",
                environment.title,
                noted().filter(|noted| noted.satisfied).count(),
                study.seeds,
                middle(&|noted| noted.nodes as f64),
                middle(&|noted| 100.0 * noted.connectible),
                middle(&|noted| 100.0 * noted.solved),
                middle(&|noted| noted.seconds),
            );
        }
    }
}
