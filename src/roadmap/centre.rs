//! Centres of connected components as sums that can be merged.
//!
//! TR05-007 §3.2 calls a component's centre of mass *"simply the average of all nodes in the
//! component"*. Real values are averaged by their sum, angles by Σ(cos, sin), rotations by the
//! principal eigenvector of Σ q qᵀ (Markley et al., *Averaging quaternions*, 2007).

use crate::math;
use crate::space::{FactorKind, Space, canonical};
use nalgebra::Matrix4;

/// A mean angle or rotation is defined only where the directions do not cancel out: where the mean vector, or the gap
/// between the two largest eigenvalues, is larger than this.
const DEGENERATE: f64 = 1e-9;

/// The additive state of one component's centre.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CentreSum {
    count: u64,
    /// Per real value one sum, per angle Σcos and Σsin, per rotation the ten entries of Σ q qᵀ.
    sums: Vec<f64>,
}

impl CentreSum {
    pub(super) fn of(space: &Space, q: &[f64]) -> CentreSum {
        let mut sums = Vec::new();
        for part in space.factors() {
            match part.kind {
                FactorKind::Real { .. } => sums.push(q[part.at]),
                FactorKind::Angle => sums.extend([math::cos(q[part.at]), math::sin(q[part.at])]),
                FactorKind::Rotation => {
                    for i in 0..4 {
                        for j in i..4 {
                            sums.push(q[part.at + i] * q[part.at + j]);
                        }
                    }
                }
            }
        }
        CentreSum { count: 1, sums }
    }

    pub(super) fn add(&mut self, other: &CentreSum) {
        self.count += other.count;
        for (sum, more) in self.sums.iter_mut().zip(&other.sums) {
            *sum += more;
        }
    }

    /// The centre; where a part has no mean direction, that part of `fallback`.
    pub(super) fn centre(&self, space: &Space, fallback: &[f64]) -> Vec<f64> {
        let mut centre = fallback.to_vec();
        let count = self.count as f64;
        let mut at = 0;
        for part in space.factors() {
            match part.kind {
                FactorKind::Real { .. } => {
                    centre[part.at] = self.sums[at] / count;
                    at += 1;
                }
                FactorKind::Angle => {
                    let (cosine, sine) = (self.sums[at], self.sums[at + 1]);
                    if (cosine * cosine + sine * sine).sqrt() > DEGENERATE * count {
                        centre[part.at] = math::wrap_angle(math::atan2(sine, cosine));
                    }
                    at += 2;
                }
                FactorKind::Rotation => {
                    if let Some(mean) = principal(&self.sums[at..at + 10], count) {
                        centre[part.at..part.at + 4].copy_from_slice(&mean);
                    }
                    at += 10;
                }
            }
        }
        centre
    }
}

/// The principal eigenvector of a mean of q qᵀ, given the upper triangle of the sum; `None` where it is not unique.
fn principal(upper: &[f64], count: f64) -> Option<[f64; 4]> {
    let mut matrix = Matrix4::zeros();
    let mut entries = upper.iter();
    for i in 0..4 {
        for j in i..4 {
            let entry = entries.next()? / count;
            matrix[(i, j)] = entry;
            matrix[(j, i)] = entry;
        }
    }
    let eigen = matrix.symmetric_eigen();
    let mut order = [0, 1, 2, 3];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]).then(a.cmp(b)));
    let [first, second, ..] = order;
    if eigen.eigenvalues[first] - eigen.eigenvalues[second] <= DEGENERATE {
        return None;
    }
    let vector = eigen.eigenvectors.column(first);
    canonical([vector[0], vector[1], vector[2], vector[3]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::Ordinal;
    use crate::seed::{Purpose, Seed};
    use crate::space::{BaseJoint, rigid_space};

    #[test]
    fn the_centre_of_one_configuration_is_itself_and_of_two_their_middle() {
        let mut stream = Seed::of_set(1, "centre", Ordinal(0)).stream(Purpose::Sampling);
        for motion in [BaseJoint::Translation3d, BaseJoint::Rigid2d, BaseJoint::Rigid3d] {
            let space = rigid_space(motion, [-1.0; 3], [1.0; 3], 0.5);
            let (mut a, mut b) = (vec![0.0; space.len()], vec![0.0; space.len()]);
            let mut middle = a.clone();
            for _ in 0..100 {
                space.sample_uniform(&mut stream, &mut a);
                space.sample_uniform(&mut stream, &mut b);
                let mut sum = CentreSum::of(&space, &a);
                assert!(space.distance(&sum.centre(&space, &b), &a) < 1e-6);
                sum.add(&CentreSum::of(&space, &b));
                space.interpolate(&a, &b, 0.5, &mut middle);
                assert!(space.distance(&sum.centre(&space, &a), &middle) < 1e-6);
            }
        }
    }

    #[test]
    fn directions_without_a_mean_fall_back() {
        let space = rigid_space(BaseJoint::Rigid2d, [-1.0; 3], [1.0; 3], 1.0);
        let mut sum = CentreSum::of(&space, &[0.0, 0.0, 1.0]);
        sum.add(&CentreSum::of(&space, &[1.0, 0.0, 1.0 - std::f64::consts::PI]));
        assert_eq!(sum.centre(&space, &[9.0, 9.0, 0.25]), [0.5, 0.0, 0.25]);

        let space = rigid_space(BaseJoint::Rigid3d, [-1.0; 3], [1.0; 3], 1.0);
        let axis = |i: usize| {
            let mut q = vec![0.0; 7];
            q[3 + i] = 1.0;
            q
        };
        let mut sum = CentreSum::of(&space, &axis(0));
        sum.add(&CentreSum::of(&space, &axis(1)));
        assert_eq!(sum.centre(&space, &axis(3)), axis(3));
    }
}
