//! What is true of every ligand.

use super::error::LigandFault;
use super::graph::{neighbours, pieces};
use super::perceive::SAME_PLACE;
use super::{Atom, Bond};
use crate::structure::{COORDINATE_MAX, Point};

/// The most atoms of a ligand. Drugs have some 20 to 100, cyclosporin has 196; a polymer is no ligand that turns by
/// torsions alone.
pub const ATOMS_MAX: usize = 1000;
/// The most bonds of a ligand: four to an atom would already be twice as many as in diamond.
pub const BONDS_MAX: usize = 4 * ATOMS_MAX;

/// That there are not too many atoms, so far or in all.
pub(super) fn expect_room(atoms: usize) -> Result<(), LigandFault> {
    if atoms > ATOMS_MAX {
        return Err(LigandFault::TooMany { found: atoms, what: "atoms", most: ATOMS_MAX });
    }
    Ok(())
}

/// Checks atoms and bonds.
pub(super) fn check(atoms: &[Atom], bonds: &[Bond]) -> Result<(), LigandFault> {
    if atoms.is_empty() {
        return Err(LigandFault::Empty);
    }
    expect_room(atoms.len())?;
    if bonds.len() > BONDS_MAX {
        return Err(LigandFault::TooMany { found: bonds.len(), what: "bonds", most: BONDS_MAX });
    }
    if bonds.is_empty() {
        return Err(LigandFault::NoBonds { atoms: atoms.len() });
    }
    check_numbers(atoms)?;
    let mut pairs = Vec::with_capacity(bonds.len());
    for Bond { atoms: [a, b], .. } in bonds {
        let name =
            || format!("a bond of atoms {} and {}", a.saturating_add(1), b.saturating_add(1));
        if *a.max(b) >= atoms.len() {
            return Err(LigandFault::BadBond(format!("{} among {}", name(), atoms.len())));
        }
        if a == b {
            return Err(LigandFault::BadBond(name()));
        }
        if let (Some(first), Some(second)) = (atoms[*a].position, atoms[*b].position)
            && (second - first).norm() < SAME_PLACE
        {
            let found = format!("{} less than {SAME_PLACE} Å long", name());
            return Err(LigandFault::BadBond(found));
        }
        pairs.push([*a.min(b), *a.max(b)]);
    }
    pairs.sort_unstable();
    if let Some([a, b]) = pairs.windows(2).find(|two| two[0] == two[1]).map(|two| two[0]) {
        let found = format!("a second bond of atoms {} and {}", a + 1, b + 1);
        return Err(LigandFault::BadBond(found));
    }
    let pieces = pieces(&neighbours(atoms.len(), bonds), |_| false);
    if pieces.len() > 1 {
        let pieces = pieces.iter().map(Vec::len).collect();
        return Err(LigandFault::NotConnected { pieces });
    }
    Ok(())
}

/// That positions and charges are numbers, and positions there for all atoms or for none.
fn check_numbers(atoms: &[Atom]) -> Result<(), LigandFault> {
    for (number, atom) in atoms.iter().enumerate() {
        let of = format!("of atom {}", number + 1);
        if let Some(charge) = atom.partial_charge.filter(|charge| !charge.is_finite()) {
            return Err(LigandFault::BadNumber {
                found: format!("`{charge}`"),
                expected: format!("the partial charge {of}, finite,"),
            });
        }
        if let Some(position) = &atom.position {
            check_position(position, number)?;
        }
    }
    let positions: Vec<Point> = atoms.iter().filter_map(|atom| atom.position).collect();
    if !positions.is_empty() && positions.len() < atoms.len() {
        let found = format!("positions of {} of {} atoms", positions.len(), atoms.len());
        return Err(LigandFault::NoCoordinates(found));
    }
    if positions.len() > 1 && positions.iter().all(|position| *position == positions[0]) {
        let found = "one position for all atoms".to_owned();
        return Err(LigandFault::NoCoordinates(found));
    }
    Ok(())
}

/// That the position in Å of the atom with this number is finite and not too far away.
pub(super) fn check_position(position: &Point, number: usize) -> Result<(), LigandFault> {
    position.iter().try_for_each(|value| check_coordinate(*value)).map_err(|fault| match fault {
        LigandFault::BadNumber { found, expected } => LigandFault::BadNumber {
            found,
            expected: format!("{expected} as a coordinate of atom {}", number + 1),
        },
        other => other,
    })
}

/// That a coordinate in Å is finite and not too large.
pub(super) fn check_coordinate(value: f64) -> Result<(), LigandFault> {
    // Not a number is not at most anything.
    if value.abs() <= COORDINATE_MAX {
        return Ok(());
    }
    Err(LigandFault::BadNumber {
        found: format!("`{value}`"),
        expected: format!("a number of at most {COORDINATE_MAX} Å"),
    })
}
