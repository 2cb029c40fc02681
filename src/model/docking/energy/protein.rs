//! Proteins as particles.

use super::particle::{Particle, is_hydrophobic};
use crate::ligand::{BOND_TOLERANCE, Element};
use crate::structure::{AminoAcid, Atom, Residue};

/// The ionised groups of side chains, by the residue's name in the file: the atoms that share the charge, and the charge.
/// Histidine is neutral. So are the names that programs give to neutral forms (ASH, GLH, LYN) and residues that are not
/// listed.
const SIDE_CHAINS: [(&str, &[&str], f64); 11] = [
    ("ASP", &["OD1", "OD2"], -1.0),
    ("GLU", &["OE1", "OE2"], -1.0),
    ("LYS", &["NZ"], 1.0),
    ("ARG", &["NH1", "NH2"], 1.0),
    // Histidine with two hydrogens on its ring, as AMBER and CHARMM call it, and cysteine without its hydrogen.
    ("HIP", &["ND1", "NE2"], 1.0),
    ("HSP", &["ND1", "NE2"], 1.0),
    ("CYM", &["SG"], -1.0),
    // Phosphorylated serine, threonine and tyrosine.
    ("SEP", &["O1P", "O2P", "O3P"], -2.0),
    ("TPO", &["O1P", "O2P", "O3P"], -2.0),
    ("PTR", &["O1P", "O2P", "O3P"], -2.0),
    // Lysine with a hydrogen more than LYN, as GROMACS calls it.
    ("LYSH", &["NZ"], 1.0),
];

/// The two oxygens of a chain's end, as the wwPDB, CHARMM and GROMACS call them.
const CARBOXYLATES: [[&str; 2]; 3] = [["O", "OXT"], ["OT1", "OT2"], ["OC1", "OC2"]];

/// Charges of ions that are residues of their own: the usual ones in water.
const IONS: [(f64, &[&str]); 4] = [
    (-1.0, &["F", "Cl", "Br", "I"]),
    (1.0, &["Li", "Na", "K", "Rb", "Cs", "Ag", "Tl"]),
    (
        2.0,
        &[
            "Be", "Mg", "Ca", "Sr", "Ba", "Mn", "Fe", "Co", "Ni", "Cu", "Zn", "Cd", "Hg", "Pb",
            "Pd", "Pt",
        ],
    ),
    (
        3.0,
        &[
            "Al", "Sc", "Cr", "Ga", "Y", "In", "La", "Ce", "Pr", "Nd", "Sm", "Eu", "Gd", "Tb",
            "Dy", "Ho", "Er", "Tm", "Yb", "Lu",
        ],
    ),
];

/// An atom of an element that has no parameters: one beyond curium, or none at all.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{residue}: atom {atom} of element {element:?} found; elements from hydrogen to curium expected"
)]
pub struct UnknownElement {
    /// The residue, as `CF 301`.
    pub residue: String,
    /// The atom's name.
    pub atom: String,
    /// The element in the file.
    pub element: String,
}

/// The particles of chains, one for every atom, hydrogens included, in the order of chains, residues and atoms.
///
/// A chain is its residues in their order, amino acids and whatever else of the file is kept. Charges are formal ones,
/// shared by the atoms of a group that are alike:
///
/// - Asp and Glu −1 on their two oxygens, Lys +1 on NZ, Arg +1 on NH1 and NH2, His none;
/// - the nitrogen of a chain's first amino acid +1, unless another carbon is bonded to it, as in chains that are
///   acetylated; whether residues before it went unseen is not known, and they are taken not to be there;
/// - an end with both oxygens (O and OXT) −1 on the two; without OXT the chain goes on unseen, and there is none;
/// - ions that are residues of one atom by their usual charge: +1 alkali metals and silver, +2 alkaline earths and transition
///   metals, +3 aluminium, chromium and lanthanides, −1 halides.
///
/// A charge whose group is seen in part is on the atoms that are seen. Everything else is neutral. Hydrophobic are the
/// carbons that have neighbours of carbon and hydrogen only, by distances within the residue.
///
/// # Errors
/// An atom whose element has no parameters.
pub fn protein_particles(chains: &[Vec<Residue>]) -> Result<Vec<Particle>, UnknownElement> {
    let mut particles = Vec::new();
    for chain in chains {
        let first = chain.iter().position(|residue| residue.amino_acid.is_some());
        for (number, residue) in chain.iter().enumerate() {
            let begin = particles.len();
            push_neutral(residue, &mut particles)?;
            let own = &mut particles[begin..];
            for (atoms, charge) in groups(residue) {
                share(residue, atoms, charge, own);
            }
            if first == Some(number) && begins(chain, number) {
                share(residue, &["N"], 1.0, own);
            }
            if let (None, [atom], [particle]) = (residue.amino_acid, &residue.atoms[..], own) {
                particle.charge = ion_charge(&atom.element);
            }
        }
    }
    Ok(particles)
}

/// Adds a residue's particles without charges.
fn push_neutral(residue: &Residue, particles: &mut Vec<Particle>) -> Result<(), UnknownElement> {
    let elements: Result<Vec<Element>, UnknownElement> = residue
        .atoms
        .iter()
        .map(|atom| {
            Element::of_symbol(&atom.element).ok_or_else(|| UnknownElement {
                residue: residue.to_string(),
                atom: atom.name.clone(),
                element: atom.element.clone(),
            })
        })
        .collect();
    let elements = elements?;
    let bonded = neighbour_elements(&residue.atoms, &elements);
    let is_backbone =
        |atom: &Atom| residue.amino_acid.is_some() && matches!(atom.name.as_str(), "CA" | "C");
    for ((atom, element), bonded) in residue.atoms.iter().zip(&elements).zip(bonded) {
        // Nitrogens of the backbone that went unseen are bonded to these, too.
        let is_hydrophobic = !is_backbone(atom) && is_hydrophobic(*element, bonded);
        particles.push(Particle { element: *element, charge: 0.0, is_hydrophobic });
    }
    Ok(())
}

/// The elements of every atom's neighbours in a residue: atoms at most the sum of the covalent radii and 0.45 Å away.
fn neighbour_elements(atoms: &[Atom], elements: &[Element]) -> Vec<Vec<Element>> {
    let widest = elements.iter().map(|element| element.covalent_radius()).fold(0.0, f64::max);
    let mut by_x: Vec<usize> = (0..atoms.len()).collect();
    by_x.sort_by(|one, other| atoms[*one].position.x.total_cmp(&atoms[*other].position.x));
    let mut bonded = vec![Vec::new(); atoms.len()];
    for (place, one) in by_x.iter().enumerate() {
        for other in &by_x[place + 1..] {
            let apart = atoms[*other].position - atoms[*one].position;
            if apart.x > 2.0 * widest + BOND_TOLERANCE {
                break;
            }
            let most = elements[*one].covalent_radius()
                + elements[*other].covalent_radius()
                + BOND_TOLERANCE;
            if apart.norm_squared() <= most * most {
                bonded[*one].push(elements[*other]);
                bonded[*other].push(elements[*one]);
            }
        }
    }
    bonded
}

/// The ionised groups of a residue, its place in the chain apart.
fn groups(residue: &Residue) -> impl Iterator<Item = (&'static [&'static str], f64)> {
    let name = residue.name.as_str();
    let side_chain = SIDE_CHAINS
        .iter()
        .filter(move |(known, ..)| *known == name)
        .map(|(_, atoms, charge)| (*atoms, *charge));
    let has = |name: &str| residue.position(name).is_some();
    let end = CARBOXYLATES
        .iter()
        .find(|[one, other]| residue.amino_acid.is_some() && has(one) && has(other))
        .map(|atoms| (&atoms[..], -1.0));
    side_chain.chain(end)
}

/// Shares a charge equally among the atoms of these names that there are.
fn share(residue: &Residue, names: &[&str], charge: f64, particles: &mut [Particle]) {
    let is_member = |atom: &Atom| names.contains(&atom.name.as_str());
    let count =
        residue.atoms.iter().filter(|atom| is_member(atom)).fold(0.0, |count, _| count + 1.0);
    for (atom, particle) in residue.atoms.iter().zip(particles) {
        if is_member(atom) {
            particle.charge += charge / count;
        }
    }
}

/// Whether the nitrogen of this residue is the free end of the chain: bonded to one carbon (proline: two) and no more.
fn begins(chain: &[Residue], number: usize) -> bool {
    let Some(nitrogen) = chain[number].position("N") else { return false };
    let most = Element::NITROGEN.covalent_radius() + Element::CARBON.covalent_radius();
    let most = (most + BOND_TOLERANCE) * (most + BOND_TOLERANCE);
    let carbons = chain
        .iter()
        .flat_map(|residue| &residue.atoms)
        .filter(|atom| atom.element == "C" && (atom.position - nitrogen).norm_squared() <= most)
        .count();
    carbons <= if chain[number].amino_acid == Some(AminoAcid::Proline) { 2 } else { 1 }
}

/// The charge of an ion that is a residue of its own.
fn ion_charge(element: &str) -> f64 {
    IONS.iter().find(|(_, elements)| elements.contains(&element)).map_or(0.0, |(charge, _)| *charge)
}
