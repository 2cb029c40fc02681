use super::frame::Stance;
use super::swept::{Stacks, Timeline};
use super::work::Work;
use crate::model::ModelScratch;
use crate::scene::Pose;

/// Working memory for judging configurations and motions of bodies.
#[derive(Clone, Debug, Default)]
pub struct BodyScratch {
    /// Where the links stand.
    pub(super) stance: Stance,
    /// Where they stand during a motion.
    pub(super) timeline: Timeline,
    pub(super) stacks: Stacks,
    /// A configuration between two others.
    pub(super) between: Vec<f64>,
}

impl BodyScratch {
    /// The steps since the last call; see [`Work`].
    pub fn take_work(&mut self) -> Work {
        std::mem::take(&mut self.stacks.work)
    }
}

impl ModelScratch for BodyScratch {
    fn poison(&mut self, rubbish: u64) {
        let nowhere = Pose { translation: [f64::NAN; 3], rotation: [0.0; 4] };
        self.stance.poses = vec![nowhere; rubbish as usize % 5];
        self.stance.frames.clear();
        self.timeline.poison(rubbish);
        self.stacks.poison(rubbish);
        self.between = vec![f64::NAN; rubbish as usize % 13];
    }
}
