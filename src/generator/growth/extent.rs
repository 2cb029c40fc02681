use crate::space::{FactorKind, Space};

/// The least box that contains the real values of some configurations; angles and rotations are not bounded by it.
#[derive(Clone, Debug, Default)]
pub(super) struct Extent {
    /// Per factor of the space the least and the largest value, where there is any; of no meaning but for reals.
    intervals: Vec<[f64; 2]>,
}

impl Extent {
    /// Takes a configuration in.
    pub fn cover(&mut self, space: &Space, q: &[f64]) {
        self.intervals.resize(space.factors().len(), [f64::INFINITY, f64::NEG_INFINITY]);
        for (factor, [low, high]) in space.factors().iter().zip(&mut self.intervals) {
            *low = low.min(q[factor.at]);
            *high = high.max(q[factor.at]);
        }
    }

    /// Takes what another one contains in.
    pub fn unite(&mut self, other: &Extent) {
        for ([low, high], [lower, higher]) in self.intervals.iter_mut().zip(&other.intervals) {
            *low = low.min(*lower);
            *high = high.max(*higher);
        }
    }

    /// Moves a configuration that was drawn from the whole space to the place that it has in the box, made longer at either end by
    /// `margin` in the metric, but not beyond the space. What is uniform in the space is then uniform in that box.
    pub fn shrink_into(&self, space: &Space, margin: f64, q: &mut [f64]) {
        for (factor, [low, high]) in space.factors().iter().zip(&self.intervals) {
            let FactorKind::Real { min, max } = factor.kind else { continue };
            let margin = if factor.weight > 0.0 { margin / factor.weight } else { f64::INFINITY };
            let (low, high) = ((low - margin).max(min), (high + margin).min(max));
            let share = (q[factor.at] - min) / (max - min);
            if share.is_finite() {
                q[factor.at] = (low + share * (high - low)).clamp(min, max);
            }
        }
    }
}
