//! PDBQT files of ligands: PDB lines with a partial charge and an AutoDock type in place of the element, in the order of
//! a tree of torsions.
//!
//! G. M. Morris et al., "AutoDock4 and AutoDockTools4", J. Comput. Chem. 30 (2009) 2785-2791, and AutoDock's user guide.
//! The format lists no bonds: they are perceived from distances, and those of BRANCH records are single.

use super::super::check;
use super::super::error::{LigandError, LigandFault, syntax};
use super::super::perceive::bonds_by_distance;
use super::super::{Atom, BondOrder, BondSource, Element, Ligand};
use super::pdb::residue_and_chain;
use super::{columns, expect_ascii, expect_molecule, ligand, number, position};
use std::collections::BTreeMap;

/// A molecule that is being read.
#[derive(Default)]
struct Reading<'a> {
    /// By a remark.
    name: Option<&'a str>,
    /// The residue name of its first atom.
    residue: Option<&'a str>,
    /// The line at which it begins.
    line: usize,
    has_root: bool,
    in_root: bool,
    atoms: Vec<Atom>,
    /// Atoms by their serial numbers.
    serials: BTreeMap<&'a str, usize>,
    /// Branches that are open: the serial numbers of their axes.
    open: Vec<[&'a str; 2]>,
    /// The axes of all branches, with their lines.
    axes: Vec<([&'a str; 2], usize)>,
}

/// Reads every molecule of a PDBQT file: one, or one for each MODEL.
pub(super) fn read(text: &str) -> Result<Vec<Ligand>, LigandError> {
    let mut ligands = Vec::new();
    let mut reading = Reading { line: 1, ..Reading::default() };
    // The name that stands before the first MODEL is that of every model without one.
    let mut common: Option<Option<&str>> = None;
    for (line, content) in text.lines().enumerate().map(|(index, line)| (index + 1, line)) {
        match content.split_whitespace().next().unwrap_or("") {
            "MODEL" => {
                if reading.has_root {
                    let fault = syntax("MODEL within a molecule", "ENDMDL before it");
                    return Err(LigandError::at(line, fault));
                }
                let name = *common.get_or_insert(reading.name);
                reading = Reading { line, name, ..Reading::default() };
            }
            "ENDMDL" => {
                expect_molecule(ligands.len(), line)?;
                let next = Reading { line: line + 1, ..Reading::default() };
                ligands.push(std::mem::replace(&mut reading, next).finish()?);
            }
            _ => {
                let result = reading.take(content, line);
                result.map_err(|fault| LigandError::at(line, fault))?;
            }
        }
    }
    if reading.has_root || ligands.is_empty() {
        ligands.push(reading.finish()?);
    }
    Ok(ligands)
}

impl<'a> Reading<'a> {
    /// Takes a line that is neither MODEL nor ENDMDL.
    fn take(&mut self, content: &'a str, line: usize) -> Result<(), LigandFault> {
        let mut words = content.split_whitespace();
        let record = words.next().unwrap_or("");
        let mut axis = || Some([words.next()?, words.next()?]);
        let no_axis = || syntax(format!("{record} without two numbers"), "those of two atoms");
        match record {
            // Programs that prepare ligands write `REMARK  Name = ...`.
            "REMARK" => {
                let name = content["REMARK".len()..].trim().strip_prefix("Name");
                let name = name.and_then(|name| name.trim_start().strip_prefix('='));
                self.name = name.map(str::trim).or(self.name);
            }
            "ROOT" if self.has_root => {
                return Err(syntax("a second ROOT", "one molecule to a MODEL or file"));
            }
            "ROOT" => (self.has_root, self.in_root) = (true, true),
            "ENDROOT" => self.in_root = false,
            "BRANCH" => {
                let axis = axis().ok_or_else(no_axis)?;
                check::expect_room(self.axes.len() + 1)?;
                self.open.push(axis);
                self.axes.push((axis, line));
            }
            "ENDBRANCH" => {
                let axis = axis().ok_or_else(no_axis)?;
                if self.open.pop() != Some(axis) {
                    let [a, b] = axis;
                    let found = format!("ENDBRANCH {a} {b}");
                    return Err(syntax(found, "the end of the branch that began last"));
                }
            }
            "BEGIN_RES" => return Err(syntax("a flexible residue", "a ligand")),
            _ if ["ATOM  ", "HETATM"].contains(&columns(content, 0, 6)) => self.atom(content)?,
            _ => {}
        }
        Ok(())
    }

    fn atom(&mut self, line: &'a str) -> Result<(), LigandFault> {
        expect_ascii(line)?;
        let name = columns(line, 12, 16).trim();
        if !self.in_root && self.open.is_empty() {
            return Err(syntax(format!("atom `{name}` outside of ROOT and BRANCH"), "it in one"));
        }
        check::expect_room(self.atoms.len() + 1)?;
        let serial = columns(line, 6, 11).trim();
        if self.serials.insert(serial, self.atoms.len()).is_some() {
            return Err(syntax(format!("a second atom `{serial}`"), "each number once"));
        }
        let charge = columns(line, 66, 76).trim();
        let partial_charge = match charge {
            "" => None,
            _ => Some(number(charge, "the charge of an atom in columns 67 to 76")?),
        };
        self.residue.get_or_insert(residue_and_chain(line).0);
        self.atoms.push(Atom {
            name: name.to_owned(),
            element: element(columns(line, 77, 80).trim(), name)?,
            position: Some(position([
                columns(line, 30, 38),
                columns(line, 38, 46),
                columns(line, 46, 54),
            ])?),
            formal_charge: None,
            partial_charge,
        });
        Ok(())
    }

    fn finish(self) -> Result<Ligand, LigandError> {
        let fail = |fault| Err(LigandError::at(self.line, fault));
        if !self.has_root {
            return fail(syntax("a molecule without ROOT", "a ligand in the PDBQT format"));
        }
        if let Some([a, b]) = self.open.last() {
            return fail(syntax(format!("BRANCH {a} {b} without an end"), "its ENDBRANCH"));
        }
        let places: Vec<_> =
            self.atoms.iter().filter_map(|atom| Some((atom.element, atom.position?))).collect();
        let mut bonds =
            bonds_by_distance(&places).map_err(|fault| LigandError::at(self.line, fault))?;
        for (axis, line) in &self.axes {
            let mut atoms = [0; 2];
            for (atom, serial) in atoms.iter_mut().zip(axis) {
                let Some(known) = self.serials.get(serial) else {
                    let found = format!("BRANCH with atom {serial}, which is not there,");
                    return Err(LigandError::at(*line, syntax(found, "an atom of the molecule")));
                };
                *atom = *known;
            }
            atoms.sort_unstable();
            let Ok(bond) = bonds.binary_search_by_key(&atoms, |bond| bond.atoms) else {
                let [a, b] = axis;
                let found = format!("BRANCH {a} {b} of atoms that are not near each other");
                return Err(LigandError::at(*line, syntax(found, "atoms that are bonded")));
            };
            bonds[bond].order = BondOrder::Single;
        }
        let name = self.name.or(self.residue).unwrap_or("");
        ligand(name, self.line, self.atoms, bonds, BondSource::Distances)
    }
}

/// The element of an AutoDock type: `A` is an aromatic carbon; `HD`, `OA` and others say whether the atom takes part in
/// hydrogen bonds; `CG0` to `CG3` are carbons at which the ring of a macrocycle is opened. The dummy atoms at these,
/// `G0` to `G3`, are no elements.
fn element(kind: &str, name: &str) -> Result<Element, LigandFault> {
    let symbol = match kind {
        "A" | "CG0" | "CG1" | "CG2" | "CG3" => "C",
        "HD" | "HS" => "H",
        "NA" | "NS" => "N",
        "OA" | "OS" => "O",
        "SA" => "S",
        other => other,
    };
    // `D` and `T` would be hydrogen elsewhere, and are no types.
    let element = Some(symbol).filter(|symbol| !["D", "T"].contains(symbol));
    element.and_then(Element::of_symbol).ok_or_else(|| LigandFault::UnknownElement {
        found: kind.to_owned(),
        atom: name.to_owned(),
    })
}
