//! Conformations of proteins per second of CPU and core: placed, all rules run to their end, and the energy.
//!
//! ```text
//! ROADMILL_DATA=FOLDER cargo bench -p roadmill --bench conformations [-- NAME …]
//! ```
//!
//! Of every structure (default 1CFD, 1PGA and 1BDD in `structures` of the folder that `ROADMILL_DATA` names) 256 valid
//! conformations are drawn beforehand, of half of which the torsions are off the source's by normal deviates of 0.25°, of half by
//! 0.5°. What is measured begins with torsions. Printed are conformations per second, medians of nine times a fifth of a
//! second: that are placed, that are held against all rules, whose energy is computed, and for all of this together.
//!
//! Then, what it is worth that few torsions changed: about a valid conformation one torsion after the other is turned by 0.001 there
//! and back, whenever both are valid. Printed are microseconds for a conformation that is placed and judged, with the
//! memory of the one before and with none, and how many times less the former is: medians over all torsions, and over
//! those in the middle fifth of the chain.
//!
//! Then the same rules beside another chain of the file that stands still (1HVR, 4DFR and 1A28, chain A beside B): with these
//! obstacles, without them, and with every residue held against every obstacle one by one.

use roadmill::model::protein::energy::{Constraint, Constraints, Hydrophobic, Mixture};
use roadmill::model::protein::kinematics::Conformer;
use roadmill::model::protein::linkage::Linkage;
use roadmill::model::protein::placed::{Placed, Site};
use roadmill::model::protein::validity::{Limits, Obstacles, Rules, Screen};
use roadmill::numbers::Ordinal;
use roadmill::seed::{Purpose, Seed};
use roadmill::structure::{self, Point, Residue};
use rustix::time::{ClockId, clock_gettime};
use std::hint::black_box;
use std::path::PathBuf;

/// Files of two chains, the first of which moves beside the second.
const BESIDE: [&str; 3] = ["1HVR", "4DFR", "1A28"];
const CONFORMATIONS: usize = 256;
const ROUNDS: usize = 9;
const SECONDS: f64 = 0.2;

fn main() {
    let words = std::env::args().skip(1).filter(|word| word != "--bench");
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = ["1CFD", "1PGA", "1BDD"].map(String::from).to_vec();
    }
    let Some(data) = std::env::var_os("ROADMILL_DATA") else {
        println!("ROADMILL_DATA names no folder");
        return;
    };
    println!("| chain | residues | torsions | bonds | place/s | rules/s | energy/s | all/s |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut of_one = Vec::new();
    for name in names {
        let path = PathBuf::from(&data).join("structures").join(&name).with_extension("pdb");
        let file = structure::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let mut chains = file.models[0].chains.iter();
        let chain =
            chains.find(|chain| !chain.residues.is_empty()).expect("a chain of amino acids");
        of_one.push((measure(&name, &chain.residues), name));
    }
    println!(
        "\n| chain | torsions turned | µs with memory | µs without | times less | in the middle |"
    );
    println!("| --- | --- | --- | --- | --- | --- |");
    for (OneTorsion { tried, with, without, gain, in_the_middle }, name) in of_one {
        println!(
            "| {name} | {tried} | {with:.2} | {without:.2} | {gain:.2} | {in_the_middle:.2} |"
        );
    }
    println!();
    println!("| chain | residues | obstacles | rules/s | beside obstacles/s | one by one/s |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for name in BESIDE {
        let path = PathBuf::from(&data).join("structures").join(name).with_extension("pdb");
        let file = structure::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let chains = file.models[0].chains.iter().filter(|chain| !chain.residues.is_empty());
        let [one, other] = chains.collect::<Vec<_>>()[..] else { panic!("{name}: two chains") };
        beside(name, &one.residues, &other.residues);
    }
}

/// Measures the rules of a chain beside another one.
fn beside(name: &str, residues: &[Residue], other: &[Residue]) {
    let linkage = Linkage::of(residues).expect("a whole chain");
    let conformer = Conformer::of(residues, &linkage).expect("a whole chain");
    let atoms = other.iter().flat_map(|residue| &residue.atoms).filter(|atom| atom.is_heavy());
    let obstacles = Obstacles::new(atoms.map(|atom| atom.position).collect());
    let (rules, none) = (Rules::default().at_nodes(), Obstacles::default());
    let mut screen = Screen::default();
    let mut stream = Seed::of_set(1, "beside", Ordinal(0)).stream(Purpose::Sampling);
    let drawn: Vec<_> = (0..CONFORMATIONS)
        .map(|_| {
            let width = 0.25f64.to_radians();
            let source = linkage.source().into_iter();
            let q: Vec<f64> = source.map(|value| value + width * stream.normal()).collect();
            let mut placed = conformer.placed();
            conformer.place(&q, &mut placed);
            placed
        })
        .collect();
    let alone = seconds(&drawn, |placed| {
        black_box(rules.count(placed, &none, &mut screen));
    });
    let with = seconds(&drawn, |placed| {
        black_box(rules.count(placed, &obstacles, &mut screen));
    });
    let one_by_one = seconds(&drawn, |placed| {
        black_box(rules.count(placed, &none, &mut screen));
        black_box(close_one_by_one((placed, residues), obstacles.points(), &rules));
    });
    for placed in &drawn {
        let counts = rules.count(placed, &obstacles, &mut screen);
        let close = close_one_by_one((placed, residues), obstacles.points(), &rules);
        assert_eq!(counts.obstacle_backbone + counts.obstacle_side_chains, close, "{name}");
    }
    let [alone, with, one_by_one] = [alone, with, one_by_one].map(f64::recip);
    println!(
        "| {name} | {} | {} | {alone:.0} | {with:.0} | {one_by_one:.0} |",
        residues.len(),
        obstacles.points().len()
    );
}

/// How many pairs of an atom and an obstacle break the rules, each residue held against each obstacle.
fn close_one_by_one(
    (placed, residues): (&Placed, &[Residue]),
    obstacles: &[Point],
    rules: &Limits,
) -> usize {
    let mut close = 0;
    for (residue, source) in residues.iter().enumerate() {
        for obstacle in obstacles {
            let mut count = |at: Point, least: f64| {
                close += usize::from((at - obstacle).norm_squared() < least * least);
            };
            for site in [Site::N, Site::CA, Site::C, Site::O] {
                count(placed.at(site, residue), rules.obstacle_backbone);
            }
            if source.position("CB").is_some() {
                count(placed.at(Site::CB, residue), rules.obstacle_backbone);
            }
            if source.side_chain_centroid().is_some() {
                count(placed.at(Site::Centroid, residue), rules.obstacle_side_chains);
            }
        }
    }
    close
}

/// What a conformation costs of which one torsion differs from the one before: medians.
struct OneTorsion {
    /// How many torsions were turned.
    tried: usize,
    /// Microseconds.
    with: f64,
    /// Microseconds.
    without: f64,
    gain: f64,
    /// `gain` of the middle fifth of the chain alone.
    in_the_middle: f64,
}

fn measure(name: &str, residues: &[Residue]) -> OneTorsion {
    let linkage = Linkage::of(residues).expect("a whole chain");
    let conformer = Conformer::of(residues, &linkage).expect("a whole chain");
    let bonds = bonds(&conformer);
    let count = bonds.len();
    let energy = Mixture::single(Constraints::new(bonds), Some(Hydrophobic::of(conformer.atoms())));
    let (rules, obstacles) = (Rules::default().at_nodes(), Obstacles::default());
    let (mut placed, mut screen) = (conformer.placed(), Screen::default());

    let seed = Seed::of_set(1, "conformations", Ordinal(0));
    let mut stream = seed.stream(Purpose::Sampling);
    let mut drawn = Vec::new();
    while drawn.len() < CONFORMATIONS {
        let width = [0.25f64, 0.5][drawn.len() % 2].to_radians();
        let source = linkage.source().into_iter();
        let q: Vec<f64> = source.map(|value| value + width * stream.normal()).collect();
        conformer.place(&q, &mut placed);
        if rules.is_valid(&placed, &obstacles, &mut screen) {
            drawn.push(q);
        }
    }

    let place = seconds(&drawn, |q| conformer.place(q, black_box(&mut placed)));
    let counted = seconds(&drawn, |_| {
        black_box(rules.count(black_box(&placed), &obstacles, &mut screen));
    });
    let valued = seconds(&drawn, |_| {
        black_box(energy.energy(black_box(&placed)));
    });
    let mut total = 0;
    let all = seconds(&drawn, |q| {
        conformer.place(q, &mut placed);
        total += rules.count(&placed, &obstacles, &mut screen).total();
        black_box(energy.energy(&placed));
    });
    assert_eq!(total, 0, "all are valid");
    let [place, counted, valued, all] = [place, counted, valued, all].map(f64::recip);
    println!(
        "| {name} | {} | {} | {count} | {place:.0} | {counted:.0} | {valued:.0} | {all:.0} |",
        residues.len(),
        linkage.torsions.len(),
    );
    one_torsion(&conformer, &rules, &drawn)
}

/// How often a torsion is turned there and back for one measurement, the least of five.
const TURNS: usize = 40;

fn one_torsion(conformer: &Conformer, rules: &Limits, drawn: &[Vec<f64>]) -> OneTorsion {
    let none = Obstacles::default();
    let (mut placed, mut screen) = (conformer.placed(), Screen::default());
    let mut is_valid = |q: &[f64]| {
        conformer.place(q, &mut placed);
        rules.is_valid(&placed, &none, &mut screen)
    };
    // Without memory: every second conformation is another one, in a memory that is of no use for it; those are not counted.
    let (base, other) = (&drawn[0], &drawn[1]);
    let least = |of: &mut dyn FnMut()| {
        let once = |of: &mut dyn FnMut()| {
            let begun = cpu_seconds();
            (0..TURNS).for_each(|_| of());
            (cpu_seconds() - begun) / (2 * TURNS) as f64 * 1e6
        };
        (0..5).map(|_| once(of)).fold(f64::INFINITY, f64::min)
    };
    let far = [other, &drawn[2]];
    let of_others = least(&mut || far.iter().for_each(|q| assert!(is_valid(q))));
    let mut rows = Vec::new();
    for torsion in 0..base.len() {
        let turned = [1e-3, -1e-3].map(|by| {
            let mut q = base.clone();
            q[torsion] += by;
            q
        });
        if !turned.iter().all(|q| is_valid(q)) {
            continue;
        }
        let with = least(&mut || turned.iter().for_each(|q| assert!(is_valid(q))));
        let both = least(&mut || {
            turned.iter().zip(far).for_each(|(q, far)| assert!(is_valid(q) && is_valid(far)));
        });
        rows.push((torsion, with, both - of_others));
    }
    let median = |rows: &[&(usize, f64, f64)], of: fn(&(usize, f64, f64)) -> f64| {
        let mut values: Vec<f64> = rows.iter().map(|row| of(row)).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
    };
    let all: Vec<_> = rows.iter().collect();
    let middle = 2 * base.len() / 5..3 * base.len() / 5;
    let middle: Vec<_> = rows.iter().filter(|row| middle.contains(&row.0)).collect();
    OneTorsion {
        tried: all.len(),
        with: median(&all, |row| row.1),
        without: median(&all, |row| row.2),
        gain: median(&all, |row| row.2 / row.1),
        in_the_middle: median(&middle, |row| row.2 / row.1),
    }
}

/// Seconds of CPU for one conformation.
fn seconds<T>(drawn: &[T], mut of: impl FnMut(&T)) -> f64 {
    let mut each = [0.0; ROUNDS];
    for each in &mut each {
        let (begun, mut count) = (cpu_seconds(), 0);
        while cpu_seconds() - begun < SECONDS {
            drawn.iter().for_each(&mut of);
            count += drawn.len();
        }
        *each = (cpu_seconds() - begun) / count as f64;
    }
    each.sort_by(f64::total_cmp);
    each[ROUNDS / 2]
}

fn cpu_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// The hydrogen bonds of the source by the energy of W. Kabsch and C. Sander (1983).
fn bonds(conformer: &Conformer) -> Vec<Constraint> {
    let atoms = conformer.atoms();
    let mut bonds = Vec::new();
    for (donor, at) in atoms.iter().enumerate() {
        let Some(h) = at.hydrogen else { continue };
        for (acceptor, to) in atoms.iter().enumerate() {
            let near = |a: &Point, b: &Point| 1.0 / (a - b).norm();
            let attraction = near(&at.n, &to.o) + near(&h, &to.c);
            let energy = 27.888 * (attraction - near(&h, &to.o) - near(&at.n, &to.c));
            if donor.abs_diff(acceptor) >= 2 && energy < -0.5 {
                bonds.push(Constraint::hydrogen_bond(donor, acceptor));
            }
        }
    }
    bonds
}
