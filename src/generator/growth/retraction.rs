use super::set::{Extension, GrowingSet};
use super::tree::Near;
use crate::push::{Search, retract};
use crate::space::Space;

/// The length of the first random step, as a share of the straight extension's length.
const FIRST: f64 = 0.3;
/// By what the length of the random steps is multiplied after a valid motion, and after a blocked one. With these two it
/// neither grows nor shrinks where about two in five motions are valid.
const LONGER: f64 = 1.5;
const SHORTER: f64 = 0.75;
/// How many random steps are drawn for one motion, of which half and more lead away from where the extension is to lead.
const DRAWS: u32 = 8;
/// By how much a bent extension must come nearer, as a share of the straight one's length.
const LEAST: f64 = 0.05;
/// The step of a retraction, as a share of the step of extensions.
const RETRACTING: f64 = 0.2;
/// How long a bent extension may be, as a share of the straight one's length.
const LONGEST: f64 = 1.5;

impl GrowingSet<'_> {
    /// [`GrowingSet::extend_straight`], and where that is blocked the extension bent aside: from the same place to a
    /// configuration nearer to `toward` that a straight motion of at most one and a half times its length leads to, so that trees
    /// get on along obstacles and through narrow places.
    ///
    /// L. Zhang and D. Manocha (*An efficient retraction-based RRT planner*, ICRA 2008) retract the blocked configuration to
    /// the nearest one in contact, and follow the contact by its geometry. Here the same is looked for by trial, which needs
    /// no more than whether motions are valid and so suits every model: a (1+1) evolution strategy (H.-G. Beyer, H.-P. Schwefel,
    /// *Evolution strategies: a comprehensive introduction*, Natural Computing 1, 2002) whose steps get longer after a success
    /// and shorter after a failure. At most as many motions are tried as the set has `trials` for one extension; without
    /// trials it is the straight extension.
    pub fn extend(&mut self, from: Near, toward: &[f64]) -> Extension {
        let straight = self.extend_straight(from, toward);
        if straight != Extension::Trapped {
            return straight;
        }
        let retracted = if self.retracts { self.retracted(from, toward) } else { None };
        if let Some(number) = retracted.and_then(|q| self.add_reached_from(from, &q)) {
            return Extension::Advanced(number);
        }
        if self.trials == 0 {
            return straight;
        }
        if self.slides() {
            return self.slide(from, toward);
        }
        let bent = self.bend(from, toward);
        bent.and_then(|q| self.add_reached_from(from, &q))
            .map_or(Extension::Trapped, Extension::Advanced)
    }

    /// The end of the straight extension retracted to contact, if it comes nearer by enough.
    fn retracted(&mut self, from: Near, toward: &[f64]) -> Option<Vec<f64>> {
        let space: &Space = &self.cx.space;
        let reach = self.step.min(from.distance);
        let mut end = toward.to_vec();
        if from.distance > self.step {
            space.interpolate(
                self.config(from.number),
                toward,
                self.step / from.distance,
                &mut end,
            );
            space.canonicalize(&mut end).ok()?;
        }
        // Retraction draws nothing.
        let stream = self.proposing.clone();
        let (cx, scratch) = (self.cx, &mut *self.scratch);
        let mut search =
            Search { cx, scratch, stream, step: RETRACTING * self.step, reach, effort: 0 };
        let q = retract(&end, &mut search)?;
        (space.distance(&q, toward) <= from.distance - LEAST * reach).then_some(q)
    }

    /// The end of the extension bent aside, if it comes nearer by enough.
    fn bend(&mut self, from: Near, toward: &[f64]) -> Option<Vec<f64>> {
        let start = self.config(from.number).to_vec();
        let reach = self.step.min(from.distance);
        let (mut best, mut left) = (start.clone(), from.distance);
        let mut length = FIRST * reach;
        for _ in 0..self.trials {
            let valid = self
                .nearer([&start, &best, toward], [left, length, LONGEST * reach])
                .filter(|(q, _)| {
                    self.cx.model.is_valid(q, self.scratch)
                        && self.cx.model.motion(&start, q, 1, self.scratch).is_some()
                });
            length *= if valid.is_some() { LONGER } else { SHORTER };
            if let Some(found) = valid {
                (best, left) = found;
            }
        }
        let is_enough = left < from.distance && left <= from.distance - LEAST * reach;
        is_enough.then_some(best)
    }

    /// A configuration a random step of `length` away from `best` and at most `longest` away from `start`, whose distance to
    /// `toward` is less than `left`; and that distance. `None` where several draws give none.
    fn nearer(
        &mut self,
        [start, best, toward]: [&[f64]; 3],
        [left, length, longest]: [f64; 3],
    ) -> Option<(Vec<f64>, f64)> {
        let space: &Space = &self.cx.space;
        let mut q = best.to_vec();
        (0..DRAWS).find_map(|_| {
            space.step(best, length, &mut self.proposing, &mut q);
            let distance = space.distance(&q, toward);
            let is_nearer = distance < left && space.distance(start, &q) <= longest;
            is_nearer.then(|| (q.clone(), distance))
        })
    }
}
