use super::list;
use crate::cli::ProteinCompareArguments;
use crate::exit::{Code, Failure};
use crate::output::{self, Plain, line};
use roadmill::structure::comparison::{Comparison, compare as compare_chains};
use roadmill::structure::matching::{MatchedBy, Pair};
use roadmill::structure::{Chain, ChainSelection, read, select_chain};
use serde::Serialize;
use std::path::Path;

/// How two conformations differ.
#[derive(Serialize)]
struct Report {
    matched_by: &'static str,
    matched: usize,
    /// Share of matched residues with one amino acid, of the shorter chain.
    identity: f64,
    only_first: Vec<String>,
    only_second: Vec<String>,
    renamed: Vec<String>,
    atoms_that_differ: usize,
    atoms: Vec<String>,
    ca_rmsd: f64,
    motions: Vec<Motion>,
    torsions: Vec<Torsion>,
}

/// How far a residue's CA is from the other one after superposition, in Å.
#[derive(Serialize)]
struct Motion {
    residue: String,
    motion: f64,
}

/// A torsion in both, in degrees.
#[derive(Serialize)]
struct Torsion {
    residue: String,
    torsion: &'static str,
    first: f64,
    second: f64,
    turn: f64,
}

/// Says how two conformations differ.
pub fn compare(arguments: &ProteinCompareArguments) -> Result<Code, Failure> {
    let first = chain(arguments, &arguments.first, arguments.chain.as_deref())?;
    let name = arguments.chain_b.as_deref().or(arguments.chain.as_deref());
    let second = chain(arguments, &arguments.second, name)?;
    let both = format!("{} and {}", arguments.first.display(), arguments.second.display());
    let comparison = compare_chains(&first, &second)
        .map_err(|error| Failure::usage(format_args!("{both}: {error}")))?;
    let report = Report::of(&comparison, &first, &second, arguments.torsions);
    if arguments.json {
        output::json(&report);
    } else {
        report.print();
    }
    Ok(Code::Done)
}

/// The chain that is meant of a file's first model.
fn chain(
    arguments: &ProteinCompareArguments,
    file: &Path,
    chain: Option<&str>,
) -> Result<Chain, Failure> {
    let structure = read(file).map_err(Failure::usage)?;
    let selection = ChainSelection { chain, range: arguments.residues };
    select_chain(&structure.models[0], selection)
        .map_err(|error| Failure::usage(error.in_file(file)))
}

impl Report {
    fn of(comparison: &Comparison, first: &Chain, second: &Chain, torsions: usize) -> Report {
        let matching = &comparison.matching;
        let pairs = &matching.pairs;
        let of_pair = |pair: &Pair| first.residues[pair.first].to_string();
        let named = |chain: &Chain, places: &[usize]| {
            places.iter().map(|place| chain.residues[*place].to_string()).collect()
        };
        let atoms = |pair: &Pair| {
            let differing = pair.only_first.iter().map(|name| format!("-{name}"));
            let differing = differing.chain(pair.only_second.iter().map(|name| format!("+{name}")));
            let differing: Vec<String> = differing.collect();
            (!differing.is_empty()).then(|| format!("{}: {}", of_pair(pair), differing.join(" ")))
        };
        let renamed = pairs.iter().filter(|pair| pair.differs).map(|pair| {
            format!("{} and {}", first.residues[pair.first], second.residues[pair.second])
        });
        let motions = pairs.iter().zip(&comparison.motions).filter_map(|(pair, motion)| {
            Some(Motion { residue: of_pair(pair), motion: (*motion)? })
        });
        let turns = comparison.turns.iter().take(torsions).map(|turn| Torsion {
            residue: of_pair(&pairs[turn.pair]),
            torsion: turn.torsion,
            first: turn.first.to_degrees(),
            second: turn.second.to_degrees(),
            turn: turn.turn.to_degrees(),
        });
        Report {
            matched_by: match matching.by {
                MatchedBy::Number => "number",
                MatchedBy::Sequence => "sequence",
            },
            matched: pairs.len(),
            identity: matching.identity,
            only_first: named(first, &matching.only_first),
            only_second: named(second, &matching.only_second),
            renamed: renamed.collect(),
            atoms_that_differ: matching.atoms_that_differ(),
            atoms: pairs.iter().filter_map(atoms).collect(),
            ca_rmsd: comparison.superposition.rmsd,
            motions: motions.collect(),
            torsions: turns.collect(),
        }
    }

    fn print(&self) {
        line(format_args!(
            "{} residues matched by {}, identity {:.1} %",
            self.matched,
            self.matched_by,
            100.0 * self.identity
        ));
        let listed = |words: &[String]| list(words.iter().cloned());
        for (what, found) in [
            ("only in the first", &self.only_first),
            ("only in the second", &self.only_second),
            ("other amino acids", &self.renamed),
        ] {
            line(format_args!("{what}: {}", Plain(&listed(found))));
        }
        line(format_args!(
            "ends differ by {} heavy atoms (- only in the first, + only in the second): {}",
            self.atoms_that_differ,
            Plain(&listed(&self.atoms))
        ));
        line(format_args!("CA RMSD after superposition: {:.3} Å", self.ca_rmsd));
        line("motion of each residue's CA, Å:");
        for Motion { residue, motion } in &self.motions {
            line(format_args!("  {:<10} {motion:8.3}", Plain(residue)));
        }
        line("largest turns of phi and psi, degrees: first, second, turn");
        for Torsion { residue, torsion, first, second, turn } in &self.torsions {
            let residue = Plain(residue);
            line(format_args!("  {residue:<10} {torsion} {first:8.1} {second:8.1} {turn:8.1}"));
        }
    }
}
