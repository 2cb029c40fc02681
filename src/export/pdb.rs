//! A path, or a roadmap's nodes, as the models of a PDB file: for PyMOL, ChimeraX, VMD and what else shows molecules.

use super::format::{CannotExport, ExportFile, Exported, RoadmapFormat};
use crate::model::Molecule;
use crate::structure::Residue;
use std::fmt::Write;

/// The PDB format (wwPDB, *Atomic coordinate entry format*, version 3.3): one model for every configuration of the path that
/// answers the query, in its order; without a path, one for every node in the order of their ids. All atoms of the source
/// structure are there, in Å; those beside the backbone move rigidly along.
pub(super) struct Pdb;

/// The columns hold no more.
const MODELS_MAX: usize = 9_999;
const ATOMS_MAX: usize = 99_999;
const COORDINATES: std::ops::Range<f64> = -999.999..9_999.999;
const NUMBERS: std::ops::RangeInclusive<i32> = -999..=9_999;

impl RoadmapFormat for Pdb {
    fn name(&self) -> &'static str {
        "pdb"
    }

    fn about(&self) -> &'static str {
        "The path's conformations, or all nodes, as models of a PDB file; of molecules only"
    }

    fn files(&self, exported: &Exported) -> Result<Vec<ExportFile>, CannotExport> {
        let Exported { problem, roadmap, path } = *exported;
        let molecule = problem.model.description().molecule();
        let molecule =
            molecule.ok_or_else(|| CannotExport("this model is no molecule".to_owned()))?;
        let configs: Vec<&[f64]> = match path {
            Some(path) => path.configs.iter().collect(),
            None => roadmap.configs().iter().collect(),
        };
        Ok(vec![ExportFile::named(pdb(molecule, configs.into_iter())?)])
    }
}

/// Conformations of a molecule as the models of a PDB file, numbered from 1 on, with all atoms of the source structure, in
/// Å.
///
/// # Errors
/// Says what does not fit into the columns of the format.
pub fn pdb<'a>(
    molecule: &dyn Molecule,
    configs: impl ExactSizeIterator<Item = &'a [f64]>,
) -> Result<String, CannotExport> {
    if configs.len() > MODELS_MAX {
        let found = configs.len();
        return Err(CannotExport(format!(
            "{found} models found; at most {MODELS_MAX} fit into a PDB file"
        )));
    }
    let mut out = String::new();
    for (index, q) in configs.enumerate() {
        writeln!(out, "MODEL     {:>4}", index + 1).expect("writing to memory cannot fail");
        model(&molecule.chains_at(q), &mut out)?;
        out += "ENDMDL\n";
    }
    out += "END\n";
    Ok(out)
}

/// Writes the atoms of one model, chain by chain, with a `TER` record behind each chain.
///
/// # Errors
/// As [`pdb`].
pub(super) fn model(chains: &[Vec<Residue>], out: &mut String) -> Result<(), CannotExport> {
    let mut serial = 0;
    for (chain, residues) in (b'A'..=b'Z').map(char::from).zip(chains) {
        for residue in residues {
            let (number, insertion) =
                (residue.number.number, residue.number.insertion.unwrap_or(' '));
            for atom in &residue.atoms {
                serial += 1;
                let [x, y, z] = atom.position.into();
                let fits = residue.name.len() <= 3
                    && atom.name.len() <= 4
                    && atom.element.len() <= 2
                    && serial <= ATOMS_MAX
                    && NUMBERS.contains(&number)
                    && [x, y, z].iter().all(|value| COORDINATES.contains(value));
                if !fits {
                    return Err(CannotExport(format!(
                        "{residue} {} does not fit into the columns of a PDB file",
                        atom.name
                    )));
                }
                // Elements of one letter begin in the second column of the name.
                let name = match (atom.element.len(), atom.name.len()) {
                    (1, 1..=3) => format!(" {:<3}", atom.name),
                    _ => format!("{:<4}", atom.name),
                };
                let element = atom.element.to_ascii_uppercase();
                writeln!(
                    out,
                    "ATOM  {serial:>5} {name} {:>3} {chain}{number:>4}{insertion}   {x:>8.3}{y:>8.3}{z:>8.3}  1.00  0.00          {element:>2}",
                    residue.name
                )
                .expect("writing to memory cannot fail");
            }
        }
        if let Some(last) = residues.last() {
            serial += 1;
            let number = last.number.number;
            let insertion = last.number.insertion.unwrap_or(' ');
            writeln!(out, "TER   {serial:>5}      {:>3} {chain}{number:>4}{insertion}", last.name)
                .expect("writing to memory cannot fail");
        }
    }
    if chains.len() > 26 {
        let found = chains.len();
        return Err(CannotExport(format!("{found} chains found; at most 26 fit into a PDB file")));
    }
    Ok(())
}
