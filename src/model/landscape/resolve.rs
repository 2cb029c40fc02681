//! From what a problem asks for to a checked landscape.

use super::{Landscape, LandscapeSpec, Term};
use crate::scene::LENGTH_MAX;
use crate::source::Step::Key;
use crate::source::{ProblemError, Source};

/// Peaks are found to this unless the file says otherwise.
const DEFAULT_TOLERANCE: f64 = 0.01;
/// The finest tolerance, as a fraction of the terms' heights together: rounding is a thousand times smaller.
const FINEST: f64 = 1e-9;
/// The most terms.
const TERMS_MAX: usize = 10_000;
/// The largest size of a height.
const HEIGHT_MAX: f64 = 1e9;
/// The largest size of an exponent within the bounds: with it every energy is a finite number.
const EXPONENT_MAX: f64 = 500.0;

/// Checks a landscape and makes what is asked for.
pub(super) fn resolve(spec: &LandscapeSpec, source: &Source) -> Result<Landscape, ProblemError> {
    let fail =
        |key: &str, message: String| Err(source.error(&[Key("landscape"), Key(key)], message));
    for (key, corner) in [("min", &spec.min), ("max", &spec.max)] {
        // Written so that NaN fails it.
        if !corner.iter().all(|value| value.abs() <= LENGTH_MAX) {
            return fail(key, format!("{corner:?} found; finite lengths expected"));
        }
    }
    for axis in 0..2 {
        let (low, high) = (spec.min[axis], spec.max[axis]);
        if low >= high {
            let name = ["x", "y"][axis];
            return fail(
                "max",
                format!("in {name} max = {high} found; more than min = {low} expected"),
            );
        }
    }
    let terms = spec.energy.terms();
    if !(1..=TERMS_MAX).contains(&terms.len()) {
        return fail("energy", format!("{} terms found; 1 to {TERMS_MAX} expected", terms.len()));
    }
    for (index, term) in terms.iter().enumerate() {
        if let Some(message) = complaint(term, spec.min, spec.max) {
            return fail("energy", format!("terms[{index}]: {message}"));
        }
    }
    if let Some(highest) = spec.highest.filter(|highest| !highest.is_finite()) {
        return fail("highest", format!("{highest} found; a finite energy expected"));
    }
    let finest = FINEST * terms.iter().map(|term| term.height.abs()).sum::<f64>();
    let tolerance = spec.tolerance.unwrap_or(DEFAULT_TOLERANCE);
    if !(tolerance.is_finite() && tolerance > 0.0 && tolerance >= finest) {
        return fail(
            "tolerance",
            format!("{tolerance} found; a positive energy of at least {finest:e} expected"),
        );
    }
    let LandscapeSpec { min, max, energy, highest, .. } = spec.clone();
    Ok(Landscape { min, max, energy, highest, tolerance })
}

/// What is wrong with a term within these bounds.
fn complaint(term: &Term, min: [f64; 2], max: [f64; 2]) -> Option<String> {
    let Term { height, centre, xx, xy, yy } = *term;
    if !(height.abs() <= HEIGHT_MAX && centre.iter().all(|value| value.abs() <= LENGTH_MAX)) {
        return Some(format!(
            "height {height} at {centre:?} found; a size of at most {HEIGHT_MAX:e} at a finite place expected"
        ));
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
