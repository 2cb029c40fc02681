//! Tests of distributions at the level 0.001. Seeds are fixed, so that a test never fails by chance later.

/// The test of Kolmogorov and Smirnov: the sample has the distribution function `law`.
pub(super) fn follows(mut sample: Vec<f64>, law: impl Fn(f64) -> f64) {
    sample.sort_by(f64::total_cmp);
    let n = sample.len() as f64;
    let gap = sample.iter().enumerate().fold(0.0f64, |gap, (i, x)| {
        let law = law(*x);
        gap.max((law - i as f64 / n).abs()).max((law - (i as f64 + 1.0) / n).abs())
    });
    assert!(n >= 1000.0 && gap < 1.95 / n.sqrt(), "gap {gap} of {n}");
}

/// The chi-square test: counts of cells agree with probabilities, which need not sum to 1.
pub(crate) fn fits(counts: &[usize], probabilities: &[f64]) {
    let n: usize = counts.iter().sum();
    let whole: f64 = probabilities.iter().sum();
    let square: f64 = counts
        .iter()
        .zip(probabilities)
        .map(|(count, probability)| {
            let expected = n as f64 * probability / whole;
            assert!(expected > 5.0);
            (*count as f64 - expected) * (*count as f64 - expected) / expected
        })
        .sum();
    // The quantile 0.999 (E. B. Wilson, M. M. Hilferty 1931).
    let freedom = counts.len() as f64 - 1.0;
    let share = 2.0 / (9.0 * freedom);
    let root = 1.0 - share + 3.09 * share.sqrt();
    let most = freedom * root * root * root;
    assert!(square < most, "{square} of {most}: {counts:?} for {probabilities:?}");
}
