//! From what a problem asks for to a checked model of docking.

use super::kinematics::Linkage;
use super::receptor::{LigandResidue, receptor};
use super::spec::{LigandFile, LigandSpec, Policy, RegionSpec};
use super::{Docking, DockingSpec, STEP};
use crate::ligand::{self, BondSource, Group, Ligand, LinkRule};
use crate::source::Step::Key;
use crate::source::{ProblemError, Source};
use crate::structure::Point;

/// The highest energy that is valid unless the file says otherwise, kJ/mol (Bayazit 2003, chapter V D).
const HIGHEST: f64 = 5_000.0;
/// How far beyond the protein's own box the ligand's atoms can be in its given shape, Å, where no box is given.
const MARGIN: f64 = 4.0;

/// Checks a problem of docking and makes what is asked for.
pub(super) fn resolve(
    spec: &DockingSpec,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Docking, ProblemError> {
    let DockingSpec { protein, ligand, hydrogens, rigid, amides, .. } = spec;
    let place = |key| [Key("docking"), Key(key)];
    let found = ligand_of(ligand, source, notes)
        .map_err(|message| source.error(&place("ligand"), message))?;
    let residue = residue_of(ligand, &found);
    let chains = receptor(protein, *hydrogens, residue.as_ref(), source, notes)
        .map_err(|error| source.error(&place("protein"), error.to_string()))?;
    let kept = match hydrogens {
        Policy::Keep => Some(found),
        Policy::Remove => found.without_hydrogens(),
    };
    let Some(ligand) = kept.map(Ligand::detached) else {
        let message = "fewer than two atoms that are not hydrogen found; at least two expected";
        return Err(source.error(&place("ligand"), message.to_owned()));
    };
    let rule = LinkRule { amides: *amides };
    let Some(linkage) = Linkage::of(&ligand, rule, *rigid) else {
        let message = "no positions found; a molecule with positions in space expected";
        return Err(source.error(&place("ligand"), message.to_owned()));
    };
    let atoms = || chains.iter().flat_map(|chain| &chain.residues).flat_map(|of| &of.atoms);
    let bounds = match spec.region {
        Some(RegionSpec { min, max }) => [min, max],
        None => around(atoms().map(|atom| atom.position), MARGIN + linkage.radius()),
    };
    let reach = linkage.reach();
    let away = atoms().map(|atom| outside(bounds, atom.position)).fold(f64::INFINITY, f64::min);
    note_distance(&ligand, atoms().map(|atom| atom.position), notes);
    let docking = Docking {
        chains,
        ligand,
        rigid: *rigid,
        amides: *amides,
        bounds,
        energy: spec.energy.clone(),
        grid: spec.grid,
        highest: spec.highest.unwrap_or(HIGHEST),
        step: spec.step.unwrap_or(STEP),
    };
    if let Some((key, message)) = docking.complaint() {
        return Err(source.error(&place(key), message));
    }
    let farthest = reach + docking.energy.cutoff;
    if away > farthest {
        let message = format!(
            "a box {away:.2} Å from the nearest atom of the protein found; one at most {farthest:.2} Å away expected, as far as this ligand's atoms can reach and energies count"
        );
        return Err(source.error(&place("box"), message));
    }
    Ok(docking)
}

/// The ligand of a file, or the one that is given.
fn ligand_of(
    spec: &LigandSpec,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Ligand, String> {
    let LigandFile { file, molecule, residue, chain, number } = match spec {
        LigandSpec::Molecule(ligand) => return Ok(ligand.clone()),
        LigandSpec::File(file) => file,
    };
    let path = source.folder.join(file);
    let found = match (residue, molecule) {
        (Some(_), Some(_)) => {
            return Err("both `residue` and `molecule` found; one of them expected".to_owned());
        }
        (Some(residue), None) => {
            let (residue, chain, number) = (residue.clone(), chain.clone(), *number);
            ligand::read_group(&path, &Group { residue, chain, number, insertion: None })
        }
        (None, _) if chain.is_some() || number.is_some() => {
            return Err("`chain` or `number` without `residue` found; the name of a residue of a \
                        PDB file expected"
                .to_owned());
        }
        (None, None) => ligand::read(&path),
        (None, Some(name)) => return named(&path, file, name, source),
    };
    let found = found.map_err(|error| error.to_string())?;
    note_file(&path, file, source);
    if found.bond_source() == BondSource::Distances {
        notes.push("ligand: bonds are perceived from distances".to_owned());
    }
    let unknown = found.bonds().iter().filter(|bond| bond.order == ligand::BondOrder::Unknown);
    let unknown = unknown.count();
    if unknown > 0 {
        let links = found.torsion_links(LinkRule::default()).len();
        notes.push(format!(
            "ligand: the orders of {unknown} bonds are not known; by their lengths {links} bonds are torsion links"
        ));
    }
    Ok(found)
}

/// The molecule of this name in a file of several.
fn named(
    path: &std::path::Path,
    file: &std::path::Path,
    name: &str,
    source: &Source,
) -> Result<Ligand, String> {
    let all = ligand::read_all(path).map_err(|error| error.to_string())?;
    note_file(path, file, source);
    let of_name: Vec<&Ligand> = all.iter().filter(|ligand| ligand.name() == name).collect();
    match of_name[..] {
        [one] => Ok(one.clone()),
        [] => {
            let names: Vec<String> =
                all.iter().map(|ligand| format!("`{}`", ligand.name())).take(20).collect();
            let (path, names) = (path.display(), names.join(", "));
            Err(format!("{path}: no molecule `{name}` found; one of {names} expected"))
        }
        _ => {
            let (path, count) = (path.display(), of_name.len());
            Err(format!("{path}: {count} molecules `{name}` found; a name of one expected"))
        }
    }
}

/// Notes that a file was read. A file that cannot be read any more, though it just could, is not noted.
fn note_file(path: &std::path::Path, name: &std::path::Path, source: &Source) {
    if let Ok(bytes) = crate::source::read_file(path) {
        source.read(crate::digest::SourceFile {
            path: name.to_string_lossy().into_owned(),
            ..crate::digest::SourceFile::named(path, &bytes)
        });
    }
}

/// The residue of the protein's file that the ligand may be: a ligand that is a group of a PDB file is no part of the protein.
fn residue_of(spec: &LigandSpec, ligand: &Ligand) -> Option<LigandResidue> {
    let LigandSpec::File(_) = spec else { return None };
    let heavy = ligand.atoms().iter().filter(|atom| atom.element.is_heavy());
    Some(LigandResidue { atoms: heavy.map(|atom| atom.position).collect::<Option<_>>()? })
}

/// The box of some points, widened on all sides.
fn around(points: impl Iterator<Item = Point>, margin: f64) -> [[f64; 3]; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for point in points {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(point[axis]);
            bounds[1][axis] = bounds[1][axis].max(point[axis]);
        }
    }
    [bounds[0].map(|low| low - margin), bounds[1].map(|high| high + margin)]
}

/// How far a point is from a box, 0 within it.
fn outside([min, max]: [[f64; 3]; 2], point: Point) -> f64 {
    let beyond = |axis: usize| (min[axis] - point[axis]).max(point[axis] - max[axis]).max(0.0);
    (beyond(0) * beyond(0) + beyond(1) * beyond(1) + beyond(2) * beyond(2)).sqrt()
}

/// Says how far the ligand's given pose is from the protein, if it is far.
fn note_distance(ligand: &Ligand, protein: impl Iterator<Item = Point>, notes: &mut Vec<String>) {
    /// From here on, Å, the given pose is none at the protein.
    const FAR: f64 = 8.0;
    let Some(positions) = ligand.positions() else { return };
    let to = |atom: Point| {
        positions.iter().map(|of| (of - atom).norm_squared()).fold(f64::INFINITY, f64::min)
    };
    let nearest = protein.map(to).fold(f64::INFINITY, f64::min).sqrt();
    if nearest > FAR {
        notes.push(format!(
            "ligand: its given pose is {nearest:.1} Å from the protein: only its shape is used"
        ));
    }
}

/// That of a checked model.
pub(super) fn to_spec(docking: &Docking) -> DockingSpec {
    let Docking { chains, ligand, rigid, amides, bounds, energy, grid, highest, step } =
        docking.clone();
    let [min, max] = bounds;
    DockingSpec {
        protein: super::ReceptorSpec::Chains(chains),
        ligand: LigandSpec::Molecule(ligand),
        hydrogens: Policy::Keep,
        rigid,
        amides,
        region: Some(RegionSpec { min, max }),
        energy,
        grid,
        highest: Some(highest),
        step: Some(step),
    }
}
