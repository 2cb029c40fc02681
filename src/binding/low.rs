//! Statistics of the lowest of many numbers.

/// The minimum of numbers, and the means of the lowest of them.
///
/// H.-Y. Yeh (PhD thesis, Texas A&M University, 2016, chapter 6) ranks ligands by these three of their samples' energies,
/// and of the distances of their centres of mass from the protein's. The unit is that of the numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Low {
    /// The lowest number.
    pub minimum: f64,
    /// The mean of the lowest hundredth, rounded up to a whole number of samples.
    pub percent: f64,
    /// The mean of the lowest tenth, rounded up to a whole number of samples.
    pub tenth: f64,
    /// How many numbers were finite.
    pub count: usize,
}

impl Low {
    /// The statistics of the finite ones among the numbers, in whatever order they are; `None` if there are none. An
    /// infinite energy or one that is not a number belongs to no sample that could be a pose, so it is left out.
    pub fn of(numbers: &[f64]) -> Option<Low> {
        let mut rising: Vec<f64> = numbers.iter().copied().filter(|x| x.is_finite()).collect();
        rising.sort_unstable_by(f64::total_cmp);
        let count = rising.len();
        Some(Low {
            minimum: *rising.first()?,
            percent: mean(&rising[..count.div_ceil(100)]),
            tenth: mean(&rising[..count.div_ceil(10)]),
            count,
        })
    }
}

/// The mean of finite numbers in rising order: between the first and the last, however it is rounded.
fn mean(numbers: &[f64]) -> f64 {
    let count = numbers.len() as f64;
    // Divided first, so that no sum of large numbers overflows.
    let mean: f64 = numbers.iter().map(|x| x / count).sum();
    mean.clamp(numbers[0], numbers[numbers.len() - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_rounded_up_and_have_one_sample_at_least() {
        // 1 to 201 in another order: the lowest 3 and the lowest 21.
        let numbers: Vec<f64> = (0..201).map(|i| f64::from(i * 50 % 201 + 1)).collect();
        let low = Low::of(&numbers).unwrap();
        assert_eq!((low.minimum, low.count), (1.0, 201));
        assert!((low.percent - 2.0).abs() < 1e-14 && (low.tenth - 11.0).abs() < 1e-14, "{low:?}");
        let low = Low::of(&[3.0, -5.0]).unwrap();
        assert_eq!(low, Low { minimum: -5.0, percent: -5.0, tenth: -5.0, count: 2 });
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let numbers = [f64::NAN, 2.0, f64::INFINITY, -f64::NAN, f64::NEG_INFINITY, 1.0];
        let low = Low::of(&numbers).unwrap();
        assert_eq!(low, Low { minimum: 1.0, percent: 1.0, tenth: 1.0, count: 2 });
        assert_eq!(Low::of(&[f64::NAN]), None);
        assert_eq!(Low::of(&[]), None);
        let large = Low::of(&[f64::MAX; 30]).unwrap();
        assert!((large.tenth / f64::MAX - 1.0).abs() < 1e-15, "{large:?}");
    }
}
