//! The file of runs: what has been measured is not measured again.

use crate::support::noting::Noted;
use std::io::Write;
use std::path::Path;

/// In the order of [`Measured::noted`].
pub const EVALUATORS: [&str; 3] = ["query", "coverage", "connectivity"];

pub const HEADER: &str = "environment,n,k,strategy,seed,evaluator,met,rounds,nodes,edges,components,\
                          connectible,solved,cost,cpu_seconds";

/// What tells one build from another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    pub environment: String,
    pub n: u32,
    pub k: u32,
    pub strategy: String,
    pub seed: u64,
}

/// A build, and its roadmap as each evaluator of [`EVALUATORS`] first was satisfied.
#[derive(Clone, Debug)]
pub struct Measured {
    pub run: Run,
    pub noted: [Noted; 3],
}

impl Measured {
    fn lines(&self) -> String {
        let Run { environment, n, k, strategy, seed } = &self.run;
        let mut text = String::new();
        for (evaluator, noted) in EVALUATORS.iter().zip(&self.noted) {
            text += &format!("{environment},{n},{k},{strategy},{seed},{evaluator},");
            let Noted { rounds, nodes, edges, components, cost, .. } = noted;
            text +=
                &format!("{},{rounds},{nodes},{edges},{components},", u8::from(noted.satisfied));
            let [connectible, solved] =
                [noted.connectible, noted.solved].map(|share| 100.0 * share);
            text += &format!("{connectible:.2},{solved:.2},{cost},{:.3}\n", noted.seconds);
        }
        text
    }
}

fn parsed(line: &str) -> Option<(Run, usize, Noted)> {
    let words: Vec<&str> = line.split(',').collect();
    let [environment, n, k, strategy, seed, evaluator, numbers @ ..] = &words[..] else {
        return None;
    };
    let numbers: Vec<f64> = numbers.iter().map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let [met, rounds, nodes, edges, components, connectible, solved, cost, seconds] = numbers[..]
    else {
        return None;
    };
    let run = Run {
        environment: environment.to_string(),
        n: n.parse().ok()?,
        k: k.parse().ok()?,
        strategy: strategy.to_string(),
        seed: seed.parse().ok()?,
    };
    let noted = Noted {
        satisfied: met == 1.0,
        rounds: rounds as u64,
        nodes: nodes as u64,
        edges: edges as u64,
        components: components as u64,
        cost: cost as u64,
        seconds,
        connectible: connectible / 100.0,
        solved: solved / 100.0,
    };
    Some((run, EVALUATORS.iter().position(|known| known == evaluator)?, noted))
}

/// The whole runs in a file; what was cut off at its end is dropped, from the file as well.
pub fn load(path: &Path) -> Vec<Measured> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let lines: Vec<&str> = text.split_inclusive('\n').filter(|line| line.ends_with('\n')).collect();
    let mut runs = Vec::new();
    for three in lines.get(1..).unwrap_or_default().chunks_exact(3) {
        let read: Vec<_> = three.iter().filter_map(|line| parsed(line.trim_end())).collect();
        let whole =
            (0..3).all(|i| read.get(i).is_some_and(|(run, at, _)| *at == i && *run == read[0].0));
        assert!(whole, "{}: {three:?} found; a build's lines expected: {HEADER}", path.display());
        let noted = [0, 1, 2].map(|i| read[i].2.clone());
        runs.push(Measured { run: read[0].0.clone(), noted });
    }
    let kept: String = runs.iter().map(Measured::lines).collect();
    std::fs::write(path, format!("{HEADER}\n{kept}")).expect("the runs can be written");
    runs
}

pub fn append(path: &Path, measured: &Measured) {
    let file = std::fs::OpenOptions::new().append(true).open(path);
    let written = file.and_then(|mut file| file.write_all(measured.lines().as_bytes()));
    written.expect("the runs can be written");
}
