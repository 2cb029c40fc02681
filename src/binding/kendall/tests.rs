//! Known values, and those of SciPy.

use super::*;
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed};
use std::fmt::Write;
use std::process::Command;

fn stream(ordinal: u64) -> Stream {
    Seed::of_set(1, "kendall", Ordinal(ordinal)).stream(Purpose::Sampling)
}

fn of<const N: usize>(a: [f64; N], b: [f64; N]) -> Kendall {
    Kendall::of(&a, &b).unwrap()
}

#[test]
fn few_ligands_in_the_right_order_say_little() {
    // What chance gives at both ends: 2/3!, 2/4!, 2/5!.
    for (count, p) in [(2, 1.0), (3, 2.0 / 6.0), (4, 2.0 / 24.0), (5, 2.0 / 120.0)] {
        let rising: Vec<f64> = (0..count).map(f64::from).collect();
        let falling: Vec<f64> = rising.iter().map(|x| -x).collect();
        let same = Kendall::of(&rising, &rising).unwrap();
        assert_eq!((same.tau, same.method), (1.0, PValue::Permutations));
        assert!((same.p - p).abs() < 1e-15, "{same:?}");
        assert_eq!(Kendall::of(&rising, &falling), Some(Kendall { tau: -1.0, ..same }));
    }
}

#[test]
fn values_with_ties_are_those_of_the_books() {
    // SciPy's own example: τ-b is -0.4714, to four digits in its documentation.
    let found = of([12.0, 2.0, 1.0, 12.0, 2.0], [1.0, 4.0, 7.0, 1.0, 0.0]);
    assert!((found.tau + 0.471_404_520_791_031_7).abs() < 1e-15, "{found:?}");
    // C − D is 0: nothing is more likely.
    assert_eq!(of([1.0, 2.0, 3.0, 4.0], [2.0, 4.0, 1.0, 3.0]).p, 1.0);
    // Of three with a tie: S is 2, 0 and −2 in the three orders of the second list, of which two are as far from 0.
    let found = of([1.0, 2.0, 3.0], [5.0, 5.0, 9.0]);
    assert!((found.tau - 2.0 / 6f64.sqrt()).abs() < 1e-15);
    assert!((found.p - 2.0 / 3.0).abs() < 1e-15);
}

#[test]
fn both_exact_ways_agree_where_there_are_no_ties() {
    let mut stream = stream(0);
    for count in 2..=8 {
        for _ in 0..20 {
            let [a, b]: [Vec<f64>; 2] =
                [(); 2].map(|()| (0..count).map(|_| stream.unit()).collect());
            let [a, b] = [ranks(&a).unwrap(), ranks(&b).unwrap()];
            let excess = Pairs::of(&a, &b).excess;
            let [one, other] =
                [by_permutations(&a, &b, excess.abs()), by_inversions(count, excess)];
            assert!((one - other).abs() < 1e-14, "{one} {other}");
        }
    }
}

#[test]
fn the_normal_approximation_nears_the_exact_value() {
    let mut stream = stream(1);
    for _ in 0..20 {
        let [a, b]: [Vec<f64>; 2] = [(); 2].map(|()| (0..40).map(|_| stream.unit()).collect());
        let [a, b] = [ranks(&a).unwrap(), ranks(&b).unwrap()];
        let pairs = Pairs::of(&a, &b);
        let difference = by_normal(&a, &b, &pairs) - by_inversions(40, pairs.excess);
        assert!(difference.abs() < 0.02, "{difference}");
    }
}

#[test]
fn lists_without_an_order_have_no_value() {
    for (a, b) in [
        (&[][..], &[][..]),
        (&[1.0], &[1.0]),
        (&[1.0, 2.0], &[1.0]),
        (&[1.0, 1.0], &[1.0, 2.0]),
        (&[0.0, -0.0], &[1.0, 2.0]),
        (&[1.0, f64::NAN], &[1.0, 2.0]),
    ] {
        assert_eq!(Kendall::of(a, b), None, "{a:?} {b:?}");
        assert_eq!(interval(a, b, 10, &mut stream(2)), None);
    }
    let infinite = of([f64::NEG_INFINITY, 0.0, f64::INFINITY], [1.0, 2.0, 3.0]);
    assert_eq!(infinite.tau, 1.0);
    assert_eq!(interval(&[1.0, 2.0], &[1.0, 2.0], 0, &mut stream(2)), None);
}

#[test]
fn the_interval_is_that_of_resampled_ligands() {
    // Two ligands: a quarter of the resamples each is one ligand twice, which are skipped; the others have τ-b 1.
    let two = interval(&[1.0, 2.0], &[1.0, 2.0], 1000, &mut stream(3)).unwrap();
    assert_eq!((two.low, two.high), (1.0, 1.0));
    assert!((400..600).contains(&two.resamples), "{two:?}");
    // Twenty ligands in an order that is right but for noise: τ-b lies within, 1 and 0 do not.
    let mut noise = stream(4);
    let a: Vec<f64> = (0..20).map(f64::from).collect();
    let b: Vec<f64> = a.iter().map(|x| x + 5.0 * noise.normal()).collect();
    let tau = Kendall::of(&a, &b).unwrap().tau;
    let found = interval(&a, &b, 2000, &mut stream(5)).unwrap();
    assert!(0.0 < found.low && found.low < tau && tau < found.high && found.high < 1.0);
    assert!((0.1..0.7).contains(&(found.high - found.low)), "{found:?}");
    assert_eq!(interval(&a, &b, 2000, &mut stream(5)), Some(found));
}

/// SciPy's values of random lists with ties, its p values where both go the same way.
#[test]
fn random_lists_have_the_values_of_scipy() {
    let there = Command::new("python3").args(["-c", "import scipy.stats"]).output();
    if !there.is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 has no scipy");
        return;
    }
    let mut script = "from scipy.stats import kendalltau\ndef worst(a, b, method, tau, p):\n    \
        found = kendalltau(a, b, method=method)\n    \
        assert abs(found.statistic - tau) < 1e-12, (a, b, found, tau)\n    \
        assert p is None or abs(found.pvalue - p) < 1e-12, (a, b, found, p)\n"
        .to_owned();
    let mut stream = stream(6);
    let mut methods = [0; 3];
    for _ in 0..400 {
        let count = 2 + stream.below(40);
        let values = 2 + stream.below(60);
        let has_ties = stream.unit() < 0.7;
        let [a, b]: [Vec<f64>; 2] = [(); 2].map(|()| {
            let draw = |stream: &mut Stream| match has_ties {
                true => stream.below(values) as f64,
                false => stream.unit(),
            };
            (0..count).map(|_| draw(&mut stream)).collect()
        });
        let Some(found) = Kendall::of(&a, &b) else { continue };
        methods[found.method as usize] += 1;
        let is_tied = |list: &[f64]| ties(&ranks(list).unwrap(), |t| t * (t - 1.0)) > 0.0;
        let (method, p) = match found.method {
            // SciPy has no exact value where there are ties.
            PValue::Permutations if is_tied(&a) || is_tied(&b) => ("auto", None),
            PValue::Permutations | PValue::Inversions => ("exact", Some(found.p)),
            PValue::Normal => ("asymptotic", Some(found.p)),
        };
        let p = p.map_or_else(|| "None".to_owned(), |p| format!("{p:?}"));
        writeln!(script, "worst({a:?}, {b:?}, {method:?}, {:?}, {p})", found.tau).unwrap();
    }
    assert!(methods.iter().all(|count| *count > 20), "{methods:?}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("judge.py");
    std::fs::write(&path, script).unwrap();
    let output = Command::new("python3").arg(&path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
