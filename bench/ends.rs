//! The ways in which two ends become one energy, shown along a path between them.
//!
//! ```text
//! ROADMILL_DATA=FOLDER cargo bench --bench ends [-- --svg FOLDER]
//! ```
//!
//! For calmodulin (1CFD to 1CLL, residues 4–147) and adenylate kinase (4AKE to 1AKE, chain A), of `structures` in the folder that
//! `ROADMILL_DATA` names, the target is superposed on the source by its backbone, and all atoms that both have are moved in
//! straight lines, in 21 frames. Such frames have torn bonds, so each is refitted on the linkage of the source, from the
//! torsions of the frame before.
//!
//! Printed are, as Markdown, for every frame: RMSD of the Cα from both ends; the constraints' energy in either basin alone, by
//! smooth minima of kT′ = 100 and 1000 kJ/mol, by the union and by the intersection of the constraints; the energy of hydrophobic
//! pairs; and how many pairs of atoms violate the rules. Then the barrier by each, with hydrophobic pairs and without: the highest
//! frame between the lowest up to the middle and the lowest from the middle on, for at the very ends energies are those of
//! crystals. `--svg` draws the profiles.

#[path = "support/plot.rs"]
#[allow(dead_code, reason = "other benches use the rest")]
mod plot;

use plot::{COLOURS, INK, Plot, Scale};
use roadmill::model::protein::energy::{
    Constraint, ConstraintKind, Constraints, Hydrophobic, Mixing, Mixture, carried_over,
    constraints_of,
};
use roadmill::model::protein::kinematics::Conformer;
use roadmill::model::protein::linkage::Linkage;
use roadmill::model::protein::placed::Site;
use roadmill::model::protein::refit::{Weights, refit, refit_from};
use roadmill::model::protein::validity::{Obstacles, Rules, Screen};
use roadmill::structure::matching::match_chains;
use roadmill::structure::measure::superpose;
use roadmill::structure::{self, Chain, ChainSelection, Point, Residue, parse_range, select_chain};
use std::path::{Path, PathBuf};

/// kT at 298 K, kJ/mol.
const KT: f64 = 2.479;
/// Steps of the path.
const STEPS: usize = 20;
/// The source, the target, and the residues of both.
const TRANSITIONS: [(&str, &str, Option<&str>); 2] =
    [("1CFD", "1CLL", Some("4-147")), ("4AKE", "1AKE", None)];
const WAYS: [&str; 6] =
    ["source alone", "target alone", "smooth 100", "smooth 1000", "union", "intersection"];
/// The default among them.
const SMOOTH: usize = 2;

fn main() {
    let mut svg: Option<PathBuf> = None;
    let mut words = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = words.next() {
        match word.as_str() {
            "--svg" => svg = Some(words.next().expect("--svg FOLDER").into()),
            _ => panic!("`{word}` found; --svg FOLDER expected"),
        }
    }
    let Some(data) = std::env::var_os("ROADMILL_DATA").map(PathBuf::from) else {
        println!("ROADMILL_DATA is not set: nothing to do");
        return;
    };
    for (source, target, residues) in TRANSITIONS {
        let [from, to] = [source, target].map(|name| chain(&data, name, residues));
        let frames = path(&from, &to);
        print(source, target, &frames);
        if let Some(folder) = &svg {
            let file = folder.join(format!("ends-{source}-{target}.svg"));
            std::fs::write(&file, picture(source, target, &frames))
                .unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        }
    }
}

fn chain(data: &Path, name: &str, residues: Option<&str>) -> Chain {
    let path = data.join("structures").join(name).with_extension("pdb");
    let structure = structure::read(&path).unwrap_or_else(|error| panic!("{error}"));
    let range = residues.map(|text| parse_range(text).expect("a range"));
    let selection = ChainSelection { chain: Some("A"), range };
    select_chain(&structure.models[0], selection).unwrap_or_else(|error| panic!("{error}"))
}

/// What there is to say of a frame.
struct Frame {
    /// RMSD of the Cα from the source, the target and the frame that was to be met, Å.
    rmsd: [f64; 3],
    /// Energies of constraints by [`WAYS`], model kJ/mol.
    energies: [f64; WAYS.len()],
    /// The energy of hydrophobic pairs, model kJ/mol.
    hydrophobic: f64,
    /// How many pairs of atoms violate the rules.
    violations: usize,
}

/// The frames between two structures on the linkage of the first.
fn path(from: &Chain, to: &Chain) -> Vec<Frame> {
    let matching = match_chains(from, to).unwrap_or_else(|error| panic!("{error}"));
    let source = &from.residues;
    let matches: Vec<[u32; 2]> =
        matching.pairs.iter().map(|pair| [pair.first as u32, pair.second as u32]).collect();
    assert_eq!(matches.len(), source.len(), "every residue has a counterpart");
    let target: Vec<Residue> =
        matches.iter().map(|[_, there]| to.residues[*there as usize].clone()).collect();
    let target = laid_upon(&target, source);

    let linkage = Linkage::of(source).expect("a whole chain");
    let conformer = Conformer::of(source, &linkage).expect("a whole chain");
    let ways = ways(source, &constraints_of(&to.residues), &matches, &conformer);
    let hydrophobic = Hydrophobic::of(conformer.atoms());
    let (rules, weights) = (Rules::default(), Weights::default());
    let (mut placed, mut screen) = (conformer.placed(), Screen::default());
    let alphas = [source, &target].map(|residues| alphas(residues));

    let mut q = linkage.source();
    let mut frames = Vec::new();
    for step in 0..=STEPS {
        let aim = between(source, &target, step as f64 / STEPS as f64);
        if step > 0 {
            let fitted = refit_from(source, &linkage, &aim, &q, &rules, &weights);
            q = fitted.unwrap_or_else(|error| panic!("{error}")).q;
        }
        conformer.place(&q, &mut placed);
        let here: Vec<Point> =
            (0..placed.len()).map(|residue| placed.at(Site::CA, residue)).collect();
        let away = |there: &[Point]| superpose(&here, there).rmsd;
        frames.push(Frame {
            rmsd: [away(&alphas[0]), away(&alphas[1]), away(&self::alphas(&aim))],
            energies: std::array::from_fn(|way| ways[way].energy(&placed)),
            hydrophobic: hydrophobic.energy(&placed),
            violations: rules.at_nodes().count(&placed, &Obstacles::default(), &mut screen).total(),
        });
    }
    let at_once = refit(source, &linkage, &target, &rules, &weights);
    let at_once = at_once.unwrap_or_else(|error| panic!("{error}"));
    conformer.place(&at_once.q, &mut placed);
    let end = &frames[STEPS];
    println!(
        "The last frame is {:.3} Å (Cα) from the target; the target refitted at once {:.3} Å, with {:.0} model kJ/mol in its basin, the \
         last frame {:.0}.\n",
        end.rmsd[1],
        at_once.ca_rmsd,
        ways[1].energy(&placed),
        end.energies[1]
    );
    frames
}

fn alphas(residues: &[Residue]) -> Vec<Point> {
    residues.iter().map(|residue| residue.position("CA").expect("a whole chain")).collect()
}

/// A structure moved onto another by N, CA, C and O.
fn laid_upon(moved: &[Residue], fixed: &[Residue]) -> Vec<Residue> {
    let of = |residues: &[Residue]| -> Vec<Point> {
        let names = ["N", "CA", "C", "O"];
        let position = |residue: &Residue, name| residue.position(name).expect("a whole chain");
        residues.iter().flat_map(|residue| names.map(|name| position(residue, name))).collect()
    };
    let motion = superpose(&of(moved), &of(fixed));
    let mut moved = moved.to_vec();
    for atom in moved.iter_mut().flat_map(|residue| &mut residue.atoms) {
        atom.position = motion.apply(&atom.position);
    }
    moved
}

/// The atoms that both structures have, at a share of the straight way from the first to the second.
fn between(first: &[Residue], second: &[Residue], share: f64) -> Vec<Residue> {
    let of = |(one, other): (&Residue, &Residue)| {
        let mut residue = one.clone();
        residue.atoms.retain_mut(|atom| {
            let Some(there) = other.position(&atom.name) else { return false };
            atom.position += (there - atom.position) * share;
            true
        });
        residue
    };
    first.iter().zip(second).map(of).collect()
}

/// The energies by [`WAYS`], without hydrophobic pairs, as the model has them.
fn ways(
    source: &[Residue],
    there: &[Constraint],
    matches: &[[u32; 2]],
    conformer: &Conformer,
) -> Vec<Mixture> {
    let atoms = conformer.atoms();
    let mut of_target = carried_over(there, matches);
    // What the source lacks can hold no bond.
    of_target.retain(|constraint| match constraint.kind {
        ConstraintKind::HydrogenBond => atoms[constraint.first].hydrogen.is_some(),
        ConstraintKind::Disulphide => {
            [constraint.first, constraint.second].iter().all(|at| atoms[*at].centroid.is_some())
        }
    });
    let of_source = constraints_of(source);
    let key = |c: &Constraint| (c.kind, c.first, c.second);
    let both = of_source.iter().filter(|c| of_target.iter().any(|o| key(o) == key(c))).count();
    let (a, b) = (of_source.len(), of_target.len());
    println!("Constraints: {a} of the source, {b} of the target, {both} of both.\n");
    let of = |list: &[Constraint]| Constraints::new(list.to_vec());
    let mixed = |ends| Mixture::of_two(of(&of_source), of(&of_target), ends, None);
    vec![
        Mixture::single(of(&of_source), None),
        Mixture::single(of(&of_target), None),
        mixed(Mixing::SmoothMinimum { kt: 100.0 }),
        mixed(Mixing::SmoothMinimum { kt: 1000.0 }),
        mixed(Mixing::Union {}),
        mixed(Mixing::Intersection {}),
    ]
}

fn print(source: &str, target: &str, frames: &[Frame]) {
    println!(
        "| {source} → {target} | Cα from source, target, aim | {} | E_hp | violations |",
        WAYS.join(" | ")
    );
    println!("|{}", " --- |".repeat(4 + WAYS.len()));
    for (step, frame) in frames.iter().enumerate() {
        let rmsd = frame.rmsd.map(|rmsd| format!("{rmsd:.2}")).join(", ");
        let energies = frame.energies.map(|energy| format!("{energy:.0}")).join(" | ");
        println!(
            "| {step} | {rmsd} | {energies} | {:.0} | {} |",
            frame.hydrophobic, frame.violations
        );
    }
    println!();
    println!(
        "| {source} → {target}: by | lowest frames | highest between | above these, kT | with E_hp: frames | above these, kT |"
    );
    println!("|{}", " --- |".repeat(6));
    for (way, name) in WAYS.iter().enumerate() {
        let constraints = frames.iter().map(|frame| frame.energies[way]);
        let whole = frames.iter().map(|frame| frame.energies[way] + frame.hydrophobic);
        let [one, other] =
            [constraints.collect::<Vec<_>>(), whole.collect()].map(|of| barrier(&of));
        let climbs = |of: &Barrier| of.climbs.map(|climb| format!("{:.0}", climb / KT)).join(", ");
        println!(
            "| {name} | {}, {} | {} | {} | {}, {}, {} | {} |",
            one.low[0],
            one.low[1],
            one.high,
            climbs(&one),
            other.low[0],
            other.high,
            other.low[1],
            climbs(&other)
        );
    }
    println!();
}

/// What lies between two basins.
struct Barrier {
    /// The lowest frame up to the middle of the path, and that from the middle on.
    low: [usize; 2],
    /// The highest frame between these.
    high: usize,
    /// How much higher it is than either, model kJ/mol.
    climbs: [f64; 2],
}

/// The barrier of a profile; of equals the first.
fn barrier(energies: &[f64]) -> Barrier {
    let lower = |a: &usize, b: &usize| energies[*a].total_cmp(&energies[*b]);
    let middle = energies.len() / 2;
    let low = [0..middle + 1, middle..energies.len()];
    let low = low.map(|half| half.min_by(lower).expect("some frames"));
    let high = (low[0]..=low[1]).rev().max_by(lower).expect("some frames");
    Barrier { low, high, climbs: low.map(|low| energies[high] - energies[low]) }
}

/// The profiles by all ways; rings mark frames that violate the rules.
fn picture(source: &str, target: &str, frames: &[Frame]) -> String {
    let colours = [COLOURS[1], COLOURS[2], COLOURS[0], COLOURS[3], COLOURS[4], COLOURS[5]];
    let highest = frames.iter().flat_map(|frame| frame.energies).fold(0.0, f64::max);
    let thousands = (highest / 1000.0).ceil() as usize;
    let y = Scale { low: 0.0, high: 1000.0 * thousands as f64, log: false };
    let x = Scale { low: 0.0, high: STEPS as f64, log: false };
    let title = format!(
        "Constraints' energy on a refitted path from {source} to {target}; rings: rules broken"
    );
    let mut plot = Plot::new(&title, ["frame", "model kJ/mol"], [900.0, 460.0], x, y);
    let columns: Vec<(f64, String)> =
        (0..=STEPS).step_by(5).map(|step| (step as f64, step.to_string())).collect();
    plot.columns(&columns);
    let rows: Vec<(f64, String)> =
        (0..=thousands).map(|k| (1000.0 * k as f64, (1000 * k).to_string())).collect();
    plot.rows(&rows);
    let legend: Vec<(String, &str)> =
        WAYS.iter().zip(colours).map(|(name, colour)| ((*name).to_owned(), colour)).collect();
    plot.legend(&legend);
    let at = |way: usize| {
        let points = frames.iter().enumerate();
        points.map(move |(step, frame)| [step as f64, frame.energies[way]])
    };
    for (way, colour) in colours.into_iter().enumerate() {
        plot.line(&at(way).collect::<Vec<_>>(), colour);
    }
    for (point, _) in at(SMOOTH).zip(frames).filter(|(_, frame)| frame.violations > 0) {
        plot.ring(point, INK);
    }
    plot.finish()
}
