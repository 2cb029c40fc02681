use crate::scene::Pose;
use bincode::{Decode, Encode};

/// What was asked of validity checking, counted where it is asked for: a measure of cost that is
/// the same on every machine.
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

/// A collision.
#[derive(Clone, Copy, Debug)]
pub(super) enum Hit {
    /// Of a piece of the robot with an obstacle.
    Obstacle { piece: usize, obstacle: usize },
    /// Of two pieces of the robot.
    Own { pair: usize },
}

/// Working memory of one thread: buffers, counters, and what blocked last.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// What was asked through this scratch since [`Scratch::take_asked`].
    pub(crate) asked: Asked,
    /// What collided last, tried first the next time.
    pub(super) last_hit: Option<Hit>,
    /// Where the links stand.
    pub(super) poses: Vec<Pose>,
    /// A configuration between two others.
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

    /// Fills the memory with rubbish that could mislead: for tests of the law that it never does.
    #[doc(hidden)]
    pub fn poison(&mut self, rubbish: u64) {
        self.last_hit = match rubbish % 4 {
            0 => None,
            1 => Some(Hit::Obstacle { piece: usize::MAX, obstacle: usize::MAX }),
            2 => Some(Hit::Own { pair: rubbish as usize / 8 % 16 }),
            _ => Some(Hit::Obstacle {
                piece: rubbish as usize / 4 % 2,
                obstacle: rubbish as usize / 8 % 16,
            }),
        };
        let nowhere = Pose { translation: [f64::NAN; 3], rotation: [0.0; 4] };
        self.poses = vec![nowhere; rubbish as usize % 5];
        self.between = vec![f64::NAN; rubbish as usize % 13];
    }
}
