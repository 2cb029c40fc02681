//! How fast valid conformations are had that are far from a known one: plain noise on all torsions, and steps of the elastic
//! network.
//!
//! ```text
//! ROADMILL_DATA=FOLDER cargo bench -p roadmill --bench reach [-- --seconds N]
//! ```
//!
//! Of 4AKE (chain A) and 1CFD (4-147), with 1AKE and 1CLL as the other ends: valid conformations per CPU second whose Cα RMSD from the
//! source is 2.5 to 3.5 Å. *Noise* draws normal deviates on every torsion, of the width among 0.25°, 0.35°, 0.5°, 0.7°, 1°, 1.5°, 2°, 3°, 5° and 10° that gives
//! most. *One step* takes random steps of 3 Å from the source. *Walk* takes 20 random steps of 0.5 Å from one place, and goes on from the
//! first valid one, the first being about where the walk is heading, as `elastic-growth` does; beyond 3.5 Å the walk is begun anew. Each gets N CPU seconds (default 5, noise as many for every width).

use roadmill::model::protein::{FileSpec, ProteinSpec};
use roadmill::model::{Model, Scratch};
use roadmill::numbers::Ordinal;
use roadmill::problem::transition;
use roadmill::seed::{Purpose, Seed, Stream};
use roadmill::structure::measure::rmsd;
use rustix::time::{ClockId, clock_gettime};
use std::path::{Path, PathBuf};

const CHILDREN: usize = 20;
const WIDTHS: [f64; 10] = [0.25, 0.35, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0];

fn main() {
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    let mut seconds = 5.0;
    while let Some(word) = words.next() {
        assert_eq!(word, "--seconds", "--seconds N expected");
        seconds = words.next().and_then(|n| n.parse().ok()).expect("a number of seconds");
    }
    let Some(data) = std::env::var_os("ROADMILL_DATA").map(PathBuf::from) else {
        println!("ROADMILL_DATA names no folder");
        return;
    };
    println!("| protein | noise, best width | one step, times noise | walk, times noise |");
    println!("| --- | --- | --- | --- |");
    let folder = data.join("structures");
    for (first, second, residues) in [("4AKE", "1AKE", None), ("1CFD", "1CLL", Some("4-147"))] {
        measure(&folder, [first, second], residues, seconds);
    }
}

fn measure(folder: &Path, [first, second]: [&str; 2], residues: Option<&str>, seconds: f64) {
    let file = |name: &str| {
        let file = FileSpec::new(folder.join(name).with_extension("pdb")).chain("A");
        residues.map_or(file.clone(), |residues| file.residues(residues))
    };
    let spec = ProteinSpec::new(file(first).into()).target(file(second).into());
    let made = transition("reach", folder, &spec, 0.0).unwrap_or_else(|error| panic!("{error}"));
    let model = made.problem.model().description().prepare();
    let native = model.native().expect("a protein has one").to_vec();
    let parent = Parent { shape: shape(&*model, &native), model: &*model, native };
    let noise = WIDTHS.map(|width| (parent.noise(width, seconds), width));
    let (best, width) = noise.into_iter().fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    let (step, walk) = (parent.one_step(seconds), parent.walk(seconds));
    let times = [step / best, walk / best];
    println!(
        "| {first} | {best:.1}/s, {width}° | {step:.1}/s, {:.1} | {walk:.1}/s, {:.1} |",
        times[0], times[1]
    );
}

struct Parent<'a> {
    model: &'a dyn Model,
    native: Vec<f64>,
    shape: Vec<roadmill::structure::Point>,
}

impl Parent<'_> {
    fn is_there(&self, q: &[f64]) -> bool {
        (2.5..=3.5).contains(&self.apart(q))
    }

    fn apart(&self, q: &[f64]) -> f64 {
        rmsd(&shape(self.model, q), &self.shape)
    }

    fn stream(&self) -> Stream {
        Seed::of_set(1, "reach", Ordinal(0)).stream(Purpose::Sampling)
    }

    /// What one draw after another finds in so many CPU seconds, per second.
    fn per_second(seconds: f64, mut draw: impl FnMut() -> usize) -> f64 {
        let (begun, mut found) = (cpu_seconds(), 0);
        while cpu_seconds() - begun < seconds {
            found += draw();
        }
        found as f64 / (cpu_seconds() - begun)
    }

    fn noise(&self, degrees: f64, seconds: f64) -> f64 {
        let (mut stream, scratch) = (self.stream(), &mut Scratch::new());
        let mut q = self.native.clone();
        Parent::per_second(seconds, || {
            for (value, native) in q.iter_mut().zip(&self.native) {
                *value = native + degrees.to_radians() * stream.normal();
            }
            usize::from(self.model.is_valid(&q, scratch) && self.is_there(&q))
        })
    }

    fn deviates(&self, stream: &mut Stream) -> Vec<f64> {
        self.native.iter().map(|_| stream.normal()).collect()
    }

    fn one_step(&self, seconds: f64) -> f64 {
        let (mut stream, scratch) = (self.stream(), &mut Scratch::new());
        let elastic = self.model.elastic(&self.native).expect("a protein is a network");
        Parent::per_second(seconds, || {
            let next = elastic.random(&self.deviates(&mut stream), 3.0);
            let mut is_good = |q: &[f64]| self.model.is_valid(q, scratch) && self.is_there(q);
            usize::from(next.is_some_and(|q| is_good(&q)))
        })
    }

    fn walk(&self, seconds: f64) -> f64 {
        let (mut stream, scratch) = (self.stream(), &mut Scratch::new());
        let mut here = self.native.clone();
        let mut heading = self.deviates(&mut stream);
        Parent::per_second(seconds, || {
            let elastic = self.model.elastic(&here).expect("a protein is a network");
            let mut found = 0;
            let mut next = None;
            for child in 0..CHILDREN {
                let deviates = self.deviates(&mut stream);
                if child == 0 {
                    let turned = heading.iter().zip(&deviates).map(|(a, b)| 0.96 * a + 0.28 * b);
                    heading = turned.collect();
                }
                let deviates = if child == 0 { &heading } else { &deviates };
                let Some(q) = elastic.random(deviates, 0.5) else { continue };
                if self.model.is_valid(&q, scratch) {
                    found += usize::from(self.is_there(&q));
                    next = next.or(Some(q));
                }
            }
            let is_stuck = next.is_none();
            here = next.unwrap_or(self.native.clone());
            if is_stuck || self.apart(&here) > 3.5 {
                here.clone_from(&self.native);
                heading = self.deviates(&mut stream);
            }
            found
        })
    }
}

fn shape(model: &dyn Model, q: &[f64]) -> Vec<roadmill::structure::Point> {
    model.shape(q, &mut Scratch::new()).expect("a protein has Cα")
}

fn cpu_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
