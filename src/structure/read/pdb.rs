//! The PDB format, version 3.3 (wwPDB 2012), and what programs make of it.
//!
//! Read are ATOM, HETATM, TER, MODEL, ENDMDL, END and MODRES. Columns are counted in characters. Serial numbers, factors
//! and charges are not looked at.

use super::super::{ResidueNumber, StructureError};
use super::elements;
use super::names::{Parents, amino_acid};
use super::site::{RawModel, Site, coordinate, expect_room};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// What a PDB file holds.
#[derive(Debug, Default)]
pub(super) struct PdbText {
    pub models: Vec<RawModel>,
    pub parents: Parents,
    /// What was passed over.
    pub notes: Vec<String>,
}

/// Reads the text of a PDB file.
pub(super) fn read(text: &str) -> Result<PdbText, StructureError> {
    let mut pdb = PdbText::default();
    for line in text.lines().filter(|line| line.starts_with("MODRES")) {
        let line = Columns::of(line);
        let (name, parent) = (line.trimmed(12, 15), line.trimmed(24, 27));
        if !name.is_empty() && !parent.is_empty() {
            pdb.parents.insert(name, parent);
        }
    }
    let two_letters = chains_of_two_letters(text, &pdb.parents);
    // Chains of the model that have had their TER.
    let mut ended: BTreeSet<String> = BTreeSet::new();
    let mut is_open = false;
    let mut has_models = false;
    let mut count = 0;
    let mut numbers = BTreeSet::new();
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    for (number, line) in lines.by_ref() {
        match line.get(..6).unwrap_or(line).trim_end() {
            "ATOM" | "HETATM" => {
                expect_room(count, number)?;
                count += 1;
                if has_models && !is_open {
                    let message = "an atom outside all models found; MODEL before it expected";
                    return Err(StructureError::line(number, message));
                }
                if pdb.models.is_empty() {
                    pdb.models.push(RawModel { number: 1, sites: Vec::new() });
                }
                let mut site = atom(&Columns::of(line), number, &pdb.parents, &two_letters)?;
                // A blank name says nothing: what follows may be another chain.
                if ended.contains(&site.chain) && !site.chain.is_empty() {
                    site.in_polymer = Some(false);
                }
                pdb.models.last_mut().expect("there is one").sites.push(site);
            }
            "TER" => {
                if let Some(model) = pdb.models.last_mut() {
                    ended.extend(end_chain(&mut model.sites));
                }
            }
            "ENDMDL" => is_open = false,
            "END" => break,
            _ if line.starts_with("MODEL") && is_model(line) => {
                if !has_models && !pdb.models.is_empty() {
                    let message = "MODEL after atoms found; MODEL before the first atom expected";
                    return Err(StructureError::line(number, message));
                }
                let next = i32::try_from(pdb.models.len() + 1).unwrap_or(i32::MAX);
                let named = line["MODEL".len()..].trim().parse().unwrap_or(next);
                if !numbers.insert(named) && pdb.notes.is_empty() {
                    pdb.notes.push(format!("line {number}: model {named} comes again"));
                }
                pdb.models.push(RawModel { number: named, sites: Vec::new() });
                (has_models, is_open) = (true, true);
                ended.clear();
            }
            _ => {}
        }
    }
    if let Some((number, _)) =
        lines.find(|(_, line)| line.starts_with("ATOM  ") || line.starts_with("HETATM"))
    {
        pdb.notes.push(format!("line {number}: atoms after END are passed over"));
    }
    pdb.models.retain(|model| !model.sites.is_empty());
    Ok(pdb)
}

/// Whether the record is MODEL, and no other that begins so: behind it are a blank and a number, or nothing.
fn is_model(line: &str) -> bool {
    let rest = &line["MODEL".len()..];
    rest.is_empty() || rest.starts_with(' ')
}

/// Notes that the chain of the last atom ends here, and gives its name: all of it that came in a row since the TER before
/// belongs to a polymer.
fn end_chain(sites: &mut [Site]) -> Option<String> {
    let chain = sites.last()?.chain.clone();
    for site in sites.iter_mut().rev() {
        if site.chain != chain || site.in_polymer == Some(true) {
            break;
        }
        site.in_polymer = Some(true);
    }
    Some(chain)
}

/// Columns 21 and 22 of all chains whose names have two letters: there an amino acid of three letters stands before
/// both, and no other name of four letters that an amino acid has (`HISE` in chain `A`) is made of it and the first.
fn chains_of_two_letters(text: &str, parents: &Parents) -> BTreeSet<String> {
    let atoms = text.lines().filter(|line| line.starts_with("ATOM") || line.starts_with("HETATM"));
    let mut chains = BTreeSet::new();
    for line in atoms.map(Columns::of) {
        let Some(first) = line.letter(20) else { continue };
        let name = line.columns(17, 20);
        let is_three = name.trim().chars().count() == 3 && amino_acid(&name, parents).is_some();
        if is_three && amino_acid(&format!("{name}{first}"), parents).is_none() {
            chains.insert(line.columns(20, 22).into_owned());
        }
    }
    chains
}

/// The atom of a line, from which its columns are taken.
fn atom(
    line: &Columns,
    number: usize,
    parents: &Parents,
    two_letters: &BTreeSet<String>,
) -> Result<Site, StructureError> {
    let field = line.columns(12, 16);
    let name = field.trim().to_owned();
    // CHARMM's and GROMACS's names have a fourth letter where others leave a blank, or have the first of two letters of a
    // chain.
    let three = line.trimmed(17, 20);
    let four = line.trimmed(17, 21);
    let is_amino_acid = |name: &str| amino_acid(name, parents).is_some();
    let has_four = four.chars().count() == 4
        && !two_letters.contains(&*line.columns(20, 22))
        && (is_amino_acid(&four) || !is_amino_acid(&three));
    let residue = if has_four { four } else { three };
    let mut chain = if has_four { line.trimmed(21, 22) } else { line.trimmed(20, 22) };
    if chain.is_empty() {
        // CHARMM names segments instead.
        chain = line.trimmed(72, 76);
    }
    let complain = |message: String| {
        let of = format!("atom `{name}` of residue `{residue}`");
        Err(StructureError::line(number, format!("{of}: {message}")))
    };
    if line.len() < 54 {
        let message = format!(
            "a line that ends after {} columns found; coordinates up to column 54 expected",
            line.len()
        );
        return complain(message);
    }
    if name.is_empty() {
        return complain("no name found; one in columns 13 to 16 expected".to_owned());
    }
    let Some(residue_number) = residue_number(line) else {
        let found = line.trimmed(22, 27);
        return complain(format!(
            "`{found}` as the residue's number found; a whole number expected"
        ));
    };
    let mut position = super::super::Point::zeros();
    for (axis, start) in [30, 38, 46].into_iter().enumerate() {
        match coordinate(&line.columns(start, start + 8), ['x', 'y', 'z'][axis]) {
            Ok(value) => position[axis] = value,
            Err(message) => {
                return complain(format!("residue number {residue_number}: {message}"));
            }
        }
    }
    let element = elements::symbol(&line.columns(76, 78))
        .unwrap_or_else(|| elements::of_name(&field, &residue, is_amino_acid(&residue)));
    let occupancy = line.trimmed(54, 60).parse::<f64>().ok().filter(|value| value.is_finite());
    Ok(Site {
        line: number,
        name,
        element,
        letter: line.letter(16),
        residue,
        number: residue_number,
        chain,
        position,
        occupancy: occupancy.unwrap_or(1.0),
        is_hetero: line.columns(0, 6).starts_with("HETATM"),
        in_polymer: None,
    })
}

/// The number of the residue in columns 23 to 26 and its insertion code in column 27.
///
/// Numbers above 9999 are written in hybrid-36 (R. W. Grosse-Kunstleve 2007: `A000` is 10 000), or with a fifth digit
/// where the insertion code would be.
fn residue_number(line: &Columns) -> Option<ResidueNumber> {
    let field = line.columns(22, 26);
    let insertion = line.letter(26);
    if let Some(digit) = insertion.and_then(|c| c.to_digit(10))
        && field.len() == 4
        && field.bytes().all(|byte| byte.is_ascii_digit())
    {
        let number = 10 * field.parse::<i32>().ok()? + i32::try_from(digit).ok()?;
        return Some(ResidueNumber { number, insertion: None });
    }
    let number = field.trim().parse().ok().or_else(|| hybrid_36(&field))?;
    Some(ResidueNumber { number, insertion })
}

/// A number of four digits to the base 36 that begins with a letter: those in capitals follow 9999, the others them.
fn hybrid_36(field: &str) -> Option<i32> {
    let bytes = field.as_bytes();
    let first = *bytes.first().filter(|byte| byte.is_ascii_alphabetic())?;
    let digit = |byte: &u8| match byte {
        b'0'..=b'9' => Some(i32::from(byte - b'0')),
        _ if byte.is_ascii_alphabetic()
            && byte.is_ascii_uppercase() == first.is_ascii_uppercase() =>
        {
            Some(i32::from(byte.to_ascii_uppercase() - b'A') + 10)
        }
        _ => None,
    };
    if bytes.len() != 4 {
        return None;
    }
    let value = bytes.iter().try_fold(0, |value, byte| Some(36 * value + digit(byte)?))?;
    let first_with_letter = 10 * 36 * 36 * 36;
    let capitals = 26 * 36 * 36 * 36;
    let after = if first.is_ascii_uppercase() { 10_000 } else { 10_000 + capitals };
    Some(value - first_with_letter + after)
}

/// A line by its columns, counted from 0, one a character.
struct Columns<'a>(Cow<'a, str>, Vec<char>);

impl<'a> Columns<'a> {
    fn of(line: &'a str) -> Columns<'a> {
        // Lines of other than ASCII, rare and in comments mostly, are looked at character by character.
        let characters = if line.is_ascii() { Vec::new() } else { line.chars().collect() };
        Columns(line.into(), characters)
    }

    fn len(&self) -> usize {
        if self.1.is_empty() { self.0.len() } else { self.1.len() }
    }

    /// The columns from `start` to before `end`, as far as the line goes.
    fn columns(&self, start: usize, end: usize) -> Cow<'_, str> {
        let end = end.min(self.len());
        let start = start.min(end);
        if self.1.is_empty() {
            Cow::Borrowed(&self.0[start..end])
        } else {
            Cow::Owned(self.1[start..end].iter().collect())
        }
    }

    fn trimmed(&self, start: usize, end: usize) -> String {
        self.columns(start, end).trim().to_owned()
    }

    /// The character of a column, unless it is blank.
    fn letter(&self, column: usize) -> Option<char> {
        self.columns(column, column + 1).chars().next().filter(|c| !c.is_whitespace())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residue_numbers_go_on_beyond_four_digits() {
        for (field, number) in [
            ("   1 ", Some((1, None))),
            ("-999A", Some((-999, Some('A')))),
            ("12345", Some((12345, None))),
            ("A000 ", Some((10_000, None))),
            ("ZZZZ ", Some((1_223_055, None))),
            ("a000 ", Some((1_223_056, None))),
            ("Aa00 ", None),
            ("***1 ", None),
            ("     ", None),
        ] {
            let line = format!("{}{field}", " ".repeat(22));
            let found = residue_number(&Columns::of(&line));
            assert_eq!(found.map(|found| (found.number, found.insertion)), number, "{field}");
        }
    }
}
