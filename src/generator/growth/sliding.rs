use super::set::{Extension, GrowingSet};
use super::tree::Near;
use crate::math;

/// The first random step is 0.3 times as long as the straight extension, or shorter: down to a hundredth of that, every order of magnitude
/// as often as another, since nothing says beforehand how narrow the place is.
const FIRST: f64 = 0.3;
const SPAN: f64 = 100.0;
/// By what the length of the random steps is multiplied after a valid motion, and after a blocked one.
const LONGER: f64 = 1.5;
const SHORTER: f64 = 0.75;
/// How many random steps are drawn for one motion, of which half and more lead away from where the extension is to lead.
const DRAWS: u32 = 8;
/// How many more motions may be tried after each valid one, and how many for one extension in all.
const BONUS: u32 = 2;
const MOST: u32 = 100;
/// With which probability a step goes on in the direction of the last valid one, but for a random part of this share of its length.
const ONWARD: f64 = 0.4;
const ASIDE: f64 = 0.3;
/// How far a slide may lead away from where it began, as a share of the straight extension's length.
const LONGEST: f64 = 1.5;
/// By how much a slide must come nearer, as a share of its first step.
const LEAST: f64 = 0.05;

/// A slide that has come to a configuration by valid motions.
struct Slide {
    /// The place from which a straight motion leads to where the slide is.
    anchor: u32,
    anchored: Vec<f64>,
    /// Where it is, and where it was before.
    at: Vec<f64>,
    before: Option<Vec<f64>>,
    /// The distance that is left to where the extension is to lead.
    left: f64,
    /// The length of the next step.
    length: f64,
}

impl GrowingSet<'_> {
    /// A blocked extension that slides along what blocks it: from a place toward a configuration in random steps, each to a configuration nearer to
    /// `toward`, with milestones where the way turns. The last milestone is what is given back; those before it have the numbers just below.
    ///
    /// As in [`GrowingSet::extend`] the steps are those of a (1+1) evolution strategy, whose steps get longer after a success and shorter
    /// after a failure. Different is that a slide need not be seen from where it began: where the straight motion from the last milestone is
    /// blocked, but that from where the slide is now is not, the latter becomes a milestone. So a slide gets around corners. It is
    /// tried longer the better it goes: each valid motion earns it more.
    pub(super) fn slide(&mut self, from: Near, toward: &[f64]) -> Extension {
        let start = self.config(from.number).to_vec();
        let reach = self.step.min(from.distance);
        let first = FIRST * reach * math::exp(-math::ln(SPAN) * self.proposing.unit());
        let mut slide = Slide {
            anchor: from.number,
            anchored: start.clone(),
            at: start.clone(),
            before: None,
            left: from.distance,
            length: first,
        };
        let (mut budget, mut tried, mut last) = (self.trials, 0, None);
        while budget > 0 && tried < MOST && !self.is_full() {
            (budget, tried) = (budget - 1, tried + 1);
            let next = self.next_of(&slide, [&start, toward], LONGEST * reach);
            let is_valid =
                next.as_ref().is_some_and(|(q, _)| self.follows(&mut slide, q, &mut last));
            slide.length *= if is_valid { LONGER } else { SHORTER };
            if let Some((q, left)) = next.filter(|_| is_valid) {
                slide.before = Some(std::mem::replace(&mut slide.at, q));
                slide.left = left;
                budget += BONUS;
            }
        }
        let is_nearer = slide.left <= from.distance - LEAST * first;
        if is_nearer && slide.at != slide.anchored && !self.is_full() {
            last = self.reached(&slide).or(last);
        }
        last.map_or(Extension::Trapped, Extension::Advanced)
    }

    /// Where a slide may go next: a configuration a step away, nearer to `toward` than it is now and at most `longest` away from `start`; and
    /// the distance that is then left. `None` where several draws give none.
    fn next_of(
        &mut self,
        slide: &Slide,
        [start, toward]: [&[f64]; 2],
        longest: f64,
    ) -> Option<(Vec<f64>, f64)> {
        let space = &self.cx.space;
        let mut q = slide.at.clone();
        (0..DRAWS).find_map(|_| {
            let onward = slide.before.as_ref().filter(|_| self.proposing.unit() < ONWARD);
            match onward {
                Some(before) => {
                    let mut ahead = slide.at.clone();
                    let direction = space.displacement(before, &slide.at);
                    space.along(&slide.at, &direction, slide.length, &mut ahead);
                    space.step(&ahead, ASIDE * slide.length, &mut self.proposing, &mut q);
                }
                None => space.step(&slide.at, slide.length, &mut self.proposing, &mut q),
            }
            let left = space.distance(&q, toward);
            let is_nearer = left < slide.left && space.distance(start, &q) <= longest;
            is_nearer.then(|| (q.clone(), left))
        })
    }

    /// Whether a slide can go on to a configuration: seen from its anchor, or from where it is, which then becomes its anchor and a
    /// milestone, `last`.
    fn follows(&mut self, slide: &mut Slide, q: &[f64], last: &mut Option<u32>) -> bool {
        let model = &self.cx.model;
        if !model.is_valid(q, self.scratch) {
            return false;
        }
        if model.motion(&slide.anchored, q, 1, self.scratch).is_some() {
            return true;
        }
        if slide.at == slide.anchored || model.motion(&slide.at, q, 1, self.scratch).is_none() {
            return false;
        }
        let Some(milestone) = self.reached(slide) else { return false };
        (slide.anchor, slide.anchored) = (milestone, slide.at.clone());
        *last = Some(milestone);
        true
    }

    /// Makes where a slide is a milestone.
    fn reached(&mut self, slide: &Slide) -> Option<u32> {
        let from = Near { number: slide.anchor, distance: 0.0 };
        self.add_reached_from(from, &slide.at)
    }
}
