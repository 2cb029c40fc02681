use super::energy::EnergySpec;
use super::validity::Rules;
use crate::source::{ProblemError, Source};
use crate::structure::Residue;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A protein whose backbone torsions turn, as a problem asks for it: the table `[protein]` of a problem file, which
/// `docs/proteins.md` describes. Nothing is checked before the problem is built.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProteinSpec {
    pub(super) source: ChainSpec,
    pub(super) target: Option<ChainSpec>,
    #[serde(default)]
    pub(super) gaps: Gaps,
    #[serde(default)]
    pub(super) obstacles: ObstacleSpec,
    #[serde(default)]
    pub(super) rules: Rules,
    #[serde(default)]
    pub(super) energy: EnergySpec,
    pub(super) highest: Option<f64>,
    pub(super) step: Option<f64>,
    pub(super) turn: Option<f64>,
}

impl ProteinSpec {
    /// A protein with the bonds, angles and omegas of `source`, whose hydrogen bonds and disulphides make the energy.
    pub fn new(source: ChainSpec) -> ProteinSpec {
        ProteinSpec {
            source,
            target: None,
            gaps: Gaps::default(),
            obstacles: ObstacleSpec::default(),
            rules: Rules::default(),
            energy: EnergySpec::default(),
            highest: None,
            step: None,
            turn: None,
        }
    }

    /// The structure at the other end of a transition, whose hydrogen bonds and disulphides make the energy's second
    /// basin.
    pub fn target(self, target: ChainSpec) -> ProteinSpec {
        ProteinSpec { target: Some(target), ..self }
    }

    /// What is made of a chain that is broken; an error if nothing is said.
    pub fn gaps(self, gaps: Gaps) -> ProteinSpec {
        ProteinSpec { gaps, ..self }
    }

    /// The chains of the source's file that stand around the protein without moving.
    pub fn obstacles(self, chains: impl IntoIterator<Item = String>) -> ProteinSpec {
        ProteinSpec { obstacles: ObstacleSpec::Chains(chains.into_iter().collect()), ..self }
    }

    /// Which conformations are invalid.
    pub fn rules(self, rules: Rules) -> ProteinSpec {
        ProteinSpec { rules, ..self }
    }

    /// The terms of the energy.
    pub fn energy(self, energy: EnergySpec) -> ProteinSpec {
        ProteinSpec { energy, ..self }
    }

    /// The highest energy that is valid, model kJ/mol. If nothing is said, every energy is.
    pub fn highest(self, energy: f64) -> ProteinSpec {
        ProteinSpec { highest: Some(energy), ..self }
    }

    /// How far apart in the space, radians, the configurations of a motion are at which its energy is computed, instead of
    /// [`turn`](ProteinSpec::turn).
    pub fn step(self, length: f64) -> ProteinSpec {
        ProteinSpec { step: Some(length), turn: None, ..self }
    }

    /// By how much a torsion turns at most, radians, between two configurations of a motion at which its energy is computed; one
    /// degree if nothing is said.
    pub fn turn(self, turn: f64) -> ProteinSpec {
        ProteinSpec { turn: Some(turn), step: None, ..self }
    }
}

/// A chain of residues.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "FileSpec")]
pub enum ChainSpec {
    /// One that a file holds.
    File(FileSpec),
    /// One that is given residue by residue.
    Residues(Vec<Residue>),
}

/// A chain, or a part of it, in a PDB or mmCIF file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileSpec {
    pub(super) file: PathBuf,
    pub(super) model: Option<i32>,
    pub(super) chain: Option<String>,
    pub(super) residues: Option<String>,
}

impl FileSpec {
    /// The only protein chain of a file's first model. A relative path starts where those of other files do.
    pub fn new(file: impl Into<PathBuf>) -> FileSpec {
        FileSpec { file: file.into(), model: None, chain: None, residues: None }
    }

    /// The number of the model; the first if nothing is said.
    pub fn model(self, number: i32) -> FileSpec {
        FileSpec { model: Some(number), ..self }
    }

    /// The chain's name, needed where there are several.
    pub fn chain(self, name: impl Into<String>) -> FileSpec {
        FileSpec { chain: Some(name.into()), ..self }
    }

    /// The first and the last residue by their numbers in the file, `4-147`; all if nothing is said.
    pub fn residues(self, range: impl Into<String>) -> FileSpec {
        FileSpec { residues: Some(range.into()), ..self }
    }
}

impl From<FileSpec> for ChainSpec {
    fn from(file: FileSpec) -> ChainSpec {
        ChainSpec::File(file)
    }
}

/// What stands around the protein without moving.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "Vec<String>")]
pub enum ObstacleSpec {
    /// Chains of the source's file.
    Chains(Vec<String>),
    /// Chains that are given residue by residue.
    Residues(Vec<Vec<Residue>>),
}

impl From<Vec<String>> for ObstacleSpec {
    fn from(chains: Vec<String>) -> ObstacleSpec {
        ObstacleSpec::Chains(chains)
    }
}

impl Default for ObstacleSpec {
    fn default() -> ObstacleSpec {
        ObstacleSpec::Chains(Vec::new())
    }
}

/// What is made of a chain in which residues are missing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, Encode, Decode)]
#[serde(rename_all = "kebab-case")]
pub enum Gaps {
    /// An error that names the residues at both sides.
    #[default]
    Error,
    /// What follows a gap moves as one with what is before it: psi before the gap and phi after it are fixed.
    Rigid,
}

#[derive(Deserialize)]
struct Tables {
    protein: ProteinSpec,
}

/// Reads the table.
pub(super) fn read(source: &Source) -> Result<ProteinSpec, ProblemError> {
    source.tables().map(|tables: Tables| tables.protein)
}
