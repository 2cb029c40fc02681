//! Where the links stand at the samples of a motion.

use crate::robot::Robot;
use crate::space::Way;
use crate::validity::frame::Stance;

/// Memory for stances of one motion.
#[derive(Clone, Debug, Default)]
pub(in crate::validity) struct Timeline {
    slots: Vec<(u64, Stance)>,
    q: Vec<f64>,
}

/// A power of two; a motion is looked at in a handful of samples, but some of them often.
const SLOTS_LOG: u32 = 6;
const EMPTY: u64 = u64::MAX;

impl Timeline {
    /// Rubbish, see [`Scratch::poison`](crate::validity::Scratch::poison).
    pub fn poison(&mut self, rubbish: u64) {
        self.slots = vec![(rubbish % 50, Stance::default()); rubbish as usize % 3];
        self.q = vec![f64::NAN; rubbish as usize % 13];
    }
}

/// A motion cut into `samples` equal steps, sample 0 being its beginning.
pub(in crate::validity) struct Clock<'a> {
    way: Way<'a>,
    robot: &'a Robot,
    pub samples: u64,
    timeline: &'a mut Timeline,
}

impl<'a> Clock<'a> {
    pub fn new(
        way: Way<'a>,
        values: usize,
        robot: &'a Robot,
        samples: u64,
        timeline: &'a mut Timeline,
    ) -> Clock<'a> {
        timeline.slots.resize(1 << SLOTS_LOG, (EMPTY, Stance::default()));
        timeline.slots.iter_mut().for_each(|(sample, _)| *sample = EMPTY);
        timeline.q.resize(values, 0.0);
        Clock { way, robot, samples, timeline }
    }

    /// Where the links stand at a sample.
    pub fn at(&mut self, sample: u64) -> &Stance {
        // Samples are multiples of powers of two, which this spreads (Fibonacci hashing).
        let slot = sample.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (u64::BITS - SLOTS_LOG);
        let Timeline { slots, q } = &mut *self.timeline;
        let (held, stance) = &mut slots[slot as usize];
        if *held != sample {
            *held = sample;
            self.way.at(sample as f64 / self.samples as f64, q);
            self.robot.place(q, &mut stance.poses);
            stance.settle();
        }
        stance
    }
}
