use super::write_whole;
use crate::cli::{ExportArguments, Format};
use crate::exit::{Code, Failure};
use crate::run::Ledger;
use roadmill::export::{edges_csv, graphml, nodes_csv, npz, parasol_map, svg};

/// Writes a roadmap in a format that other programs read.
pub fn export(arguments: &ExportArguments) -> Result<Code, Failure> {
    let Ledger { problem, roadmap, path, .. } = Ledger::read(&arguments.run)?;
    let out = &arguments.out;
    match arguments.format {
        Format::Graphml => write_whole(out, graphml(&problem, &roadmap))?,
        Format::Csv => {
            write_whole(out, nodes_csv(&problem.space(), &roadmap))?;
            write_whole(&out.with_extension("edges.csv"), edges_csv(&roadmap))?;
        }
        Format::Npz => write_whole(out, npz(&problem, &roadmap).map_err(Failure::system)?)?,
        Format::Map => write_whole(out, parasol_map(&problem, &problem.context(), &roadmap))?,
        Format::Svg => match svg(&problem, &roadmap, path.as_ref()) {
            Some(picture) => write_whole(out, picture)?,
            None => return Err(Failure::usage("--format: this model cannot be drawn")),
        },
    }
    Ok(Code::Done)
}
