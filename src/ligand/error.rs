use crate::internal::plain::plain;
use std::fmt;
use std::path::{Path, PathBuf};

/// A small molecule that cannot be used: where, what was found, what is expected.
///
/// It reads `FILE:LINE: what was found; what is expected`; file and line are left out where there are none.
#[derive(Clone, Debug, PartialEq)]
pub struct LigandError {
    path: PathBuf,
    line: Option<usize>,
    fault: LigandFault,
}

/// What is wrong with a small molecule or its file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LigandFault {
    /// The file cannot be read, by the words of the system.
    Unreadable(String),
    /// The bytes are not text in UTF-8: what was found instead.
    NotText(String),
    /// Nothing stands there but blanks.
    Empty,
    /// The text has none of the formats that are read: what it looks like.
    UnknownFormat(String),
    /// Something stands where the format has something else.
    Syntax {
        /// What was found.
        found: String,
        /// What is expected.
        expected: String,
    },
    /// A number that is none, is not finite, or is too large.
    BadNumber {
        /// The text, or the value.
        found: String,
        /// Which number is expected.
        expected: String,
    },
    /// An atom whose element is not known.
    UnknownElement {
        /// What names the element.
        found: String,
        /// Name or number of the atom.
        atom: String,
    },
    /// More than is taken.
    TooMany {
        /// How many there are.
        found: usize,
        /// Of what.
        what: &'static str,
        /// How many are taken at most.
        most: usize,
    },
    /// No bonds, though there are atoms.
    NoBonds {
        /// How many atoms there are.
        atoms: usize,
    },
    /// A bond that cannot be: what is wrong with it.
    BadBond(String),
    /// Bonds do not join all atoms.
    NotConnected {
        /// The numbers of atoms of the pieces, in the order of their lowest atoms.
        pieces: Vec<usize>,
    },
    /// No positions in space: what was found instead.
    NoCoordinates(String),
    /// Several molecules where one is expected.
    Several {
        /// How many there are.
        count: usize,
        /// What tells the first of them apart.
        names: Vec<String>,
        /// How one of them is chosen.
        choose: &'static str,
    },
    /// The group that was asked for is water.
    Water {
        /// The residue name.
        residue: String,
        /// How many molecules of it were meant.
        count: usize,
        /// The other groups that are there.
        there: Vec<String>,
    },
    /// The group that was asked for is not there.
    NoGroup {
        /// The group.
        wanted: String,
        /// The groups that are there.
        there: Vec<String>,
    },
}

impl LigandError {
    /// An error of atoms and bonds that may have come from anywhere.
    pub fn pathless(fault: LigandFault) -> LigandError {
        LigandError { path: PathBuf::new(), line: None, fault }
    }

    /// An error in a line, counted from 1.
    pub fn at(line: usize, fault: LigandFault) -> LigandError {
        LigandError { path: PathBuf::new(), line: Some(line), fault }
    }

    /// The same error, of this file if it names none.
    #[must_use]
    pub fn in_file(mut self, path: &Path) -> LigandError {
        if self.path.as_os_str().is_empty() {
            path.clone_into(&mut self.path);
        }
        self
    }

    /// What is wrong.
    pub fn fault(&self) -> &LigandFault {
        &self.fault
    }

    /// The line, counted from 1, where it is known.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// The file, if there is one.
    pub fn path(&self) -> Option<&Path> {
        Some(self.path.as_path()).filter(|path| !path.as_os_str().is_empty())
    }
}

/// Something found where the format has something else.
pub(super) fn syntax(found: impl Into<String>, expected: impl Into<String>) -> LigandFault {
    LigandFault::Syntax { found: found.into(), expected: expected.into() }
}

impl fmt::Display for LigandFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LigandFault::Unreadable(reason) => write!(f, "cannot read the molecule: {reason}"),
            LigandFault::NotText(found) => write!(f, "{found} found; text in UTF-8 expected"),
            LigandFault::Empty => f.write_str("nothing found; a molecule expected"),
            LigandFault::UnknownFormat(found) => write!(
                f,
                "{found} found; a molecule in the formats SDF, MOL2, PDBQT or PDB expected"
            ),
            LigandFault::Syntax { found, expected }
            | LigandFault::BadNumber { found, expected } => {
                write!(f, "{found} found; {expected} expected")
            }
            LigandFault::UnknownElement { found, atom } => write!(
                f,
                "`{found}` as the element of atom {atom} found; a chemical element up to curium expected"
            ),
            LigandFault::TooMany { found, what, most } => {
                write!(f, "{found} {what} found; at most {most} expected")
            }
            LigandFault::NoBonds { atoms } => {
                write!(f, "{} without bonds found; atoms that bonds join expected", count(*atoms))
            }
            LigandFault::BadBond(found) => {
                write!(f, "{found} found; a bond of two different atoms expected, once")
            }
            LigandFault::NotConnected { pieces } => {
                let sizes: Vec<String> = pieces.iter().take(SHOWN).map(|n| count(*n)).collect();
                write!(
                    f,
                    "{} pieces that no bonds join found ({}{}); one molecule expected, without salts and waters",
                    pieces.len(),
                    sizes.join(", "),
                    more(pieces.len())
                )
            }
            LigandFault::NoCoordinates(found) => {
                write!(f, "{found} found; positions in three dimensions, in Å, expected")
            }
            LigandFault::Several { count, names, choose } => write!(
                f,
                "{count} molecules found ({}{}); one expected: {choose}",
                names.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", "),
                more(*count)
            ),
            LigandFault::Water { residue, count, there } => write!(
                f,
                "water found ({residue}, {count} of it); another HETATM group of the file expected: {}",
                listed(there)
            ),
            LigandFault::NoGroup { wanted, there } => {
                write!(
                    f,
                    "no HETATM group {wanted} found; one of the file's expected: {}",
                    listed(there)
                )
            }
        }
    }
}

/// How many of a list are shown.
const SHOWN: usize = 8;

/// The groups of a file.
fn listed(there: &[String]) -> String {
    match there.is_empty() {
        true => "none of more than one atom but waters".to_owned(),
        false => {
            let first: Vec<_> = there.iter().take(SHOWN).cloned().collect();
            format!("{}{}", first.join(", "), more(there.len()))
        }
    }
}

/// What ends a list of which the first are shown.
fn more(of: usize) -> String {
    if of > SHOWN { format!(", and {} more", of - SHOWN) } else { String::new() }
}

fn count(atoms: usize) -> String {
    if atoms == 1 { "1 atom".to_owned() } else { format!("{atoms} atoms") }
}

impl fmt::Display for LigandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&plain(&self.path.to_string_lossy()))?;
        if let Some(line) = self.line {
            write!(f, "{}{line}", if self.path().is_some() { ":" } else { "line " })?;
        }
        if self.path().is_some() || self.line.is_some() {
            f.write_str(": ")?;
        }
        f.write_str(&plain(&self.fault.to_string()))
    }
}

impl std::error::Error for LigandError {}
