//! How well two lists of numbers agree in their order: Kendall's τ-b, its p value, and its interval.
//!
//! M. G. Kendall, *The treatment of ties in ranking problems*, Biometrika 33 (1945) 239, and *Rank Correlation Methods*,
//! 4th edition, 1970, chapters 3 and 5.

use crate::math;
use crate::seed::Stream;

/// Lists of at most so many numbers have a p value by all permutations: 9! is 362 880.
const PERMUTED_MAX: usize = 9;

/// Lists of at most so many numbers, without ties, have an exact p value by the distribution of inversions.
const COUNTED_MAX: usize = 50;

/// The rank correlation of two lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kendall {
    /// τ-b, from −1 to 1: (C − D) / √((N − T)(N − U)) with C concordant and D discordant ones of the N pairs, T pairs tied in
    /// the first list and U in the second.
    pub tau: f64,
    /// How likely |C − D| is as large or larger if the order of the one list has nothing to do with that of the other.
    pub p: f64,
    /// How `p` was found.
    pub method: PValue,
}

/// How a p value was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PValue {
    /// Over all permutations of the one list, exactly: up to nine numbers, tied or not.
    Permutations,
    /// From the distribution of the number of inversions of a random permutation, exactly: up to fifty numbers, no ties.
    Inversions,
    /// By the normal distribution with the variance of C − D that accounts for ties (Kendall 1970, chapter 4).
    Normal,
}

/// An interval of τ-b over ligands drawn again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The 2.5th percentile.
    pub low: f64,
    /// The 97.5th percentile.
    pub high: f64,
    /// How many of the resamples had a τ-b: those all of whose numbers are tied in one of the lists have none.
    pub resamples: usize,
}

impl Kendall {
    /// The correlation of two lists of the same length, with two-sided p value. `None` if their lengths differ, if a number
    /// is NaN, or if there are not two different numbers in each.
    pub fn of(a: &[f64], b: &[f64]) -> Option<Kendall> {
        if a.len() != b.len() {
            return None;
        }
        let [a, b] = [ranks(a)?, ranks(b)?];
        let pairs = Pairs::of(&a, &b);
        let tau = pairs.tau()?;
        let (p, method) = p_value(&a, &b, &pairs);
        Some(Kendall { tau, p, method })
    }
}

/// The interval that has 95 % of the values of τ-b over `resamples` resamples, each as many pairs drawn with replacement
/// from the pairs of the two lists: the percentile method of B. Efron and R. J. Tibshirani, *An Introduction to the
/// Bootstrap*, 1993, chapter 13. Percentiles are interpolated between neighbours. Resamples that are all ties in one list are skipped and
/// not replaced. `None` where [`Kendall::of`] has none, and where no resample has a value.
///
/// The interval says how much τ-b hangs on which ligands were measured. Of few ligands it is wide, and narrower than it should be.
pub fn interval(a: &[f64], b: &[f64], resamples: usize, stream: &mut Stream) -> Option<Interval> {
    Kendall::of(a, b)?;
    let [a, b] = [ranks(a)?, ranks(b)?];
    let mut values = Vec::with_capacity(resamples);
    let (mut drawn_a, mut drawn_b) = (vec![0; a.len()], vec![0; b.len()]);
    for _ in 0..resamples {
        for place in 0..a.len() {
            let drawn = stream.below(a.len() as u64) as usize;
            (drawn_a[place], drawn_b[place]) = (a[drawn], b[drawn]);
        }
        values.extend(Pairs::of(&drawn_a, &drawn_b).tau());
    }
    values.sort_unstable_by(f64::total_cmp);
    let percentile = |share: f64| {
        let place = share * (values.len().checked_sub(1)? as f64);
        let below = place.floor() as usize;
        let above = (below + 1).min(values.len() - 1);
        Some(values[below] + (place - below as f64) * (values[above] - values[below]))
    };
    Some(Interval { low: percentile(0.025)?, high: percentile(0.975)?, resamples: values.len() })
}

/// For every number how many different ones are lower: equal numbers have equal ranks. `None` if one is NaN.
fn ranks(numbers: &[f64]) -> Option<Vec<usize>> {
    if numbers.iter().any(|x| x.is_nan()) {
        return None;
    }
    // Adding zero makes -0 the same as 0.
    let mut distinct: Vec<f64> = numbers.iter().map(|x| x + 0.0).collect();
    distinct.sort_unstable_by(f64::total_cmp);
    distinct.dedup();
    Some(numbers.iter().map(|x| distinct.partition_point(|other| other < x)).collect())
}

/// What the pairs of places of two lists of ranks are.
struct Pairs {
    /// All pairs.
    all: f64,
    /// Concordant pairs without discordant ones.
    excess: i64,
    /// Pairs that are tied in the first list, and in the second.
    tied: [f64; 2],
}

impl Pairs {
    fn of(a: &[usize], b: &[usize]) -> Pairs {
        let count = a.len() as f64;
        let mut excess = 0;
        for (place, (x, y)) in a.iter().zip(b).enumerate() {
            for (other_x, other_y) in a[..place].iter().zip(b) {
                excess += agreement(x, other_x, y, other_y);
            }
        }
        let tied = [a, b].map(|list| ties(list, |t| t * (t - 1.0) / 2.0));
        Pairs { all: count * (count - 1.0) / 2.0, excess, tied }
    }

    /// τ-b; `None` if all pairs are tied in one of the lists.
    fn tau(&self) -> Option<f64> {
        let untied = self.tied.map(|tied| self.all - tied);
        let tau = self.excess as f64 / (untied[0] * untied[1]).sqrt();
        // Rounding may lead beyond the ends.
        (untied[0] > 0.0 && untied[1] > 0.0).then(|| tau.clamp(-1.0, 1.0))
    }
}

/// 1 if two places are in the same order in both lists, −1 if in opposite ones, 0 if they are tied in one.
fn agreement(x: &usize, other_x: &usize, y: &usize, other_y: &usize) -> i64 {
    x.cmp(other_x) as i64 * y.cmp(other_y) as i64
}

/// The sum of a function of the number of places of every rank.
fn ties(ranks: &[usize], of: impl Fn(f64) -> f64) -> f64 {
    let mut counts = vec![0_u32; ranks.len()];
    for rank in ranks {
        counts[*rank] += 1;
    }
    counts.into_iter().map(|count| of(f64::from(count))).sum()
}

fn p_value(a: &[usize], b: &[usize], pairs: &Pairs) -> (f64, PValue) {
    let has_ties = pairs.tied.iter().any(|tied| *tied > 0.0);
    if a.len() <= PERMUTED_MAX {
        (by_permutations(a, b, pairs.excess.abs()), PValue::Permutations)
    } else if !has_ties && a.len() <= COUNTED_MAX {
        (by_inversions(a.len(), pairs.excess), PValue::Inversions)
    } else {
        (by_normal(a, b, pairs), PValue::Normal)
    }
}

/// The share of all permutations of the second list with |C − D| of at least `least`.
fn by_permutations(a: &[usize], b: &[usize], least: i64) -> f64 {
    /// Puts each number that is left at the next place; returns how many permutations there are, and how many have enough.
    fn place(a: &[usize], b: &mut [usize], next: usize, excess: i64, least: i64) -> [u32; 2] {
        if next == b.len() {
            return [1, u32::from(excess.abs() >= least)];
        }
        let mut counts = [0; 2];
        for chosen in next..b.len() {
            b.swap(next, chosen);
            let more = (0..next).map(|at| agreement(&a[next], &a[at], &b[next], &b[at]));
            let [all, enough] = place(a, b, next + 1, excess + more.sum::<i64>(), least);
            counts = [counts[0] + all, counts[1] + enough];
            b.swap(next, chosen);
        }
        counts
    }
    let [all, enough] = place(a, &mut b.to_vec(), 0, 0, least);
    f64::from(enough) / f64::from(all)
}

/// The probability that C − D of a random permutation of so many different numbers is at least as far from 0.
///
/// Its discordant pairs are inversions. The k-th number brings 0 to k − 1 of them, each as likely as the other, so that
/// their distribution is that of a sum of uniform ones.
fn by_inversions(count: usize, excess: i64) -> f64 {
    let most = count * (count - 1) / 2;
    let mut probability = vec![0.0; most + 1];
    probability[0] = 1.0;
    for k in 2..=count {
        let share = 1.0 / k as f64;
        let before = probability.clone();
        for (inversions, to) in probability.iter_mut().enumerate() {
            let from = inversions.saturating_sub(k - 1);
            *to = share * before[from..=inversions].iter().sum::<f64>();
        }
    }
    // C + D is `most`, so the fewer of both are (most - |C - D|) / 2. Both tails are alike.
    let fewer = (most - excess.unsigned_abs() as usize) / 2;
    let tail: f64 = probability[..=fewer].iter().sum();
    (2.0 * tail).min(1.0)
}

/// The probability of a normal distribution beyond C − D, at both ends. The variance is that of C − D over all permutations,
/// ties among them (Kendall 1970, eq. 4.3).
fn by_normal(a: &[usize], b: &[usize], pairs: &Pairs) -> f64 {
    let n = a.len() as f64;
    let both = |of: fn(f64) -> f64| [ties(a, of), ties(b, of)];
    let [v_a, v_b] = both(|t| t * (t - 1.0) * (2.0 * t + 5.0));
    let [w_a, w_b] = both(|t| t * (t - 1.0) * (t - 2.0));
    let [t_a, t_b] = pairs.tied;
    let ordered = n * (n - 1.0);
    let variance = (ordered * (2.0 * n + 5.0) - v_a - v_b) / 18.0
        + 2.0 * t_a * t_b / ordered
        + w_a * w_b / (9.0 * ordered * (n - 2.0));
    math::erfc((pairs.excess as f64).abs() / (2.0 * variance).sqrt())
}

#[cfg(test)]
mod tests;
