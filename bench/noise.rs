//! How well the energy of a protein tells its native state from noise, and how much of the noise is possible at all.
//!
//! ```text
//! cargo bench --bench noise -- [--draws N] [NAME.pdb[:FIRST-LAST] …]
//! ```
//!
//! For every structure (default: 1PGA, 1MI0, 1BDD, 1CFD and 1CLL in the folder that `ROADMILL_DATA` names) N configurations
//! (default 2000) are drawn about the native one with normal deviates of 1°, 2°, 5°, 10° and 20° on every torsion. Printed
//! are, as Markdown, the 5th, 50th and 95th percentile of their energies above the native one's in kT, with the hydrophobic
//! term and without, and the share that keeps all rules. Then the same of a helix (phi −57°, psi −47°) and an extended chain
//! (−139°, 135°), which are one configuration each.
//!
//! A second table repeats the papers' rule, which tests side chains alone. Of ten times N draws at each width: how many keep
//! this rule, in which share of these two Cα, |i − j| > 2, are nearer than 3.0 Å, and which share breaks any rule.

use roadmill::math;
use roadmill::model::protein::energy::EnergySpec;
use roadmill::model::protein::kinematics::Conformer;
use roadmill::model::protein::linkage::Linkage;
use roadmill::model::protein::validity::{Obstacles, Rules, Screen};
use roadmill::model::protein::{FileSpec, ProteinSpec};
use roadmill::model::{Model, ModelKind, Scratch};
use roadmill::numbers::Ordinal;
use roadmill::problem::Problem;
use roadmill::seed::{Purpose, Seed};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// kT at 298 K, kJ/mol.
const KT: f64 = 2.479;
const DEGREES: [f64; 5] = [1.0, 2.0, 5.0, 10.0, 20.0];
const SHAPES: [(&str, [f64; 2]); 2] = [("helix", [-57.0, -47.0]), ("extended", [-139.0, 135.0])];

/// How many times more draws the papers' rule gets: few keep it.
const DRAWS_MORE: usize = 10;

/// A protein with and without the hydrophobic term.
struct Pair {
    linkage: Linkage,
    conformer: Conformer,
    names: Vec<String>,
    with: Box<dyn Model>,
    without: Box<dyn Model>,
}

impl Pair {
    fn of(path: &Path, residues: Option<&str>) -> Pair {
        let mut file = FileSpec::new(path).chain("A");
        if let Some(residues) = residues {
            file = file.residues(residues);
        }
        let model = |hydrophobic| {
            let energy = EnergySpec { hydrophobic, ..EnergySpec::default() };
            let spec = ProteinSpec::new(file.clone().into()).energy(energy);
            let problem = Problem::builder("noise", spec).build();
            problem.unwrap_or_else(|error| panic!("{error}"))
        };
        let (with, without) = (model(true), model(false));
        let ModelKind::Protein(protein) = with.model() else { unreachable!("it is a protein") };
        let linkage = Linkage::of(protein.source()).expect("a whole chain");
        let conformer = Conformer::of(protein.source(), &linkage).expect("a whole chain");
        let names = with.space().dofs().iter().map(|dof| dof.name.clone()).collect();
        let prepare = |problem: &Problem| problem.model().description().prepare();
        Pair { names, with: prepare(&with), without: prepare(&without), linkage, conformer }
    }

    /// Energies above the native one's in kT, with the hydrophobic term and without, and whether all rules are kept.
    fn judge(&self, q: &[f64], scratch: &mut Scratch) -> ([f64; 2], bool) {
        let native = self.with.native().expect("a protein has one").to_vec();
        let mut above = |model: &dyn Model| {
            let mut energy = |q: &[f64]| model.energy(q, scratch).expect("a protein has one");
            (energy(q) - energy(&native)) / KT
        };
        let energies = [above(&*self.with), above(&*self.without)];
        (energies, self.with.is_valid(q, scratch))
    }
}

fn main() {
    let mut draws = 2000;
    let mut files = Vec::new();
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        if word == "--draws" {
            draws = words.next().and_then(|n| n.parse().ok()).expect("--draws N, a number");
        } else {
            files.push(word);
        }
    }
    if files.is_empty() {
        let Some(data) = std::env::var_os("ROADMILL_DATA").map(PathBuf::from) else {
            println!("ROADMILL_DATA is not set and no structure is given: nothing to do");
            return;
        };
        let names = ["1PGA.pdb", "1MI0.pdb", "1BDD.pdb", "1CFD.pdb", "1CLL.pdb"];
        files = names.map(|name| data.join("structures").join(name).display().to_string()).into();
    }
    println!(
        "| structure | noise | kT above native, 5 %, 50 %, 95 % | without E_hp | keep all rules |"
    );
    println!("| --- | --- | --- | --- | --- |");
    let mut pairs = Vec::new();
    for file in &files {
        let (path, residues) = match file.split_once(".pdb:") {
            Some((stem, residues)) => (PathBuf::from(format!("{stem}.pdb")), Some(residues)),
            None => (PathBuf::from(file), None),
        };
        let pair = Pair::of(&path, residues);
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        table(&name, &pair, draws);
        pairs.push((name, pair));
    }
    println!();
    println!(
        "| structure | noise | keep the papers' rule | of these with two Cα within 3.0 Å | that break any rule |"
    );
    println!("| --- | --- | --- | --- | --- |");
    pairs.iter().for_each(|(name, pair)| by_papers_rule(name, pair, DRAWS_MORE * draws));
}

/// What the papers' rule lets pass.
fn by_papers_rule(name: &str, pair: &Pair, draws: usize) {
    let Rules { side_chains, alpha_carbons, .. } = Rules::default();
    let papers = Rules { side_chains, ..Rules::none() }.at_nodes();
    let alphas = Rules { alpha_carbons, ..Rules::none() }.at_nodes();
    let all = Rules::default().at_nodes();
    let (native, none) = (pair.linkage.source(), Obstacles::default());
    let (mut placed, mut screen) = (pair.conformer.placed(), Screen::default());
    for degrees in DEGREES {
        let seed = Seed::of_set(1, &format!("noise of {degrees} degrees"), Ordinal(0));
        let mut stream = seed.stream(Purpose::Sampling);
        let [mut kept, mut near, mut broken] = [0usize; 3];
        for _ in 0..draws {
            let turn =
                |value: &f64| math::wrap_angle(value + stream.normal() * degrees * PI / 180.0);
            let q: Vec<f64> = native.iter().map(turn).collect();
            pair.conformer.place(&q, &mut placed);
            if papers.is_valid(&placed, &none, &mut screen) {
                kept += 1;
                near += usize::from(!alphas.is_valid(&placed, &none, &mut screen));
                broken += usize::from(!all.is_valid(&placed, &none, &mut screen));
            }
        }
        let share = |count: usize| 100.0 * count as f64 / kept as f64;
        let shares = match kept {
            0 => "– | –".to_owned(),
            _ => format!("{:.0} % | {:.0} %", share(near), share(broken)),
        };
        println!("| {name} | {degrees}° | {kept} of {draws} | {shares} |");
    }
}

fn table(name: &str, pair: &Pair, draws: usize) {
    let scratch = &mut Scratch::new();
    let native = pair.with.native().expect("a protein has one").to_vec();
    for degrees in DEGREES {
        let seed = Seed::of_set(1, &format!("noise of {degrees} degrees"), Ordinal(0));
        let mut stream = seed.stream(Purpose::Sampling);
        let mut energies = [Vec::new(), Vec::new()];
        let mut valid = 0;
        for _ in 0..draws {
            let turn =
                |value: &f64| math::wrap_angle(value + stream.normal() * degrees * PI / 180.0);
            let q: Vec<f64> = native.iter().map(turn).collect();
            let (above, is_valid) = pair.judge(&q, scratch);
            energies.iter_mut().zip(above).for_each(|(all, one)| all.push(one));
            valid += usize::from(is_valid);
        }
        let [with, without] = energies.map(|mut all| {
            all.sort_by(f64::total_cmp);
            [5, 50, 95].map(|percent| format!("{:.0}", all[(draws - 1) * percent / 100])).join(", ")
        });
        let share = 100.0 * valid as f64 / draws as f64;
        println!("| {name} | {degrees}° | {with} | {without} | {share:.2} % |");
    }
    for (shape, [phi, psi]) in SHAPES {
        let value = |name: &String| if name.starts_with("phi") { phi } else { psi };
        let q: Vec<f64> = pair.names.iter().map(|name| value(name) * PI / 180.0).collect();
        let ([with, without], is_valid) = pair.judge(&q, scratch);
        let keeps = if is_valid { "yes" } else { "no" };
        println!("| {name} | {shape} | {with:.0} | {without:.0} | {keeps} |");
    }
}
