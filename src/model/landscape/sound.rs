//! What makes the numbers of a landscape sound, whether they come from a problem file or from bytes.

use super::{Landscape, Term};
use crate::scene::LENGTH_MAX;

/// The finest tolerance, as a fraction of the terms' heights together: rounding is a thousand times smaller.
const FINEST: f64 = 1e-9;
/// The most terms.
const TERMS_MAX: usize = 10_000;
/// The largest size of a height.
const HEIGHT_MAX: f64 = 1e9;
/// The largest size of an exponent within the bounds: with it every energy is a finite number.
const EXPONENT_MAX: f64 = 500.0;

impl Landscape {
    /// What is wrong with the landscape, if anything: the key of the table by which a problem file says it, what was
    /// found and what is expected.
    pub(super) fn complaint(&self) -> Option<(&'static str, String)> {
        let Landscape { min, max, energy, highest, tolerance } = self;
        for (key, corner) in [("min", min), ("max", max)] {
            // Written so that NaN fails it.
            if !corner.iter().all(|value| value.abs() <= LENGTH_MAX) {
                return Some((
                    key,
                    format!("{corner:?} found; lengths within ±{LENGTH_MAX:e} expected"),
                ));
            }
        }
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let (low, high) = (min[axis], max[axis]);
            if low >= high {
                let message =
                    format!("in {name} max = {high} found; more than min = {low} expected");
                return Some(("max", message));
            }
        }
        let terms = energy.terms();
        if !(1..=TERMS_MAX).contains(&terms.len()) {
            let message = format!("{} terms found; 1 to {TERMS_MAX} expected", terms.len());
            return Some(("energy", message));
        }
        for (index, term) in terms.iter().enumerate() {
            if let Some(message) = complaint_of(term, *min, *max) {
                return Some(("energy", format!("terms[{index}]: {message}")));
            }
        }
        if let Some(highest) = highest.filter(|highest| !highest.is_finite()) {
            return Some(("highest", format!("{highest} found; a finite energy expected")));
        }
        let finest = FINEST * terms.iter().map(|term| term.height.abs()).sum::<f64>();
        if !(tolerance.is_finite() && *tolerance > 0.0 && *tolerance >= finest) {
            let expected = format!("a positive energy of at least {finest:e} expected");
            return Some(("tolerance", format!("{tolerance} found; {expected}")));
        }
        None
    }
}

/// What is wrong with a term within these bounds.
fn complaint_of(term: &Term, min: [f64; 2], max: [f64; 2]) -> Option<String> {
    let Term { height, centre, xx, xy, yy } = *term;
    if height.is_nan() || height.abs() > HEIGHT_MAX {
        return Some(format!("height {height} found; one within ±{HEIGHT_MAX:e} expected"));
    }
    // Written so that NaN fails it.
    if !centre.iter().all(|value| value.abs() <= LENGTH_MAX) {
        return Some(format!("centre {centre:?} found; lengths within ±{LENGTH_MAX:e} expected"));
    }
    let [u, v] = [0, 1]
        .map(|axis: usize| (min[axis] - centre[axis]).abs().max((max[axis] - centre[axis]).abs()));
    let size = xx.abs() * u * u + xy.abs() * u * v + yy.abs() * v * v;
    let fits = size <= EXPONENT_MAX;
    (!fits).then(|| {
        format!(
            "exponents of up to {size:e} within the bounds found; at most {EXPONENT_MAX} expected"
        )
    })
}
