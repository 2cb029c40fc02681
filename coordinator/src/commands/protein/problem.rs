use crate::cli::ProteinProblemArguments;
use crate::commands::written::write_problem;
use crate::exit::{Code, Failure};
use crate::output::line;
use roadmill::model::protein::refit::Refit;
use roadmill::model::protein::{FileSpec, Gaps, ProteinSpec};
use roadmill::problem::{Relaxed, Transition, about_native, transition};
use roadmill::structure::ResidueNumber;
use std::path::Path;

/// Writes a protein's transition between two structures, or what is about one structure, as a problem file.
pub fn problem(arguments: &ProteinProblemArguments) -> Result<Code, Failure> {
    let file = |path: &Path, chain: &Option<String>| {
        let mut file = FileSpec::new(path);
        if let Some(chain) = chain {
            file = file.chain(chain);
        }
        match arguments.residues {
            Some((first, last)) => file.residues(range(first, last)),
            None => file,
        }
    };
    let second_chain = arguments.chain_b.as_ref().or(arguments.chain.as_ref()).cloned();
    let mut spec = ProteinSpec::new(file(&arguments.first, &arguments.chain).into())
        .obstacles(arguments.obstacles.iter().cloned());
    if arguments.gaps == crate::cli::Gaps::Rigid {
        spec = spec.gaps(Gaps::Rigid);
    }
    let name = arguments.out.file_stem().unwrap_or_default().to_string_lossy();
    let comment = "# Written by `roadmill protein problem`.\n";
    let problem = match &arguments.second {
        Some(second) => {
            let spec = spec.target(file(second, &second_chain).into());
            let made =
                transition(&name, Path::new(""), &spec, arguments.hold).map_err(Failure::usage)?;
            let Transition { problem, refit, relaxed } = made;
            write_problem(&problem, comment, &arguments.out, arguments.force)?;
            say(&refit);
            for (end, relaxed) in ["start", "goal"].iter().zip(relaxed) {
                let Relaxed { moved, energy: [before, after] } = relaxed;
                line(format_args!(
                    "{end:<17}relaxed by {moved:.3} Å, from {before:.1} to {after:.1} model kJ/mol"
                ));
            }
            return Ok(Code::Done);
        }
        None => about_native(&name, Path::new(""), &spec).map_err(Failure::usage)?,
    };
    write_problem(&problem, comment, &arguments.out, arguments.force)?;
    Ok(Code::Done)
}

/// A range of residues as a problem file writes it.
fn range(first: ResidueNumber, last: ResidueNumber) -> String {
    format!("{first}-{last}")
}

/// How near the goal is to the target.
fn say(refit: &Refit) {
    line(format_args!(
        "refit            Cα RMSD {:.3} Å, N CA C O {:.3} Å from the target; {:.3} Å with its torsions copied",
        refit.ca_rmsd, refit.backbone_rmsd, refit.copied_rmsd
    ));
    let lost = refit.lost_hydrogen_bonds.len();
    line(format_args!(
        "                 {} of {} hydrogen bonds kept; their energy {:.1}, {:.1} in the target itself",
        refit.hydrogen_bonds - lost,
        refit.hydrogen_bonds,
        refit.energy[1],
        refit.energy[0]
    ));
    line(format_args!("                 {} new pairs that break a rule", refit.new_clashes.len()));
}
