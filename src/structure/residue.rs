use super::{AminoAcid, Point};
use bincode::de::Decoder;
use bincode::enc::Encoder;
use bincode::error::{DecodeError, EncodeError};
use bincode::{Decode, Encode};
use std::fmt;

/// The number of a residue in its file, with the letter that tells inserted residues of one number apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Encode, Decode)]
pub struct ResidueNumber {
    /// The number, which may be negative.
    pub number: i32,
    /// The insertion code.
    pub insertion: Option<char>,
}

/// `52`, or `52A` with an insertion code.
impl fmt::Display for ResidueNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.number)?;
        self.insertion.map_or(Ok(()), |insertion| write!(f, "{insertion}"))
    }
}

/// An atom.
#[derive(Clone, Debug, PartialEq)]
pub struct Atom {
    /// Its name in the residue: `CA`.
    pub name: String,
    /// Its element, as in the periodic table: `C`, `Ca`.
    pub element: String,
    /// Its position, in Å.
    pub position: Point,
}

impl Atom {
    /// Whether it is no hydrogen or deuterium.
    pub fn is_heavy(&self) -> bool {
        !matches!(self.element.as_str(), "H" | "D")
    }
}

impl Encode for Atom {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        self.name.encode(encoder)?;
        self.element.encode(encoder)?;
        [self.position.x, self.position.y, self.position.z].encode(encoder)
    }
}

impl<Context> Decode<Context> for Atom {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let (name, element) = (String::decode(decoder)?, String::decode(decoder)?);
        let position = <[f64; 3]>::decode(decoder)?;
        Ok(Atom { name, element, position: position.into() })
    }
}

bincode::impl_borrow_decode!(Atom);

/// A residue of a chain.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct Residue {
    /// Its number in the file.
    pub number: ResidueNumber,
    /// Its name in the file: `ALA`, `MSE`, `HOH`.
    pub name: String,
    /// The amino acid that it is, or was before it was modified; `None` for anything else.
    pub amino_acid: Option<AminoAcid>,
    /// Its atoms; of an amino acid each name once.
    pub atoms: Vec<Atom>,
}

/// Whether a residue of this name is a molecule of water, by the names that the wwPDB and programs give it.
pub fn is_water(name: &str) -> bool {
    matches!(name, "HOH" | "DOD" | "WAT" | "H2O" | "SOL" | "TIP")
        || matches!(
            name.as_bytes(),
            [b'T', b'I', b'P', _] | [b'T', b'P', b'3'] | [b'S', b'P', b'C'] | [b'S', b'P', b'C', _]
        )
}

impl Residue {
    /// The position of the atom of this name.
    pub fn position(&self, name: &str) -> Option<Point> {
        self.atoms.iter().find(|atom| atom.name == name).map(|atom| atom.position)
    }

    /// Whether it is a molecule of water ([`is_water`]).
    pub fn is_water(&self) -> bool {
        is_water(&self.name)
    }

    /// The atoms of the side chain: the heavy ones that are not N, CA, C, O or OXT.
    pub fn side_chain(&self) -> impl Iterator<Item = &Atom> {
        let is_backbone = |name: &str| matches!(name, "N" | "CA" | "C" | "O" | "OXT");
        self.atoms.iter().filter(move |atom| atom.is_heavy() && !is_backbone(&atom.name))
    }

    /// The centroid of the side chain's atoms; `None` for glycine, and where none was seen.
    pub fn side_chain_centroid(&self) -> Option<Point> {
        let (sum, count) = self
            .side_chain()
            .fold((Point::zeros(), 0.0), |(sum, count), atom| (sum + atom.position, count + 1.0));
        (count > 0.0).then(|| sum / count)
    }
}

/// `ALA 52A`.
impl fmt::Display for Residue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.name, self.number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn water_has_many_names() {
        assert!(["HOH", "TIP3", "TP3", "SOL", "SPCE"].into_iter().all(is_water));
        assert!(!["TIPX5", "ALA", ""].into_iter().any(is_water));
    }
}
