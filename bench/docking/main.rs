//! Ligands at proteins, on complexes whose poses are known.
//!
//! ```text
//! ROADMILL_DATA=… cargo bench --bench docking -- poses [--csv FILE] [--seeds 1-10] [--mode boxed|blind] [--nodes N] [--charges] [COMPLEX …]
//! ROADMILL_DATA=… cargo bench --bench docking -- generators | chains [--csv FILE] [--seeds 1-10] [--nodes N] [COMPLEX …]
//! ROADMILL_DATA=… cargo bench --bench docking -- speed | grid
//! ```
//!
//! `poses` looks for the poses of each complex, in the box of `bench/peers/docking-boxes.csv` and blind, by the problem that `roadmill
//! ligand problem` makes, with `--charges` by an energy with Coulomb and hydrophobic terms; `generators` by one generator at a time, flexible and rigid, which repeats Tables V and VI of O. B. Bayazit's thesis
//! (2003) on the complexes at hand; `chains` by chains of hops with other settings than the usual ones; `speed` counts energies per second, `grid` compares energies of the grid with exact sums. With `--csv` a run's rows are appended as it ends, and runs that
//! stand there are not made again. Times are CPU seconds of this thread.

mod chains;
mod complexes;
mod generators;
mod grid;
mod poses;
#[path = "../support/rows.rs"]
mod rows;
mod run;
mod speed;

use rows::Rows;

/// What is asked for.
pub struct Asked {
    /// The complexes, by their names.
    pub complexes: Vec<String>,
    /// The base seeds.
    pub seeds: std::ops::RangeInclusive<u64>,
    /// `boxed` or `blind`; `None`: both.
    pub mode: Option<String>,
    /// The most nodes of a roadmap; `None`: those of the study.
    pub nodes: Option<u64>,
    /// Whether the energy has Coulomb and hydrophobic terms.
    pub charges: bool,
    /// Where rows are kept.
    pub rows: Rows,
}

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|argument| argument != "--bench");
    let study = arguments.next().unwrap_or_default();
    let (mut complexes, mut seeds, mut csv) = (Vec::new(), 1..=10, None);
    let (mut nodes, mut mode, mut charges) = (None, None, false);
    while let Some(argument) = arguments.next() {
        let mut next = || arguments.next().expect("a value follows an option");
        match argument.as_str() {
            "--csv" => csv = Some(next()),
            "--charges" => charges = true,
            "--mode" => mode = Some(next()),
            "--nodes" => nodes = Some(next().parse().expect("a number of nodes")),
            "--seeds" => {
                let text = next();
                let (first, last) = text.split_once('-').unwrap_or((&text, &text));
                seeds = first.parse().expect("a seed")..=last.parse().expect("a seed");
            }
            _ => complexes.push(argument),
        }
    }
    if study != "poses" && (mode.is_some() || charges) {
        eprintln!("`--mode` or `--charges` found, which `poses` alone has");
        std::process::exit(2);
    }
    let asked = Asked { complexes, seeds, nodes, mode, charges, rows: Rows::open(csv.as_deref()) };
    match study.as_str() {
        "poses" => poses::run(asked),
        "chains" => chains::run(asked),
        "generators" => generators::run(asked),
        "speed" => speed::run(),
        "grid" => grid::run(),
        other => {
            eprintln!("study `{other}` found; poses, generators, chains, speed or grid expected");
            std::process::exit(2);
        }
    }
}
