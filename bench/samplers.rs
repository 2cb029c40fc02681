//! Samplers compared: what each costs until a problem's criteria are met.
//!
//! ```text
//! cargo bench --bench samplers -- problems/cage.toml 'uniform = {}' 'bridge = { deviation = 0.5 }'
//! ```
//!
//! Words with `=` are samplers as a problem file names them; the others are problems, built with each of the
//! samplers in the place of their strategies' own, with five seeds. The cost is counted, not timed: nodes,
//! and the configurations and motions asked for, over all sets, joins and evaluations, up to the end of the
//! round that met the criteria. A build ends at `NODES_MAX` nodes; such seeds are counted as unsolved and
//! stay in the medians.

use roadmill::img::{Core, Judgement, Observer, Round, Serial, Setup, Stop, drive};
use roadmill::problem::Problem;
use roadmill::roadmap::Roadmap;
use roadmill::sampler::SamplerKind;
use roadmill::validity::Asked;
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

const SEEDS: u64 = 5;
const NODES_MAX: u64 = 30_000;

fn main() {
    let words: Vec<String> =
        std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let (samplers, problems): (Vec<&String>, Vec<&String>) =
        words.iter().partition(|word| word.contains('='));
    println!(
        "| problem | sampler | unsolved | nodes, each seed | nodes | motions | configurations |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for problem in problems {
        for sampler in &samplers {
            compare(problem, sampler);
        }
    }
}

fn compare(path: &str, text: &str) {
    let mut problem = Problem::load(Path::new(path)).unwrap_or_else(|error| panic!("{error}"));
    let sampler: SamplerKind =
        toml::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(sampler.method().complaint(), None);
    sampler.method().suits(&problem.context()).unwrap_or_else(|error| panic!("{text}: {error}"));
    problem.strategies.iter_mut().for_each(|strategy| strategy.sampler = sampler.clone());
    problem.limits.nodes = NODES_MAX;
    let costs: Vec<Cost> =
        (1..=SEEDS).map(|seed| build(Problem { seed, ..problem.clone() })).collect();
    let unsolved = costs.iter().filter(|cost| !cost.solved).count();
    let each: Vec<String> = costs.iter().map(|cost| cost.nodes.to_string()).collect();
    let median = |of: fn(&Cost) -> u64| {
        let mut values: Vec<u64> = costs.iter().map(of).collect();
        values.sort_unstable();
        values[values.len() / 2]
    };
    println!(
        "| {} | `{text}` | {unsolved} | {} | {} | {} | {} |",
        problem.name,
        each.join(" "),
        median(|cost| cost.nodes),
        median(|cost| cost.asked.motions),
        median(|cost| cost.asked.configurations)
    );
}

#[derive(Default)]
struct Cost {
    solved: bool,
    nodes: u64,
    asked: Asked,
}

impl Observer for Cost {
    type Error = Infallible;

    fn folded(&mut self, round: &Round, roadmap: &Roadmap) -> Result<(), Infallible> {
        self.nodes = roadmap.configs().len() as u64;
        for set in &round.sets {
            self.asked += set.increment.asked;
            self.asked += set.joined.asked;
        }
        Ok(())
    }

    fn judged(&mut self, judgement: &Judgement) -> Result<(), Infallible> {
        judgement.verdicts.iter().for_each(|verdict| self.asked += verdict.asked);
        Ok(())
    }
}

fn build(problem: Problem) -> Cost {
    let setup = Arc::new(Setup::new(problem));
    let mut cost = Cost::default();
    let Ok(stop) = drive(&mut Core::new(&setup, 0), &mut Serial::new(setup.clone()), &mut cost);
    cost.solved = stop == Stop::Satisfied;
    cost
}
