//! Which residues of a protein are exposed to the solvent.
//!
//! H.-Y. Yeh (2016, §6.2) takes as exposed what has a relative accessibility of at least 20 %: the accessible area of the residue in the
//! protein over the area that it has in the peptide Gly-X-Gly (C. Chothia, *The nature of the accessible and buried surfaces in
//! proteins*, J. Mol. Biol. 105 (1976) 1-14).

use super::StillChain;
use crate::model::ExposedResidue;
use crate::structure::measure::{Probe, solvent_accessible_areas, van_der_waals_radius};
use crate::structure::{AminoAcid, Atom};

/// The least relative accessibility of an exposed residue.
const EXPOSED: f64 = 0.2;
/// Points per atom: areas are needed to a few percent.
const POINTS: usize = 92;

/// The exposed residues among the amino acids of some chains, in their order.
pub(super) fn exposed(chains: &[StillChain]) -> Vec<ExposedResidue> {
    let is_measured =
        |atom: &&Atom| atom.is_heavy() && van_der_waals_radius(&atom.element).is_some();
    let residues = || chains.iter().flat_map(|chain| &chain.residues);
    let atoms: Vec<&Atom> =
        residues().flat_map(|residue| residue.atoms.iter().filter(is_measured)).collect();
    // All have radii, so there are areas.
    let probe = Probe { points: POINTS, ..Probe::default() };
    let areas = solvent_accessible_areas(&atoms, probe).unwrap_or_default();
    let mut areas = areas.into_iter();
    let mut found = Vec::new();
    for chain in chains {
        for residue in &chain.residues {
            let heavy: Vec<&Atom> = residue.atoms.iter().filter(is_measured).collect();
            let area: f64 = areas.by_ref().take(heavy.len()).sum();
            let Some(whole) = residue.amino_acid.map(area_in_peptide) else { continue };
            if area >= EXPOSED * whole {
                found.push(ExposedResidue {
                    name: format!("{} {residue}", chain.name),
                    atoms: heavy.iter().map(|atom| atom.position).collect(),
                });
            }
        }
    }
    found
}

/// The accessible area of a residue in the peptide Gly-X-Gly, Å² (Chothia 1976).
fn area_in_peptide(amino_acid: AminoAcid) -> f64 {
    match amino_acid.letter() {
        'A' => 115.0,
        'R' => 225.0,
        'N' => 160.0,
        'D' => 150.0,
        'C' => 135.0,
        'Q' => 180.0,
        'E' => 190.0,
        'G' => 75.0,
        'H' => 195.0,
        'I' => 175.0,
        'L' => 170.0,
        'K' => 200.0,
        'M' => 185.0,
        'F' => 210.0,
        'P' => 145.0,
        'S' => 115.0,
        'T' => 140.0,
        'W' => 255.0,
        'Y' => 230.0,
        _ => 155.0, // valine, the only one that is left
    }
}
