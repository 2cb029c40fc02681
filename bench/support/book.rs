//! Builds that a bench has done, in a file, so that a bench which was interrupted goes on where it was.

use super::median;
use std::fs::File;
use std::io::Write;

/// One build.
#[derive(Clone, Copy)]
pub struct Build {
    pub seed: u64,
    pub solved: bool,
    pub nodes: f64,
    /// CPU seconds.
    pub seconds: f64,
    /// Whether there was a path that the judge did not let pass.
    pub refused: bool,
}

/// Builds of one scene by one program.
pub struct Builds {
    pub scene: String,
    pub program: String,
    pub all: Vec<Build>,
}

impl Builds {
    pub fn median_seconds(&self) -> f64 {
        median(&mut self.all.iter().map(|build| build.seconds).collect::<Vec<_>>())
    }

    /// A line of the table, whose last column is `of` in units of the median.
    pub fn row(&self, of: f64) -> String {
        let values: [fn(&Build) -> f64; 2] = [|build| build.nodes, |build| build.seconds];
        let [nodes, seconds] = values.map(|value| {
            let mut values: Vec<f64> = self.all.iter().map(value).collect();
            (median(&mut values), values[0], values[values.len() - 1])
        });
        let count = |is: fn(&Build) -> bool| self.all.iter().filter(|build| is(build)).count();
        format!(
            "| {} | {} | {} of {} | {} | {:.0} ({:.0}–{:.0}) | {:.3} ({:.3}–{:.2}) | {:.1} |",
            self.scene,
            self.program,
            count(|build| build.solved),
            self.all.len(),
            count(|build| build.refused),
            nodes.0,
            nodes.1,
            nodes.2,
            seconds.0,
            seconds.1,
            seconds.2,
            of / seconds.0,
        )
    }
}

const HEAD: &str = "scene,program,seed,solved,nodes,cpu_seconds,refused\n";

/// The builds that were done, in a file if there is one.
pub struct Book {
    done: Vec<Builds>,
    file: Option<File>,
}

impl Book {
    pub fn open(path: Option<&str>) -> Book {
        let Some(path) = path else { return Book { done: Vec::new(), file: None } };
        let text = std::fs::read_to_string(path).unwrap_or_default();
        let opened = File::options().create(true).append(true).open(path);
        let mut file = opened.unwrap_or_else(|error| panic!("{path}: {error}"));
        if text.is_empty() {
            file.write_all(HEAD.as_bytes()).expect("the file can be written");
        }
        Book { done: of_csv(&text), file: Some(file) }
    }

    /// A build of a scene by a program that was done, or else is done now and written down.
    pub fn build(
        &mut self,
        (scene, program): (&str, &str),
        seed: u64,
        build: impl FnOnce() -> Build,
    ) -> Build {
        let known = self.done.iter().find(|b| b.scene == scene && b.program == program);
        let known = known.and_then(|builds| builds.all.iter().find(|build| build.seed == seed));
        if let Some(known) = known {
            return *known;
        }
        let done = build();
        if let Some(file) = &mut self.file {
            let Build { seed, solved, nodes, seconds, refused } = done;
            let [solved, refused] = [solved, refused].map(u8::from);
            let line =
                format!("{scene},{program},{seed},{solved},{nodes},{seconds:.4},{refused}\n");
            file.write_all(line.as_bytes()).expect("the file can be written");
        }
        done
    }
}

/// The builds that a file tells of.
pub fn of_csv(text: &str) -> Vec<Builds> {
    let mut all: Vec<Builds> = Vec::new();
    for line in text.lines().skip(1) {
        let words: Vec<&str> = line.split(',').collect();
        let (scene, program) = (words[0].to_owned(), words[1].to_owned());
        let number = |word: usize| words[word].parse::<f64>().expect("a number");
        let known = all.iter().position(|b| b.scene == scene && b.program == program);
        let index = known.unwrap_or_else(|| {
            all.push(Builds { scene, program, all: Vec::new() });
            all.len() - 1
        });
        all[index].all.push(Build {
            seed: words[2].parse().expect("a seed"),
            solved: number(3) == 1.0,
            nodes: number(4),
            seconds: number(5),
            // Files of before have no such column.
            refused: words.get(6).is_some_and(|word| *word == "1"),
        });
    }
    all
}
