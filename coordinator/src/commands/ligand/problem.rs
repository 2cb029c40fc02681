use super::model::{molecules, spec_of};
use crate::cli::LigandProblemArguments;
use crate::commands::written::write_problem;
use crate::exit::{Code, Failure};
use crate::output::{Plain, line};
use roadmill::ligand;
use roadmill::model::ModelKind;
use roadmill::model::docking::{Docking, DockingSpec, LigandFile, LigandSpec};
use roadmill::problem::{PoseSearch, docking};
use std::path::Path;

/// The edge of the box about a ligand, Å: 60 steps of AutoDock's usual grid.
const EDGE: f64 = 22.5;
/// What the box has beside the ligand's own extent at least, Å.
const BESIDE: f64 = 10.0;

/// Writes the search for a ligand's poses at a protein as a problem file.
pub fn problem(arguments: &LigandProblemArguments) -> Result<Code, Failure> {
    let LigandProblemArguments { protein, receptor, model, region, out, force, .. } = arguments;
    let mut spec = spec_of(protein, ligand_of(arguments)?, receptor, model, region);
    if let Some(edge) = arguments.box_around_ligand {
        spec = boxed(spec, edge)?;
    }
    let hints = match &arguments.hints {
        None => Vec::new(),
        Some(file) => ligand::read_all(file).map_err(Failure::usage)?,
    };
    let search =
        PoseSearch { nodes: arguments.nodes, hints, ends_when_covered: arguments.until_covered };
    let name = out.file_stem().unwrap_or_default().to_string_lossy();
    let made = docking(&name, Path::new(""), &spec, &search).map_err(Failure::usage)?;
    let made = made.with_seed(arguments.seed.unwrap_or(roadmill::problem::DEFAULT_SEED));
    write_problem(&made, "# Written by `roadmill ligand problem`.\n", out, (*force, false))?;
    if let ModelKind::Docking(docking) = made.model() {
        announce(docking, made.limits().nodes);
    }
    Ok(Code::Done)
}

/// The ligand that the command line names.
fn ligand_of(arguments: &LigandProblemArguments) -> Result<LigandSpec, Failure> {
    let LigandProblemArguments { protein, ligand, chain, number, molecule, .. } = arguments;
    let path = Path::new(ligand);
    if path.exists() {
        if chain.is_some() || number.is_some() {
            let message = format!(
                "--chain and --number: of no use to the file {ligand}; the name of a residue of {} as --ligand expected",
                protein.display()
            );
            return Err(Failure::usage(message));
        }
        let file = LigandFile::new(path);
        return Ok(LigandSpec::File(match molecule {
            Some(name) => file.molecule(name),
            None => file,
        }));
    }
    let is_residue =
        (1..=4).contains(&ligand.len()) && ligand.bytes().all(|byte| byte.is_ascii_alphanumeric());
    if !is_residue {
        let message = format!(
            "--ligand: {ligand} found, which is no file; a file, or the name of a residue of {} expected",
            protein.display()
        );
        return Err(Failure::usage(message));
    }
    if molecule.is_some() {
        return Err(Failure::usage(
            "--molecule: of no use to a residue; a file as --ligand expected",
        ));
    }
    Ok(LigandSpec::File(LigandFile::new(protein).residue(ligand, chain.clone(), *number)))
}

/// The spec with a cube about the centroid of the ligand's given pose.
fn boxed(spec: DockingSpec, edge: Option<f64>) -> Result<DockingSpec, Failure> {
    let docking = molecules(&spec)?;
    let positions = docking.positions_at(&docking.given());
    let mut extent: f64 = 0.0;
    let mut centre = [0.0; 3];
    for axis in 0..3 {
        let along = || positions.iter().map(|position| position[axis]);
        let low = along().fold(f64::INFINITY, f64::min);
        extent = extent.max(along().fold(low, f64::max) - low);
        centre[axis] = along().sum::<f64>() / positions.len() as f64;
    }
    let edge = edge.unwrap_or(EDGE.max(extent + BESIDE));
    Ok(spec.region(centre, [edge; 3]))
}

fn announce(docking: &Docking, nodes: u64) {
    let ligand = docking.ligand();
    let residues: usize = docking.chains().iter().map(|chain| chain.residues.len()).sum();
    let [min, max] = docking.bounds();
    let edges = [0, 1, 2].map(|axis| format!("{:.1}", max[axis] - min[axis])).join(" x ");
    line(format_args!("protein          {residues} residues in {} chains", docking.chains().len()));
    line(format_args!(
        "ligand           {}: {} heavy atoms, {} degrees of freedom",
        Plain(ligand.name()),
        ligand.heavy_atoms(),
        docking.degrees_of_freedom()
    ));
    line(format_args!("box              {edges} Å"));
    line(format_args!("nodes            {nodes}"));
}
