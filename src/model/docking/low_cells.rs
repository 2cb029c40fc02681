//! Cells of the grid by their energies.

use super::grid::Field;
use crate::model::{CellLimits, LowCells};

/// The cells about those points of the grid at which an atom with this number has an energy of at most `limits.low`, in the order of the
/// grid's points; those apart of which a neighbour along an axis has `limits.high` or more.
pub(super) fn low_cells(field: &Field, atom: usize, limits: CellLimits) -> LowCells {
    let mut cells = LowCells { spacing: 0.0, at_boundary: Vec::new(), inside: Vec::new() };
    let Some((grid, values)) = field.grid() else { return cells };
    cells.spacing = grid.spacing();
    let counts = grid.counts();
    let energy = |at: [usize; 3]| grid.at_point(values, field.sum(), atom, at);
    for z in 0..counts[2] {
        for y in 0..counts[1] {
            for x in 0..counts[0] {
                let at = [x, y, z];
                let is_low = energy(at) <= limits.low;
                if !is_low {
                    continue;
                }
                let is_high = |axis: usize, by: isize| {
                    let mut near = at;
                    let moved = near[axis].checked_add_signed(by);
                    let Some(moved) = moved.filter(|moved| *moved < counts[axis]) else {
                        return false;
                    };
                    near[axis] = moved;
                    energy(near) >= limits.high
                };
                let is_at_boundary = (0..3).any(|axis| is_high(axis, -1) || is_high(axis, 1));
                let centre = grid.point(at);
                match is_at_boundary {
                    true => cells.at_boundary.push(centre),
                    false => cells.inside.push(centre),
                }
            }
        }
    }
    cells
}
