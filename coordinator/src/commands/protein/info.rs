use super::{list, names_of};
use crate::cli::ProteinInfoArguments;
use crate::exit::{Code, Failure};
use crate::output::{self, Plain, line};
use roadmill::structure::backbone::missing_atom;
use roadmill::structure::disulphides::disulphides;
use roadmill::structure::measure::secondary_structure;
use roadmill::structure::peptides::{cis_peptides, gaps};
use roadmill::structure::{
    AminoAcid, Chain, ChainSelection, Residue, Structure, StructureError, read, select_chain,
    select_model,
};
use serde::Serialize;

/// Letters of a sequence in a line.
const WIDTH: usize = 60;

/// What a file holds.
#[derive(Serialize)]
struct Info {
    format: String,
    models: Vec<ModelInfo>,
    /// The number of the model that is shown: the first, unless another is asked for.
    model: i32,
    /// Of that model, as everything below.
    chains: Vec<ChainInfo>,
    disulphides: Vec<String>,
    notes: Vec<String>,
}

/// How much the file has of a model, alternatives included.
#[derive(Serialize)]
struct ModelInfo {
    number: i32,
    atoms: usize,
    residues: usize,
}

/// A chain.
#[derive(Serialize)]
struct ChainInfo {
    name: String,
    residues: usize,
    first: Option<String>,
    last: Option<String>,
    sequence: String,
    secondary_structure: String,
    /// Atoms of its amino acids, and the heavy ones of these.
    atoms: [usize; 2],
    others: String,
    gaps: Vec<String>,
    missing_backbone_atoms: Vec<String>,
    without_side_chain: Vec<String>,
    modified: Vec<String>,
    alternatives: Vec<String>,
    cis_peptides: Vec<String>,
}

/// Says what a structure file holds.
pub fn info(arguments: &ProteinInfoArguments) -> Result<Code, Failure> {
    let structure = read(&arguments.file).map_err(Failure::usage)?;
    let info = Info::of(&structure, arguments.model, arguments.chain.as_deref())
        .map_err(|error| Failure::usage(error.in_file(&arguments.file)))?;
    if arguments.json {
        output::json(&info);
    } else {
        info.print(&arguments.file.to_string_lossy());
    }
    Ok(Code::Done)
}

impl Info {
    fn of(
        structure: &Structure,
        model: Option<i32>,
        chain: Option<&str>,
    ) -> Result<Info, StructureError> {
        let shown = select_model(structure, model)?;
        let chains = match chain {
            None => shown.chains.clone(),
            Some(_) => vec![select_chain(shown, ChainSelection { chain, range: None })?],
        };
        let counts = structure.models.iter().zip(&structure.counts);
        let model = |(model, counts): (&roadmill::structure::StructureModel, &_)| {
            let roadmill::structure::ModelCounts { atoms, residues } = *counts;
            ModelInfo { number: model.number, atoms, residues }
        };
        let bond = |bond: &roadmill::structure::disulphides::Disulphide| {
            let of = |(chain, place): (usize, usize)| {
                let chain = &chains[chain];
                format!("{} of `{}`", chain.residues[place], chain.name)
            };
            format!("{} and {} ({:.2} Å)", of(bond.first), of(bond.second), bond.distance)
        };
        Ok(Info {
            format: structure.format.to_string(),
            models: counts.map(model).collect(),
            model: shown.number,
            disulphides: disulphides(&chains).iter().map(bond).collect(),
            chains: chains
                .iter()
                .map(|chain| ChainInfo::of(structure, shown.number, chain))
                .collect(),
            notes: structure.notes.clone(),
        })
    }

    fn print(&self, file: &str) {
        line(format_args!("{}: {}, models: {}", Plain(file), self.format, self.models.len()));
        if let Some(shown) = self.models.iter().find(|model| model.number == self.model) {
            line(format_args!(
                "model {}: {} atoms, {} residues; chains: {}",
                shown.number,
                shown.atoms,
                shown.residues,
                self.chains.len()
            ));
        }
        for chain in &self.chains {
            chain.print();
        }
        line(format_args!("disulphides: {}", list(self.disulphides.iter().cloned())));
        for note in &self.notes {
            line(format_args!("note: {}", Plain(note)));
        }
    }
}

impl ChainInfo {
    fn of(structure: &Structure, model: i32, chain: &Chain) -> ChainInfo {
        let residues = &chain.residues;
        let between = |before: usize| format!("{} and {}", residues[before], residues[before + 1]);
        let named = |residues: Vec<&Residue>| residues.iter().map(ToString::to_string).collect();
        let missing = |residue: &Residue| Some(format!("{} of {residue}", missing_atom(residue)?));
        let is_bare = |residue: &&Residue| {
            residue.amino_acid != Some(AminoAcid::Glycine) && residue.position("CB").is_none()
        };
        let modified = |residue: &Residue| {
            let code =
                residue.amino_acid.map(AminoAcid::code).filter(|code| *code != residue.name)?;
            Some(format!("{residue} ({code})"))
        };
        let alternatives = structure.alternatives.iter().filter(|alternative| {
            // Of chains with one name each may be meant.
            alternative.model == model && alternative.chain == chain.name
        });
        let atoms = || residues.iter().flat_map(|residue| &residue.atoms);
        ChainInfo {
            name: chain.name.clone(),
            residues: residues.len(),
            first: residues.first().map(ToString::to_string),
            last: residues.last().map(ToString::to_string),
            sequence: chain.sequence(),
            secondary_structure: secondary_structure(residues)
                .iter()
                .map(|assigned| assigned.letter())
                .collect(),
            atoms: [atoms().count(), atoms().filter(|atom| atom.is_heavy()).count()],
            others: names_of(chain.others.iter()),
            gaps: gaps(residues)
                .iter()
                .map(|gap| match gap.distance {
                    Some(distance) => format!("{} ({distance:.2} Å)", between(gap.before)),
                    None => between(gap.before),
                })
                .collect(),
            missing_backbone_atoms: residues.iter().filter_map(missing).collect(),
            without_side_chain: named(residues.iter().filter(is_bare).collect()),
            modified: residues.iter().filter_map(modified).collect(),
            alternatives: alternatives
                .map(|found| {
                    let letters = found.letters.iter();
                    let letters = list(letters.map(|(letter, sum)| format!("{letter} {sum:.2}")));
                    format!("{} {} ({letters}: {} taken)", found.name, found.number, found.chosen)
                })
                .collect(),
            cis_peptides: cis_peptides(residues)
                .iter()
                .map(|cis| {
                    format!("{} (omega {:.1}°)", between(cis.before), cis.omega.to_degrees())
                })
                .collect(),
        }
    }

    fn print(&self) {
        let name = Plain(&self.name);
        let (Some(first), Some(last)) = (&self.first, &self.last) else {
            line(format_args!("chain `{name}`: no amino acids; others: {}", Plain(&self.others)));
            return;
        };
        line(format_args!(
            "chain `{name}`: {} residues, {} to {}; {} atoms, {} of them heavy; others: {}",
            self.residues,
            Plain(first),
            Plain(last),
            self.atoms[0],
            self.atoms[1],
            Plain(&self.others)
        ));
        let letters = self.sequence.as_bytes().chunks(WIDTH);
        let assigned = self.secondary_structure.as_bytes().chunks(WIDTH);
        for (index, (letters, assigned)) in letters.zip(assigned).enumerate() {
            let [letters, assigned] = [letters, assigned].map(String::from_utf8_lossy);
            line(format_args!("  {:>5} {letters}", 1 + index * WIDTH));
            line(format_args!("        {assigned}"));
        }
        for (what, found) in [
            ("gaps", &self.gaps),
            ("missing backbone atoms", &self.missing_backbone_atoms),
            ("side chains not seen", &self.without_side_chain),
            ("modified residues", &self.modified),
            ("alternative locations", &self.alternatives),
            ("cis peptides", &self.cis_peptides),
        ] {
            if !found.is_empty() || what == "gaps" {
                line(format_args!("  {what}: {}", Plain(&list(found.iter().cloned()))));
            }
        }
    }
}
