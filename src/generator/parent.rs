use crate::digest::Digest;
use crate::numbers::NodeId;
use crate::roadmap::Roadmap;
use crate::space::Space;
use bincode::Encode;
use bincode::de::{Decode, Decoder};
use bincode::enc::Encoder;
use bincode::error::{DecodeError, EncodeError};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// A finished run whose roadmap a generator reads.
///
/// A problem file names the run by its folder, from the folder of the file, and may say the hash of its ledger.
/// Once the problem is read, the nodes and edges of the run's roadmap are part of the problem, as its meshes are:
/// whoever has the problem's bytes, a worker, a ledger or a file of sets, needs the run no more.
///
/// The hash of the ledger and the roadmap say what the parent is. Where its folder is does not count: it is no part of
/// the bytes, and parents from different folders can be equal.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parent {
    /// The run's folder: as the problem file writes it, an absolute path once the problem is read, and empty in a
    /// problem that comes from bytes.
    pub run: String,
    /// The hash of the run's ledger up to its last complete round. A problem file may leave it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ledger: Option<Digest>,
    #[serde(skip)]
    roadmap: Arc<ParentRoadmap>,
}

/// What there is of the roadmap of a [`Parent`]: configurations and which of them are joined.
#[derive(Clone, Default, PartialEq, Encode)]
pub struct ParentRoadmap {
    dofs: u32,
    /// `dofs` values per node.
    values: Vec<f64>,
    edges: Vec<[NodeId; 2]>,
}

/// A run that was read: what a [`Runs`] gives.
#[derive(Clone, Debug)]
pub struct ParentRun {
    /// The hash of its ledger up to its last complete round.
    pub ledger: Digest,
    /// The space of its problem.
    pub space: Space,
    /// Its roadmap.
    pub roadmap: Roadmap,
}

/// Whoever can read run folders. This library knows no ledgers: a program that keeps them hands in their reader.
pub trait Runs {
    /// Reads the run in a folder.
    ///
    /// # Errors
    /// Says why it cannot be read.
    fn read(&self, folder: &Path) -> Result<ParentRun, String>;
}

/// No run can be read.
pub struct NoRuns;

impl Runs for NoRuns {
    fn read(&self, _folder: &Path) -> Result<ParentRun, String> {
        Err("a problem without parent runs expected here".to_owned())
    }
}

impl Parent {
    /// The run in a folder, and the hash that its ledger must have, if it is said. The run is read when a problem is
    /// built that names it.
    pub fn new(run: impl Into<String>, ledger: Option<Digest>) -> Parent {
        Parent { run: run.into(), ledger, roadmap: Arc::default() }
    }

    /// Takes in the roadmap of the run, for problems over `space`. `folder` is that of the problem file. A roadmap
    /// that is taken in already stays.
    ///
    /// # Errors
    /// Says what is wrong with the run: it cannot be read, has another ledger than was said, or another space.
    pub fn take_in(&mut self, runs: &dyn Runs, folder: &Path, space: &Space) -> Result<(), String> {
        if !self.roadmap.is_empty() {
            return self.fits(space);
        }
        let run = runs.read(&folder.join(&self.run))?;
        if let Some(expected) = self.ledger.filter(|expected| *expected != run.ledger) {
            return Err(format!(
                "the ledger of {} has the hash {}; {expected} expected",
                self.run, run.ledger
            ));
        }
        if !run.space.has_form_of(space) {
            return Err(format!(
                "the configurations of {} are {}; {} expected",
                self.run,
                run.space.form(),
                space.form()
            ));
        }
        if run.roadmap.configs().is_empty() {
            return Err(format!("the roadmap of {} has no nodes; at least 1 expected", self.run));
        }
        let place = std::path::absolute(folder.join(&self.run));
        self.run = place.map_or_else(|_| self.run.clone(), |path| path.to_string_lossy().into());
        self.ledger = Some(run.ledger);
        self.roadmap = Arc::new(ParentRoadmap::of(&run.roadmap));
        Ok(())
    }

    /// Whether the roadmap that was taken in has configurations of as many values as those of a space.
    ///
    /// # Errors
    /// Says how many were found and are expected.
    pub(super) fn fits(&self, space: &Space) -> Result<(), String> {
        let (found, expected) = (self.roadmap.dofs(), space.len());
        match self.roadmap.is_empty() || found == expected {
            true => Ok(()),
            false => Err(format!(
                "the roadmap of another run found, with configurations of {found} values; {expected} expected"
            )),
        }
    }

    /// A run that was read by whoever makes the problem: where its folder is, the hash of its ledger, and its roadmap.
    pub(crate) fn of(run: &str, ledger: Digest, roadmap: &Roadmap) -> Parent {
        let roadmap = Arc::new(ParentRoadmap::of(roadmap));
        Parent { run: run.to_owned(), ledger: Some(ledger), roadmap }
    }

    /// The same with no more of the roadmap than the nodes that are kept, and the edges between these.
    pub(crate) fn of_some(
        run: &str,
        ledger: Digest,
        roadmap: &Roadmap,
        mut keeps: impl FnMut(&[f64]) -> bool,
    ) -> Parent {
        let mut kept =
            ParentRoadmap { dofs: roadmap.configs().dofs() as u32, ..Default::default() };
        let mut numbers: Vec<Option<NodeId>> = Vec::new();
        for q in roadmap.configs().iter() {
            let number = keeps(q).then_some(NodeId(kept.len() as u32));
            if number.is_some() {
                kept.values.extend_from_slice(q);
            }
            numbers.push(number);
        }
        for edge in roadmap.edges().iter() {
            if let (Some(low), Some(high)) = (numbers[edge.low.index()], numbers[edge.high.index()])
            {
                kept.edges.push([low, high]);
            }
        }
        Parent { run: run.to_owned(), ledger: Some(ledger), roadmap: Arc::new(kept) }
    }

    /// The roadmap, empty until it is [taken in](Parent::take_in).
    pub fn roadmap(&self) -> &ParentRoadmap {
        &self.roadmap
    }
}

impl PartialEq for Parent {
    fn eq(&self, other: &Parent) -> bool {
        (self.ledger, &self.roadmap) == (other.ledger, &other.roadmap)
    }
}

impl Encode for Parent {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        (self.ledger, &self.roadmap).encode(encoder)
    }
}

impl<Context> Decode<Context> for Parent {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let (ledger, roadmap): (Option<Digest>, Arc<ParentRoadmap>) = Decode::decode(decoder)?;
        if ledger.is_none() || roadmap.is_empty() {
            return Err(DecodeError::Other("a parent that was never read"));
        }
        Ok(Parent { run: String::new(), ledger, roadmap })
    }
}
bincode::impl_borrow_decode!(Parent);

impl ParentRoadmap {
    fn of(roadmap: &Roadmap) -> ParentRoadmap {
        ParentRoadmap {
            dofs: roadmap.configs().dofs() as u32,
            values: roadmap.configs().values().collect(),
            edges: roadmap.edges().iter().map(|edge| [edge.low, edge.high]).collect(),
        }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.values.len() / (self.dofs as usize).max(1)
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Number of values of a configuration.
    pub fn dofs(&self) -> usize {
        self.dofs as usize
    }

    /// The configuration of a node.
    pub fn config(&self, node: usize) -> &[f64] {
        let dofs = self.dofs();
        &self.values[node * dofs..(node + 1) * dofs]
    }

    /// The edges in the order of the run, by the ids of their ends, lower first.
    pub fn edges(&self) -> &[[NodeId; 2]] {
        &self.edges
    }
}

/// The numbers of nodes and edges alone: a description of the problem is for people to read.
impl fmt::Debug for ParentRoadmap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} nodes, {} edges", self.len(), self.edges.len())
    }
}

/// Checks what decoded bytes must show: whole finite configurations, and edges between them.
impl<Context> Decode<Context> for ParentRoadmap {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Self, DecodeError> {
        let (dofs, values, edges) = Decode::decode(decoder)?;
        let roadmap = ParentRoadmap { dofs, values, edges };
        let nodes = roadmap.len();
        let sound = roadmap.values.len() == nodes * roadmap.dofs()
            && roadmap.values.iter().all(|value| value.is_finite())
            && roadmap.edges.iter().all(|[low, high]| low < high && high.index() < nodes);
        if sound { Ok(roadmap) } else { Err(DecodeError::Other("a roadmap that cannot be")) }
    }
}

bincode::impl_borrow_decode!(ParentRoadmap);
