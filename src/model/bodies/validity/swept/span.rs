//! Stretches of a motion.

/// A stretch of time, in shares of the motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub from: f32,
    pub to: f32,
}

impl Span {
    pub const ALL: Span = Span { from: 0.0, to: 1.0 };

    pub fn length(self) -> f32 {
        self.to - self.from
    }

    pub fn with(self, other: Span) -> Span {
        Span { from: self.from.min(other.from), to: self.to.max(other.to) }
    }

    /// Whether any sample is in it.
    pub fn holds_any(self, last: u64) -> bool {
        let [from, to] = self.within(last);
        from.ceil() <= to.floor()
    }

    /// In samples.
    fn within(self, last: u64) -> [f64; 2] {
        [self.from, self.to].map(|time| f64::from(time) * last as f64)
    }
}

/// A stretch of samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Samples {
    pub from: u64,
    pub to: u64,
}

impl Samples {
    pub fn length(self) -> u64 {
        self.to - self.from
    }

    /// Those of so many that hold a span, the last one being the end of the motion.
    pub fn around(span: Span, last: u64) -> Samples {
        let [from, to] = span.within(last);
        // Samples fit signed integers, to which conversion is one instruction.
        Samples { from: from.max(0.0) as i64 as u64, to: (to as i64 as u64 + 1).min(last) }
    }
}
