//! Writing small molecules at given positions, for other programs and for [`super::read()`].
//!
//! [`sdf`] writes one record, [`pdb`] one residue with as many models as there are poses. Texts that come from files cannot break
//! either format: characters that would act on a terminal or end a line are written as escapes such as `\u{a}`.

mod names;
mod pdb;
mod sdf;
#[cfg(test)]
mod tests;

pub use names::{atom_names, residue_name};
pub use pdb::{PdbPose, PdbResidue, pdb};
pub use sdf::{SdfRecord, sdf};

use super::Ligand;
use super::error::{LigandError, LigandFault, syntax};
use crate::structure::Point;

/// That there is a finite position for every atom.
fn check_positions(ligand: &Ligand, positions: &[Point]) -> Result<(), LigandError> {
    if positions.len() != ligand.atoms().len() {
        let found = format!("{} positions", positions.len());
        let expected = format!("{}, one for each atom,", ligand.atoms().len());
        return Err(LigandError::pathless(syntax(found, expected)));
    }
    let check = |(number, position)| super::check::check_position(position, number);
    positions.iter().enumerate().try_for_each(check).map_err(LigandError::pathless)
}

/// A number that has no columns in a format.
fn too_wide(found: f64, what: &str, format: &str) -> LigandError {
    LigandError::pathless(LigandFault::BadNumber {
        found: format!("`{found}`"),
        expected: format!("{what} that fits into the columns of {format}"),
    })
}

/// The first characters of a text, as many as there is room for.
fn cut(text: &str, room: usize) -> &str {
    text.char_indices().nth(room).map_or(text, |(end, _)| &text[..end])
}
