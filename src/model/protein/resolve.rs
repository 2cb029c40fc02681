//! From what a problem asks for to a checked protein.

use super::motion::EnergySteps;
use super::{ChainSpec, FileSpec, Gaps, ObstacleSpec, Protein, ProteinSpec, Target};
use crate::source::Step::Key;
use crate::source::{ProblemError, Source};
use crate::structure::matching::match_chains;
use crate::structure::{
    Alternative, Chain, ChainSelection, Residue, StructureError, StructureModel, backbone,
    find_chain, parse_range, peptides, read, select_chain, select_model,
};
use std::collections::BTreeMap;

/// No torsion turns by more than this between two energies along a motion unless the file says otherwise, radians: one degree.
const DEFAULT_TURN: f64 = std::f64::consts::PI / 180.0;

/// Checks a protein and makes what is asked for.
pub(super) fn resolve(
    spec: &ProteinSpec,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Protein, ProblemError> {
    let place = |key| [Key("protein"), Key(key)];
    let fail = |key, error: &StructureError| source.error(&place(key), error.to_string());

    let whole = WholeChain { source, gaps: spec.gaps };
    let (chain, file) = whole.of(&spec.source, "source", notes)?;
    let target = match &spec.target {
        None => None,
        Some(target) => {
            let (other, _) = whole.of(target, "target", notes)?;
            let matching = match_chains(&chain, &other).map_err(|error| fail("target", &error))?;
            let differ = matching.atoms_that_differ();
            if differ > 0 {
                let atoms = count_of(differ, "heavy atom");
                notes.push(format!(
                    "the ends differ by {atoms}, which play no part but in exports and centroids"
                ));
            }
            if matching.pairs.iter().any(|pair| pair.differs) {
                let count = matching.pairs.iter().filter(|pair| pair.differs).count();
                let amino_acids = count_of(count, "amino acid");
                notes.push(format!("the ends differ in {amino_acids}: the source's are taken"));
            }
            let unmatched = matching.only_first.len();
            if unmatched > 0 {
                let residues = count_of(unmatched, "residue");
                notes.push(format!("no counterpart in the target of {residues} of the source"));
            }
            let matches = matching.pairs.iter().map(|pair| [pair.first as u32, pair.second as u32]);
            Some(Target { matches: matches.collect(), residues: other.residues })
        }
    };
    let obstacles = obstacles_of(spec, source, file, notes)?;
    let step = match (spec.step, spec.turn) {
        (Some(_), Some(_)) => {
            let message = "found beside protein.step; only one of them expected".to_owned();
            return Err(source.error(&place("turn"), message));
        }
        (Some(length), None) => EnergySteps::Length(length),
        (None, Some(turn)) => EnergySteps::Turn(turn),
        (None, None) => {
            notes.push(
                "turn = 1° of a torsion at most between two energies along a motion".to_owned(),
            );
            EnergySteps::Turn(DEFAULT_TURN)
        }
    };
    let protein = Protein {
        source: chain.residues,
        target,
        gaps: spec.gaps,
        obstacles,
        rules: spec.rules,
        energy: spec.energy,
        highest: spec.highest,
        step,
    };
    if let Some((key, message)) = protein.complaint() {
        return Err(source.error(&place(key), message));
    }
    if let Some(message) = protein.broken_rule(&protein.linkage().source()) {
        notes.push(format!("the source is not valid: {message}"));
    }
    Ok(protein)
}

/// "1 residue", "2 residues".
fn count_of(count: usize, what: &str) -> String {
    let end = if count == 1 { "" } else { "s" };
    format!("{count} {what}{end}")
}

/// A model of a file, and which of its chains was taken, counted from 0.
type Taken = (StructureModel, usize);

/// Finds chains and looks whether they are whole.
struct WholeChain<'a> {
    source: &'a Source<'a>,
    gaps: Gaps,
}

impl WholeChain<'_> {
    /// The chain that the table `key` asks for, and the model that it was taken from, if a file has it.
    fn of(
        &self,
        spec: &ChainSpec,
        key: &'static str,
        notes: &mut Vec<String>,
    ) -> Result<(Chain, Option<Taken>), ProblemError> {
        let fail = |error: &StructureError| {
            self.source.error(&[Key("protein"), Key(key)], error.to_string())
        };
        let (chain, taken) = match spec {
            ChainSpec::Residues(residues) => {
                let residues = residues.clone();
                (Chain { name: String::new(), residues, others: Vec::new() }, None)
            }
            ChainSpec::File(file) => {
                let (chain, taken) =
                    self.in_file(file, key, notes).map_err(|error| fail(&error))?;
                (chain, Some(taken))
            }
        };
        let found = match self.gaps {
            Gaps::Error => backbone::check(&chain),
            Gaps::Rigid => backbone::completeness(&chain),
        };
        let found = found.map_err(|error| fail(&error))?;
        for gap in &found.gaps {
            let [before, after] = [gap.before, gap.before + 1].map(|at| &chain.residues[at]);
            notes.push(format!(
                "{key}: the gap between {before} and {after} is bridged: both sides move as one"
            ));
        }
        if let [first, ..] = found.without_side_chain[..] {
            let residues = count_of(found.without_side_chain.len(), "residue");
            let first = &chain.residues[first];
            notes.push(format!("{key}: {residues} without a side chain, first {first}"));
        }
        for cis in peptides::cis_peptides(&chain.residues) {
            let [before, after] = [cis.before, cis.before + 1].map(|at| &chain.residues[at]);
            notes.push(format!(
                "{key}: the peptide bond between {before} and {after} is cis, and stays so"
            ));
        }
        Ok((chain, taken))
    }

    fn in_file(
        &self,
        spec: &FileSpec,
        key: &str,
        notes: &mut Vec<String>,
    ) -> Result<(Chain, Taken), StructureError> {
        let path = self.source.folder.join(&spec.file);
        let structure = read(&path)?;
        self.source.read(crate::digest::SourceFile {
            path: spec.file.to_string_lossy().into_owned(),
            ..structure.source.clone()
        });
        let model = select_model(&structure, spec.model).map_err(|error| error.in_file(&path))?;
        let (model, count) = (model.clone(), structure.models.len());
        let alternatives = structure.alternatives;
        if count > 1 && spec.model.is_none() {
            notes.push(format!("{key}: model {} of {count}, the first", model.number));
        }
        let range = spec.residues.as_deref().map(|text| {
            parse_range(text).ok_or_else(|| {
                let expected = "the first and the last residue expected, such as 4-147";
                StructureError::pathless(format!("residues = {text:?} found; {expected}"))
            })
        });
        let range = range.transpose()?;
        let selection = ChainSelection { chain: spec.chain.as_deref(), range };
        let at = find_chain(&model, selection.chain).map_err(|error| error.in_file(&path))?;
        let mut chain = select_chain(&model, selection).map_err(|error| error.in_file(&path))?;
        let is_of_chain = |alternative: &&Alternative| {
            let Alternative { model: number, chain: name, .. } = alternative;
            let is_its = |residue: &Residue| {
                residue.number == alternative.number && residue.name == alternative.name
            };
            *number == model.number && *name == chain.name && chain.residues.iter().any(is_its)
        };
        let count = alternatives.iter().filter(is_of_chain).count();
        if count > 0 {
            let residues = count_of(count, "residue");
            notes.push(format!("{key}: of {residues} with alternative locations those of the highest occupancy are taken"));
        }
        leave_out_nameless(&mut chain, key, notes);
        Ok((chain, (model, at)))
    }
}

/// Leaves out the atoms of no element, such as dummy atoms of simulations.
fn leave_out_nameless(chain: &mut Chain, key: &str, notes: &mut Vec<String>) {
    let count = |chain: &Chain| chain.residues.iter().map(|of| of.atoms.len()).sum::<usize>();
    let before = count(chain);
    for residue in &mut chain.residues {
        residue.atoms.retain(|atom| !atom.element.is_empty());
    }
    let left_out = before - count(chain);
    if left_out > 0 {
        let atoms = count_of(left_out, "atom");
        notes.push(format!("{key}: {atoms} of no element left out"));
    }
}

/// The chains that stand still.
fn obstacles_of(
    spec: &ProteinSpec,
    source: &Source,
    taken: Option<Taken>,
    notes: &mut Vec<String>,
) -> Result<Vec<Vec<Residue>>, ProblemError> {
    let names = match &spec.obstacles {
        ObstacleSpec::Residues(chains) => return Ok(chains.clone()),
        ObstacleSpec::Chains(names) => names,
    };
    let fail = |message: String| Err(source.error(&[Key("protein"), Key("obstacles")], message));
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let Some((model, moving)) = taken else {
        return fail(
            "names of chains found; residues, as the source is given, expected".to_owned(),
        );
    };
    let proteins: Vec<usize> =
        (0..model.chains.len()).filter(|at| !model.chains[*at].residues.is_empty()).collect();
    let mut obstacles = Vec::new();
    for (index, name) in names.iter().enumerate() {
        if names[..index].contains(name) {
            return fail(format!("`{name}` found twice; each chain once expected"));
        }
        let named: Vec<usize> =
            proteins.iter().copied().filter(|at| model.chains[*at].name == *name).collect();
        let at = match named[..] {
            [at] if at == moving => {
                return fail(format!(
                    "`{name}` found, the chain that moves; another chain expected"
                ));
            }
            [at] => at,
            [] => {
                let others = proteins.iter().filter(|at| **at != moving);
                let known: Vec<String> =
                    others.map(|at| format!("`{}`", model.chains[*at].name)).collect();
                let expected = match &known[..] {
                    [] => "none, for the file has no other chain of amino acids,".to_owned(),
                    _ => format!("one of {}", known.join(", ")),
                };
                return fail(format!("no chain `{name}` found; {expected} expected"));
            }
            _ => {
                let count = named.len();
                return fail(format!("{count} chains `{name}` found; a name of one expected"));
            }
        };
        let mut chain = model.chains[at].clone();
        let key = format!("obstacles: chain {name}");
        if !chain.others.is_empty() {
            let others = names_of(&chain.others);
            notes.push(format!("{key}: {others} left out, amino acids alone are obstacles"));
        }
        leave_out_nameless(&mut chain, &key, notes);
        obstacles.push(chain.residues);
    }
    Ok(obstacles)
}

/// The names of residues, the most frequent first, equal ones by the alphabet: "43 HOH, 12 CA and 3 others".
fn names_of(residues: &[Residue]) -> String {
    /// How many names are listed.
    const LISTED: usize = 6;
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for residue in residues {
        *counts.entry(&residue.name).or_default() += 1;
    }
    let mut counts: Vec<(&str, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let listed = counts.iter().take(LISTED).map(|(name, count)| format!("{count} {name}"));
    let listed = listed.collect::<Vec<_>>().join(", ");
    match counts.iter().skip(LISTED).map(|(_, count)| count).sum::<usize>() {
        0 => listed,
        more => format!("{listed} and {}", count_of(more, "other")),
    }
}
