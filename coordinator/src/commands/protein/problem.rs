use crate::cli::{ChainArguments, EndsArguments, ProteinProblemArguments};
use crate::commands::written::write_problem;
use crate::exit::{Code, Failure};
use crate::output::told;
use roadmill::model::protein::refit::Refit;
use roadmill::model::protein::{FileSpec, Gaps, ProteinSpec};
use roadmill::problem::{Relaxed, Transition, about_native, transition};
use roadmill::structure::ResidueNumber;
use std::path::Path;

/// Writes a protein's transition between two structures, or what is about one structure, as a problem file.
pub fn problem(arguments: &ProteinProblemArguments) -> Result<Code, Failure> {
    let ProteinProblemArguments { first, second, ends, out, force } = arguments;
    let comment = "# Written by `roadmill protein problem`.\n";
    match second {
        Some(second) => {
            let made = problem_of(first, second, ends, out)?;
            write_problem(&made.problem, comment, out, (*force, false))?;
            announce(&made, false);
        }
        None => {
            let problem = about_native(&name_of(out), Path::new(""), &spec_of(first, &ends.first));
            write_problem(&problem.map_err(Failure::usage)?, comment, out, (*force, false))?;
        }
    }
    Ok(Code::Done)
}

/// The problem of a transition, named after the file that it is to be written to.
pub(in crate::commands) fn problem_of(
    first: &Path,
    second: &Path,
    ends: &EndsArguments,
    out: &Path,
) -> Result<Transition, Failure> {
    let chain = ends.chain_b.as_ref().or(ends.first.chain.as_ref());
    let target = file_of(second, chain, &ends.first);
    let spec = spec_of(first, &ends.first).target(target.into());
    transition(&name_of(out), Path::new(""), &spec, ends.hold).map_err(Failure::usage)
}

/// The name of the problem that is written to a file.
pub(in crate::commands) fn name_of(out: &Path) -> String {
    out.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn file_of(path: &Path, chain: Option<&String>, what: &ChainArguments) -> FileSpec {
    let mut file = FileSpec::new(path);
    if let Some(chain) = chain {
        file = file.chain(chain);
    }
    match what.residues {
        Some((first, last)) => file.residues(range(first, last)),
        None => file,
    }
}

/// The protein of a file.
pub(in crate::commands) fn spec_of(first: &Path, what: &ChainArguments) -> ProteinSpec {
    let spec = ProteinSpec::new(file_of(first, what.chain.as_ref(), what).into())
        .obstacles(what.obstacles.iter().cloned());
    if what.gaps == crate::cli::Gaps::Rigid { spec.gaps(Gaps::Rigid) } else { spec }
}

/// Says how near the goal is to the target, and how far the ends were relaxed; with `is_json` on standard error, as standard output is
/// for objects alone.
pub(in crate::commands) fn announce(made: &Transition, is_json: bool) {
    say(&made.refit, is_json);
    for (end, relaxed) in ["start", "goal"].iter().zip(made.relaxed) {
        let Relaxed { moved, energy: [before, after] } = relaxed;
        let text = format!(
            "{end:<17}relaxed by {moved:.3} Å, from {before:.1} to {after:.1} model kJ/mol"
        );
        told(text, is_json);
    }
}

/// A range of residues as a problem file writes it.
fn range(first: ResidueNumber, last: ResidueNumber) -> String {
    format!("{first}-{last}")
}

/// How near the goal is to the target.
fn say(refit: &Refit, is_json: bool) {
    let lost = refit.lost_hydrogen_bonds.len();
    let lines = [
        format!(
            "refit            Cα RMSD {:.3} Å, N CA C O {:.3} Å from the target; {:.3} Å with its torsions copied",
            refit.ca_rmsd, refit.backbone_rmsd, refit.copied_rmsd
        ),
        format!(
            "                 {} of {} hydrogen bonds kept; their energy {:.1}, {:.1} in the target itself",
            refit.hydrogen_bonds - lost,
            refit.hydrogen_bonds,
            refit.energy[1],
            refit.energy[0]
        ),
        format!("                 {} new pairs that break a rule", refit.new_clashes.len()),
    ];
    lines.iter().for_each(|line| told(line, is_json));
}
