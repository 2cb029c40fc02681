//! Every table and figure of chapters 4 and 5 of H.-Y. Yeh's dissertation (2016), measured again, one at a time.
//!
//! ```text
//! cargo bench --bench uniform -- table-4.1 [--runs N] [--seconds S] [--csv FILE] [--svg FILE] [CASE …]
//! cargo bench --bench uniform                 # lists what there is
//! ```
//!
//! A study has cases: a scene with a sampler and its settings. Each case is run N times (default 40) with the seeds 1 to N; with
//! names of cases only these are run. With `--csv` each run gets a line in the file as it ends, and runs that stand there are not
//! done again, so that a study that was interrupted goes on where it was. Prints a table in Markdown, our numbers beside the
//! dissertation's, and whether they agree, by a verdict that the study states in its own file, before it was run. `--svg` draws the
//! figure. S bounds the CPU seconds of a run (default 600) where a run may not end by itself. Times are CPU seconds of this machine.
//!
//! `surfaces` are chapter 4 (UOBPRM), `axes` chapter 5 (UMAPRM).

mod axes;
mod runs;
#[path = "../support/mod.rs"]
mod support;
mod surfaces;

use runs::Runs;
use std::path::PathBuf;

/// A table or a figure.
pub struct Study {
    /// As it is asked for: `table-4.1`.
    pub name: &'static str,
    /// What it shows, in a line.
    pub about: &'static str,
    /// Runs it and prints its table.
    pub run: fn(&mut Bench),
}

/// What a study is asked for, and what it has at hand.
pub struct Bench {
    /// How often each case is run.
    pub runs: u64,
    /// The most CPU seconds of a run that may not end by itself.
    pub seconds: f64,
    /// The cases asked for; none are all.
    cases: Vec<String>,
    study: &'static str,
    book: Runs,
    svg: Option<PathBuf>,
}

impl Bench {
    /// Whether a case is asked for.
    pub fn wants(&self, case: &str) -> bool {
        self.cases.is_empty() || self.cases.iter().any(|name| name == case)
    }

    /// The numbers of each run of a case, in the order of the seeds: those that stand in the file, and else those of `measure`, which gets
    /// the seed.
    pub fn case(&mut self, case: &str, measure: impl FnMut(u64) -> Vec<f64>) -> Vec<Vec<f64>> {
        self.case_of(self.study, case, measure)
    }

    /// The same, of a case that belongs to another study, so that two figures of the same runs share them.
    pub fn case_of(
        &mut self,
        study: &str,
        case: &str,
        mut measure: impl FnMut(u64) -> Vec<f64>,
    ) -> Vec<Vec<f64>> {
        let book = &mut self.book;
        (1..=self.runs).map(|seed| book.run(study, case, seed, || measure(seed))).collect()
    }

    /// Writes the figure, if there is a file for it.
    pub fn draw(&self, svg: &str) {
        if let Some(path) = &self.svg {
            std::fs::write(path, svg).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        }
    }
}

fn main() {
    let studies: Vec<&Study> = surfaces::STUDIES.iter().chain(axes::STUDIES).collect();
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    let Some(name) = words.next() else {
        studies.iter().for_each(|study| println!("{:12} {}", study.name, study.about));
        return;
    };
    let study = studies.iter().find(|study| study.name == name);
    let study = study.unwrap_or_else(|| panic!("{name}: no study"));
    let (mut runs, mut seconds, mut csv, mut svg, mut cases) = (40, 600.0, None, None, Vec::new());
    while let Some(word) = words.next() {
        let mut next = || words.next().unwrap_or_else(|| panic!("something after {word}"));
        match word.as_str() {
            "--runs" => runs = next().parse().expect("a number of runs"),
            "--seconds" => seconds = next().parse().expect("a number of seconds"),
            "--csv" => csv = Some(PathBuf::from(next())),
            "--svg" => svg = Some(PathBuf::from(next())),
            _ => cases.push(word),
        }
    }
    let book = Runs::open(csv.as_deref());
    (study.run)(&mut Bench { runs, seconds, cases, study: study.name, book, svg });
}
