//! How fast valid conformations are had that are far from a known one: plain noise on all torsions, and steps of the elastic
//! network.
//!
//! ```text
//! ROADMILL_DATA=FOLDER cargo bench -p roadmill --bench reach [-- --seconds N]
//! ```
//!
//! Of 4AKE (chain A) and 1CFD (4-147), with 1AKE and 1CLL as the other ends: valid conformations per CPU second whose Cα RMSD from the
//! source is 2.5 to 3.5 Å. *Noise* draws normal deviates on every torsion, of the width among 0.25°, 0.35°, 0.5°, 0.7°, 1°, 1.5°, 2°, 3°, 5° and 10° that gives
//! most. *One step* takes a random step of 3 Å from the source, *walk* random steps of 0.5 Å, each from the last valid one, begun
//! anew beyond 3.5 Å; there every motion is proved valid, too. Each gets N CPU seconds (default 5, noise as many for every width).

use roadmill::model::protein::{FileSpec, ProteinSpec};
use roadmill::model::{Model, Scratch};
use roadmill::numbers::Ordinal;
use roadmill::problem::transition;
use roadmill::seed::{Purpose, Seed, Stream};
use roadmill::structure::measure::rmsd;
use rustix::time::{ClockId, clock_gettime};
use std::path::{Path, PathBuf};

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
    println!(
        "| protein | noise, best width | torsions held | one step, times noise | walk, times noise |"
    );
    println!("| --- | --- | --- | --- | --- |");
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
    let mut parent = Parent { shape: shape(&*model, &native), model: &*model, native, hold: 4.0 };
    let noise = WIDTHS.map(|width| (parent.noise(width, seconds), width));
    let (best, width) = noise.into_iter().fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    for hold in [4.0, 0.1, 0.002] {
        parent.hold = hold;
        let (step, walk) = (parent.one_step(seconds), parent.walk(seconds));
        println!(
            "| {first} | {best:.1}/s, {width}° | {hold} | {step:.1}/s, {:.1} | {walk:.1}/s, {:.1} |",
            step / best,
            walk / best
        );
    }
}

struct Parent<'a> {
    model: &'a dyn Model,
    native: Vec<f64>,
    /// How strongly every torsion is held, kT/rad².
    hold: f64,
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
        let elastic = self.model.elastic(&self.native, self.hold).expect("a protein is a network");
        Parent::per_second(seconds, || {
            let next = elastic.random(&self.deviates(&mut stream), 3.0);
            let mut is_good = |q: &[f64]| self.model.is_valid(q, scratch) && self.is_there(q);
            usize::from(next.is_some_and(|q| is_good(&q)))
        })
    }

    fn walk(&self, seconds: f64) -> f64 {
        let (mut stream, scratch) = (self.stream(), &mut Scratch::new());
        let mut here = self.native.clone();
        Parent::per_second(seconds, || {
            let elastic = self.model.elastic(&here, self.hold).expect("a protein is a network");
            let next = elastic.random(&self.deviates(&mut stream), 0.5);
            let next = next.filter(|next| {
                self.model.is_valid(next, scratch)
                    && self.model.motion(&here, next, 1, scratch).is_some()
            });
            drop(elastic);
            let Some(next) = next else { return 0 };
            here = next;
            let found = usize::from(self.is_there(&here));
            if self.apart(&here) > 3.5 {
                here.clone_from(&self.native);
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
