//! Runs that a study has done, in a file, so that a study which was interrupted goes on where it was.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Study, case and seed.
type Key = (String, String, u64);

/// The runs that were done, in a file if there is one: a line each, `study,case,seed,number,number,…`. Cases have no commas.
pub struct Runs {
    done: BTreeMap<Key, Vec<f64>>,
    file: Option<File>,
}

impl Runs {
    pub fn open(path: Option<&Path>) -> Runs {
        let Some(path) = path else { return Runs { done: BTreeMap::new(), file: None } };
        let text = std::fs::read_to_string(path).unwrap_or_default();
        let file = File::options().create(true).append(true).open(path);
        let file = file.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Runs { done: text.lines().filter_map(line).collect(), file: Some(file) }
    }

    /// The numbers of a run that was done, or else is done now and written down.
    pub fn run(
        &mut self,
        study: &str,
        case: &str,
        seed: u64,
        measure: impl FnOnce() -> Vec<f64>,
    ) -> Vec<f64> {
        let key = (study.to_owned(), case.to_owned(), seed);
        if let Some(known) = self.done.get(&key) {
            return known.clone();
        }
        let numbers = measure();
        if let Some(file) = &mut self.file {
            let words: Vec<String> = numbers.iter().map(f64::to_string).collect();
            let line = format!("{study},{case},{seed},{}\n", words.join(","));
            file.write_all(line.as_bytes()).expect("the file can be written");
        }
        self.done.insert(key, numbers.clone());
        numbers
    }
}

/// A line; `None` for one that was cut off when a study was interrupted.
fn line(text: &str) -> Option<(Key, Vec<f64>)> {
    let mut words = text.split(',');
    let (study, case) = (words.next()?.to_owned(), words.next()?.to_owned());
    let seed = words.next()?.parse().ok()?;
    let numbers: Result<Vec<f64>, _> = words.map(str::parse).collect();
    numbers.ok().filter(|numbers| !numbers.is_empty()).map(|numbers| ((study, case, seed), numbers))
}
