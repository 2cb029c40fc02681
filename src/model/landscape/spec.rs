use super::{Energy, Term};
use crate::source::{ProblemError, Source};
use serde::Deserialize;

/// A point in an energy over the plane, as a problem asks for it: the table `[landscape]` of a problem file, which
/// `docs/problems.md` describes. Nothing is checked before the problem is built.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LandscapeSpec {
    pub(super) min: [f64; 2],
    pub(super) max: [f64; 2],
    #[serde(deserialize_with = "energy")]
    pub(super) energy: Energy,
    pub(super) highest: Option<f64>,
    pub(super) tolerance: Option<f64>,
}

impl LandscapeSpec {
    /// An energy within a rectangle, whose corners `min` and `max` are points `x y`.
    pub fn new(min: [f64; 2], max: [f64; 2], energy: Energy) -> LandscapeSpec {
        LandscapeSpec { min, max, energy, highest: None, tolerance: None }
    }

    /// The highest energy that is valid. If nothing is said, every energy is.
    pub fn highest(self, energy: f64) -> LandscapeSpec {
        LandscapeSpec { highest: Some(energy), ..self }
    }

    /// How far above the highest energy on a motion the peak may be that is found for it, an energy; 0.01 if nothing
    /// is said.
    pub fn tolerance(self, energy: f64) -> LandscapeSpec {
        LandscapeSpec { tolerance: Some(energy), ..self }
    }
}

#[derive(Deserialize)]
struct Tables {
    landscape: LandscapeSpec,
}

/// An energy as a problem file writes it.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum EnergyTable {
    MullerBrown {},
    Terms(Vec<Term>),
}

fn energy<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Energy, D::Error> {
    EnergyTable::deserialize(deserializer).map(|table| match table {
        EnergyTable::MullerBrown {} => Energy::MullerBrown,
        EnergyTable::Terms(terms) => Energy::Terms(terms),
    })
}

/// Reads the table.
pub(super) fn read(source: &Source) -> Result<LandscapeSpec, ProblemError> {
    source.tables().map(|tables: Tables| tables.landscape)
}
