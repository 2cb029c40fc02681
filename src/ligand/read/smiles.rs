//! SMILES: D. Weininger, J. Chem. Inf. Comput. Sci. 28 (1988) 31-36; "OpenSMILES specification", 2016.
//!
//! What counts here are atoms, bonds and rings: isotopes, atom classes and stereochemistry are read and passed over.

use super::super::check;
use super::super::error::{LigandError, LigandFault, syntax};
use super::super::graph::{in_rings, neighbours};
use super::super::{Atom, Bond, BondOrder, Element, Ligand};
use std::collections::BTreeMap;

/// Symbols that need no brackets, the longer ones first, and those of aromatic atoms, with and without brackets.
const PLAIN: [&str; 10] = ["Cl", "Br", "B", "C", "N", "O", "P", "S", "F", "I"];
const AROMATIC: [&str; 6] = ["b", "c", "n", "o", "p", "s"];
const AROMATIC_IN_BRACKETS: [&str; 10] = ["se", "as", "te", "si", "b", "c", "n", "o", "p", "s"];

/// A molecule from SMILES, without positions, to count atoms, rings and torsion links. A name may follow behind a blank.
///
/// Hydrogens that the text leaves to valences, or has in brackets with another atom, are not among the atoms.
///
/// # Errors
/// What is no SMILES, with the character at which that shows; what is not read: atoms of any element (`*`), quadruple
/// bonds; several molecules (`.`); and what [`Ligand::new`] refuses, as a single atom.
pub fn from_smiles(text: &str) -> Result<Ligand, LigandError> {
    let text = text.trim();
    let (smiles, name) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    if smiles.is_empty() {
        return Err(LigandError::pathless(LigandFault::Empty));
    }
    let mut reading = Reading { text: smiles, ..Reading::default() };
    let bonds = reading.read().map_err(LigandError::pathless)?;
    Ligand::new(name.trim(), reading.atoms, bonds)
}

/// SMILES that is being read.
#[derive(Default)]
struct Reading<'a> {
    text: &'a str,
    /// The byte that is looked at.
    at: usize,
    atoms: Vec<Atom>,
    is_aromatic: Vec<bool>,
    /// Bonds; those without a symbol have no order yet.
    bonds: Vec<([usize; 2], Option<BondOrder>)>,
    /// The atom to which the next one is bonded.
    last: Option<usize>,
    /// The symbol of the bond before what comes next.
    bond: Option<BondOrder>,
    /// The atoms to which the branches that are open go back.
    branches: Vec<usize>,
    /// Rings that are open, by their numbers: the atom, and the bond's symbol if one stands there.
    rings: BTreeMap<u32, (usize, Option<BondOrder>)>,
}

impl Reading<'_> {
    fn read(&mut self) -> Result<Vec<Bond>, LigandFault> {
        while let Some(c) = self.next() {
            let symbol = match c {
                '-' | '/' | '\\' => Some(BondOrder::Single),
                '=' => Some(BondOrder::Double),
                '#' => Some(BondOrder::Triple),
                ':' => Some(BondOrder::Aromatic),
                _ => None,
            };
            if self.text[..self.at].ends_with('(') && matches!(c, '(' | ')') {
                return Err(self.found("an atom that a branch begins with"));
            }
            match c {
                _ if symbol.is_some() => {
                    if self.bond.is_some() || self.last.is_none() {
                        return Err(self.found("an atom or a ring's number before it"));
                    }
                    self.bond = symbol;
                    self.at += 1;
                }
                '(' => {
                    let last = self.last.filter(|_| self.bond.is_none());
                    self.branches.push(last.ok_or_else(|| self.found("an atom before a branch"))?);
                    self.at += 1;
                }
                ')' => {
                    let before = self.branches.pop().filter(|_| self.bond.is_none());
                    self.last = Some(before.ok_or_else(|| self.found("the end of a branch"))?);
                    self.at += 1;
                }
                '0'..='9' | '%' => self.ring()?,
                '.' => {
                    let found = "`.`, which separates molecules,".to_owned();
                    return Err(syntax(found, "one molecule"));
                }
                '[' => self.bracket()?,
                _ => self.plain()?,
            }
        }
        if self.bond.is_some() || !self.branches.is_empty() {
            return Err(self.found("an atom, or the end of a branch,"));
        }
        if let Some(number) = self.rings.keys().next() {
            return Err(syntax(format!("ring {number} without an end"), "its number twice"));
        }
        Ok(self.ordered())
    }

    /// The bonds with their orders: those without a symbol are aromatic in rings between aromatic atoms, and single.
    fn ordered(&self) -> Vec<Bond> {
        let bonds: Vec<Bond> = self
            .bonds
            .iter()
            .map(|(atoms, order)| Bond { atoms: *atoms, order: order.unwrap_or(BondOrder::Single) })
            .collect();
        let is_in_ring = in_rings(&neighbours(self.atoms.len(), &bonds), bonds.len());
        let is_aromatic = |number: usize| {
            self.bonds[number].1.is_none()
                && is_in_ring[number]
                && self.bonds[number].0.iter().all(|atom| self.is_aromatic[*atom])
        };
        let order = |(number, bond): (usize, Bond)| match is_aromatic(number) {
            true => Bond { order: BondOrder::Aromatic, ..bond },
            false => bond,
        };
        bonds.into_iter().enumerate().map(order).collect()
    }

    fn next(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    /// What stands here, where something else is expected.
    fn found(&self, expected: &str) -> LigandFault {
        let number = self.text[..self.at].chars().count() + 1;
        let found = match self.next() {
            Some(c) => format!("`{c}` as character {number} of the SMILES"),
            None => "the end of the SMILES".to_owned(),
        };
        syntax(found, expected)
    }

    /// The number of the digits that stand here, at most `most` of them.
    fn digits(&mut self, most: usize) -> Option<u32> {
        let is_digit = |byte: &u8| byte.is_ascii_digit();
        let count = self.rest().bytes().take(most).take_while(is_digit).count();
        let value = self.rest()[..count].parse().ok()?;
        self.at += count;
        Some(value)
    }

    /// Takes the text if it stands here.
    fn takes(&mut self, text: &str) -> bool {
        let is_there = self.rest().starts_with(text);
        self.at += if is_there { text.len() } else { 0 };
        is_there
    }

    /// Takes one of the symbols, if one stands here.
    fn one_of(&mut self, symbols: &[&'static str]) -> Option<&'static str> {
        symbols.iter().copied().find(|symbol| self.takes(symbol))
    }

    /// Takes an atom without brackets.
    fn plain(&mut self) -> Result<(), LigandFault> {
        let (symbol, is_aromatic) = match self.one_of(&PLAIN) {
            Some(symbol) => (symbol, false),
            None => match self.one_of(&AROMATIC) {
                Some(symbol) => (symbol, true),
                None => return Err(self.found("an atom, a bond, a branch or a ring's number")),
            },
        };
        self.atom(symbol, is_aromatic, 0)
    }

    /// Takes an atom in brackets: isotope, symbol, chirality, hydrogens, charge, class.
    fn bracket(&mut self) -> Result<(), LigandFault> {
        self.at += 1;
        self.digits(4);
        let (symbol, is_aromatic) = match self.one_of(&AROMATIC_IN_BRACKETS) {
            Some(symbol) => (symbol.to_owned(), true),
            None => (self.symbol()?, false),
        };
        while self.takes("@") {}
        for class in ["TH", "AL", "SP", "TB", "OH"] {
            // `[C@H]` has a hydrogen: the classes have a number behind their letters.
            let number = self.rest().strip_prefix(class).and_then(|rest| rest.chars().next());
            if number.is_some_and(|c| c.is_ascii_digit()) {
                self.at += class.len();
                self.digits(2);
            }
        }
        if self.takes("H") {
            self.digits(1);
        }
        let charge = self.charge()?;
        if self.takes(":") && self.digits(9).is_none() {
            return Err(self.found("the number of an atom's class"));
        }
        if !self.takes("]") {
            return Err(self.found("`]`, or what an atom may have in brackets,"));
        }
        self.atom(&symbol, is_aromatic, charge)
    }

    /// The symbol of an element in brackets: a capital, and a small letter if there is such an element.
    fn symbol(&mut self) -> Result<String, LigandFault> {
        let mut letters = self.rest().chars();
        let first = letters.next().filter(char::is_ascii_uppercase);
        let first = first.ok_or_else(|| self.found("the symbol of an element"))?;
        let second = letters.next().filter(char::is_ascii_lowercase);
        let symbol: String = [Some(first), second].into_iter().flatten().collect();
        self.at += symbol.len();
        Ok(symbol)
    }

    /// The charge that stands here: `+`, `--`, `+2`; 0 if none does.
    fn charge(&mut self) -> Result<i8, LigandFault> {
        let sign = match self.next() {
            Some('+') => 1,
            Some('-') => -1,
            _ => return Ok(0),
        };
        let mark = if sign == 1 { "+" } else { "-" };
        let mut size = 0_u32;
        while size < 15 && self.takes(mark) {
            size += 1;
        }
        if size == 1 {
            size = self.digits(2).unwrap_or(1);
        }
        let size = i8::try_from(size).ok().filter(|size| *size <= 15);
        Ok(sign * size.ok_or_else(|| self.found("a charge of at most 15"))?)
    }

    /// Adds an atom and its bond to the last one.
    fn atom(&mut self, symbol: &str, is_aromatic: bool, charge: i8) -> Result<(), LigandFault> {
        let number = self.atoms.len();
        check::expect_room(number + 1)?;
        let element = Element::of_symbol(symbol).ok_or_else(|| LigandFault::UnknownElement {
            found: symbol.to_owned(),
            atom: (number + 1).to_string(),
        })?;
        self.atoms.push(Atom {
            name: String::new(),
            element,
            position: None,
            formal_charge: Some(charge),
            partial_charge: None,
        });
        self.is_aromatic.push(is_aromatic);
        let bond = self.bond.take();
        self.bonds.extend(self.last.map(|last| ([last, number], bond)));
        self.last = Some(number);
        Ok(())
    }

    /// Takes the number of a ring: a digit, or `%` and two digits or a number in parentheses.
    fn ring(&mut self) -> Result<(), LigandFault> {
        let expected = "the number of a ring behind an atom";
        let last = self.last.ok_or_else(|| self.found(expected))?;
        let number = if self.takes("%(") {
            let number = self.digits(5);
            number.filter(|_| self.takes(")"))
        } else if self.takes("%") {
            let start = self.at;
            self.digits(2).filter(|_| self.at == start + 2)
        } else {
            self.digits(1)
        };
        let number = number.ok_or_else(|| self.found(expected))?;
        let here = self.bond.take();
        let Some((first, there)) = self.rings.remove(&number) else {
            self.rings.insert(number, (last, here));
            return Ok(());
        };
        if let (Some(one), Some(other)) = (here, there)
            && one != other
        {
            return Err(syntax(format!("ring {number} with two different bonds"), "one bond"));
        }
        self.bonds.push(([first, last], here.or(there)));
        Ok(())
    }
}
