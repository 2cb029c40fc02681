//! SDF and molfiles, V2000 and V3000, by the crate `sdfrust`.
//!
//! "CTfile formats", Dassault Systèmes BIOVIA, 2020. The crate is given one record after the other, from its header to
//! `M  END`, with a cursor that tells at which line it stopped; data items behind that are not looked at. What it would
//! not refuse is checked before: numbers of atoms and bonds, for which it would ask for memory, charges, and what it
//! makes of characters other than ASCII.

use super::super::check::{self, BONDS_MAX};
use super::super::error::{LigandError, LigandFault, syntax};
use super::super::{Atom, Bond, BondOrder, BondSource, Element, Ligand};
use super::{columns, expect_molecule, ligand};
use crate::structure::Point;
use sdfrust::{Molecule, SdfError, SdfParser, SdfV3000Parser};
use std::io::Cursor;

/// The beginning of a line of V3000.
const V30: &str = "M  V30 ";

/// Reads every record of an SDF file.
pub(super) fn read(text: &str) -> Result<Vec<Ligand>, LigandError> {
    let mut ligands = Vec::new();
    let mut record: Vec<&str> = Vec::new();
    let mut first = 1;
    let mut finish = |record: &[&str], first: usize| {
        // Blank lines at the end are no molecule.
        if record.iter().all(|line| line.trim().is_empty()) {
            return Ok(());
        }
        expect_molecule(ligands.len(), first)?;
        ligands.push(molecule(record, first)?);
        Ok(())
    };
    for (index, line) in text.lines().enumerate() {
        if line.starts_with("$$$$") {
            finish(&record, first)?;
            record.clear();
            first = index + 2;
        } else {
            record.push(line);
        }
    }
    finish(&record, first)?;
    Ok(ligands)
}

/// A molecule of the crate, and for each of its atoms the place of its line in the record.
type Found = (Molecule, Vec<usize>);

/// The molecule of a record whose first line has the number `first`.
fn molecule(record: &[&str], first: usize) -> Result<Ligand, LigandError> {
    let end = record.iter().position(|line| line.starts_with("M  END"));
    let record = &record[..end.map_or(record.len(), |end| end + 1)];
    let Some(counts) = record.get(3) else {
        let found = format!("a header of {} lines only", record.len());
        return Err(LigandError::at(first, syntax(found, "three lines and the line of counts")));
    };
    if columns(record[1], 20, 22) == "2D" {
        let found = "a drawing in two dimensions".to_owned();
        return Err(LigandError::at(first + 1, LigandFault::NoCoordinates(found)));
    }
    let (molecule, places) =
        if counts.contains("V3000") { v3000(record, first)? } else { v2000(record, first)? };
    let line = |atom: usize| first + places.get(atom).copied().unwrap_or(0);
    let (atoms, bonds) =
        convert(&molecule).map_err(|(atom, fault)| LigandError::at(line(atom), fault))?;
    ligand(record[0], first, atoms, bonds, BondSource::Format)
}

fn v2000(record: &[&str], first: usize) -> Result<Found, LigandError> {
    if let Ok(atoms) = columns(record[3], 0, 3).trim().parse() {
        check::expect_room(atoms).map_err(|fault| LigandError::at(first + 3, fault))?;
        for (place, line) in record.iter().enumerate().skip(4).take(atoms) {
            check_v2000_charge(line).map_err(|fault| LigandError::at(first + place, fault))?;
        }
    }
    for (place, line) in record.iter().enumerate().skip(4) {
        // Behind the number of pairs, each of an atom and its charge.
        let words = line.strip_prefix("M  CHG").into_iter().flat_map(str::split_whitespace);
        for charge in words.skip(2).step_by(2) {
            check_charge(charge).map_err(|fault| LigandError::at(first + place, fault))?;
        }
    }
    let text = record.join("\n");
    let mut cursor = Cursor::new(text.as_bytes());
    let found = SdfParser::new(&mut cursor).parse_molecule();
    let line = first + line_of(&cursor) - 1;
    let molecule = found.map_err(|error| LigandError::at(line, fault(&error)))?;
    let molecule = molecule.ok_or_else(|| LigandError::at(first, LigandFault::Empty))?;
    let places = (4..).take(molecule.atoms.len()).collect();
    Ok((molecule, places))
}

fn v3000(record: &[&str], first: usize) -> Result<Found, LigandError> {
    let lines = v3000_lines(record);
    check_counts(&lines).map_err(|fault| LigandError::at(first, fault))?;
    for (place, line) in v3000_atoms(&lines) {
        check_v3000_charge(line).map_err(|fault| LigandError::at(first + place, fault))?;
    }
    // Only labels have other characters than ASCII, and labels are not used.
    let is_odd = |c: char| !c.is_ascii();
    let body = record[4..].join("\n").replace(is_odd, "?");
    let mut cursor = Cursor::new(body.as_bytes());
    let mut parser = SdfV3000Parser::new(&mut cursor);
    let found = parser.parse_molecule_body(String::new(), None, None);
    let line = first + 3 + line_of(&cursor);
    let molecule = found.map_err(|error| LigandError::at(line, fault(&error)))?;
    let mut numbers: Vec<u32> = molecule.atoms.iter().filter_map(|atom| atom.v3000_id).collect();
    numbers.sort_unstable();
    if let Some(twice) = numbers.windows(2).find(|two| two[0] == two[1]) {
        let found = format!("two atoms with the number {}", twice[0]);
        let fault = syntax(found, "each number once");
        return Err(LigandError::at(first, fault));
    }
    let places = v3000_atoms(&lines).iter().map(|(place, _)| *place).collect();
    Ok((molecule, places))
}

/// The lines of V3000 in a record, each with the place of its first line: one that ends in `-` goes on in the next.
fn v3000_lines(record: &[&str]) -> Vec<(usize, String)> {
    let mut lines: Vec<(usize, String)> = Vec::new();
    let mut goes_on = false;
    for (place, line) in record.iter().enumerate() {
        let Some(line) = line.strip_prefix(V30) else { continue };
        if !goes_on {
            lines.push((place, String::new()));
        }
        goes_on = line.ends_with('-');
        if let Some((_, whole)) = lines.last_mut() {
            whole.push_str(line.strip_suffix('-').unwrap_or(line));
        }
    }
    lines
}

/// That a record of V3000 does not announce more atoms or bonds than are taken.
fn check_counts(lines: &[(usize, String)]) -> Result<(), LigandFault> {
    for counts in lines.iter().filter_map(|(_, line)| line.strip_prefix("COUNTS ")) {
        let mut numbers = counts.split_whitespace().map(|word| word.parse().unwrap_or(0));
        check::expect_room(numbers.next().unwrap_or(0))?;
        if let Some(found) = numbers.next().filter(|bonds| *bonds > BONDS_MAX) {
            return Err(LigandFault::TooMany { found, what: "bonds", most: BONDS_MAX });
        }
    }
    Ok(())
}

/// The lines of atoms among those of V3000.
fn v3000_atoms(lines: &[(usize, String)]) -> &[(usize, String)] {
    let place = |begin: &str| lines.iter().position(|(_, line)| line.starts_with(begin));
    let start = place("BEGIN ATOM").map_or(lines.len(), |begin| begin + 1);
    let end = place("END ATOM").filter(|end| *end >= start).unwrap_or(lines.len());
    &lines[start..end]
}

/// That the charge of an atom's line in V3000 is one, if the line has any: the crate would take it for 0.
fn check_v3000_charge(line: &str) -> Result<(), LigandFault> {
    let pairs = line.split_whitespace().skip(6).filter_map(|word| word.split_once('='));
    for (_, charge) in pairs.filter(|(key, _)| key.eq_ignore_ascii_case("CHG")) {
        check_charge(charge)?;
    }
    Ok(())
}

/// That the code for the charge of an atom's line in V2000 is one, if the line has any: the crate would take it for 0.
fn check_v2000_charge(line: &str) -> Result<(), LigandFault> {
    let code = columns(line, 36, 39).trim();
    if code.is_empty() || code.parse().is_ok_and(|code: u8| code <= 7) {
        return Ok(());
    }
    Err(LigandFault::BadNumber {
        found: format!("`{code}`"),
        expected: "the charge of an atom, 0 to 7 in columns 37 to 39,".to_owned(),
    })
}

/// That a formal charge is one that the format has.
fn check_charge(text: &str) -> Result<(), LigandFault> {
    if text.parse().is_ok_and(|charge: i8| (-15..=15).contains(&charge)) {
        return Ok(());
    }
    Err(LigandFault::BadNumber {
        found: format!("`{text}`"),
        expected: "a charge of -15 to 15".to_owned(),
    })
}

/// The line, counted from 1, that the cursor has read last.
fn line_of(cursor: &Cursor<&[u8]>) -> usize {
    let text: &[u8] = cursor.get_ref();
    let read = usize::try_from(cursor.position()).map_or(text.len(), |read| read.min(text.len()));
    let ended = text[..read].iter().filter(|byte| **byte == b'\n').count();
    let is_inside = read > 0 && text[read - 1] != b'\n';
    (ended + usize::from(is_inside)).max(1)
}

/// What the crate says, as what was found and what is expected.
fn fault(error: &SdfError) -> LigandFault {
    match error {
        SdfError::Parse { message, .. }
        | SdfError::InvalidV3000AtomLine { message, .. }
        | SdfError::InvalidV3000BondLine { message, .. }
        | SdfError::InvalidV3000Block(message) => {
            syntax(format!("a line that is no part of an SDF record ({message})"), "another")
        }
        SdfError::AtomCountMismatch { expected, found } => {
            syntax(format!("{found} atoms"), format!("{expected}, by the line of counts,"))
        }
        SdfError::BondCountMismatch { expected, found } => {
            syntax(format!("{found} bonds"), format!("{expected}, by the line of counts,"))
        }
        SdfError::InvalidAtomIndex { index, atom_count } => {
            LigandFault::BadBond(format!("atom {index} of {atom_count}"))
        }
        SdfError::AtomIdNotFound { id } => {
            LigandFault::BadBond(format!("atom {id}, which is not there,"))
        }
        SdfError::InvalidBondOrder(order) => {
            syntax(format!("`{order}` as the type of a bond"), "1 to 10")
        }
        SdfError::InvalidCountsLine(line) => syntax(
            format!("`{}` as the line of counts", line.trim()),
            "the numbers of atoms and bonds in three columns each",
        ),
        SdfError::InvalidCoordinate(text) => LigandFault::BadNumber {
            found: format!("`{}`", text.trim()),
            expected: "a coordinate in Å".to_owned(),
        },
        other => syntax(format!("a record that cannot be read ({other})"), "an SDF record"),
    }
}

/// The crate's atoms and bonds as this library's; an error with the atom that it is of.
fn convert(molecule: &Molecule) -> Result<(Vec<Atom>, Vec<Bond>), (usize, LigandFault)> {
    let mut atoms = Vec::with_capacity(molecule.atoms.len());
    for (index, atom) in molecule.atoms.iter().enumerate() {
        let element = Element::of_symbol(&atom.element).ok_or_else(|| {
            let found = atom.element.clone();
            (index, LigandFault::UnknownElement { found, atom: (index + 1).to_string() })
        })?;
        let position = Point::new(atom.x, atom.y, atom.z);
        check::check_position(&position, index).map_err(|fault| (index, fault))?;
        atoms.push(Atom {
            name: String::new(),
            element,
            position: Some(position),
            formal_charge: Some(atom.formal_charge),
            partial_charge: None,
        });
    }
    let order = |order| match order {
        sdfrust::BondOrder::Single => Some(BondOrder::Single),
        sdfrust::BondOrder::Double => Some(BondOrder::Double),
        sdfrust::BondOrder::Triple => Some(BondOrder::Triple),
        sdfrust::BondOrder::Aromatic => Some(BondOrder::Aromatic),
        // Hydrogen bonds join no atoms to a molecule.
        sdfrust::BondOrder::Hydrogen => None,
        _ => Some(BondOrder::Unknown),
    };
    let bonds = molecule.bonds.iter();
    let bonds = bonds.filter_map(|bond| {
        Some(Bond { atoms: [bond.atom1, bond.atom2], order: order(bond.order)? })
    });
    Ok((atoms, bonds.collect()))
}
