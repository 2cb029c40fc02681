//! How many tests of each kind collision detection takes, for benches.

/// Numbers of tests that checks of motions take. They are counted with the feature `counts` and in the library's own
/// tests alone, and stay zero elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Tests of the moving tree's bounding sphere against a standing box.
    pub balls: u64,
    /// Moving boxes that were placed at both ends of a chord.
    pub placed: u64,
    /// Tests of such a box against a standing box.
    pub boxes: u64,
    /// Batches of up to four such tests, which are done at once.
    pub batches: u64,
    /// Collision checks of single samples during a search.
    pub looks: u64,
    /// Pairs of elements tested by conservative advancement.
    pub pairs: u64,
    /// Samples at which the distances of these pairs were computed.
    pub advances: u64,
}

impl Work {
    /// Runs `note`, which counts something, if counting is on.
    #[inline(always)]
    pub(super) fn count(&mut self, note: impl FnOnce(&mut Work)) {
        if cfg!(any(test, feature = "counts")) {
            note(self);
        }
    }

    /// Counts a batch of that many tests of boxes.
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
