//! Stretches of a motion, in time and in samples.

/// A stretch of time, from 0 at the beginning of the motion to 1 at its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub from: f32,
    pub to: f32,
}

impl Span {
    pub const ALL: Span = Span { from: 0.0, to: 1.0 };

    #[inline(always)]
    pub fn length(self) -> f32 {
        self.to - self.from
    }

    /// The least stretch that holds both.
    #[inline(always)]
    pub fn with(self, other: Span) -> Span {
        Span { from: self.from.min(other.from), to: self.to.max(other.to) }
    }

    /// Whether it holds any of the samples 0 to `last`, the ends of the motion.
    #[inline(always)]
    pub fn holds_any(self, last: u64) -> bool {
        let [from, to] = self.within(last);
        from.ceil() <= to.floor()
    }

    /// Its ends in units of samples.
    #[inline(always)]
    fn within(self, last: u64) -> [f64; 2] {
        let last = last as f64;
        [f64::from(self.from) * last, f64::from(self.to) * last]
    }
}

/// A stretch of samples, both ends included.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleRange {
    pub from: u64,
    pub to: u64,
}

impl SampleRange {
    /// Number of steps in it.
    #[inline(always)]
    pub fn length(self) -> u64 {
        self.to - self.from
    }

    /// The least stretch of the samples 0 to `last` that holds a span of time.
    #[inline(always)]
    pub fn around(span: Span, last: u64) -> SampleRange {
        let [from, to] = span.within(last);
        // By way of signed integers, which the samples fit: that conversion is a single instruction.
        SampleRange { from: from.max(0.0) as i64 as u64, to: (to as i64 as u64 + 1).min(last) }
    }
}
