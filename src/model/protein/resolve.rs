//! From what a problem asks for to a checked protein.

use super::{ChainSpec, FileSpec, Gaps, ObstacleSpec, Protein, ProteinSpec, Target};
use crate::source::Step::Key;
use crate::source::{ProblemError, Source};
use crate::structure::matching::match_chains;
use crate::structure::{
    Chain, ChainSelection, Residue, Structure, StructureError, StructureModel, backbone,
    parse_range, peptides, read, select_chain,
};

/// The energy along a motion is computed at steps of this length in the space unless the file says otherwise, radians: a third of
/// a degree for each of 286 torsions.
pub(super) const DEFAULT_STEP: f64 = 0.1;

/// Checks a protein and makes what is asked for.
pub(super) fn resolve(
    spec: &ProteinSpec,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Protein, ProblemError> {
    let place = |key| [Key("protein"), Key(key)];
    let fail = |key, error: &StructureError| source.error(&place(key), error.to_string());

    let whole = WholeChain { source, gaps: spec.gaps };
    let (chain, model) = whole.of(&spec.source, "source", notes)?;
    let target = match &spec.target {
        None => None,
        Some(target) => {
            let (other, _) = whole.of(target, "target", notes)?;
            let matching = match_chains(&chain, &other).map_err(|error| fail("target", &error))?;
            let differ = matching.atoms_that_differ();
            if differ > 0 {
                notes.push(format!("the ends differ by {differ} heavy atoms, which play no part but in exports and centroids"));
            }
            if matching.pairs.iter().any(|pair| pair.differs) {
                let count = matching.pairs.iter().filter(|pair| pair.differs).count();
                notes.push(format!(
                    "the ends differ in {count} amino acids: the source's are taken"
                ));
            }
            let unmatched = matching.only_first.len();
            if unmatched > 0 {
                notes.push(format!(
                    "{unmatched} residues of the source have no counterpart in the target"
                ));
            }
            let matches = matching.pairs.iter().map(|pair| [pair.first as u32, pair.second as u32]);
            Some(Target { matches: matches.collect(), residues: other.residues })
        }
    };
    let obstacles = obstacles_of(spec, source, model.as_ref())?;
    let step = spec.step.unwrap_or_else(|| {
        notes.push(format!("step = {DEFAULT_STEP} radians between two energies along a motion"));
        DEFAULT_STEP
    });
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
    match protein.complaint() {
        None => Ok(protein),
        Some((key, message)) => Err(source.error(&place(key), message)),
    }
}

/// Finds chains and looks whether they are whole.
struct WholeChain<'a> {
    source: &'a Source<'a>,
    gaps: Gaps,
}

impl WholeChain<'_> {
    /// The chain that the table `key` asks for, and the model that it is from, if a file has it.
    fn of(
        &self,
        spec: &ChainSpec,
        key: &'static str,
        notes: &mut Vec<String>,
    ) -> Result<(Chain, Option<StructureModel>), ProblemError> {
        let fail = |error: &StructureError| {
            self.source.error(&[Key("protein"), Key(key)], error.to_string())
        };
        let (chain, model) = match spec {
            ChainSpec::Residues(residues) => {
                let residues = residues.clone();
                (Chain { name: String::new(), residues, others: Vec::new() }, None)
            }
            ChainSpec::File(file) => {
                let (chain, model) =
                    self.in_file(file, key, notes).map_err(|error| fail(&error))?;
                (chain, Some(model))
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
            let count = found.without_side_chain.len();
            let first = &chain.residues[first];
            notes.push(format!("{key}: {count} residues without a side chain, first {first}"));
        }
        for cis in peptides::cis_peptides(&chain.residues) {
            let [before, after] = [cis.before, cis.before + 1].map(|at| &chain.residues[at]);
            notes.push(format!(
                "{key}: the peptide bond between {before} and {after} is cis, and stays so"
            ));
        }
        Ok((chain, model))
    }

    fn in_file(
        &self,
        spec: &FileSpec,
        key: &str,
        notes: &mut Vec<String>,
    ) -> Result<(Chain, StructureModel), StructureError> {
        let path = self.source.folder.join(&spec.file);
        let structure = read(&path)?;
        self.source.read(crate::digest::SourceFile {
            path: spec.file.to_string_lossy().into_owned(),
            ..structure.source.clone()
        });
        let Structure { models, alternatives, .. } = structure;
        let count = models.len();
        let numbers: Vec<String> = models.iter().map(|model| model.number.to_string()).collect();
        let model =
            models.into_iter().find(|model| spec.model.is_none_or(|number| number == model.number));
        let model = model.ok_or_else(|| {
            let number = spec.model.unwrap_or_default();
            let numbers = numbers.join(", ");
            StructureError::file(
                &path,
                format!("no model {number} found; one of {numbers} expected"),
            )
        })?;
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
        let chain = select_chain(&model, selection).map_err(|error| error.in_file(&path))?;
        if !alternatives.is_empty() {
            notes.push(format!("{key}: of {} residues with alternative locations those of the highest occupancy are taken", alternatives.len()));
        }
        Ok((chain, model))
    }
}

/// The chains that stand still.
fn obstacles_of(
    spec: &ProteinSpec,
    source: &Source,
    model: Option<&StructureModel>,
) -> Result<Vec<Vec<Residue>>, ProblemError> {
    let names = match &spec.obstacles {
        ObstacleSpec::Residues(chains) => return Ok(chains.clone()),
        ObstacleSpec::Chains(names) => names,
    };
    let fail = |message: String| Err(source.error(&[Key("protein"), Key("obstacles")], message));
    let mut obstacles = Vec::new();
    for name in names {
        let moving = match &spec.source {
            ChainSpec::File(file) => file.chain.as_deref(),
            ChainSpec::Residues(_) => None,
        };
        if moving == Some(&name[..]) {
            return fail(format!("`{name}` found, the chain that moves; another chain expected"));
        }
        let chains = model.map_or(&[][..], |model| &model.chains);
        let Some(chain) = chains.iter().find(|chain| chain.name == *name) else {
            let known: Vec<String> =
                chains.iter().map(|chain| format!("`{}`", chain.name)).collect();
            return fail(format!("no chain `{name}` found; one of {} expected", known.join(", ")));
        };
        obstacles.push(chain.residues.clone());
    }
    Ok(obstacles)
}
