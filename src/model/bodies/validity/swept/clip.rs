//! The times at which boxes may meet, for eight pairs of boxes at once: each separating axis excludes the times at
//! which there is a gap along it.

use super::span::Span;
use crate::model::bodies::validity::light::{Gaps, Three};
use fearless_simd::prelude::*;
use fearless_simd::{f32x8, f32x16};

/// The overlaps of eight pairs of boxes along an axis, each measured from either side (lanes 0 to 7 from one, 8 to 15
/// from the other), at the beginning and at the end of a chord. A negative overlap is a gap.
pub(super) struct Turned<S: Simd> {
    begin: f32x16<S>,
    end: f32x16<S>,
}

impl<S: Simd> Turned<S> {
    #[inline(always)]
    pub fn new(Gaps(below, above): Gaps<f32x16<S>>) -> Turned<S> {
        let ((a, b), (c, d)) = (below.split(), above.split());
        Turned { begin: a.combine(c), end: b.combine(d) }
    }

    /// Negative where boxes are apart at both ends on the same side, and so during the whole chord.
    #[inline(always)]
    pub fn both(&self) -> f32x16<S> {
        self.begin.max(self.end)
    }
}

#[inline(always)]
pub(super) fn turned<S: Simd>([a, b, c]: Three<Gaps<f32x16<S>>>) -> [Turned<S>; 3] {
    [Turned::new(a), Turned::new(b), Turned::new(c)]
}

#[inline(always)]
pub(super) fn least<S: Simd>([a, b, c]: &[Turned<S>; 3]) -> f32x16<S> {
    a.both().min(b.both()).min(c.both())
}

/// A bit for each of the eight pairs that are apart, on either side.
#[inline(always)]
pub(super) fn apart<S: Simd>(overlap: f32x16<S>) -> u32 {
    let sides = overlap.simd_lt(0.0).to_bitmask() as u32;
    (sides | sides >> 8) & 255
}

/// Eight spans.
#[derive(Clone, Copy)]
pub(super) struct Spans<S: Simd> {
    from: f32x8<S>,
    to: f32x8<S>,
}

impl<S: Simd> Spans<S> {
    #[inline(always)]
    pub fn new(simd: S, [a, b, c, d, e, f, g, h]: [Span; 8]) -> Spans<S> {
        let from = [a.from, b.from, c.from, d.from, e.from, f.from, g.from, h.from];
        let to = [a.to, b.to, c.to, d.to, e.to, f.to, g.to, h.to];
        Spans { from: f32x8::load_array(simd, from), to: f32x8::load_array(simd, to) }
    }

    #[inline(always)]
    pub fn same(simd: S, span: Span) -> Spans<S> {
        Spans { from: f32x8::splat(simd, span.from), to: f32x8::splat(simd, span.to) }
    }
}

/// When each of eight pairs of boxes may meet.
#[derive(Clone, Copy)]
pub(super) struct Met {
    /// A bit for each pair that may meet at all.
    lanes: u32,
    from: [f32; 8],
    to: [f32; 8],
}

impl Met {
    pub const NOTHING: Met = Met { lanes: 0, from: [0.0; 8], to: [0.0; 8] };

    /// The pairs among the first `count` that may meet, and when.
    #[inline(always)]
    pub fn spans(&self, count: usize) -> impl Iterator<Item = (usize, Span)> {
        let mut rest = self.lanes & ((1 << count) - 1);
        std::iter::from_fn(
            #[inline(always)]
            move || {
                let lane = rest.trailing_zeros() as usize;
                rest &= rest.wrapping_sub(1);
                (lane < 8).then(|| (lane, Span { from: self.from[lane], to: self.to[lane] }))
            },
        )
    }
}

/// The stretch of a chord in which each pair may meet, from 0 at its beginning to 1 at its end, by the overlaps from
/// either side (lanes as in [`Turned`]).
pub(super) struct Clip<S: Simd> {
    low: f32x16<S>,
    high: f32x16<S>,
}

/// More than rounding can move the ends of a stretch, as a share of the chord.
const CHORD_MOMENT: f32 = 1e-6;
/// The same as a share of the motion.
pub(super) const MOMENT: f32 = 3e-7;

impl<S: Simd> Clip<S> {
    #[inline(always)]
    pub fn whole(simd: S) -> Clip<S> {
        Clip { low: f32x16::splat(simd, 0.0), high: f32x16::splat(simd, 1.0) }
    }

    /// Excludes the times at which there is a gap. Overlaps are linear in time, and not negative at both ends.
    #[inline(always)]
    pub fn cut(&mut self, Turned { begin, end }: &Turned<S>) {
        let crossing = *begin / (*begin - *end);
        self.low = begin.simd_lt(0.0).select(self.low.max(crossing), self.low);
        self.high = end.simd_lt(0.0).select(self.high.min(crossing), self.high);
    }

    #[inline(always)]
    pub fn cut_all(&mut self, [a, b, c]: &[Turned<S>; 3]) {
        self.cut(a);
        self.cut(b);
        self.cut(c);
    }

    /// What is left of the spans in which the pairs of `lanes` were thought to meet, the stretch being one of
    /// `chord`.
    #[inline(always)]
    pub fn met(self, simd: S, lanes: u32, chord: Span, spans: &Spans<S>) -> Met {
        let (low, high) = (self.low.split(), self.high.split());
        let (low, high) = (low.0.max(low.1), high.0.min(high.1));
        let length = f32x8::splat(simd, chord.length());
        let slack = chord.length() * CHORD_MOMENT + MOMENT;
        let low = low.mul_add(length, f32x8::splat(simd, chord.from - slack));
        let high = high.mul_add(length, f32x8::splat(simd, chord.from + slack));
        let from = low.max(spans.from);
        let to = high.min(spans.to);
        let left = from.simd_le(to).to_bitmask() as u32;
        Met { lanes: lanes & left, from: from.to_array(), to: to.to_array() }
    }
}
