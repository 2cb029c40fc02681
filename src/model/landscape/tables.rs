//! The table of a problem file that describes a landscape.

use super::{Energy, Landscape, Term};
use crate::source::Step::Key;
use crate::source::{ProblemError, Source};
use serde::Deserialize;

/// Peaks are found to this unless the file says otherwise.
const DEFAULT_TOLERANCE: f64 = 0.01;

#[derive(Deserialize)]
struct Tables {
    landscape: LandscapeTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LandscapeTable {
    min: [f64; 2],
    max: [f64; 2],
    energy: EnergyTable,
    highest: Option<f64>,
    tolerance: Option<f64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum EnergyTable {
    MullerBrown {},
    Terms(Vec<Term>),
}

/// Reads and checks the table.
pub(super) fn read(source: &Source) -> Result<Landscape, ProblemError> {
    let Tables { landscape: table } = source.tables()?;
    let energy = match table.energy {
        EnergyTable::MullerBrown {} => Energy::MullerBrown,
        EnergyTable::Terms(terms) => Energy::Terms(terms),
    };
    let LandscapeTable { min, max, highest, tolerance, .. } = table;
    let tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
    let landscape = Landscape { min, max, energy, highest, tolerance };
    match landscape.complaint() {
        None => Ok(landscape),
        Some((key, message)) => Err(source.error(&[Key("landscape"), Key(key)], message)),
    }
}
