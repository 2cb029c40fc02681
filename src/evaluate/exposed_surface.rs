use super::{Evaluator, Verdict};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{LigandAtProtein, Scratch};
use crate::roadmap::Roadmap;
use crate::structure::Point;
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// The roadmap covers the surface of a protein (H.-Y. Yeh, PhD thesis, 2016, §6.2): every residue that is exposed to the solvent has a
/// sample, and samples lie close to one another.
///
/// An exposed residue *has a sample* if an atom of the ligand at some milestone is within `contact` of one of the residue's atoms. The
/// value is the mean distance of the ligand's centroid at a milestone to the nearest at another one, in percent of the ligand's diameter.
/// Neither the contact nor the percentage is said there: 4.5 Å between heavy atoms is a usual definition of a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields, default)]
pub struct ExposedSurface {
    /// The largest mean distance, in percent of the ligand's diameter.
    pub percent: f64,
    /// How near an atom of the ligand is to an atom of a residue that has a sample, Å.
    pub contact: f64,
}

impl Default for ExposedSurface {
    fn default() -> ExposedSurface {
        ExposedSurface { percent: 25.0, contact: 4.5 }
    }
}

impl ExposedSurface {
    /// How many of the exposed residues have a sample.
    fn covered(&self, ligand: &dyn LigandAtProtein, samples: &[Vec<Point>]) -> usize {
        let square = self.contact * self.contact;
        let has_sample = |atoms: &[Point]| {
            samples.iter().any(|sample| {
                sample
                    .iter()
                    .any(|of| atoms.iter().any(|atom| (atom - of).norm_squared() <= square))
            })
        };
        ligand.exposed().iter().filter(|residue| has_sample(&residue.atoms)).count()
    }
}

/// The mean distance of points to the nearest other one; infinite where there are fewer than two.
fn mean_nearest_distance(mut points: Vec<Point>) -> f64 {
    if points.len() < 2 {
        return f64::INFINITY;
    }
    // Sorted along x, a point need not look farther along x than its nearest is away.
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    let nearest = |at: usize| {
        let here = points[at];
        let mut least = f64::INFINITY;
        let mut look = |other: &Point| {
            least = least.min((other - here).norm_squared());
            (other.x - here.x) * (other.x - here.x) < least
        };
        let _ = points[at + 1..].iter().all(&mut look);
        let _ = points[..at].iter().rev().all(&mut look);
        least.sqrt()
    };
    (0..points.len()).map(nearest).sum::<f64>() / points.len() as f64
}

impl Evaluator for ExposedSurface {
    fn name(&self) -> &'static str {
        "exposed-surface"
    }

    fn evaluate(
        &self,
        cx: &Context,
        _path: &str,
        roadmap: &Roadmap,
        scratch: &mut Scratch,
    ) -> Verdict {
        let asked = scratch.take_asked();
        let Some(ligand) = cx.model.ligand() else {
            return Verdict::at_most(self.percent, f64::INFINITY, asked);
        };
        let samples: Vec<Vec<Point>> =
            roadmap.configs().iter().map(|q| ligand.positions(q)).collect();
        let centroid = |sample: &Vec<Point>| {
            sample.iter().fold(Point::zeros(), |sum, atom| sum + atom) / sample.len() as f64
        };
        let distance = mean_nearest_distance(samples.iter().map(centroid).collect());
        let percent = 100.0 * distance / ligand.diameter();
        let (covered, exposed) = (self.covered(ligand, &samples), ligand.exposed().len());
        let verdict = Verdict::at_most(self.percent, percent, asked);
        Verdict {
            satisfied: verdict.satisfied && covered == exposed,
            measures: vec![covered as f64, exposed as f64],
            ..verdict
        }
    }

    fn measures(&self) -> &'static [&'static str] {
        &["covered", "exposed"]
    }

    fn complaint(&self) -> Option<Complaint> {
        let settings = [("percent", self.percent), ("contact", self.contact)];
        settings.iter().find_map(|(key, value)| Complaint::of_length(key, *value, 1e6))
    }

    fn accept(&mut self, cx: &Context) -> Result<(), String> {
        match cx.model.ligand() {
            Some(_) => Ok(()),
            None => Err("an exposed surface found; a ligand at a protein expected".to_owned()),
        }
    }
}
