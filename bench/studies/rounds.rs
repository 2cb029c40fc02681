use super::Study;
use crate::support::noting::note;
use crate::support::panels::{Look, Panel, Series, svg};
use crate::support::plot::COLOURS;
use roadmill::evaluate::EvaluatorKind;
use roadmill::img::Setup;
use roadmill::model::Scratch;
use std::sync::Arc;

/// Draws what expansion, information gain and connectivity measure, round by round, of one build each.
pub fn run(study: &Study) {
    let mut panels = Vec::new();
    for environment in &study.environments {
        let setup = Arc::new(Setup::new(study.problem(environment, 1)));
        let how = study.choices.attaching();
        let tests = study.choices.hundred(environment, setup.context(), (0, "tests"));
        let [expansion, gain] = ["expansion = {}", "information-gain = {}"]
            .map(|text| toml::from_str::<EvaluatorKind>(text).expect("an evaluator"));
        let solved = how.connectivity(tests, 75.0);
        let diameter = setup.context().space().diameter();
        let mut scratch = Scratch::new();
        let mut lines: [Vec<[f64; 2]>; 5] = Default::default();
        let mut each = |roadmap: &roadmill::roadmap::Roadmap| {
            let [expansion, gain, solved] = [&expansion, &gain, &solved].map(|kind| {
                kind.method().evaluate(setup.context(), "tests", roadmap, &mut scratch)
            });
            let (widths, shares) = (&expansion.measures, &gain.measures);
            let now = [
                widths[0] / diameter,
                widths[1] / diameter,
                expansion.value,
                shares[0].max(shares[1]),
                solved.value,
            ];
            for (line, value) in lines.iter_mut().zip(now) {
                line.push([roadmap.configs().len() as f64, 100.0 * value]);
            }
        };
        note(&setup, &[], None, study.choices.cap(), &mut each);
        let first = |line: &[[f64; 2]], below: f64| {
            let met = line.iter().find(|point| point[1] <= below);
            met.map_or("never".to_owned(), |point| format!("at {} nodes", point[0]))
        };
        println!(
            "{}: expansion first met {}, information gain {}",
            environment.title,
            first(&lines[2], 1.0),
            first(&lines[3], 5.0)
        );
        let names = ["width", "separation", "expansion", "information gain", "tests solved"];
        let series = names.iter().zip(COLOURS).zip(lines).map(|((name, colour), points)| Series {
            name: (*name).to_owned(),
            colour,
            look: Look::Line,
            points,
        });
        panels.push(Panel {
            title: environment.title.to_owned(),
            x_label: "nodes".to_owned(),
            y_label: "%".to_owned(),
            log_y: false,
            words: Vec::new(),
            series: series.collect(),
        });
    }
    let path = study.out.join("rounds.svg");
    std::fs::write(&path, svg(&panels)).expect("the picture can be written");
    println!("{}", path.display());
}
