//! A ligand as bytes of ledgers and messages, and as the table of a problem file: both hold the same, every number to the
//! last bit.

use super::{Atom, Bond, BondOrder, BondSource, Element, Ligand};
use crate::structure::Point;
use bincode::de::Decoder;
use bincode::enc::Encoder;
use bincode::error::{DecodeError, EncodeError};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// A ligand, atom by atom.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub(crate) struct LigandTable {
    /// Its name.
    pub name: String,
    /// Its atoms.
    pub atoms: Vec<AtomTable>,
    /// Its bonds: the two atoms, the first of which is 0, and the order.
    pub bonds: Vec<(u32, u32, BondOrder)>,
}

/// An atom of a [`LigandTable`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub(crate) struct AtomTable {
    /// Its name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The symbol of its element.
    pub element: String,
    /// Where it is, Å.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// Its formal charge in elementary charges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formal_charge: Option<i8>,
    /// Its partial charge in elementary charges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub partial_charge: Option<f64>,
}

impl LigandTable {
    /// The table of a ligand. The line of its file and where its bonds come from are left out: they say nothing of the molecule.
    pub fn of(ligand: &Ligand) -> LigandTable {
        let atom = |atom: &Atom| AtomTable {
            name: atom.name.clone(),
            element: atom.element.symbol().to_owned(),
            at: atom.position.map(Into::into),
            formal_charge: atom.formal_charge,
            partial_charge: atom.partial_charge,
        };
        let bond = |bond: &Bond| {
            let [first, second] = bond.atoms.map(|atom| atom as u32);
            (first, second, bond.order)
        };
        LigandTable {
            name: ligand.name.clone(),
            atoms: ligand.atoms.iter().map(atom).collect(),
            bonds: ligand.bonds.iter().map(bond).collect(),
        }
    }

    /// The ligand.
    ///
    /// # Errors
    /// What is wrong with it: what was found, what is expected.
    pub fn ligand(&self) -> Result<Ligand, String> {
        let atom = |(number, atom): (usize, &AtomTable)| {
            let element = Element::of_symbol(&atom.element).ok_or_else(|| {
                let (number, found) = (number + 1, &atom.element);
                format!("element `{found}` of atom {number} found; a symbol expected, such as C")
            })?;
            Ok(Atom {
                name: atom.name.clone(),
                element,
                position: atom.at.map(Point::from),
                formal_charge: atom.formal_charge,
                partial_charge: atom.partial_charge,
            })
        };
        let atoms = self.atoms.iter().enumerate().map(atom).collect::<Result<Vec<_>, String>>()?;
        let bond = |(first, second, order): &(u32, u32, BondOrder)| Bond {
            atoms: [*first as usize, *second as usize],
            order: *order,
        };
        let bonds = self.bonds.iter().map(bond).collect();
        Ligand::new(self.name.clone(), atoms, bonds).map_err(|error| error.to_string())
    }
}

/// As its table: names, elements, positions, charges and bonds.
impl Encode for Ligand {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        LigandTable::of(self).encode(encoder)
    }
}

impl<Context> Decode<Context> for Ligand {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Ligand, DecodeError> {
        LigandTable::decode(decoder)?.ligand().map_err(DecodeError::OtherString)
    }
}

bincode::impl_borrow_decode!(Ligand);

impl Ligand {
    /// The molecule alone: without the line of its file, its bonds as if the format had listed them.
    pub(crate) fn detached(self) -> Ligand {
        Ligand { line: None, bond_source: BondSource::Format, ..self }
    }

    /// The molecule without its hydrogens, whose partial charges go to the heavy atoms that they are bonded to; `None` where fewer than
    /// two atoms are left, or they are not one molecule.
    pub(crate) fn without_hydrogens(&self) -> Option<Ligand> {
        let is_heavy = |atom: usize| self.atoms[atom].element.is_heavy();
        let mut numbers = vec![None; self.atoms.len()];
        let mut atoms = Vec::new();
        for (number, atom) in self.atoms.iter().enumerate().filter(|(number, _)| is_heavy(*number))
        {
            numbers[number] = Some(atoms.len());
            atoms.push(atom.clone());
        }
        let mut bonds = Vec::new();
        for bond in &self.bonds {
            match bond.atoms.map(|atom| numbers[atom]) {
                [Some(first), Some(second)] => {
                    bonds.push(Bond { atoms: [first, second], order: bond.order });
                }
                [None, Some(heavy)] => unite(&mut atoms[heavy], &self.atoms[bond.atoms[0]]),
                [Some(heavy), None] => unite(&mut atoms[heavy], &self.atoms[bond.atoms[1]]),
                [None, None] => {}
            }
        }
        let (name, line, bond_source) = (self.name.clone(), self.line, self.bond_source);
        super::check::check(&atoms, &bonds).ok()?;
        Some(Ligand { name, line, atoms, bonds, bond_source })
    }
}

/// Adds a hydrogen's partial charge to that of its heavy atom.
fn unite(heavy: &mut Atom, hydrogen: &Atom) {
    if let Some(charge) = hydrogen.partial_charge {
        heavy.partial_charge = Some(heavy.partial_charge.unwrap_or(0.0) + charge);
    }
}
