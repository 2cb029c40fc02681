//! Groups of HETATM records of a PDB file: "Protein Data Bank Contents Guide", version 3.3, 2012.

use super::super::check;
use super::super::error::{LigandError, LigandFault};
use super::super::perceive::bonds_by_distance;
use super::super::{Atom, Bond, BondOrder, BondSource, Element, Ligand, graph};
use super::{columns, expect_ascii, expect_molecule, ligand, number, position};
use crate::structure::is_water;
use std::collections::BTreeMap;
use std::fmt;

/// Which group of a PDB file is meant: `BEN`, or `MTX` of chain `B`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    /// The residue name.
    pub residue: String,
    /// The chain; any if none is named.
    pub chain: Option<String>,
    /// The residue number; any if none is named.
    pub number: Option<i32>,
    /// The insertion code, a letter behind the number; any if none is named.
    pub insertion: Option<char>,
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.residue)?;
        if let Some(chain) = &self.chain {
            write!(f, " of chain `{chain}`")?;
        }
        if let Some(number) = self.number {
            write!(f, " with number {number}")?;
        }
        match (self.number, self.insertion) {
            (Some(_), Some(code)) => write!(f, "{code}")?,
            (None, Some(code)) => write!(f, " with insertion code {code}")?,
            (_, None) => {}
        }
        Ok(())
    }
}

/// A residue of HETATM records.
#[derive(Default)]
struct Residue<'a> {
    lines: Vec<(usize, &'a str)>,
}

/// What tells residues apart, as their columns have it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Key<'a> {
    chain: &'a str,
    number: &'a str,
    /// The insertion code.
    insertion: &'a str,
    residue: &'a str,
}

impl<'a> Key<'a> {
    fn of(line: &'a str) -> Key<'a> {
        let (residue, chain) = residue_and_chain(line);
        let (number, insertion) = (columns(line, 22, 26).trim(), columns(line, 26, 27).trim());
        Key { chain, number, insertion, residue }
    }

    fn is_meant(&self, wanted: &Group) -> bool {
        self.residue == wanted.residue
            && wanted.chain.as_deref().is_none_or(|chain| chain == self.chain)
            && wanted.number.is_none_or(|number| self.number.parse() == Ok(number))
            && wanted.insertion.is_none_or(|code| self.insertion.chars().eq([code]))
    }
}

impl fmt::Display for Key<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Key { chain, number, insertion, residue } = self;
        write!(f, "{residue} {number}{insertion} of chain `{chain}`")
    }
}

/// The residue's name, columns 18 to 20, and the chain, column 22. Column 21 is blank by the format; where it is not,
/// it ends a name of four letters if 18 to 20 are full, and begins a chain of two letters otherwise.
pub(super) fn residue_and_chain(line: &str) -> (&str, &str) {
    let (narrow, wide) = (columns(line, 17, 20), columns(line, 17, 21));
    let is_wide = wide.len() > 3 && !wide.ends_with(' ');
    match is_wide && wide.contains(' ') {
        true => (narrow.trim(), columns(line, 20, 22).trim()),
        false => (wide.trim(), columns(line, 21, 22).trim()),
    }
}

/// CONECT records by the serial number that they begin with.
type Conect<'a> = BTreeMap<&'a str, Vec<&'a str>>;

/// The residues of HETATM records of a text's first model, in their order, and its CONECT records.
struct Groups<'a> {
    residues: Vec<(Key<'a>, Residue<'a>)>,
    conect: Conect<'a>,
}

/// Every group of more than one atom, waters excepted.
pub(super) fn all(text: &str) -> Result<Vec<Ligand>, LigandError> {
    let groups = Groups::of(text)?;
    let candidates: Vec<_> = groups.candidates().collect();
    if candidates.is_empty() {
        let wanted = "of a ligand".to_owned();
        return Err(LigandError::pathless(LigandFault::NoGroup { wanted, there: Vec::new() }));
    }
    let mut ligands = Vec::new();
    for (_, residue) in candidates {
        expect_molecule(ligands.len(), residue.lines[0].0)?;
        ligands.push(residue.read(&groups.conect)?);
    }
    Ok(ligands)
}

/// The group that is meant.
pub(super) fn group(text: &str, wanted: &Group) -> Result<Ligand, LigandError> {
    let groups = Groups::of(text)?;
    let there = || groups.candidates().map(|(key, _)| key.to_string()).collect();
    let meant: Vec<_> = groups.residues.iter().filter(|(key, _)| key.is_meant(wanted)).collect();
    match &meant[..] {
        [] => Err(LigandError::pathless(LigandFault::NoGroup {
            wanted: wanted.to_string(),
            there: there(),
        })),
        found if is_water(&wanted.residue) => Err(LigandError::pathless(LigandFault::Water {
            residue: wanted.residue.clone(),
            count: found.len(),
            there: there(),
        })),
        [(_, residue)] => residue.read(&groups.conect),
        several => Err(LigandError::pathless(LigandFault::Several {
            count: several.len(),
            names: several.iter().map(|(key, _)| key.to_string()).collect(),
            choose: "choose it by chain, number and insertion code",
        })),
    }
}

impl<'a> Groups<'a> {
    fn of(text: &'a str) -> Result<Groups<'a>, LigandError> {
        let mut residues: Vec<(Key<'a>, Residue<'a>)> = Vec::new();
        let mut places: BTreeMap<Key<'a>, usize> = BTreeMap::new();
        let mut conect = Conect::new();
        let mut is_first_model = true;
        for (index, line) in text.lines().enumerate() {
            if ["HETATM", "ATOM  ", "CONECT"].iter().any(|record| line.starts_with(record)) {
                expect_ascii(line).map_err(|fault| LigandError::at(index + 1, fault))?;
            }
            match columns(line, 0, 6) {
                "HETATM" if is_first_model => {
                    let key = Key::of(line);
                    let place = *places.entry(key).or_insert_with(|| {
                        residues.push((key, Residue::default()));
                        residues.len() - 1
                    });
                    residues[place].1.lines.push((index + 1, line));
                }
                "ENDMDL" => is_first_model = false,
                "CONECT" => conect.entry(columns(line, 6, 11).trim()).or_default().push(line),
                _ => {}
            }
        }
        Ok(Groups { residues, conect })
    }

    /// The residues that may be meant when none is named.
    fn candidates(&self) -> impl Iterator<Item = &(Key<'a>, Residue<'a>)> {
        let is_candidate =
            |(key, residue): &&(Key, Residue)| !is_water(key.residue) && residue.chosen().len() > 1;
        self.residues.iter().filter(is_candidate)
    }
}

impl<'a> Residue<'a> {
    fn read(&self, conect: &Conect) -> Result<Ligand, LigandError> {
        let first = self.lines[0].0;
        let mut atoms = Vec::new();
        let mut places = Vec::new();
        let mut serials = Vec::new();
        for (number, line) in self.chosen() {
            check::expect_room(atoms.len() + 1).map_err(|fault| LigandError::at(number, fault))?;
            let atom = atom(line).map_err(|fault| LigandError::at(number, fault))?;
            places.extend(atom.position.map(|position| (atom.element, position)));
            serials.push(columns(line, 6, 11).trim());
            atoms.push(atom);
        }
        let (name, _) = residue_and_chain(self.lines[0].1);
        let listed = conect_bonds(&serials, conect);
        let neighbours = graph::neighbours(atoms.len(), &listed);
        if graph::pieces(&neighbours, |_| false).len() <= 1 && !listed.is_empty() {
            return ligand(name, first, atoms, listed, BondSource::Conect);
        }
        let bonds = bonds_by_distance(&places).map_err(|fault| LigandError::at(first, fault))?;
        ligand(name, first, atoms, bonds, BondSource::Distances)
    }

    /// The lines of the atoms that are taken, each with its number: of alternative locations those of one letter, that
    /// whose atoms have most occupancy together. An atom that does not have this letter is taken with its own of most
    /// occupancy. Of equal ones it is the first in the alphabet.
    fn chosen(&self) -> Vec<(usize, &'a str)> {
        let mut of_all: BTreeMap<&str, f64> = BTreeMap::new();
        let mut of_atoms: BTreeMap<&str, BTreeMap<&str, f64>> = BTreeMap::new();
        for (_, line) in &self.lines {
            let occupancy = number(columns(line, 54, 60), "occupancy").unwrap_or(1.0);
            if let Some(letter) = location(line) {
                *of_all.entry(letter).or_default() += occupancy;
                let of_atom = of_atoms.entry(columns(line, 12, 16)).or_default();
                *of_atom.entry(letter).or_default() += occupancy;
            }
        }
        let common = most_occupied(&of_all);
        let letter_of = |name| {
            let letters = of_atoms.get(name)?;
            common.filter(|letter| letters.contains_key(letter)).or_else(|| most_occupied(letters))
        };
        let is_chosen = |line: &'a str| {
            location(line).is_none_or(|letter| letter_of(columns(line, 12, 16)) == Some(letter))
        };
        self.lines.iter().filter(|(_, line)| is_chosen(line)).copied().collect()
    }
}

/// The letter of a line's alternative location, if there is one.
fn location(line: &str) -> Option<&str> {
    Some(columns(line, 16, 17)).filter(|letter| !letter.trim().is_empty())
}

/// The letter of most occupancy, of equal ones the first in the alphabet.
fn most_occupied<'a>(letters: &BTreeMap<&'a str, f64>) -> Option<&'a str> {
    let most = letters.iter().rev().max_by(|(_, one), (_, other)| one.total_cmp(other));
    most.map(|(letter, _)| *letter)
}

/// The atom of a line.
fn atom(line: &str) -> Result<Atom, LigandFault> {
    let field = columns(line, 12, 16);
    let position = position([columns(line, 30, 38), columns(line, 38, 46), columns(line, 46, 54)])?;
    let symbol = columns(line, 76, 78).trim();
    let element = if symbol.is_empty() { of_name(field) } else { Element::of_symbol(symbol) };
    let element = element.ok_or_else(|| LigandFault::UnknownElement {
        found: if symbol.is_empty() { field.to_owned() } else { symbol.to_owned() },
        atom: field.trim().to_owned(),
    })?;
    Ok(Atom {
        name: field.trim().to_owned(),
        element,
        position: Some(position),
        formal_charge: charge(columns(line, 78, 80)),
        partial_charge: None,
    })
}

/// The element of an atom by its name in four columns: the symbol ends with the second, so `CA  ` is calcium and ` CA ` a
/// carbon; names of four letters begin with hydrogen's, or that of another element of one letter, but for chlorine and bromine with
/// a number behind.
fn of_name(field: &str) -> Option<Element> {
    let trimmed = field.trim();
    let letters = trimmed.trim_start_matches(|c: char| !c.is_ascii_alphabetic());
    // Ligands with many halogens: `CL10`, `BR12`.
    let is_halogen = match trimmed.to_ascii_uppercase().as_bytes() {
        [b'C', b'L', digit, _] | [b'B', b'R', digit, _] => digit.is_ascii_digit(),
        _ => false,
    };
    let is_at_left =
        field.starts_with(|c: char| c.is_ascii_alphabetic()) && (trimmed.len() < 4 || is_halogen);
    let two = letters.get(..2).filter(|_| is_at_left).and_then(Element::of_symbol);
    two.or_else(|| letters.get(..1).and_then(Element::of_symbol))
}

/// A charge such as `2+` or `1-`; `None` where the columns are blank.
fn charge(text: &str) -> Option<i8> {
    let digits = text.trim();
    let (size, sign) = match digits.as_bytes() {
        [size @ b'0'..=b'9', sign] | [sign, size @ b'0'..=b'9'] => (size - b'0', sign),
        _ => return None,
    };
    let size = i8::try_from(size).ok()?;
    match sign {
        b'+' => Some(size),
        b'-' => Some(-size),
        _ => None,
    }
}

/// The bonds that CONECT records list between the atoms of these serial numbers.
///
/// A bond that a record repeats is a double or triple one, as many programs write them. Where none is repeated nothing
/// is told of orders, nor where all are, as some programs write every record twice.
fn conect_bonds(serials: &[&str], conect: &Conect) -> Vec<Bond> {
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    for (number, serial) in serials.iter().enumerate() {
        if numbers.insert(serial, number).is_some() {
            // Numbers beyond the five columns: there is no telling which atoms are meant.
            return Vec::new();
        }
    }
    // How often the record of the first atom lists the second.
    let mut listed: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let records = numbers.iter().flat_map(|(serial, from)| {
        conect.get(serial).into_iter().flatten().map(move |line| (from, line))
    });
    for (from, line) in records {
        for start in [11, 16, 21, 26] {
            let to = numbers.get(columns(line, start, start + 5).trim());
            if let Some(to) = to.filter(|to| *to != from) {
                *listed.entry([*from, *to]).or_default() += 1;
            }
        }
    }
    let mut times: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for ([a, b], count) in listed {
        let most = times.entry([a.min(b), a.max(b)]).or_default();
        *most = count.max(*most);
    }
    let tells_orders =
        times.values().any(|times| *times > 1) && times.values().any(|times| *times == 1);
    let order = |times| match times {
        1 if tells_orders => BondOrder::Single,
        2 if tells_orders => BondOrder::Double,
        3 if tells_orders => BondOrder::Triple,
        _ => BondOrder::Unknown,
    };
    times.into_iter().map(|(atoms, times)| Bond { atoms, order: order(times) }).collect()
}
