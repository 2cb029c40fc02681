//! How far two sequences are apart: the discrete Fréchet distance, and the Hausdorff distance.

/// A distance of two sequences, and the pair of elements whose distance it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decided {
    /// The distance.
    pub value: f64,
    /// Which element of the first sequence.
    pub first: usize,
    /// Which element of the second.
    pub second: usize,
}

/// The discrete Fréchet distance of two sequences of `n` and `m` elements, both at least 1, whose elements `i` and `j` are
/// `distance(i, j)` apart: the shortest leash with which two walkers can go from beginning to end, each along one of the
/// sequences, by steps to the next element of one or of both (T. Eiter & H. Mannila, *Computing discrete Fréchet
/// distance*, TU Vienna CD-TR 94/64, 1994, table 1). The pair is the first, along the way that the recursion takes, at
/// which the leash is that long. Every pair's distance is asked for once.
///
/// # Panics
/// If one of the sequences is empty.
pub fn discrete_frechet(
    n: usize,
    m: usize,
    mut distance: impl FnMut(usize, usize) -> f64,
) -> Decided {
    assert!(n > 0 && m > 0, "sequences with elements");
    let mut row: Vec<Decided> = Vec::with_capacity(m);
    for first in 0..n {
        // What the row above had at the place before this one.
        let mut diagonal: Option<Decided> = None;
        for second in 0..m {
            let here = Decided { value: distance(first, second), first, second };
            let above = (first > 0).then(|| row[second]);
            let before = (second > 0).then(|| row[second - 1]);
            let ways = [diagonal, above, before].into_iter().flatten();
            let best = ways.reduce(|best, way| if way.value < best.value { way } else { best });
            let leash = best.map_or(here, |best| if here.value > best.value { here } else { best });
            diagonal = above;
            match row.get_mut(second) {
                Some(place) => *place = leash,
                None => row.push(leash),
            }
        }
    }
    row[m - 1]
}

/// The Hausdorff distance of two sequences of `n` and `m` elements, both at least 1: the largest distance of an element of
/// either from the nearest element of the other. The pair is that element, the first if there are several, and the
/// first of the nearest.
///
/// # Panics
/// If one of the sequences is empty.
pub fn hausdorff(n: usize, m: usize, mut distance: impl FnMut(usize, usize) -> f64) -> Decided {
    assert!(n > 0 && m > 0, "sequences with elements");
    let mut nearest: Vec<Option<Decided>> = vec![None; n + m];
    for first in 0..n {
        for second in 0..m {
            let here = Decided { value: distance(first, second), first, second };
            for place in [first, n + second] {
                if nearest[place].is_none_or(|known| here.value < known.value) {
                    nearest[place] = Some(here);
                }
            }
        }
    }
    let all = nearest.into_iter().flatten();
    let farthest = all.reduce(|far, next| if next.value > far.value { next } else { far });
    farthest.expect("there are elements")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The definition, as a recursion over all couplings.
    fn by_recursion(i: usize, j: usize, d: &dyn Fn(usize, usize) -> f64) -> f64 {
        let before =
            match (i, j) {
                (0, 0) => return d(0, 0),
                (0, _) => by_recursion(0, j - 1, d),
                (_, 0) => by_recursion(i - 1, 0, d),
                _ => by_recursion(i - 1, j - 1, d)
                    .min(by_recursion(i - 1, j, d))
                    .min(by_recursion(i, j - 1, d)),
            };
        before.max(d(i, j))
    }

    proptest! {
        #[test]
        fn tables_hold_what_the_recursion_finds(
            a in prop::collection::vec((-5i8..5, -5i8..5), 1..7),
            b in prop::collection::vec((-5i8..5, -5i8..5), 1..7),
        ) {
            let distance = |i: usize, j: usize| {
                let [dx, dy] = [a[i].0 - b[j].0, a[i].1 - b[j].1].map(f64::from);
                (dx * dx + dy * dy).sqrt()
            };
            let (n, m) = (a.len(), b.len());
            let found = discrete_frechet(n, m, distance);
            prop_assert_eq!(found.value, by_recursion(n - 1, m - 1, &distance));
            prop_assert_eq!(found.value, distance(found.first, found.second));
            let back = discrete_frechet(m, n, |i, j| distance(j, i));
            prop_assert_eq!(found.value, back.value);

            let nearest = |i: usize| (0..m).map(|j| distance(i, j)).fold(f64::INFINITY, f64::min);
            let from = |j: usize| (0..n).map(|i| distance(i, j)).fold(f64::INFINITY, f64::min);
            let expected = (0..n).map(nearest).chain((0..m).map(from)).fold(0.0, f64::max);
            let found = hausdorff(n, m, distance);
            prop_assert_eq!(found.value, expected);
            prop_assert_eq!(found.value, distance(found.first, found.second));
            prop_assert!(discrete_frechet(n, m, distance).value >= found.value);
        }
    }

    #[test]
    fn a_detour_decides_and_walking_back_counts_for_frechet_alone() {
        let line: Vec<f64> = vec![0.0, 1.0, 2.0, 3.0, 4.0];
        let detour: Vec<f64> = vec![0.0, 1.0, 9.0, 3.0, 4.0];
        let between =
            |a: &[f64], b: &[f64]| discrete_frechet(a.len(), b.len(), |i, j| (a[i] - b[j]).abs());
        let found = between(&line, &detour);
        assert_eq!((found.value, found.first, found.second), (5.0, 4, 2), "{found:?}");
        assert_eq!(between(&line, &line).value, 0.0);
        // There, back, and there again covers the same points.
        let zigzag = [0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 2.0, 3.0, 4.0];
        let apart = hausdorff(5, 9, |i, j| (line[i] - zigzag[j]).abs());
        assert_eq!((apart.value, between(&line, &zigzag).value), (0.0, 1.0));
    }
}
