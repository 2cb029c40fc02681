use bincode::{Decode, Encode};

/// One of the twenty amino acids that genes spell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Encode, Decode)]
#[allow(missing_docs, reason = "the names say it")]
pub enum AminoAcid {
    Alanine,
    Arginine,
    Asparagine,
    AsparticAcid,
    Cysteine,
    Glutamine,
    GlutamicAcid,
    Glycine,
    Histidine,
    Isoleucine,
    Leucine,
    Lysine,
    Methionine,
    Phenylalanine,
    Proline,
    Serine,
    Threonine,
    Tryptophan,
    Tyrosine,
    Valine,
}

use AminoAcid::*;

/// The amino acids with their codes of one and of three letters (IUPAC-IUB 1983).
const CODES: [(AminoAcid, char, &str); 20] = [
    (Alanine, 'A', "ALA"),
    (Arginine, 'R', "ARG"),
    (Asparagine, 'N', "ASN"),
    (AsparticAcid, 'D', "ASP"),
    (Cysteine, 'C', "CYS"),
    (Glutamine, 'Q', "GLN"),
    (GlutamicAcid, 'E', "GLU"),
    (Glycine, 'G', "GLY"),
    (Histidine, 'H', "HIS"),
    (Isoleucine, 'I', "ILE"),
    (Leucine, 'L', "LEU"),
    (Lysine, 'K', "LYS"),
    (Methionine, 'M', "MET"),
    (Phenylalanine, 'F', "PHE"),
    (Proline, 'P', "PRO"),
    (Serine, 'S', "SER"),
    (Threonine, 'T', "THR"),
    (Tryptophan, 'W', "TRP"),
    (Tyrosine, 'Y', "TYR"),
    (Valine, 'V', "VAL"),
];

impl AminoAcid {
    /// The amino acid of a code of three capital letters; `None` for any other name.
    pub fn of_code(code: &str) -> Option<AminoAcid> {
        CODES.iter().find(|(_, _, three)| *three == code).map(|(amino_acid, ..)| *amino_acid)
    }

    /// Its code of three capital letters.
    pub fn code(self) -> &'static str {
        CODES[self as usize].2
    }

    /// Its code of one capital letter.
    pub fn letter(self) -> char {
        CODES[self as usize].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_stand_in_the_order_of_the_amino_acids() {
        for (amino_acid, letter, code) in CODES {
            assert_eq!(AminoAcid::of_code(code), Some(amino_acid));
            assert_eq!((amino_acid.letter(), amino_acid.code()), (letter, code));
        }
        assert_eq!(AminoAcid::of_code("HOH"), None);
    }
}
