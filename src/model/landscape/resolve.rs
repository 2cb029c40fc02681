//! From what a problem asks for to a checked landscape.

use super::{Landscape, LandscapeSpec};
use crate::source::Step::Key;
use crate::source::{ProblemError, Source};

/// Peaks are found to this unless the file says otherwise.
const DEFAULT_TOLERANCE: f64 = 0.01;

/// Checks a landscape and makes what is asked for.
pub(super) fn resolve(spec: &LandscapeSpec, source: &Source) -> Result<Landscape, ProblemError> {
    let LandscapeSpec { min, max, energy, highest, tolerance } = spec.clone();
    let tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
    let landscape = Landscape { min, max, energy, highest, tolerance };
    match landscape.complaint() {
        None => Ok(landscape),
        Some((key, message)) => Err(source.error(&[Key("landscape"), Key(key)], message)),
    }
}
