use super::Spread;
use super::beta::regularized;
use nalgebra::{DMatrix, DVector};

/// The shares of samples in cells, over several independent runs, beside those expected.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// Per cell what its share came to.
    pub cells: Vec<CellShare>,
    /// The largest absolute error among the cells of which a share above 0 is expected.
    pub largest_error: f64,
    /// A test that the mean shares are those expected; `None` where there are too few runs for it, or where shares do not vary
    /// enough to tell.
    pub test: Option<Hotelling>,
}

/// The share of samples in one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellShare {
    /// The share expected.
    pub expected: f64,
    /// The mean over the runs.
    pub mean: f64,
    /// The standard deviation over the runs, by n − 1.
    pub deviation: f64,
    /// The mean less the share expected, as a share of the latter; `None` where none is expected.
    pub error: Option<f64>,
}

/// Hotelling's test: T² = n (m − μ)ᵀ S⁻¹ (m − μ) with the runs' mean m and covariance S, over all cells but one, since shares add up to 1.
/// If shares are about normal with mean μ, then T² (n − p) / (p (n − 1)) has the F distribution with p and n − p
/// degrees of freedom, whatever the covariance of samples within a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hotelling {
    /// The number of runs, n.
    pub runs: usize,
    /// The number of shares that are free, p.
    pub freedom: usize,
    /// T² as an F value.
    pub f: f64,
    /// The probability of as large a value if shares are those expected.
    pub probability: f64,
}

impl Shares {
    /// Compares the counts of several runs, each per cell, with shares that are proportional to `expected`. `None` if there
    /// are no runs or no samples in one, numbers of cells differ, or what is expected is no share.
    pub fn of<R: AsRef<[usize]>>(runs: &[R], expected: &[f64]) -> Option<Shares> {
        let whole: f64 = expected.iter().sum();
        let sound = whole > 0.0 && whole.is_finite() && expected.iter().all(|share| *share >= 0.0);
        if runs.is_empty() || !sound {
            return None;
        }
        let mut shares: Vec<Vec<f64>> = Vec::new();
        for counts in runs {
            let counts = counts.as_ref();
            let samples: usize = counts.iter().sum();
            if counts.len() != expected.len() || samples == 0 {
                return None;
            }
            shares.push(counts.iter().map(|count| *count as f64 / samples as f64).collect());
        }
        let cell = |index: usize| {
            let column: Vec<f64> = shares.iter().map(|run| run[index]).collect();
            let Spread { mean, deviation } = Spread::of(&column)?;
            let expected = expected[index] / whole;
            let error = (expected > 0.0).then(|| (mean - expected) / expected);
            Some(CellShare { expected, mean, deviation, error })
        };
        let cells: Vec<CellShare> = (0..expected.len()).map(cell).collect::<Option<_>>()?;
        let errors = cells.iter().filter_map(|cell| cell.error);
        let largest_error = errors.fold(0.0, |most, error| f64::max(most, error.abs()));
        let test = hotelling(&shares, &cells);
        Some(Shares { cells, largest_error, test })
    }
}

fn hotelling(shares: &[Vec<f64>], cells: &[CellShare]) -> Option<Hotelling> {
    // Cells in which nothing is expected and nothing is found say nothing. Of the others the last follows from the rest.
    let mut kept: Vec<usize> = (0..cells.len())
        .filter(|index| cells[*index].expected > 0.0 || cells[*index].mean > 0.0)
        .collect();
    kept.pop();
    let (runs, freedom) = (shares.len(), kept.len());
    if freedom == 0 || runs <= freedom {
        return None;
    }
    let from_mean = |run: usize, at: usize| shares[run][kept[at]] - cells[kept[at]].mean;
    let rows = DMatrix::from_fn(runs, freedom, from_mean);
    let covariance = rows.transpose() * &rows / (runs as f64 - 1.0);
    let off = DVector::from_fn(freedom, |at, _| cells[kept[at]].mean - cells[kept[at]].expected);
    let solved = covariance.cholesky()?.solve(&off);
    let (n, p) = (runs as f64, freedom as f64);
    let f = n * off.dot(&solved) * (n - p) / (p * (n - 1.0));
    if !f.is_finite() {
        return None;
    }
    let probability = regularized((n - p) / (n - p + p * f), (n - p) / 2.0, p / 2.0);
    Some(Hotelling { runs, freedom, f, probability })
}
