use super::write_whole;
use crate::cli::{ExportArguments, Format};
use crate::exit::{Code, Failure};
use crate::run::Ledger;

/// Writes a roadmap in a format that other programs read.
pub fn export(arguments: &ExportArguments) -> Result<Code, Failure> {
    let ledger = Ledger::read(&arguments.run)?;
    let contents = match arguments.format {
        Format::Svg => {
            roadmill::export::svg(&ledger.problem, &ledger.roadmap, ledger.path.as_ref())
        }
    };
    write_whole(&arguments.out, &contents)?;
    Ok(Code::Done)
}
