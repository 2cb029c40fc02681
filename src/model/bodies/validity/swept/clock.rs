//! The poses of the links at the samples of a motion, computed once and kept in a small cache.

use crate::model::bodies::robot::Robot;
use crate::model::bodies::validity::frame::Stance;
use crate::space::{Space, Way};

/// The memory of that cache, used for one motion after the other.
#[derive(Clone, Debug, Default)]
pub(in crate::model::bodies::validity) struct Timeline {
    /// SampleRange and the poses there.
    slots: Vec<(u64, Stance)>,
    /// A configuration, while its poses are computed.
    q: Vec<f64>,
}

/// Binary logarithm of the number of slots. A search visits a handful of samples, some of them many times.
const SLOTS_LOG: u32 = 6;

impl Timeline {
    /// Fills the memory with rubbish, see [`ModelScratch::poison`](crate::model::ModelScratch::poison).
    pub fn poison(&mut self, rubbish: u64) {
        self.slots = vec![(rubbish % 50, Stance::default()); rubbish as usize % 3];
        self.q = vec![f64::NAN; rubbish as usize % 13];
    }
}

/// A motion cut into `samples` equal steps, sample 0 being its beginning.
pub(in crate::model::bodies::validity) struct Clock<'a> {
    space: &'a Space,
    robot: &'a Robot,
    a: &'a [f64],
    b: &'a [f64],
    /// The motion between the ends, prepared for interpolation when a sample between them is first needed.
    way: Option<Way<'a>>,
    pub samples: u64,
    /// A bit for every slot that holds poses of this motion, not of an earlier one.
    held: u64,
    timeline: &'a mut Timeline,
}

impl<'a> Clock<'a> {
    pub fn new(
        space: &'a Space,
        robot: &'a Robot,
        (a, b): (&'a [f64], &'a [f64]),
        samples: u64,
        timeline: &'a mut Timeline,
    ) -> Clock<'a> {
        timeline.slots.resize(1 << SLOTS_LOG, (0, Stance::default()));
        timeline.q.resize(a.len(), 0.0);
        Clock { space, robot, a, b, way: None, samples, held: 0, timeline }
    }

    /// Where the links stand at a sample.
    pub fn at(&mut self, sample: u64) -> &Stance {
        // Fibonacci hashing: samples are often multiples of large powers of two, which it spreads over the slots.
        let slot = sample.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (u64::BITS - SLOTS_LOG);
        let Timeline { slots, q } = &mut *self.timeline;
        let (held, stance) = &mut slots[slot as usize];
        if *held != sample || self.held & (1 << slot) == 0 {
            *held = sample;
            self.held |= 1 << slot;
            let q = if sample == 0 {
                self.a
            } else if sample == self.samples {
                self.b
            } else {
                let way = self.way.get_or_insert_with(|| self.space.way(self.a, self.b));
                way.at(sample as f64 / self.samples as f64, q);
                q
            };
            self.robot.link_poses(q, &mut stance.poses);
            stance.update_frames();
        }
        stance
    }
}
