//! Whether a chain is whole: all backbone atoms, and no gaps.

use super::peptides::{Gap, PEPTIDE_BOND_MAX, gaps};
use super::{AminoAcid, Chain, Residue, StructureError};

/// The atoms that every residue must have.
const REQUIRED: [&str; 4] = ["N", "CA", "C", "O"];

/// What a chain lacks that no model of it needs, and its gaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Completeness {
    /// Gaps between residues.
    pub gaps: Vec<Gap>,
    /// Indices of residues other than glycine without CB: their side chains were not seen.
    pub without_side_chain: Vec<usize>,
}

/// The first backbone atom that a residue lacks.
pub fn missing_atom(residue: &Residue) -> Option<&'static str> {
    REQUIRED.into_iter().find(|name| residue.position(name).is_none())
}

/// Looks at a chain's backbone.
///
/// # Errors
/// The first residue that lacks N, CA, C or O, named with the atom.
pub fn completeness(chain: &Chain) -> Result<Completeness, StructureError> {
    for residue in &chain.residues {
        if let Some(atom) = missing_atom(residue) {
            let message = format!(
                "chain `{}`: {residue} without its atom {atom} found; N, CA, C and O of every residue expected",
                chain.name
            );
            return Err(StructureError::pathless(message));
        }
    }
    let is_without = |residue: &Residue| {
        residue.amino_acid != Some(AminoAcid::Glycine) && residue.position("CB").is_none()
    };
    let places = 0..chain.residues.len();
    Ok(Completeness {
        gaps: gaps(&chain.residues),
        without_side_chain: places.filter(|place| is_without(&chain.residues[*place])).collect(),
    })
}

/// Looks at a chain's backbone and accepts no gaps.
///
/// # Errors
/// As [`completeness`], and the first gap, with the residues on both sides.
pub fn check(chain: &Chain) -> Result<Completeness, StructureError> {
    let found = completeness(chain)?;
    let Some(gap) = found.gaps.first() else { return Ok(found) };
    let [before, after] = [gap.before, gap.before + 1].map(|place| &chain.residues[place]);
    let distance = gap.distance.unwrap_or(f64::NAN);
    let message = format!(
        "chain `{}`: a gap between {before} and {after} found ({} in all), C and N {distance:.2} Å apart; a peptide bond, \
         at most {PEPTIDE_BOND_MAX} Å, expected",
        chain.name,
        found.gaps.len()
    );
    Err(StructureError::pathless(message))
}
