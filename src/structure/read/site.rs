//! An atom as it stands in a file, before it is decided to which residue of which chain it belongs.

use super::super::{Point, ResidueNumber, StructureError};
use std::fmt;

/// The largest coordinate that is read, in Å: the PDB format writes none above 9999.999.
pub const COORDINATE_MAX: f64 = 99_999.0;
/// The most atoms of a file, all models together. Each takes some 200 bytes.
pub(super) const ATOMS_MAX: usize = 500_000;

/// An atom as in the file.
#[derive(Clone, Debug)]
pub(super) struct Site {
    /// The line, counted from 1.
    pub line: usize,
    pub name: String,
    pub element: String,
    /// The letter of the alternative location.
    pub letter: Option<char>,
    pub residue: String,
    pub number: ResidueNumber,
    pub chain: String,
    pub position: Point,
    pub occupancy: f64,
    /// Whether its record is HETATM, for what is no standard residue of a polymer.
    pub is_hetero: bool,
    /// Whether it belongs to a polymer, where the file says so.
    pub in_polymer: Option<bool>,
}

/// A model as in the file.
#[derive(Debug, Default)]
pub(super) struct RawModel {
    pub number: i32,
    pub sites: Vec<Site>,
}

/// `atom CA of ALA 5 in chain A`.
impl fmt::Display for Site {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Site { name, residue, number, chain, .. } = self;
        write!(f, "atom {name} of {residue} {number} in chain `{chain}`")
    }
}

/// A coordinate from its text.
pub(super) fn coordinate(text: &str, axis: char) -> Result<f64, String> {
    let value = text.trim().parse::<f64>().ok().filter(|value| value.abs() <= COORDINATE_MAX);
    value.ok_or_else(|| {
        let text = text.trim();
        format!("`{text}` as {axis} found; a number of at most {COORDINATE_MAX} Å expected")
    })
}

/// An error if there are more atoms than may be.
pub(super) fn expect_room(count: usize, line: usize) -> Result<(), StructureError> {
    if count < ATOMS_MAX {
        return Ok(());
    }
    let message = format!(
        "more than {ATOMS_MAX} atoms found; at most that many expected: keep the models and chains that matter"
    );
    Err(StructureError::line(line, message))
}
