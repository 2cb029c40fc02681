use super::{Descent, complaint_of_iterations};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::scene::LENGTH_MAX;
use crate::seed::Stream;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Descent by the energy's gradient: the quasi-Newton method of Broyden, Fletcher, Goldfarb and Shanno (J. Nocedal, S. J. Wright,
/// *Numerical Optimization*, 2006, chapter 6), its steps bounded, each shortened until the energy has fallen by enough.
///
/// It works in the space's tangent vectors with the lengths of its metric, so that an angle and a length count as they do for
/// neighbours. A step leads along a geodesic; vectors at its two ends are compared as if the space were flat, which costs a
/// little speed and nothing of the result.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct Gradient {
    /// The longest step, in the metric of the space.
    pub longest: f64,
    /// A step by which the energy falls by less ends the descent, in the unit of the energy.
    pub least: f64,
    /// The most steps.
    pub iterations: u32,
}

impl Default for Gradient {
    fn default() -> Gradient {
        Gradient { longest: 0.5, least: 1e-3, iterations: 200 }
    }
}

/// By which share of what the slope promises the energy must fall (Armijo's condition).
const ENOUGH: f64 = 1e-4;
/// How often a step is halved before there is no way down.
const HALVINGS: u32 = 20;
/// The length of the first step, as a share of the longest.
const FIRST: f64 = 0.2;

/// Where the descent is, its gradient in the metric's lengths, and the energy.
struct Stand {
    q: Vec<f64>,
    gradient: Vec<f64>,
    energy: f64,
}

impl Descent for Gradient {
    fn descend(
        &self,
        cx: &Context,
        _stream: &mut Stream,
        q: &mut [f64],
        scratch: &mut Scratch,
    ) -> f64 {
        let weights = cx.space.tangent_weights();
        let size = weights.len();
        let mut now = Stand { q: q.to_vec(), gradient: vec![0.0; size], energy: 0.0 };
        let mut next = Stand { q: q.to_vec(), gradient: vec![0.0; size], energy: 0.0 };
        look(cx, &weights, &mut now, scratch);
        if !now.energy.is_finite() {
            return now.energy;
        }
        let mut inverse = Inverse::new(size);
        let (mut by, mut step) = (vec![0.0; size], vec![0.0; size]);
        for iteration in 0..self.iterations {
            let mut slope = inverse.direction(&now.gradient, &mut step);
            // What is no number leads nowhere.
            if slope >= 0.0 || slope.is_nan() {
                inverse = Inverse::new(size);
                slope = inverse.direction(&now.gradient, &mut step);
            }
            let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
            if !(slope < 0.0 && length.is_finite()) {
                break;
            }
            // The size of the first step says nothing, as nothing is known of the energy's curvature.
            let most = if iteration == 0 { FIRST * self.longest } else { self.longest };
            let mut share = if iteration == 0 || length > most { most / length } else { 1.0 };
            let mut is_lower = false;
            for _ in 0..HALVINGS {
                for (by, (step, weight)) in by.iter_mut().zip(step.iter().zip(&weights)) {
                    *by = share * step / weight;
                }
                cx.space.moved(&now.q, &by, &mut next.q);
                if cx.space.within_bounds(&next.q) {
                    look(cx, &weights, &mut next, scratch);
                    is_lower = next.energy <= now.energy + ENOUGH * share * slope;
                    if is_lower {
                        break;
                    }
                }
                share /= 2.0;
            }
            if !is_lower {
                // What was learned of the curvature may mislead, above all across a face of a grid: once more without it.
                if inverse.is_new() {
                    break;
                }
                inverse = Inverse::new(size);
                continue;
            }
            let fall = now.energy - next.energy;
            step.iter_mut().for_each(|x| *x *= share);
            inverse.learn(&step, &now.gradient, &next.gradient);
            std::mem::swap(&mut now, &mut next);
            if fall < self.least {
                break;
            }
        }
        q.copy_from_slice(&now.q);
        now.energy
    }

    fn complaint(&self) -> Option<Complaint> {
        if let Some(complaint) = Complaint::of_length("longest", self.longest, LENGTH_MAX) {
            return Some(complaint);
        }
        if !(self.least.is_finite() && self.least >= 0.0) {
            return Some(Complaint::new("least", self.least, "an energy of at least 0"));
        }
        complaint_of_iterations(self.iterations)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        match cx.model.has_gradient() {
            true => Ok(()),
            false => Err(
                "a descent by the gradient found, a model whose energy has derivatives expected"
                    .to_owned(),
            ),
        }
    }
}

/// Finds energy and gradient of where it stands, the gradient by the metric's lengths.
fn look(cx: &Context, weights: &[f64], stand: &mut Stand, scratch: &mut Scratch) {
    let energy = cx.model.gradient(&stand.q, &mut stand.gradient, scratch);
    stand.energy = energy.unwrap_or(f64::INFINITY);
    for (by, weight) in stand.gradient.iter_mut().zip(weights) {
        *by /= weight;
    }
}

/// What is known of the inverse of the energy's second derivatives: a symmetric matrix, row by row.
struct Inverse {
    size: usize,
    rows: Vec<f64>,
    is_new: bool,
    work: Vec<f64>,
}

impl Inverse {
    /// Nothing is known: the identity.
    fn new(size: usize) -> Inverse {
        let mut rows = vec![0.0; size * size];
        (0..size).for_each(|at| rows[at * size + at] = 1.0);
        Inverse { size, rows, is_new: true, work: vec![0.0; size] }
    }

    fn is_new(&self) -> bool {
        self.is_new
    }

    /// Writes the direction downhill to `out`; returns the slope along it.
    fn direction(&self, gradient: &[f64], out: &mut [f64]) -> f64 {
        let mut slope = 0.0;
        for (row, (out, by)) in self.rows.chunks_exact(self.size).zip(out.iter_mut().zip(gradient))
        {
            *out = -dot(row, gradient);
            slope += *out * by;
        }
        slope
    }

    /// Takes in a step and how the gradient changed along it.
    fn learn(&mut self, step: &[f64], before: &[f64], after: &[f64]) {
        let Inverse { size, rows, is_new, work } = self;
        let change: Vec<f64> =
            after.iter().zip(before).map(|(after, before)| after - before).collect();
        let curvature = dot(step, &change);
        let square = dot(&change, &change);
        // Only where the energy is convex along the step the matrix stays positive definite.
        let is_convex = curvature > 1e-12 * square.sqrt() * dot(step, step).sqrt();
        if !is_convex {
            return;
        }
        if *is_new {
            // The scale of the identity is that of the curvature seen first (Nocedal and Wright, eq. 6.20).
            rows.iter_mut().for_each(|value| *value *= curvature / square);
            *is_new = false;
        }
        for (row, out) in rows.chunks_exact(*size).zip(work.iter_mut()) {
            *out = dot(row, &change);
        }
        let scale = (1.0 + dot(&change, work) / curvature) / curvature;
        for (i, row) in rows.chunks_exact_mut(*size).enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value +=
                    scale * step[i] * step[j] - (work[i] * step[j] + step[i] * work[j]) / curvature;
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
