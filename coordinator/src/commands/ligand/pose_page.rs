//! The page of poses.

use super::descents::Descents;
use super::pose_files::{plain_record, protein, record, steps};
use super::pose_table::PoseTable;
use crate::exit::Failure;
use crate::work::Recorded;
use roadmill::binding::{Candidates, Comparison, Reference};
use roadmill::export::{Minimum, PosesPage, ShownPose, WayFrame, poses_page};
use roadmill::model::Description;
use roadmill::model::docking::Docking;
use roadmill::structure::Point;
use roadmill::structure::measure::centroid;

/// A page shows so many places of a way out at most, so that it does not get too large.
const FRAMES_MAX: usize = 200;

/// What there is to be shown.
pub(super) struct Shown<'a> {
    pub run: &'a Recorded,
    pub docking: &'a Docking,
    pub found: &'a Candidates,
    pub reference: Option<&'a Reference>,
    pub comparison: &'a Comparison,
    pub descents: &'a Descents,
    pub table: &'a PoseTable,
}

impl Shown<'_> {
    /// The page.
    ///
    /// # Errors
    /// Exit code 2: the protein or the ligand cannot be written in the formats that the page has them in.
    pub fn page(&self) -> Result<String, Failure> {
        let Shown { run, docking, reference, descents, table, .. } = *self;
        let ligand = docking.ligand();
        let reference_record = match reference {
            Some(known) => Some(plain_record(docking, &known.descended, &[])?),
            None => None,
        };
        let facts = [
            ("ligand", ligand.name().to_owned()),
            ("degrees of freedom", docking.degrees_of_freedom().to_string()),
            ("nodes", run.roadmap().configs().len().to_string()),
            ("improved", format!("{} nodes, {} clusters", table.improved, table.clusters)),
            ("seed", run.problem().seed().to_string()),
            ("roadmap", run.digest().to_string()),
            ("program", run.program()),
        ];
        let meaning = format!(
            "{} The score is the mean energy of configurations near the pose.",
            docking.molecule().map_or("", |molecule| molecule.about_energies())
        );
        Ok(poses_page(&PosesPage {
            title: run.problem().name(),
            facts: &facts,
            meaning: &meaning,
            protein: &protein(docking)?,
            poses: &self.poses()?,
            reference: reference_record.as_deref(),
            reference_energy: reference.map(|known| known.descended_energy.sum()),
            minima: &self.minima(),
            before: &descents.before,
            after: &descents.after,
        }))
    }

    fn poses(&self) -> Result<Vec<ShownPose>, Failure> {
        let mut poses = Vec::new();
        for (index, (row, pose)) in self.table.rows.iter().zip(&self.found.candidates).enumerate() {
            let mut way_out = Vec::new();
            if let Some(way) = &pose.way_out {
                let steps = steps(self.docking, way);
                let every = steps.len().div_ceil(FRAMES_MAX).max(1);
                let last = steps.len() - 1;
                let shown = steps.into_iter().enumerate();
                let shown = shown.filter(|(at, _)| at % every == 0 || *at == last);
                way_out.extend(shown.map(|(_, step)| WayFrame {
                    positions: step.positions,
                    along: step.along,
                    energy: step.energy,
                }));
            }
            poses.push(ShownPose {
                label: row.rank.to_string(),
                sdf: record(self.docking, row, &pose.positions)?,
                energy: row.energy,
                score: row.score,
                cluster: index,
                population: row.population,
                peak: row.peak,
                barrier: row.barrier,
                rmsd: row.rmsd,
                way_out,
            });
        }
        Ok(poses)
    }

    /// All improved nodes, with the poses among them.
    fn minima(&self) -> Vec<Minimum> {
        let Shown { found, reference, comparison, .. } = *self;
        let centre = |positions: &[Point]| centroid(positions);
        let lowest = found.candidates.first().map(|pose| centre(&pose.positions));
        let of_pose = |node| found.candidates.iter().position(|pose| pose.node == node);
        let minimum = |of: &roadmill::binding::Improved| Minimum {
            energy: of.energy,
            rmsd: reference.map(|known| comparison.distance(&of.positions, &known.descended)),
            distance: lowest.map_or(0.0, |lowest| (centre(&of.positions) - lowest).norm()),
            pose: of_pose(of.node),
        };
        found.improved.iter().map(minimum).collect()
    }
}
