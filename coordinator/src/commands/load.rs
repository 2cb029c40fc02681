use crate::cli::{Bounds, Dh, Origin, ProblemArguments, Solid, Unit, Up};
use crate::exit::Failure;
use crate::run::Ledgers;
use crate::waiting::waiting;
use roadmill::model::bodies::foreign::{self, SceneOptions, Solidity};
use roadmill::model::bodies::validity::BoundsMeaning;
use roadmill::problem::Problem;
use roadmill::scene::{self, Centre};
use std::path::Path;

/// Reads the problem that the command line names.
///
/// # Errors
/// Exit code 2: it cannot be used.
pub(super) fn load(arguments: &ProblemArguments) -> Result<Problem, Failure> {
    let options = SceneOptions {
        robot: arguments.robot.as_deref(),
        query: arguments.query.as_deref(),
        solid: arguments.solid.map(|solid| match solid {
            Solid::Auto => Solidity::Auto,
            Solid::Yes => Solidity::Yes,
            Solid::No => Solidity::No,
        }),
        bounds: arguments.bounds.map(|bounds| match bounds {
            Bounds::Body => BoundsMeaning::Body,
            Bounds::Reference => BoundsMeaning::Reference,
        }),
        origin: arguments.origin.map(|origin| match origin {
            Origin::Mean => Centre::VertexMean,
            Origin::Stored => Centre::AsStored,
        }),
        up: arguments.up.map(|up| match up {
            Up::Y => scene::Up::Y,
            Up::Stored => scene::Up::AsStored,
        }),
        unit: arguments.unit.map(|unit| match unit {
            Unit::Metres => foreign::Unit::Metres,
            Unit::Stored => foreign::Unit::AsStored,
        }),
        weld: arguments.weld,
        dh: arguments.dh.map(|dh| match dh {
            Dh::Standard => foreign::DhOrder::Standard,
            Dh::Modified => foreign::DhOrder::Modified,
        }),
        srdf: arguments.srdf.as_deref(),
        group: arguments.group.as_deref(),
    };
    let load = || Problem::load_with(&arguments.file, &options, &Ledgers);
    let problem = waiting("reading the problem", load).map_err(Failure::usage)?;
    problem.with_hints(&arguments.hint).map_err(Failure::usage)
}

/// Reads a problem file of our own.
///
/// # Errors
/// Exit code 2: it cannot be used.
pub(super) fn load_file(file: &Path) -> Result<Problem, Failure> {
    Problem::load_with(file, &SceneOptions::default(), &Ledgers).map_err(Failure::usage)
}
