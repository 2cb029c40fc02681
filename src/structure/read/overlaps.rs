//! Atoms upon one another.

use super::super::{Point, StructureError};

/// No two heavy atoms of proteins are nearer than this, in Å: bonds are at least 1.1 Å long, and copies of a chain
/// that were moved into one another have atoms much nearer.
const NEAREST: f64 = 0.5;

/// A heavy atom of an amino acid, with what it is called in errors.
pub(super) struct Placed {
    pub position: Point,
    pub line: usize,
    pub name: String,
}

/// An error that names two atoms that stand upon one another, if any do.
pub(super) fn expect_apart(atoms: &[Placed]) -> Result<(), StructureError> {
    // Atoms in cubes as wide as the distance: what is near is in the same cube or in one beside it. The search ends with
    // the first pair, and a cube holds at most eight atoms without one, so its time is bounded whatever the file.
    let cube_of = |position: &Point| {
        [position.x, position.y, position.z].map(|value| (value / NEAREST).floor() as i64)
    };
    let mut cubes: Vec<([i64; 3], usize)> =
        atoms.iter().enumerate().map(|(index, atom)| (cube_of(&atom.position), index)).collect();
    cubes.sort_unstable();
    for (cube, one) in &cubes {
        let columns = (-1..=1).flat_map(|x| (-1..=1).map(move |y| (cube[0] + x, cube[1] + y)));
        for (x, y) in columns {
            let begin = cubes.partition_point(|(other, _)| *other < [x, y, cube[2] - 1]);
            let beside =
                cubes[begin..].iter().take_while(|(other, _)| *other <= [x, y, cube[2] + 1]);
            for (_, other) in beside.filter(|(_, other)| other != one) {
                let distance = (atoms[*one].position - atoms[*other].position).norm();
                if distance < NEAREST {
                    let (first, second) = (&atoms[*one.min(other)], &atoms[*one.max(other)]);
                    let message = format!(
                        "{} found {distance:.3} Å from {} (line {}); at least {NEAREST} Å expected",
                        second.name, first.name, first.line
                    );
                    return Err(StructureError::line(second.line, message));
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(line: usize, position: [f64; 3]) -> Placed {
        Placed { position: position.into(), line, name: format!("atom {line}") }
    }

    #[test]
    fn two_atoms_nearer_than_half_an_angstrom_are_named() {
        let apart = [[0.0; 3], [0.5, 0.0, 0.0], [0.0, -0.51, 0.0], [-99_999.0, 0.0, 0.0]];
        let mut atoms: Vec<Placed> =
            apart.into_iter().zip(1..).map(|(p, line)| at(line, p)).collect();
        assert!(expect_apart(&atoms).is_ok());
        atoms.push(at(5, [0.0, -0.51, 0.49]));
        let error = expect_apart(&atoms).unwrap_err().to_string();
        assert_eq!(error, ":5: atom 5 found 0.490 Å from atom 3 (line 3); at least 0.5 Å expected");
    }

    #[test]
    fn a_great_heap_is_found_at_once() {
        let heap: Vec<Placed> = (1..=100_000).map(|line| at(line, [1.0; 3])).collect();
        assert!(expect_apart(&heap).is_err());
    }
}
