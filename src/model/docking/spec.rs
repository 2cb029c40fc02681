use super::energy::EnergySpec;
use super::grid::GridSpec;
use crate::ligand::{Ligand, LigandTable};
use crate::source::{ProblemError, Source};
use crate::structure::Residue;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A flexible ligand at a rigid protein, as a problem asks for it: the table `[docking]` of a problem file, which
/// `docs/docking.md` describes. Nothing is checked before the problem is built.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DockingSpec {
    pub(super) protein: ReceptorSpec,
    pub(super) ligand: LigandSpec,
    #[serde(default)]
    pub(super) hydrogens: Policy,
    #[serde(default)]
    pub(super) rigid: bool,
    #[serde(default = "yes")]
    pub(super) amides: bool,
    #[serde(rename = "box")]
    pub(super) region: Option<RegionSpec>,
    #[serde(default)]
    pub(super) energy: EnergySpec,
    #[serde(default)]
    pub(super) grid: GridSpec,
    pub(super) highest: Option<f64>,
    pub(super) step: Option<f64>,
}

fn yes() -> bool {
    true
}

impl DockingSpec {
    /// A ligand that may be anywhere at the protein.
    pub fn new(protein: ReceptorSpec, ligand: LigandSpec) -> DockingSpec {
        DockingSpec {
            protein,
            ligand,
            hydrogens: Policy::Remove,
            rigid: false,
            amides: true,
            region: None,
            energy: EnergySpec::default(),
            grid: GridSpec::default(),
            highest: None,
            step: None,
        }
    }

    /// Whether hydrogens of both molecules count; if nothing is said, they are removed.
    pub fn hydrogens(self, hydrogens: Policy) -> DockingSpec {
        DockingSpec { hydrogens, ..self }
    }

    /// Whether the ligand has no torsion links.
    pub fn rigid(self, rigid: bool) -> DockingSpec {
        DockingSpec { rigid, ..self }
    }

    /// Whether bonds of amides are torsion links; if nothing is said, they are.
    pub fn amides(self, amides: bool) -> DockingSpec {
        DockingSpec { amides, ..self }
    }

    /// The box in which the centre of the ligand's base is, by its centre and its edges, Å, in the frame of the protein's file. If nothing is
    /// said, it is the box of the protein and what the ligand needs around it.
    pub fn region(self, centre: [f64; 3], size: [f64; 3]) -> DockingSpec {
        DockingSpec { region: Some(RegionSpec::about(centre, size)), ..self }
    }

    /// The terms of the energy.
    pub fn energy(self, energy: EnergySpec) -> DockingSpec {
        DockingSpec { energy, ..self }
    }

    /// How the energy is looked up.
    pub fn grid(self, grid: GridSpec) -> DockingSpec {
        DockingSpec { grid, ..self }
    }

    /// The highest energy that is valid, kJ/mol; 5000 if nothing is said.
    pub fn highest(self, energy: f64) -> DockingSpec {
        DockingSpec { highest: Some(energy), ..self }
    }

    /// How far an atom moves at most, Å, between two configurations of a motion at which its energy is computed; 0.5 if
    /// nothing is said.
    pub fn step(self, length: f64) -> DockingSpec {
        DockingSpec { step: Some(length), ..self }
    }
}

/// Whether something that stands in a protein's file is a part of the protein.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Policy {
    /// It is left out.
    #[default]
    Remove,
    /// It stays.
    Keep,
}

/// The protein, which stands still.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "ReceptorFile")]
pub enum ReceptorSpec {
    /// One that a file holds.
    File(ReceptorFile),
    /// One that is given chain by chain.
    Chains(Vec<StillChain>),
}

impl From<ReceptorFile> for ReceptorSpec {
    fn from(file: ReceptorFile) -> ReceptorSpec {
        ReceptorSpec::File(file)
    }
}

/// A protein in a PDB or mmCIF file, and what of the file is taken.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReceptorFile {
    pub(super) file: PathBuf,
    pub(super) model: Option<i32>,
    pub(super) chains: Option<Vec<String>>,
    #[serde(default)]
    pub(super) waters: Policy,
    #[serde(default = "keep")]
    pub(super) metals: Policy,
    #[serde(default)]
    pub(super) others: Policy,
    #[serde(default)]
    pub(super) keep: Vec<String>,
}

fn keep() -> Policy {
    Policy::Keep
}

impl ReceptorFile {
    /// All chains of a file's first model, with their metals, without waters and whatever else. A relative path starts where
    /// those of other files do.
    pub fn new(file: impl Into<PathBuf>) -> ReceptorFile {
        ReceptorFile {
            file: file.into(),
            model: None,
            chains: None,
            waters: Policy::Remove,
            metals: Policy::Keep,
            others: Policy::Remove,
            keep: Vec::new(),
        }
    }

    /// The number of the model; the first if nothing is said.
    pub fn model(self, number: i32) -> ReceptorFile {
        ReceptorFile { model: Some(number), ..self }
    }

    /// The names of the chains; all if nothing is said.
    pub fn chains(self, names: impl IntoIterator<Item = String>) -> ReceptorFile {
        ReceptorFile { chains: Some(names.into_iter().collect()), ..self }
    }

    /// Whether molecules of water stay.
    pub fn waters(self, waters: Policy) -> ReceptorFile {
        ReceptorFile { waters, ..self }
    }

    /// Whether single ions of metals stay; if nothing is said, they do.
    pub fn metals(self, metals: Policy) -> ReceptorFile {
        ReceptorFile { metals, ..self }
    }

    /// Whether everything else stays that is neither amino acid nor cap, water nor metal, such as cofactors and buffers.
    pub fn others(self, others: Policy) -> ReceptorFile {
        ReceptorFile { others, ..self }
    }

    /// The names of residues that stay, whatever else is said of them.
    pub fn keep(self, names: impl IntoIterator<Item = String>) -> ReceptorFile {
        ReceptorFile { keep: names.into_iter().collect(), ..self }
    }
}

/// A chain of a protein that stands still.
#[derive(Clone, Debug, PartialEq, Encode, Decode)]
pub struct StillChain {
    /// Its name: letters and digits.
    pub name: String,
    /// Its residues, amino acids and whatever else is bound.
    pub residues: Vec<Residue>,
}

/// The ligand.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "LigandKeys")]
pub enum LigandSpec {
    /// One that a file holds.
    File(LigandFile),
    /// One that is given atom by atom.
    Molecule(Ligand),
}

/// A ligand in a file; see [`crate::ligand`].
#[derive(Clone, Debug, PartialEq)]
pub struct LigandFile {
    pub(super) file: PathBuf,
    pub(super) molecule: Option<String>,
    pub(super) residue: Option<String>,
    pub(super) chain: Option<String>,
    pub(super) number: Option<i32>,
}

impl LigandFile {
    /// The only molecule of a file. A relative path starts where those of other files do.
    pub fn new(file: impl Into<PathBuf>) -> LigandFile {
        let (molecule, residue, chain, number) = (None, None, None, None);
        LigandFile { file: file.into(), molecule, residue, chain, number }
    }

    /// The name of one molecule of several.
    pub fn molecule(self, name: impl Into<String>) -> LigandFile {
        LigandFile { molecule: Some(name.into()), ..self }
    }

    /// A group of HETATM records of a PDB file, by the name of its residue and, where there are several, its chain and its
    /// number.
    pub fn residue(
        self,
        name: impl Into<String>,
        chain: Option<String>,
        number: Option<i32>,
    ) -> LigandFile {
        LigandFile { residue: Some(name.into()), chain, number, ..self }
    }
}

/// The keys of a ligand in a problem file: those of a [`LigandFile`], or those of a [`LigandTable`].
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LigandKeys {
    file: Option<PathBuf>,
    molecule: Option<String>,
    residue: Option<String>,
    chain: Option<String>,
    number: Option<i32>,
    table: Option<LigandTable>,
}

impl TryFrom<LigandKeys> for LigandSpec {
    type Error = String;

    fn try_from(keys: LigandKeys) -> Result<LigandSpec, String> {
        let LigandKeys { file, molecule, residue, chain, number, table } = keys;
        match (file, table) {
            (Some(file), None) => {
                Ok(LigandSpec::File(LigandFile { file, molecule, residue, chain, number }))
            }
            (None, Some(table)) => table.ligand().map(LigandSpec::Molecule),
            _ => Err("a ligand with either a `file` or a `table` expected".to_owned()),
        }
    }
}

/// A box, by its least and its largest corner or by its centre and its edges, Å.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "RegionKeys")]
pub struct RegionSpec {
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
}

impl RegionSpec {
    /// The box with this centre and these edges.
    fn about(centre: [f64; 3], size: [f64; 3]) -> RegionSpec {
        let corner = |side: f64| [0, 1, 2].map(|axis| centre[axis] + side * size[axis] / 2.0);
        RegionSpec { min: corner(-1.0), max: corner(1.0) }
    }
}

/// The keys of a box in a problem file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RegionKeys {
    centre: Option<[f64; 3]>,
    size: Option<[f64; 3]>,
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
}

impl TryFrom<RegionKeys> for RegionSpec {
    type Error = &'static str;

    fn try_from(keys: RegionKeys) -> Result<RegionSpec, &'static str> {
        match keys {
            RegionKeys { centre: Some(centre), size: Some(size), min: None, max: None } => {
                Ok(RegionSpec::about(centre, size))
            }
            RegionKeys { centre: None, size: None, min: Some(min), max: Some(max) } => {
                Ok(RegionSpec { min, max })
            }
            _ => Err("a box with either `centre` and `size` or `min` and `max` expected"),
        }
    }
}

#[derive(Deserialize)]
struct Tables {
    docking: DockingSpec,
}

/// Reads the table.
pub(super) fn read(source: &Source) -> Result<DockingSpec, ProblemError> {
    source.tables().map(|tables: Tables| tables.docking)
}
