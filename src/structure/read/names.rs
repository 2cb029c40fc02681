//! Names of residues and atoms that programs write in their own ways, and parents of modified residues.

use super::super::{AminoAcid, Atom};
use std::collections::BTreeMap;

/// Parents of modified residues by the file itself: name to name.
pub(super) type Parents = BTreeMap<String, String>;

/// Other names of the twenty: protonation states as CHARMM, AMBER and GROMACS call them.
const ALIASES: [(&str, &str); 24] = [
    ("HSD", "HIS"),
    ("HSE", "HIS"),
    ("HSP", "HIS"),
    ("HID", "HIS"),
    ("HIE", "HIS"),
    ("HIP", "HIS"),
    ("HISA", "HIS"),
    ("HISB", "HIS"),
    ("HISD", "HIS"),
    ("HISE", "HIS"),
    ("HISH", "HIS"),
    ("CYX", "CYS"),
    ("CYM", "CYS"),
    ("CYSH", "CYS"),
    ("CYS2", "CYS"),
    ("ASH", "ASP"),
    ("ASPH", "ASP"),
    ("ASPP", "ASP"),
    ("GLH", "GLU"),
    ("GLUH", "GLU"),
    ("GLUP", "GLU"),
    ("LYN", "LYS"),
    ("LYSH", "LYS"),
    ("LSN", "LYS"),
];

/// Common modified residues with their parents (wwPDB Chemical Component Dictionary).
const MODIFIED: [(&str, &str); 40] = [
    ("ALY", "LYS"),
    ("CAS", "CYS"),
    ("CGU", "GLU"),
    ("CME", "CYS"),
    ("CSD", "CYS"),
    ("CSO", "CYS"),
    ("CSS", "CYS"),
    ("CSX", "CYS"),
    ("CXM", "MET"),
    ("FME", "MET"),
    ("HIC", "HIS"),
    ("HYP", "PRO"),
    ("KCX", "LYS"),
    ("LLP", "LYS"),
    ("M3L", "LYS"),
    ("MEN", "ASN"),
    ("MHO", "MET"),
    ("MHS", "HIS"),
    ("MLY", "LYS"),
    ("MLZ", "LYS"),
    ("MSE", "MET"),
    ("NEP", "HIS"),
    ("OCS", "CYS"),
    ("PCA", "GLN"),
    ("PHD", "ASP"),
    ("PTR", "TYR"),
    ("SAC", "SER"),
    ("SCH", "CYS"),
    ("SCY", "CYS"),
    ("SEC", "CYS"),
    ("SEP", "SER"),
    ("SMC", "CYS"),
    ("SME", "MET"),
    ("SNC", "CYS"),
    ("TPO", "THR"),
    ("TPQ", "TYR"),
    ("TRQ", "TRP"),
    ("TYI", "TYR"),
    ("TYS", "TYR"),
    ("YCM", "CYS"),
];

/// The amino acid that a residue of this name is, or was before it was modified.
pub(super) fn amino_acid(name: &str, parents: &Parents) -> Option<AminoAcid> {
    let listed = |table: &[(&str, &str)]| {
        let found = table.iter().find(|(other, _)| *other == name);
        found.and_then(|(_, code)| AminoAcid::of_code(code))
    };
    // AMBER marks the ends of chains: NALA, CALA.
    let at_end = || match name.len() {
        4 => name.strip_prefix(['N', 'C']).and_then(AminoAcid::of_code),
        _ => None,
    };
    AminoAcid::of_code(name)
        .or_else(|| listed(&ALIASES))
        .or_else(|| parents.get(name).and_then(|parent| AminoAcid::of_code(parent)))
        .or_else(|| listed(&MODIFIED))
        .or_else(at_end)
}

/// Gives the atoms of an amino acid the names of the wwPDB where other programs call them otherwise: `CD` of isoleucine
/// is CD1; `OT1`, `O1`, `OC1` and `OT2`, `O2`, `OC2` of the last residue are O and OXT.
pub(super) fn normalise(amino_acid: AminoAcid, atoms: &mut [Atom]) {
    let mut rename = |from: &[&str], to: &str| {
        if atoms.iter().any(|atom| atom.name == to) {
            return;
        }
        if let Some(atom) = atoms.iter_mut().find(|atom| from.contains(&atom.name.as_str())) {
            atom.name = to.to_owned();
        }
    };
    if amino_acid == AminoAcid::Isoleucine {
        rename(&["CD"], "CD1");
    }
    rename(&["OT1", "O1", "OC1", "OT", "O'"], "O");
    rename(&["OT2", "O2", "OC2", "O''"], "OXT");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::Point;

    #[test]
    fn names_of_other_programs_and_modified_residues_are_known() {
        let none = Parents::new();
        for (name, amino_acid) in [
            ("HSD", Some(AminoAcid::Histidine)),
            ("MSE", Some(AminoAcid::Methionine)),
            ("NALA", Some(AminoAcid::Alanine)),
            ("CLYS", Some(AminoAcid::Lysine)),
            ("HOH", None),
            ("XYZ", None),
        ] {
            assert_eq!(super::amino_acid(name, &none), amino_acid, "{name}");
        }
        let own = Parents::from([("XYZ".to_owned(), "TRP".to_owned())]);
        assert_eq!(super::amino_acid("XYZ", &own), Some(AminoAcid::Tryptophan));
        for (name, code) in ALIASES.iter().chain(&MODIFIED) {
            assert!(AminoAcid::of_code(code).is_some() && AminoAcid::of_code(name).is_none());
        }
    }

    #[test]
    fn atoms_get_the_names_of_the_wwpdb() {
        let atoms = |names: &[&str]| -> Vec<Atom> {
            let atom = |name: &&str| Atom {
                name: (*name).to_owned(),
                element: "C".to_owned(),
                position: Point::zeros(),
            };
            names.iter().map(atom).collect()
        };
        let mut charmm = atoms(&["N", "CA", "CD", "OT1", "OT2"]);
        normalise(AminoAcid::Isoleucine, &mut charmm);
        assert_eq!(charmm, atoms(&["N", "CA", "CD1", "O", "OXT"]));
        let mut lysine = atoms(&["CD", "O", "OXT"]);
        normalise(AminoAcid::Lysine, &mut lysine);
        assert_eq!(lysine, atoms(&["CD", "O", "OXT"]));
    }
}
