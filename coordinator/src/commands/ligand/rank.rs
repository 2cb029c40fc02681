use super::model::{molecules, spec_of};
use super::rank_table::{Measured, RankTable, Ranked};
use crate::cli::{RankArguments, Samples};
use crate::commands::crew::workers;
use crate::commands::place::check_place;
use crate::exit::{Code, Failure};
use crate::files::{make_empty, write_whole};
use crate::output::{Plain, json, lines, note};
use crate::run::outside_of_runs;
use crate::signals::Signals;
use crate::work::{Run, Workers, limit};
use roadmill::binding::{Affinity, Exact};
use roadmill::internal::plain::plain;
use roadmill::ligand::{self, Ligand};
use roadmill::model::ModelKind;
use roadmill::model::docking::{Docking, DockingSpec, LigandSpec};
use roadmill::problem::{AffinitySearch, DEFAULT_SEED, Problem, affinity};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// What the box about all given poses has beside their extent, Å: as much as the box about one ligand.
const BESIDE: f64 = 10.0;
/// A given pose that is farther from every atom of the protein, Å, is none at the protein.
const FAR: f64 = 8.0;

/// Samples several ligands at one protein, one run each, and ranks them.
pub fn rank(arguments: &RankArguments) -> Result<Code, Failure> {
    let ligands = ligand::read_all(&arguments.ligands).map_err(Failure::usage)?;
    let names = names(arguments, &ligands)?;
    let measured = match &arguments.measured {
        None => None,
        Some(file) => Some(Measured::read(file, arguments.larger_is_stronger, &names)?),
    };
    let workers = workers(&arguments.crew)?;
    outside_of_runs(&arguments.out)?;
    let files = ["rank.csv", "rank.md"].map(|name| arguments.out.join(name));
    if arguments.or_resume || arguments.force {
        files.iter().try_for_each(|file| check_place("--out", file))?;
    }
    // Whatever is wrong with a ligand is said before anything runs.
    let problems = problems(arguments, &ligands, &names)?;
    if !(arguments.or_resume || arguments.force) {
        make_empty(&arguments.out)?;
    }
    std::fs::create_dir_all(&arguments.out)
        .map_err(|error| crate::files::cannot_write(&arguments.out, &error))?;
    let signals = Arc::new(Signals::listen().map_err(Failure::system)?);
    let mut rows = Vec::new();
    for (name, problem) in names.iter().zip(problems) {
        rows.push(ranked(arguments, name, problem, &workers, &signals)?);
    }
    let seed = arguments.seed.unwrap_or(DEFAULT_SEED);
    let table = RankTable::of(rows, measured.as_ref(), seed);
    write_whole(&files[0], table.csv())?;
    write_whole(&files[1], table.markdown())?;
    match arguments.json {
        true => drop(json(&table)),
        false => drop(lines(table.text().trim_end())),
    }
    Ok(Code::Done)
}

/// The names of the ligands, each one's own, which become those of folders.
fn names(arguments: &RankArguments, ligands: &[Ligand]) -> Result<Vec<String>, Failure> {
    let file = arguments.ligands.display();
    let mut seen = BTreeSet::new();
    for ligand in ligands {
        let (name, line) = (ligand.name(), ligand.line().unwrap_or(1));
        let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        let fits =
            (1..=100).contains(&name.len()) && name.chars().all(is_plain) && !name.starts_with('.');
        if !fits {
            let name = plain(name);
            return Err(Failure::usage(format!(
                "{file}:{line}: `{name}` found as the name of a ligand; letters, digits, `-`, `_` and `.` expected, as it names a folder"
            )));
        }
        // On some file systems names that differ in capitals alone are one.
        if !seen.insert(name.to_ascii_lowercase()) || matches!(name, "rank.csv" | "rank.md") {
            return Err(Failure::usage(format!(
                "{file}:{line}: a second ligand `{name}` found; names of their own expected"
            )));
        }
    }
    Ok(ligands.iter().map(|ligand| ligand.name().to_owned()).collect())
}

/// The problems of all ligands.
fn problems(
    arguments: &RankArguments,
    ligands: &[Ligand],
    names: &[String],
) -> Result<Vec<Problem>, Failure> {
    let RankArguments { protein, receptor, model, region, .. } = arguments;
    let named = |ligand: &Ligand, failure: Failure| {
        let (file, line) = (arguments.ligands.display(), ligand.line().unwrap_or(1));
        let name = Plain(ligand.name());
        Failure::new(failure.code, format!("{file}:{line}: {name}: {}", failure.message))
    };
    let spec = |ligand: &Ligand| {
        spec_of(protein, LigandSpec::Molecule(ligand.clone()), receptor, model, region)
    };
    let mut taken: Vec<(DockingSpec, Docking)> = Vec::new();
    for ligand in ligands {
        let spec = spec(ligand);
        let docking = molecules(&spec).map_err(|failure| named(ligand, failure))?;
        taken.push((spec, docking));
    }
    let is_boxed = region.box_at.is_some();
    let region = match is_boxed || arguments.blind {
        true => None,
        false => about_all(taken.iter().map(|(_, docking)| docking)),
    };
    if !is_boxed && !arguments.blind && region.is_none() {
        note("not all given poses are at the protein: ligands may be anywhere");
    }
    let is_blind = !is_boxed && region.is_none();
    let search = AffinitySearch {
        nodes: Some(arguments.nodes),
        minima: arguments.strategy == Samples::Minima,
        length: arguments.length,
        step: arguments.step,
        percent: is_blind.then_some(arguments.percent),
    };
    let mut problems = Vec::new();
    for ((name, ligand), (spec, _)) in names.iter().zip(ligands).zip(taken) {
        let spec = match region {
            Some([centre, size]) => spec.region(centre, size),
            None => spec,
        };
        let made = affinity(name, Path::new(""), &spec, &search).map_err(Failure::usage);
        let made = made.map_err(|failure| named(ligand, failure))?;
        let made = made.with_seed(arguments.seed.unwrap_or(DEFAULT_SEED));
        problems.push(limit(made, Some(arguments.nodes), None)?);
    }
    // They are the same of all ligands.
    if let Some(first) = problems.first() {
        let of_protein = first.notes().iter().filter(|note| note.starts_with("protein"));
        of_protein.for_each(note);
    }
    Ok(problems)
}

/// The centre and the edges of the box about all given poses; `None` if one is not at the protein.
fn about_all<'a>(dockings: impl Iterator<Item = &'a Docking>) -> Option<[[f64; 3]; 2]> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for docking in dockings {
        let positions = docking.positions_at(&docking.given());
        let residues = docking.chains().iter().flat_map(|chain| &chain.residues);
        let mut atoms = residues.flat_map(|residue| &residue.atoms);
        let is_near = atoms
            .any(|atom| positions.iter().any(|position| (position - atom.position).norm() <= FAR));
        if !is_near {
            return None;
        }
        for position in &positions {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis]);
                high[axis] = high[axis].max(position[axis]);
            }
        }
    }
    let centre = [0, 1, 2].map(|axis| (low[axis] + high[axis]) / 2.0);
    let size = [0, 1, 2].map(|axis| high[axis] - low[axis] + BESIDE);
    Some([centre, size])
}

/// Grows the samples of a ligand, or goes on with them, and measures them.
fn ranked(
    arguments: &RankArguments,
    name: &str,
    problem: Problem,
    workers: &Workers,
    signals: &Arc<Signals>,
) -> Result<Ranked, Failure> {
    let folder = arguments.out.join(name);
    let growing = Run::begin(problem).workers(workers).signals(signals).folder(&folder);
    let growing = growing.max_seconds(arguments.max_time);
    let growing = match (arguments.force, arguments.or_resume) {
        (true, _) => growing.replace(),
        (_, true) => growing.or_resume(),
        _ => growing,
    };
    let named = |failure: Failure| {
        Failure::new(failure.code, format!("{}: {}", Plain(name), failure.message))
    };
    let ended = growing.grow().map_err(named)?;
    let (code, reason) = ended.outcome();
    // A limit that ends the build before the surface is covered is no failure here: the table says so.
    let gave_up = ended.stopped().gave_up();
    if !matches!(code, Code::Done | Code::NoSuccess) || gave_up {
        return Err(named(Failure::new(code, reason)));
    }
    note(format_args!("{}: {reason}", Plain(name)));
    let run = Run::at(&folder).read()?;
    let ModelKind::Docking(docking) = run.problem().model() else {
        return Err(named(Failure::usage(
            "a run of another model found; one of a ligand expected",
        )));
    };
    let exact = Exact::of(docking, run.problem().seed());
    let affinity = Affinity::of(&exact, docking, run.roadmap());
    let affinity = affinity.ok_or_else(|| {
        named(Failure::new(Code::NoSuccess, "no samples with a finite energy found"))
    })?;
    Ok(Ranked {
        name: name.to_owned(),
        heavy_atoms: docking.ligand().heavy_atoms(),
        degrees_of_freedom: docking.degrees_of_freedom(),
        samples: run.roadmap().configs().len(),
        is_covered: (!run.problem().evaluators().is_empty()).then_some(code == Code::Done),
        numbers: affinity.numbers(),
    })
}
