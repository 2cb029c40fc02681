//! Alignment of two sequences over their whole length (Needleman & Wunsch 1970, J. Mol. Biol. 48:443).

/// Score of two equal letters.
const SAME: i32 = 2;
/// Score of two letters that differ.
const DIFFERENT: i32 = -1;
/// Score of a letter that has no partner; none at the ends, so that a part of a sequence fits within the whole.
const GAP: i32 = -2;

/// The pairs of indices that an alignment of highest score puts together, in order. Of alignments with one score the
/// pairs nearest the ends of both sequences are kept, then gaps in `second`.
///
/// Time and memory are proportional to the product of the lengths.
pub(super) fn align<T: PartialEq>(first: &[T], second: &[T]) -> Vec<(usize, usize)> {
    let (rows, columns) = (first.len() + 1, second.len() + 1);
    let mut scores = vec![0; rows * columns];
    let at = |row: usize, column: usize| row * columns + column;
    let gap = |is_end: bool| if is_end { 0 } else { GAP };
    // The best of a pair, of a gap in `second`, and of a gap in `first`.
    let ways = |scores: &[i32], row: usize, column: usize| {
        let pair = if first[row - 1] == second[column - 1] { SAME } else { DIFFERENT };
        [
            scores[at(row - 1, column - 1)] + pair,
            scores[at(row - 1, column)] + gap(column == columns - 1),
            scores[at(row, column - 1)] + gap(row == rows - 1),
        ]
    };
    for row in 1..rows {
        for column in 1..columns {
            let best = ways(&scores, row, column).into_iter().max();
            scores[at(row, column)] = best.unwrap_or(0);
        }
    }
    let (mut row, mut column) = (rows - 1, columns - 1);
    let mut pairs = Vec::new();
    while row > 0 && column > 0 {
        let score = scores[at(row, column)];
        match ways(&scores, row, column).iter().position(|way| *way == score) {
            Some(0) => {
                pairs.push((row - 1, column - 1));
                (row, column) = (row - 1, column - 1);
            }
            Some(1) => row -= 1,
            _ => column -= 1,
        }
    }
    pairs.reverse();
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn aligned(first: &str, second: &str) -> String {
        let (first, second): (Vec<char>, Vec<char>) =
            (first.chars().collect(), second.chars().collect());
        let shown = align(&first, &second);
        shown
            .iter()
            .map(|(a, b)| format!("{}{}", first[*a], second[*b]))
            .collect::<Vec<_>>()
            .join(" ")
    }

    #[test]
    fn parts_and_changes_find_their_places() {
        assert_eq!(aligned("ACDEF", "ACDEF"), "AA CC DD EE FF");
        assert_eq!(aligned("ACDEFGHIK", "EFG"), "EE FF GG");
        assert_eq!(aligned("ACDEFGHIK", "ACDGHIK"), "AA CC DD GG HH II KK");
        assert_eq!(aligned("ACDEF", "ACXEF"), "AA CC DX EE FF");
        assert_eq!(aligned("", "ACD"), "");
    }

    #[test]
    fn ties_are_broken_in_one_way() {
        assert_eq!(align(&['A', 'A'], &['A']), [(1, 0)]);
        assert_eq!(align(&['A'], &['A', 'A']), [(0, 1)]);
    }
}
