use super::Study;
use crate::support::median;
use crate::support::noting::{Noted, note};
use roadmill::evaluate::{EvaluatorKind, Query};
use roadmill::img::Setup;
use roadmill::schedule::Adaptive;
use std::sync::Arc;

/// Prints what it takes to solve the query when every strategy gets as many sets, and when the schedule adapts.
pub fn run(study: &Study) {
    let how = study.choices.attaching();
    let query = EvaluatorKind::Query(Query { neighbors: how.neighbors, planners: how.planners });
    println!("| environment | schedule | solved | nodes | asked for | CPU s |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for environment in &study.environments {
        let mut ways = vec![("equal".to_owned(), None)];
        for rounds in [3, 10] {
            ways.push((format!("adaptive, {rounds} rounds"), Some(Adaptive { rounds })));
        }
        for (name, adaptive) in ways {
            let mut noted: Vec<Noted> = Vec::new();
            for seed in 1..=study.seeds {
                let mut problem = study.problem(environment, seed);
                if let Some(adaptive) = adaptive {
                    let adapting = problem.to_builder().adaptive(adaptive).build();
                    problem = adapting.unwrap_or_else(|error| panic!("{error}"));
                }
                let setup = Arc::new(Setup::new(problem));
                let cap = study.choices.cap();
                noted.extend(note(&setup, std::slice::from_ref(&query), None, cap, &mut |_| ()).0);
            }
            let middle = |of: &dyn Fn(&Noted) -> f64| {
                median(&mut noted.iter().map(of).collect::<Vec<f64>>())
            };
            println!(
                "| {} | {name} | {} of {} | {} | {} | {:.2} |",
                environment.title,
                noted.iter().filter(|noted| noted.satisfied).count(),
                study.seeds,
                middle(&|noted| noted.nodes as f64),
                middle(&|noted| noted.cost as f64),
                middle(&|noted| noted.seconds),
            );
        }
    }
}
