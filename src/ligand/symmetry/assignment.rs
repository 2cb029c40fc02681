//! The assignment of as many columns to rows with the least sum of costs.
//!
//! H. W. Kuhn, *The Hungarian method for the assignment problem*, Naval Res. Logist. Q. 2 (1955) 83, with shortest
//! augmenting paths (R. Jonker, A. Volgenant, Computing 38 (1987) 325): at most n³ steps for n rows.

/// For every row the column that it has in the cheapest assignment. Costs are finite; `cost` is given a row and a column.
pub(super) fn assign(count: usize, cost: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    // Row `count` and column `count` stand for none.
    let none = count;
    let mut row_of = vec![none; count + 1];
    let (mut of_rows, mut of_columns) = (vec![0.0; count + 1], vec![0.0; count + 1]);
    for row in 0..count {
        row_of[none] = row;
        let mut column = none;
        let mut least = vec![f64::INFINITY; count];
        let mut came_from = vec![none; count];
        let mut is_done = vec![false; count + 1];
        // A shortest path of columns from the row to one that no row has.
        loop {
            is_done[column] = true;
            let from = row_of[column];
            let (mut step, mut next) = (f64::INFINITY, none);
            for to in (0..count).filter(|to| !is_done[*to]) {
                let reduced = cost(from, to) - of_rows[from] - of_columns[to];
                if reduced < least[to] {
                    (least[to], came_from[to]) = (reduced, column);
                }
                if least[to] < step || next == none {
                    (step, next) = (least[to], to);
                }
            }
            for done in 0..=count {
                if is_done[done] {
                    of_rows[row_of[done]] += step;
                    of_columns[done] -= step;
                } else {
                    least[done] -= step;
                }
            }
            column = next;
            if row_of[column] == none {
                break;
            }
        }
        while column != none {
            let before = came_from[column];
            row_of[column] = row_of[before];
            column = before;
        }
    }
    let mut column_of = vec![0; count];
    for (column, row) in row_of[..count].iter().enumerate() {
        column_of[*row] = column;
    }
    column_of
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The least sum over all permutations of the columns that are left.
    fn by_trying(costs: &[Vec<f64>], row: usize, left: &mut Vec<usize>) -> f64 {
        if row == costs.len() {
            return 0.0;
        }
        let mut least = f64::INFINITY;
        for place in 0..left.len() {
            let column = left.swap_remove(place);
            least = least.min(costs[row][column] + by_trying(costs, row + 1, left));
            left.push(column);
            let last = left.len() - 1;
            left.swap(place, last);
        }
        least
    }

    proptest! {
        #[test]
        fn no_other_assignment_is_cheaper(
            count in 0usize..7,
            numbers in prop::collection::vec(prop_oneof![0f64..100.0, (0u8..3).prop_map(f64::from)], 49),
        ) {
            let costs: Vec<Vec<f64>> = (0..count).map(|row| numbers[7 * row..7 * row + count].to_vec()).collect();
            let found = assign(count, |row, column| costs[row][column]);
            let mut sorted = found.clone();
            sorted.sort_unstable();
            prop_assert_eq!(sorted, (0..count).collect::<Vec<_>>());
            let sum: f64 = found.iter().enumerate().map(|(row, column)| costs[row][*column]).sum();
            let least = by_trying(&costs, 0, &mut (0..count).collect());
            prop_assert!((sum - least).abs() < 1e-9, "{} {}", sum, least);
        }
    }
}
