//! Bounding-box deformation (ICRA 2002, §6.1): a lattice around the robot is deformed by ChainMail, and the robot with it by free-form
//! deformation. `docs/deformable-shapes.md` says what the papers leave open and how that is decided here.

mod chainmail;
mod free_form;
mod lattice;
mod push;
mod relaxation;
#[cfg(test)]
mod tests;

pub use push::Rays;

use super::shape::lengths;
use super::{Deform, Deformed, Obstacles, Refusal, SoftBody};
use crate::model::deformable::BoundingBoxSettings;
use crate::scene::Pose;
use chainmail::{Counts, Interval, Limits};
use free_form::FreeForm;
use lattice::Lattice;
use push::{Cells, Guide, Pushes, Scene};
use std::sync::Arc;

/// The largest number of rounds: a first one, and others that push farther what still collides.
const ROUNDS: u32 = 12;

/// How much farther a colliding triangle is pushed in a round at least, as a share of the least spacing of the lattice.
const STEP: f64 = 0.1;

/// How far beyond the clearance points are pushed, as a share of the least spacing of the lattice.
const BEYOND: f64 = 0.02;

/// Deforms a robot by its bounding box.
pub struct BoundingBox {
    body: SoftBody,
    settings: BoundingBoxSettings,
    highest_energy: f64,
    clearance: f64,
    rays: Rays,
    obstacles: Arc<Obstacles>,
    lattice: Lattice,
    limits: Limits,
    free_form: FreeForm,
    cells: Cells,
    /// The guide of all poses at which the centre of the box is free.
    centre: Guide,
}

/// How one shape was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BoundingBoxWork {
    /// Rounds of pushing.
    pub rounds: u32,
    /// Intervals of lattice points that were looked at.
    pub narrowings: u64,
    /// Points that breadth-first searches came to.
    pub searched: u64,
}

impl BoundingBox {
    /// Prepares the deformation of a robot among obstacles. Shapes with a higher energy than `highest_energy` are refused, and such as
    /// are nearer to an obstacle than `clearance`; both are lengths. The energy is the sum of the displacements of all lattice points.
    ///
    /// # Errors
    /// What is wrong with the settings ([`BoundingBoxSettings::complaint`]), or with a length: it is negative or no number.
    pub fn new(
        body: &SoftBody,
        settings: &BoundingBoxSettings,
        highest_energy: f64,
        clearance: f64,
        obstacles: Arc<Obstacles>,
    ) -> Result<BoundingBox, String> {
        if let Some((key, message)) = settings.complaint() {
            return Err(format!("{key}: {message}"));
        }
        lengths(highest_energy, clearance)?;
        let lattice = Lattice::around(body.mesh(), settings.lattice);
        Ok(BoundingBox {
            limits: Limits::new(settings, lattice.spacing),
            free_form: FreeForm::new(&lattice, settings.interpolation, body.vertices()),
            cells: Cells::new(&lattice, body.vertices()),
            centre: Guide::centre(&lattice),
            lattice,
            body: body.clone(),
            settings: settings.clone(),
            highest_energy,
            clearance,
            rays: Rays::FromRobot,
            obstacles,
        })
    }

    /// The same with rays cast from elsewhere; from the robot, unless something else is said.
    pub fn with_rays(self, rays: Rays) -> BoundingBox {
        BoundingBox { rays, ..self }
    }

    /// See [`Deform::deform`]; and what was done, for measurements.
    ///
    /// # Errors
    /// Why there is no shape.
    pub fn deform_counted(
        &self,
        pose: &Pose,
        work: &mut BoundingBoxWork,
    ) -> Result<Deformed, Refusal> {
        let rest = self.body.vertices();
        let mut in_world: Vec<[f64; 3]> = rest.iter().map(|vertex| pose.apply(*vertex)).collect();
        if self.is_free(&in_world) {
            return Ok(Deformed { vertices: rest.to_vec(), energy: 0.0 });
        }
        let obstacles = self.obstacles.as_ref();
        let least = self.lattice.spacing.iter().fold(f64::INFINITY, |a, b| f64::min(a, *b));
        let (clearance, beyond) = (self.clearance, self.clearance + BEYOND * least);
        let scene = Scene { obstacles, pose, clearance, beyond };
        let guide = Guide::choose(&self.lattice, &self.centre, &scene).ok_or(Refusal::NoGuide)?;
        let mut pushes = Pushes::new(&self.lattice, &self.cells, rest, self.rays, guide, &scene);
        let step = STEP * least;
        let mut vertices = rest.to_vec();
        for round in 0..ROUNDS {
            // Where no ray meets anything the first round has nothing to push.
            let is_to_deepen = round > 0 || pushes.shares.iter().all(|share| *share == 0.0);
            if is_to_deepen && !pushes.deepen(&self.cells, &self.body, &vertices, step, &scene) {
                return Err(Refusal::Collides);
            }
            work.rounds += 1;
            let displacements = self.displacements(&pushes, work)?;
            for (index, vertex) in vertices.iter_mut().enumerate() {
                let by = self.free_form.displacement(&self.lattice, &displacements, index);
                *vertex = [0, 1, 2].map(|k| rest[index][k] + by[k]);
                in_world[index] = pose.apply(*vertex);
            }
            if self.is_free(&in_world) {
                let energy = energy(&displacements);
                if energy > self.highest_energy {
                    return Err(Refusal::Energy(energy));
                }
                return Ok(Deformed { vertices, energy });
            }
        }
        Err(Refusal::Collides)
    }

    /// Where ChainMail and relaxation put the lattice points.
    fn displacements(
        &self,
        pushes: &Pushes,
        work: &mut BoundingBoxWork,
    ) -> Result<Vec<[f64; 3]>, Refusal> {
        let mut intervals = vec![Interval::ALL; self.lattice.points.len()];
        let mut demanded = Vec::new();
        for (index, interval) in intervals.iter_mut().enumerate() {
            if pushes.guide.held.binary_search(&index).is_ok() {
                *interval = Interval::HELD;
            } else if let Some(vector) = pushes.vector(index) {
                *interval = Interval::pushed(vector);
            } else {
                continue;
            }
            demanded.push(index);
        }
        let mut counts = Counts::default();
        let narrowed = chainmail::narrow(
            self.settings.order,
            &self.lattice,
            &self.limits,
            &demanded,
            &mut intervals,
            &mut counts,
        );
        work.narrowings += counts.narrowings;
        work.searched += counts.searched;
        narrowed.map_err(|_| Refusal::Limits)?;
        let mut displacements: Vec<[f64; 3]> =
            intervals.iter().map(|interval| interval.nearest([0.0; 3])).collect();
        relaxation::relax(&self.lattice, &intervals, self.settings.relaxation, &mut displacements);
        Ok(displacements)
    }

    fn is_free(&self, in_world: &[[f64; 3]]) -> bool {
        self.obstacles.is_free_body(&self.body, in_world, self.clearance)
    }
}

impl Deform for BoundingBox {
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
        self.deform_counted(pose, &mut BoundingBoxWork::default())
    }
}

/// The sum of all lengths.
fn energy(displacements: &[[f64; 3]]) -> f64 {
    displacements.iter().map(|[x, y, z]| (x * x + y * y + z * z).sqrt()).sum()
}
