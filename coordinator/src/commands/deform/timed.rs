use crate::cpu::Meter;
use roadmill::deformation::{Deform, Deformed, Refusal};
use roadmill::scene::Pose;
use std::cell::Cell;

/// A method of deformation under the clock.
pub(super) struct Timed<'a> {
    method: &'a dyn Deform,
    meter: Cell<Meter>,
}

impl<'a> Timed<'a> {
    pub fn new(method: &'a dyn Deform) -> Timed<'a> {
        Timed { method, meter: Cell::default() }
    }

    /// CPU seconds of deforming so far.
    pub fn seconds(&self) -> f64 {
        self.meter.get().seconds()
    }

    fn timed<T>(&self, work: impl FnOnce() -> T) -> T {
        let begun = Meter::begin();
        let done = work();
        let mut meter = self.meter.get();
        meter.end(begun);
        self.meter.set(meter);
        done
    }
}

impl Deform for Timed<'_> {
    fn deform(&self, pose: &Pose) -> Result<Deformed, Refusal> {
        self.timed(|| self.method.deform(pose))
    }

    fn accepts_blend(&self, pose: &Pose, vertices: &[[f64; 3]]) -> bool {
        self.timed(|| self.method.accepts_blend(pose, vertices))
    }
}
