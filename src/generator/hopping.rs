use super::Generator;
use crate::connect::WithinKind;
use crate::context::Context;
use crate::descent::{BasinHopping, Descent};
use crate::methods::Complaint;
use crate::model::{CellLimits, Scratch};
use crate::roadmap::{Configs, Increment, Roadmap};
use crate::sampler::GaveUp;
use crate::seed::{Purpose, Seed, Stream};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Milestones are low minima: chains of [`BasinHopping`], each from a configuration that is drawn wherever it may be, valid or not, and of
/// each chain the lowest minima that are apart from one another.
///
/// Samplers keep what is valid, and in a narrow pocket hardly any random pose of a long ligand is. Here a pose that
/// overlaps the protein is no loss: the descent leads out of the overlap, often within the pocket. A ligand's base begins in a random cell
/// of low energy, its orientation and its torsions are drawn uniformly; any other model begins anywhere within its bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct Hopping {
    /// The chains.
    pub hopping: BasinHopping,
    /// How many minima of a chain become milestones at most.
    pub kept: u32,
    /// How far apart these are at least, in the metric of the space.
    pub apart: f64,
    /// Up to this energy of its central atom a ligand's base may begin in a cell of the grid, kJ/mol.
    pub low: f64,
    /// The most chains tried for one milestone.
    pub attempts: u64,
    /// How the milestones of a set are connected with one another.
    pub within: WithinKind,
}

impl Default for Hopping {
    fn default() -> Hopping {
        Hopping {
            hopping: BasinHopping { hops: 200, ..BasinHopping::default() },
            kept: 5,
            apart: 1.0,
            low: -1.0,
            attempts: 1000,
            within: WithinKind::default(),
        }
    }
}

impl Hopping {
    /// Draws where a chain begins.
    fn start(&self, cx: &Context, stream: &mut Stream, q: &mut [f64]) {
        cx.space.sample_uniform(stream, q);
        let Some(ligand) = cx.model.ligand() else { return };
        // No cell is high: only whether it is low counts.
        let limits = CellLimits { low: self.low, high: f64::MAX };
        let cells = ligand.low_cells(ligand.central_atom(), limits);
        if cells.inside.is_empty() {
            return;
        }
        let cell = cells.inside[stream.below(cells.inside.len() as u64) as usize];
        for axis in 0..3 {
            q[axis] = cell[axis] + cells.spacing * (stream.unit() - 0.5);
        }
        cx.space.clamp(q);
    }

    /// The lowest minima of a chain that are apart, in rising energy.
    fn chain(&self, cx: &Context, stream: &mut Stream, scratch: &mut Scratch) -> Vec<Vec<f64>> {
        let mut q = vec![0.0; cx.space.len()];
        self.start(cx, stream, &mut q);
        let mut minima: Vec<(f64, Vec<f64>)> = Vec::new();
        self.hopping.chain(cx, stream, &mut q, scratch, &mut |q, energy| {
            minima.push((energy, q.to_vec()));
        });
        minima.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut kept: Vec<Vec<f64>> = Vec::new();
        for (_, q) in minima {
            if kept.len() == self.kept as usize {
                break;
            }
            let is_apart = kept.iter().all(|other| cx.space.distance(other, &q) >= self.apart);
            if is_apart && cx.model.is_valid(&q, scratch) {
                kept.push(q);
            }
        }
        kept
    }
}

impl Generator for Hopping {
    fn generate(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        _frozen: Option<&Roadmap>,
        scratch: &mut Scratch,
    ) -> Result<Increment, GaveUp> {
        let mut stream = seed.stream(Purpose::Sampling);
        let mut configs = Configs::new(cx.space.len());
        let mut without = 0;
        while configs.len() < count {
            let minima = self.chain(cx, &mut stream, scratch);
            without = if minima.is_empty() { without + 1 } else { 0 };
            if without == self.attempts {
                return Err(GaveUp { attempts: self.attempts });
            }
            minima.iter().take(count - configs.len()).for_each(|q| configs.push(q));
        }
        let edges = self.within.method().connect(cx, seed, &configs, scratch);
        Ok(Increment { configs, edges, ..Increment::empty(cx.space.len()) })
    }

    fn complaint(&self) -> Option<Complaint> {
        if self.kept == 0 {
            return Some(Complaint::new("kept", 0, "at least 1"));
        }
        if !(self.apart.is_finite() && self.apart >= 0.0) {
            return Some(Complaint::new("apart", self.apart, "a length of at least 0"));
        }
        if !self.low.is_finite() {
            return Some(Complaint::new("low", self.low, "a finite energy"));
        }
        Complaint::of_attempts(self.attempts, super::ATTEMPTS_MAX)
            .or_else(|| self.hopping.complaint())
            .or_else(|| self.within.method().complaint())
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        self.hopping.suits(cx)?;
        self.within.method().suits(cx)
    }
}
