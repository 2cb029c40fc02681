//! How many nodes and CPU seconds it takes to solve scenes at their default settings.
//!
//! ```text
//! cargo bench --bench scenes -- [--seeds N] [--seconds S] SCENE …
//! ```
//!
//! Builds every scene with seeds 1 to N (default 5) in this thread, until all its criteria are met or S
//! CPU seconds (default 300) have gone by, and prints one line per scene: in how many builds the
//! criteria were met, then nodes and CPU seconds as median (least–most) over all builds, met or not.

mod support;

use roadmill::img::{Core, Cut, Observer, Progress, Serial, Setup, Stop, drive};
use roadmill::problem::Problem;
use roadmill::roadmap::Roadmap;
use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;
use support::{cpu_seconds, median};

fn main() {
    let (mut seeds, mut seconds, mut scenes) = (5u64, 300.0f64, Vec::new());
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        let mut number = || words.next().and_then(|word| word.parse::<f64>().ok());
        match word.as_str() {
            "--seeds" => seeds = number().expect("a number after --seeds") as u64,
            "--seconds" => seconds = number().expect("a number after --seconds"),
            _ => scenes.push(word),
        }
    }
    println!("| scene | solved | nodes | CPU s |");
    println!("| --- | --- | --- | --- |");
    for scene in scenes {
        let (mut solved, mut nodes, mut times) = (0, Vec::new(), Vec::new());
        let problem = Problem::load(Path::new(&scene)).unwrap_or_else(|error| panic!("{error}"));
        for seed in 1..=seeds {
            let begun = cpu_seconds();
            let setup = Arc::new(Setup::new(Problem { seed, ..problem.clone() }));
            let mut core = Core::new(&setup, 0);
            let mut serial = Serial::new(setup.clone());
            let mut clock = Clock { end: begun + seconds };
            let Ok(stop) = drive(&mut core, &mut serial, &mut clock);
            solved += u64::from(stop == Stop::Satisfied);
            nodes.push(core.progress().nodes as f64);
            times.push(cpu_seconds() - begun);
        }
        let name = &problem.name;
        println!("| {name} | {solved} of {seeds} | {} | {} |", spread(nodes, 0), spread(times, 2));
    }
}

/// Ends a build when the thread's CPU time is up.
struct Clock {
    end: f64,
}

impl Observer for Clock {
    type Error = Infallible;

    fn tick(&mut self, _: &Progress, _: &Roadmap, _: usize) -> Option<Cut> {
        (cpu_seconds() >= self.end).then_some(Cut::Time)
    }
}

fn spread(mut values: Vec<f64>, digits: usize) -> String {
    let middle = median(&mut values);
    let (least, most) = (values[0], values[values.len() - 1]);
    format!("{middle:.digits$} ({least:.digits$}–{most:.digits$})")
}
