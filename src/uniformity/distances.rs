use crate::space::{Configs, Space};
use rayon::prelude::*;

/// How far the nearest other configuration of each is in the space's metric, in their order; none of fewer than two.
pub fn nearest_distances(space: &Space, configs: &Configs) -> Vec<f64> {
    if configs.len() < 2 {
        return Vec::new();
    }
    let nearest = |index: usize| {
        let own = configs.get(index);
        let others = (0..configs.len()).filter(|other| *other != index);
        others.fold(f64::INFINITY, |least, other| {
            let distance = space.distance_unless_above(own, configs.get(other), least);
            distance.map_or(least, |distance| least.min(distance))
        })
    };
    (0..configs.len()).into_par_iter().map(nearest).collect()
}

/// The mean of numbers and their standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The standard deviation, by n − 1; 0 of a single number.
    pub deviation: f64,
}

impl Spread {
    /// Of some numbers; `None` if there are none.
    pub fn of(numbers: &[f64]) -> Option<Spread> {
        let count = numbers.len() as f64;
        if numbers.is_empty() {
            return None;
        }
        let mean = numbers.iter().sum::<f64>() / count;
        let square = numbers.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>();
        Some(Spread { mean, deviation: (square / (count - 1.0).max(1.0)).sqrt() })
    }
}
