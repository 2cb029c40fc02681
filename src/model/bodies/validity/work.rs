//! What motions are made of, for benches.

/// Steps of the search for what is in the way of motions. They are counted with the feature `counts` alone,
/// and stay zero without it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Tests of the ball around what moves against a box that stands still.
    pub balls: u64,
    /// Boxes that were placed at both ends of a chord.
    pub placed: u64,
    /// Tests of such a box against one that stands still.
    pub boxes: u64,
    /// How often such tests were done, up to four at once.
    pub batches: u64,
    /// Looks at where the robot stands at one sample.
    pub looks: u64,
    /// Pairs of elements.
    pub pairs: u64,
    /// Samples at which pairs of elements were looked at.
    pub advances: u64,
}

impl Work {
    #[inline(always)]
    pub(super) fn count(&mut self, note: impl FnOnce(&mut Work)) {
        if cfg!(feature = "counts") {
            note(self);
        }
    }

    /// So many tests of boxes at once.
    pub(super) fn tested(&mut self, boxes: usize) {
        self.boxes += boxes as u64;
        self.batches += 1;
    }
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Work) {
        self.balls += other.balls;
        self.placed += other.placed;
        self.boxes += other.boxes;
        self.batches += other.batches;
        self.looks += other.looks;
        self.pairs += other.pairs;
        self.advances += other.advances;
    }
}
