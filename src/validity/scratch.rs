use super::frame::Stance;
use super::swept::{Stacks, Timeline};
use super::work::Work;
use crate::scene::Pose;
use bincode::{Decode, Encode};

/// Numbers of validity checks, counted by those that ask for them: a measure of cost that is the same on every
/// machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Encode, Decode)]
pub struct Asked {
    /// Configurations whose validity was asked for.
    pub configurations: u64,
    /// Motions whose validity was asked for.
    pub motions: u64,
}

impl std::ops::AddAssign for Asked {
    fn add_assign(&mut self, other: Asked) {
        self.configurations += other.configurations;
        self.motions += other.motions;
    }
}

/// Working memory of one thread: buffers and counters.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// The validity checks asked for with this scratch since the last [`Scratch::take_asked`].
    pub(crate) asked: Asked,
    /// The poses of the links at the configuration at hand.
    pub(super) stance: Stance,
    /// Their poses at the samples of the motion at hand.
    pub(super) timeline: Timeline,
    pub(super) stacks: Stacks,
    /// A configuration on the motion at hand.
    pub(crate) between: Vec<f64>,
}

impl Scratch {
    /// Fresh memory.
    pub fn new() -> Scratch {
        Scratch::default()
    }

    /// The counters since the last call.
    pub fn take_asked(&mut self) -> Asked {
        std::mem::take(&mut self.asked)
    }

    /// The counts of collision tests since the last call; see [`Work`].
    pub fn take_work(&mut self) -> Work {
        std::mem::take(&mut self.stacks.work)
    }

    /// Fills the memory with rubbish, for tests of the law that what a scratch remembers changes no verdict.
    #[doc(hidden)]
    pub fn poison(&mut self, rubbish: u64) {
        let nowhere = Pose { translation: [f64::NAN; 3], rotation: [0.0; 4] };
        self.stance.poses = vec![nowhere; rubbish as usize % 5];
        self.stance.frames.clear();
        self.timeline.poison(rubbish);
        self.stacks.poison(rubbish);
        self.between = vec![f64::NAN; rubbish as usize % 13];
    }
}
