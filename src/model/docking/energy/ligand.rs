//! Ligands as particles.

use super::particle::{Particle, is_hydrophobic};
use crate::ligand::{BondOrder, Element, Ligand};

/// The particles of a ligand, one for every atom, hydrogens included, in their order.
///
/// Charges are the file's partial charges if any atom has one, and formal charges otherwise; an atom of which the file
/// does not tell has none. Formal charges are shared among the atoms at which another drawing of the same molecule would put
/// them, so that a carboxylate's oxygens are alike. With `united`, the charges of hydrogens are counted at the heavy
/// atoms that they are bonded to: for a model of heavy atoms alone, which leaves hydrogens out.
pub fn ligand_particles(ligand: &Ligand, united: bool) -> Vec<Particle> {
    let neighbours = neighbours(ligand);
    let has_partial = ligand.atoms().iter().any(|atom| atom.partial_charge.is_some());
    let mut charges = if has_partial {
        ligand.atoms().iter().map(|atom| atom.partial_charge.unwrap_or(0.0)).collect()
    } else {
        shared_charges(ligand, &neighbours)
    };
    if united {
        unite(ligand, &neighbours, &mut charges);
    }
    let elements = |atom: usize| neighbours[atom].iter().map(|(other, _)| element(ligand, *other));
    (0..ligand.atoms().len())
        .map(|atom| Particle {
            element: element(ligand, atom),
            charge: charges[atom],
            is_hydrophobic: is_hydrophobic(element(ligand, atom), elements(atom)),
        })
        .collect()
}

/// The neighbours of every atom, each with the order of the bond, in the order of the bonds.
fn neighbours(ligand: &Ligand) -> Vec<Vec<(usize, BondOrder)>> {
    let mut of = vec![Vec::new(); ligand.atoms().len()];
    for bond in ligand.bonds() {
        let [one, other] = bond.atoms;
        of[one].push((other, bond.order));
        of[other].push((one, bond.order));
    }
    of
}

fn element(ligand: &Ligand, atom: usize) -> Element {
    ligand.atoms()[atom].element
}

/// Formal charges, those of resonant groups shared.
///
/// A group is one element's terminal atoms at one centre (an atom is terminal if it has one heavy neighbour) whose places
/// resonance exchanges: of anions the singly bonded ones that are charged and the doubly bonded ones that are not (carboxylates,
/// phosphates, sulphonates, nitro groups), of cations the doubly bonded ones that are charged and the singly bonded ones that
/// are not (amidinium, guanidinium). Bonds that are aromatic or of unknown order may be either. Terminal atoms with
/// different numbers of hydrogens, where the file has hydrogens, are different.
fn shared_charges(ligand: &Ligand, neighbours: &[Vec<(usize, BondOrder)>]) -> Vec<f64> {
    let formal = |atom: usize| ligand.atoms()[atom].formal_charge.unwrap_or(0);
    let mut charges: Vec<f64> =
        (0..ligand.atoms().len()).map(|atom| f64::from(formal(atom))).collect();
    let is_heavy = |atom: usize| element(ligand, atom).is_heavy();
    let heavy_neighbours =
        |atom: usize| neighbours[atom].iter().filter(|(other, _)| is_heavy(*other)).count();
    let hydrogens = |atom: usize| neighbours[atom].len() - heavy_neighbours(atom);
    for centre in (0..ligand.atoms().len()).filter(|atom| is_heavy(*atom)) {
        let terminal: Vec<(usize, BondOrder)> = neighbours[centre]
            .iter()
            .copied()
            .filter(|(atom, _)| is_heavy(*atom) && heavy_neighbours(*atom) == 1)
            .collect();
        for (first, _) in &terminal {
            let sign = formal(*first).signum();
            if sign == 0 {
                continue;
            }
            let is_alike = |atom: usize| {
                element(ligand, atom) == element(ligand, *first)
                    && hydrogens(atom) == hydrogens(*first)
            };
            let members: Vec<usize> = terminal
                .iter()
                .filter(|(atom, order)| is_alike(*atom) && resonates(formal(*atom), *order, sign))
                .map(|(atom, _)| *atom)
                .collect();
            // A group that holds several charged atoms is shared once, at the first of them.
            let is_first = members.iter().find(|atom| formal(**atom) != 0) == Some(first);
            if !is_first || members.len() < 2 {
                continue;
            }
            let total: i32 = members.iter().map(|atom| i32::from(formal(*atom))).sum();
            let count = members.iter().fold(0.0, |count, _| count + 1.0);
            for member in &members {
                charges[*member] = f64::from(total) / count;
            }
        }
    }
    charges
}

/// Whether a terminal atom of this formal charge and bond belongs to a resonant group of this sign.
fn resonates(charge: i8, order: BondOrder, sign: i8) -> bool {
    let is_charged = charge == sign;
    let is_either = matches!(order, BondOrder::Aromatic | BondOrder::Unknown);
    let is_single = order == BondOrder::Single || is_either;
    let is_double = order == BondOrder::Double || is_either;
    match (sign < 0, is_charged, charge) {
        (true, true, _) | (false, false, 0) => is_single,
        (true, false, 0) | (false, true, _) => is_double,
        _ => false,
    }
}

/// Moves the charges of hydrogens to the heavy atoms that they are bonded to, one of those at most.
fn unite(ligand: &Ligand, neighbours: &[Vec<(usize, BondOrder)>], charges: &mut [f64]) {
    for atom in 0..charges.len() {
        if element(ligand, atom).is_heavy() {
            continue;
        }
        let heavy = neighbours[atom].iter().find(|(other, _)| element(ligand, *other).is_heavy());
        if let Some((heavy, _)) = heavy {
            charges[*heavy] += charges[atom];
            charges[atom] = 0.0;
        }
    }
}
