//! Nonlinear least squares by Levenberg's and Marquardt's method (Marquardt 1963), with the damping of Nielsen (1999):
//! a step solves (JᵀJ + λ diag JᵀJ) δ = −Jᵀr. How much the sum of squares falls, compared with what the linear model
//! foretold, says whether the step is taken and how λ changes.

use crate::model::protein::equations::NormalEquations;

/// A sum of squares.
pub trait SumOfSquares {
    /// What is varied.
    type State;

    /// Half the sum of squares.
    fn cost(&self, state: &Self::State) -> f64;

    /// JᵀJ and Jᵀr at the state.
    fn normal_equations(&self, state: &Self::State) -> NormalEquations;

    /// The state after a step.
    fn after(&self, state: &Self::State, step: &[f64]) -> Self::State;
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// After so many steps, taken or not.
    pub steps: usize,
    /// When a step that is taken lowers the sum of squares by less than this share of it.
    pub decrease: f64,
}

/// Where the minimization ended.
#[derive(Clone, Debug)]
pub struct Minimum<S> {
    /// The state.
    pub state: S,
    /// Half the sum of squares there.
    pub cost: f64,
    /// The steps tried.
    pub steps: usize,
}

/// λ at the start, as a share of the diagonal.
const FIRST_DAMPING: f64 = 1e-3;

/// The largest λ: beyond it no step leads down.
const LARGEST_DAMPING: f64 = 1e12;

/// Half a sum of squares below which nothing is gained.
const ZERO: f64 = 1e-24;

/// Minimizes a sum of squares from a state on. The cost never rises.
pub fn minimize<P: SumOfSquares>(problem: &P, state: P::State, stop: Stop) -> Minimum<P::State> {
    let mut best = Minimum { cost: problem.cost(&state), state, steps: 0 };
    let (mut damping, mut growth) = (FIRST_DAMPING, 2.0);
    let mut equations = problem.normal_equations(&best.state);
    while best.steps < stop.steps && best.cost > ZERO && damping <= LARGEST_DAMPING {
        best.steps += 1;
        let mut damped = equations.matrix.clone();
        let size = equations.gradient.len();
        let damp: Vec<f64> = (0..size).map(|k| damping * damped.diagonal(k).max(1e-9)).collect();
        for (k, damp) in damp.iter().enumerate() {
            damped.row_mut(k)[0] += damp;
        }
        let downhill: Vec<f64> = equations.gradient.iter().map(|slope| -slope).collect();
        if let Some(step) = damped.solve(&downhill) {
            // The linear model's decrease is ½ δᵀ(λDδ − Jᵀr).
            let foretold: f64 = (0..size)
                .map(|k| 0.5 * step[k] * (damp[k] * step[k] - equations.gradient[k]))
                .sum();
            let next = problem.after(&best.state, &step);
            let cost = problem.cost(&next);
            let decrease = best.cost - cost;
            if decrease > 0.0 && foretold > 0.0 {
                let share = 2.0 * (decrease / foretold) - 1.0;
                damping *= (1.0 - share * share * share).max(1.0 / 3.0);
                growth = 2.0;
                let is_enough = decrease < stop.decrease * best.cost;
                (best.state, best.cost) = (next, cost);
                if is_enough {
                    break;
                }
                equations = problem.normal_equations(&best.state);
                continue;
            }
        }
        damping *= growth;
        growth *= 2.0;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley: residuals 10 (y − x²) and 1 − x, zero at (1, 1).
    struct Valley;

    impl SumOfSquares for Valley {
        type State = [f64; 2];

        fn cost(&self, [x, y]: &[f64; 2]) -> f64 {
            let (a, b) = (10.0 * (y - x * x), 1.0 - x);
            0.5 * (a * a + b * b)
        }

        fn normal_equations(&self, [x, y]: &[f64; 2]) -> NormalEquations {
            let mut equations = NormalEquations::zeros(2);
            equations.add(0, &[-20.0 * x, 10.0], 10.0 * (y - x * x));
            equations.add(0, &[-1.0], 1.0 - x);
            equations
        }

        fn after(&self, state: &[f64; 2], step: &[f64]) -> [f64; 2] {
            [state[0] + step[0], state[1] + step[1]]
        }
    }

    #[test]
    fn rosenbrocks_valley_is_followed_to_its_end() {
        let stop = Stop { steps: 200, decrease: 0.0 };
        let minimum = minimize(&Valley, [-1.2, 1.0], stop);
        assert!((minimum.state[0] - 1.0).abs() < 1e-9 && (minimum.state[1] - 1.0).abs() < 1e-9);
        assert!(minimum.steps < 60, "{}", minimum.steps);
    }

    #[test]
    fn steps_are_bounded_and_never_lead_up() {
        let minimum = minimize(&Valley, [-1.2, 1.0], Stop { steps: 5, decrease: 0.0 });
        assert_eq!(minimum.steps, 5);
        assert!(minimum.cost < Valley.cost(&[-1.2, 1.0]));
    }
}
