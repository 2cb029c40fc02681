//! MOL2 files: "Tripos Mol2 File Format", Tripos 2007.
//!
//! A reader of its own, for what others drop: the names of atoms, and bond types that say that there is no bond
//! (`nc`) or that its order is not known (`un`, `du`).

use super::super::check;
use super::super::error::{LigandError, LigandFault, syntax};
use super::super::{Atom, Bond, BondOrder, BondSource, Element, Ligand};
use super::{expect_molecule, ligand, number, position};
use std::collections::BTreeMap;

/// What begins a section.
const SECTION: &str = "@<TRIPOS>";

/// A molecule that is being read.
#[derive(Default)]
struct Reading<'a> {
    /// The line of its section MOLECULE.
    line: usize,
    /// The lines of that section that are not blank: name, counts, type, charges.
    header: Vec<&'a str>,
    atoms: Vec<Atom>,
    /// Atoms by what stands in their first column.
    ids: BTreeMap<&'a str, usize>,
    bonds: Vec<Bond>,
    /// The lines of the section BOND, those included that say that there is no bond.
    bond_lines: usize,
}

/// Reads every molecule of a MOL2 file.
pub(super) fn read(text: &str) -> Result<Vec<Ligand>, LigandError> {
    let mut ligands = Vec::new();
    let mut reading: Option<Reading> = None;
    let mut section = "";
    for (line, content) in text.lines().enumerate().map(|(index, line)| (index + 1, line)) {
        if let Some(name) = content.strip_prefix(SECTION) {
            section = name.trim();
            if section == "MOLECULE" {
                if let Some(molecule) = reading.take() {
                    ligands.push(molecule.finish()?);
                }
                expect_molecule(ligands.len(), line)?;
                reading = Some(Reading { line, ..Reading::default() });
            }
            continue;
        }
        let is_header = section == "MOLECULE";
        // A molecule without a name has a blank line for it, and a name may begin with the sign of comments.
        let is_name =
            is_header && reading.as_ref().is_some_and(|molecule| molecule.header.is_empty());
        if !is_name && (content.starts_with('#') || content.trim().is_empty()) {
            continue;
        }
        let Some(molecule) = &mut reading else {
            if section == "ATOM" || section == "BOND" {
                let fault =
                    syntax(format!("the section {section} before any molecule"), "MOLECULE");
                return Err(LigandError::at(line, fault));
            }
            continue;
        };
        let result = match section {
            "MOLECULE" => {
                molecule.header.push(content);
                Ok(())
            }
            "ATOM" => molecule.atom(content),
            "BOND" => molecule.bond(content),
            _ => Ok(()),
        };
        result.map_err(|fault| LigandError::at(line, fault))?;
    }
    if let Some(molecule) = reading {
        ligands.push(molecule.finish()?);
    }
    Ok(ligands)
}

impl<'a> Reading<'a> {
    /// Takes a line `id name x y z type [residue residue_name [charge]]`.
    fn atom(&mut self, line: &'a str) -> Result<(), LigandFault> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [id, name, x, y, z, kind, rest @ ..] = &words[..] else {
            let found = format!("{} words in the line of an atom", words.len());
            return Err(syntax(found, "number, name, x, y, z and type"));
        };
        check::expect_room(self.atoms.len() + 1)?;
        // A type is a symbol, or a symbol and the kind of neighbourhood behind a point: `C.ar`.
        let symbol = kind.split('.').next().unwrap_or(kind);
        let element = Element::of_symbol(symbol).ok_or_else(|| LigandFault::UnknownElement {
            found: (*kind).to_owned(),
            atom: format!("{name} ({id})"),
        })?;
        let partial_charge = match rest.get(2).filter(|_| !self.has_no_charges()) {
            Some(charge) => Some(number(charge, "the charge of an atom")?),
            None => None,
        };
        if self.ids.insert(id, self.atoms.len()).is_some() {
            return Err(syntax(format!("a second atom `{id}`"), "each number once"));
        }
        self.atoms.push(Atom {
            name: (*name).to_owned(),
            element,
            position: Some(position([x, y, z])?),
            formal_charge: None,
            partial_charge,
        });
        Ok(())
    }

    /// Takes a line `id atom atom type`.
    fn bond(&mut self, line: &str) -> Result<(), LigandFault> {
        self.bond_lines += 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, first, second, kind, ..] = words[..] else {
            let found = format!("{} words in the line of a bond", words.len());
            return Err(syntax(found, "number, two atoms and type"));
        };
        let atom = |id: &str| {
            let known = self.ids.get(id).copied();
            known.ok_or_else(|| LigandFault::BadBond(format!("atom `{id}`, which is not there,")))
        };
        let atoms = [atom(first)?, atom(second)?];
        let order = match kind.to_ascii_lowercase().as_str() {
            // An amide's bond is single.
            "1" | "am" => BondOrder::Single,
            "2" => BondOrder::Double,
            "3" => BondOrder::Triple,
            "ar" => BondOrder::Aromatic,
            "un" | "du" => BondOrder::Unknown,
            // Not connected.
            "nc" => return Ok(()),
            _ => {
                let found = format!("`{kind}` as the type of a bond");
                return Err(syntax(found, "1, 2, 3, am, ar, du, un or nc"));
            }
        };
        self.bonds.push(Bond { atoms, order });
        Ok(())
    }

    fn has_no_charges(&self) -> bool {
        self.header.get(3).is_some_and(|line| line.trim() == "NO_CHARGES")
    }

    fn finish(self) -> Result<Ligand, LigandError> {
        let counts = self.header.get(1).unwrap_or(&"");
        let mut numbers = counts.split_whitespace().map(str::parse::<usize>);
        let (Some(Ok(atoms)), Ok(bonds)) = (numbers.next(), numbers.next().unwrap_or(Ok(0))) else {
            let found = format!("`{}` as the numbers of atoms and bonds", counts.trim());
            return Err(LigandError::at(self.line, syntax(found, "whole numbers")));
        };
        for (found, expected, what) in
            [(self.atoms.len(), atoms, "atoms"), (self.bond_lines, bonds, "bonds")]
        {
            if found != expected {
                let expected = format!("{expected}, by the third line of the molecule,");
                let fault = syntax(format!("{found} {what}"), expected);
                return Err(LigandError::at(self.line, fault));
            }
        }
        let name = self.header.first().unwrap_or(&"");
        ligand(name, self.line, self.atoms, self.bonds, BondSource::Format)
    }
}
