use super::{Finder, Milestones};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::neighbor::{Best, Neighbor};
use crate::roadmap::Configs;
use crate::seed::Stream;
use crate::structure::measure::CentredPoints;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The `neighbors` nearest milestones by Cα RMSD: the root-mean-square distance of all Cα after the superposition that makes
/// it least, in Å ([`measure::rmsd`](crate::structure::measure::rmsd)). It is for models that have Cα.
///
/// Two conformations that are near one another in their torsions can lie far apart in space, since a torsion in the middle of
/// a chain swings the half behind it. RMSD says how far the atoms are.
///
/// Conformations whose radii of gyration differ by more than the RMSD of the farthest neighbour so far are not superposed. Of
/// N points about their centroid, with S the sum of their squares, N · RMSD² = Sa + Sb − 2 Σ a · R b for the best rotation R,
/// which by Cauchy and Schwarz is at least (√Sa − √Sb)². So RMSD is at least the difference of the radii √(S / N).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct CaRmsd {
    /// How many.
    #[serde(default = "default_neighbors")]
    pub neighbors: u32,
}

/// What rounding may add to a difference of radii beyond an RMSD, as part of the radii's sum. It is ample: RMSDs of proteins,
/// whose radii are some 20 Å, are computed within 1e-9 Å, and radii within 1e-12 Å.
const ROUNDING: f64 = 1e-7;

fn default_neighbors() -> u32 {
    10
}

impl Default for CaRmsd {
    fn default() -> CaRmsd {
        CaRmsd { neighbors: default_neighbors() }
    }
}

impl Finder for CaRmsd {
    fn near(
        &self,
        cx: &Context,
        milestones: &Milestones,
        q: &[f64],
        scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let Milestones { configs, components, .. } = *milestones;
        // What `suits` refuses in a problem file can still come in the bytes of a ledger.
        let Some(shape) = shape_at(cx, q, scratch) else { return Vec::new() };
        let mut shape_of = |node: u32| shape_at(cx, configs.get(node as usize), scratch);
        let shapes = components.shapes(&mut shape_of);
        let radius = shape.radius_of_gyration();
        let mut best = Best::new(self.neighbors as usize);
        for id in milestones.ids() {
            if least(radius, shapes.radius(id)) > best.bound() {
                continue;
            }
            let computed;
            let other = match shapes.points(id) {
                Some(kept) => kept,
                None => {
                    computed = shape_of(id);
                    let Some(computed) = &computed else { continue };
                    computed
                }
            };
            best.offer(Neighbor { distance: shape.rmsd(other), id });
        }
        best.into_items()
    }

    fn near_of_few(
        &self,
        cx: &Context,
        few: &Configs,
        _total: usize,
        q: &[f64],
        scratch: &mut Scratch,
    ) -> Vec<Neighbor> {
        let Some(shape) = shape_at(cx, q, scratch) else { return Vec::new() };
        let mut best = Best::new(self.neighbors as usize);
        for (id, other) in few.iter().enumerate() {
            let Some(other) = shape_at(cx, other, scratch) else { continue };
            best.offer(Neighbor { distance: shape.rmsd(&other), id: id as u32 });
        }
        best.into_items()
    }

    fn pairs(
        &self,
        cx: &Context,
        configs: &Configs,
        _chance: &mut Stream,
        scratch: &mut Scratch,
    ) -> Vec<(u32, u32)> {
        let shapes: Option<Vec<CentredPoints>> =
            configs.iter().map(|q| shape_at(cx, q, scratch)).collect();
        let Some(shapes) = shapes else { return Vec::new() };
        let radii: Vec<f64> = shapes.iter().map(CentredPoints::radius_of_gyration).collect();
        let mut bests = vec![Best::new(self.neighbors as usize); shapes.len()];
        for high in 0..shapes.len() {
            for low in 0..high {
                let bound = bests[low].bound().max(bests[high].bound());
                if least(radii[low], radii[high]) > bound {
                    continue;
                }
                let distance = shapes[low].rmsd(&shapes[high]);
                bests[low].offer(Neighbor { distance, id: high as u32 });
                bests[high].offer(Neighbor { distance, id: low as u32 });
            }
        }
        let pairs = bests.into_iter().enumerate().flat_map(|(id, best)| {
            let others = best.into_items().into_iter().map(|near| near.id);
            others.map(move |other| (other.min(id as u32), other.max(id as u32)))
        });
        pairs.collect::<BTreeSet<_>>().into_iter().collect()
    }

    fn most(&self, _total: usize) -> Option<usize> {
        Some(self.neighbors as usize)
    }

    fn complaint(&self) -> Option<Complaint> {
        (self.neighbors == 0).then(|| Complaint::new("neighbors", "0", "at least 1"))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        // A model has a shape everywhere or nowhere.
        let mut middle = vec![0.0; cx.space.len()];
        cx.space.of_cube(&vec![0.5; cx.space.cube_dimensions()], &mut middle);
        match cx.model.shape(&middle, &mut Scratch::new()) {
            Some(_) => Ok(()),
            None => Err("neighbours by Cα RMSD found, a model with Cα expected".to_owned()),
        }
    }
}

/// The Cα of the model at `q` about their centroid.
fn shape_at(cx: &Context, q: &[f64], scratch: &mut Scratch) -> Option<CentredPoints> {
    cx.model.shape(q, scratch).map(|points| CentredPoints::new(&points))
}

/// What an RMSD, as it is computed, is at least, Å, where these are the radii of gyration.
fn least(a: f64, b: f64) -> f64 {
    (a - b).abs() - ROUNDING * (a + b)
}
