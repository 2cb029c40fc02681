use super::{GaveUp, Sampler, collect, collides, no_length, obstructed, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{Clearance, Scratch, Validity};
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use crate::space::{Direction, FactorKind};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Medial axis sampling: milestones as far from the nearest obstacle as from a second one (S. A. Wilmarth,
/// N. M. Amato, P. F. Stiller, *MAPRM: A probabilistic roadmap planner with sampling on the medial axis of
/// the free space*, 1999; J.-M. Lien, S. L. Thomas, N. M. Amato, *A general framework for sampling on the
/// medial axis of the free space*, 2003; TR05-007 §4.1).
///
/// Draws a configuration uniformly. If it collides, it is moved out of the obstacle by the least penetration. Then it is
/// pushed away from its witness, the nearest point of an obstacle, until another point of an obstacle is nearer, and
/// the last stretch of the push is bisected down to the tolerance.
///
/// *Clearance.* Of a robot whose base can be translated, the base is pushed straight away from the witness; rotation and
/// joints stay as they are. The clearance in the workspace is exactly the distance that the robot can be translated in
/// any direction, and it grows by the length of the push for as long as the witness stays the nearest point. So
/// clearance and push are exact for a robot that cannot turn, and else among the configurations with the same rotation
/// and joint values. (In spaces of many dimensions a few random directions would tell less at a higher price.) Where
/// the base cannot be pushed (a fixed base; nothing but links that must not touch one another; for a planar robot a
/// nearest obstacle above or below it), clearance is approximate: the least length of a walk to a collision, over
/// random directions.
///
/// *Penetration.* It is exact where moving to the nearest point of an obstacle's surface ends the collision, as for a
/// point inside a mesh or a box. Else it is approximate: the least length of a walk out of collision, over random
/// directions. Random directions are drawn anew for each configuration, come in opposite pairs, and lead through the
/// whole space, rotations and joints included.
///
/// A configuration that gets out of bounds is dropped, unless `bounds` says that being out of bounds is to collide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Maprm {
    /// Length of the steps of a walk in a random direction, and of the first push, in the space's metric. Walks may
    /// pass obstacles thinner than a step unnoticed; pushes do not.
    pub step: f64,
    /// The most by which the distances of a milestone from its two witnesses may differ.
    pub tolerance: f64,
    /// How many random directions: an even number.
    #[serde(default = "default_directions")]
    pub directions: u32,
    /// The most steps of a walk.
    #[serde(default = "default_steps")]
    pub steps: u32,
    /// Whether being out of bounds is to collide, so that milestones also lie between obstacles and bounds.
    #[serde(default)]
    pub bounds: bool,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

impl Maprm {
    /// The method with the settings that have no defaults; the others have theirs.
    pub fn new(step: f64, tolerance: f64) -> Maprm {
        Maprm {
            step,
            tolerance,
            directions: default_directions(),
            steps: default_steps(),
            bounds: false,
            attempts: default_attempts(),
        }
    }
}

fn default_directions() -> u32 {
    16
}

fn default_steps() -> u32 {
    1000
}

fn default_attempts() -> u64 {
    10_000
}

const DIRECTIONS_MAX: u32 = 1000;
/// The least tolerance, as a share of the step.
const FINEST: f64 = 1e-9;
/// The share of the tolerance that a push may use up; the rest is for the distances from the bounds, which are bisected.
const SHARE: f64 = 0.99;

impl Sampler for Maprm {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let mut pusher = Pusher {
            maprm: self,
            cx,
            stream: seed.stream(Purpose::Sampling),
            scratch,
            lines: Vec::new(),
            at: vec![0.0; cx.space.len()],
        };
        collect(count, self.attempts, out, |q| pusher.milestone(q))
    }

    fn complaint(&self) -> Option<Complaint> {
        let lengths =
            no_length("step", self.step).or_else(|| no_length("tolerance", self.tolerance));
        if lengths.is_some() {
            return lengths;
        }
        if !(self.step * FINEST..=self.step).contains(&self.tolerance) {
            let expected = "a billionth of the step up to the step";
            return Some(Complaint::new("tolerance", self.tolerance, expected));
        }
        if !(1..=DIRECTIONS_MAX).contains(&self.directions) || !self.directions.is_multiple_of(2) {
            return Some(Complaint::new(
                "directions",
                self.directions,
                "an even number, 2 to 1000",
            ));
        }
        zero("steps", self.steps).or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        obstructed(cx, self.bounds)
    }
}

/// Moves drawn configurations to the medial axis.
struct Pusher<'a> {
    maprm: &'a Maprm,
    cx: &'a Context,
    stream: Stream,
    scratch: &'a mut Scratch,
    /// Random lines through the configuration at hand, each for two opposite directions; drawn when first needed.
    lines: Vec<Direction>,
    /// The configuration that is checked at present.
    at: Vec<f64>,
}

/// How a robot is pushed away from its witness.
struct Way {
    /// Distance of the witness.
    distance: f64,
    /// The direction of the push, from the witness to the robot: a unit vector.
    away: [f64; 3],
    /// How far the base can be translated before the robot is out of bounds, in the negative and the positive
    /// direction of every axis; infinite if being out of bounds is not to collide.
    room: [[f64; 2]; 3],
}

/// A walk in a random direction to where it begins to collide, or ceases to.
struct Found {
    direction: usize,
    /// Length of the walk to just behind that place.
    length: f64,
}

impl Pusher<'_> {
    /// Draws a configuration and pushes it to the medial axis. Returns whether it got there.
    fn milestone(&mut self, q: &mut [f64]) -> bool {
        self.lines.clear();
        self.cx.space.sample_uniform(&mut self.stream, q);
        let Some(inside) = self.collides(q) else { return false };
        if inside && self.push_out(q).is_none() {
            return false;
        }
        let pushed = match self.way(q) {
            Some(way) => self.push(q, &way),
            None => self.push_back(q),
        };
        pushed.is_some() && self.cx.model.is_valid(q, self.scratch)
    }

    fn collides(&mut self, q: &[f64]) -> Option<bool> {
        collides(self.cx.model.validity(q, self.scratch), self.maprm.bounds)
    }

    /// The clearance, and the unit vector from the nearest point of an obstacle to that of the robot. Counts as one
    /// configuration asked for.
    fn clearance(&mut self, q: &[f64]) -> Option<(Clearance, [f64; 3])> {
        self.scratch.count_configuration();
        let clearance = self.cx.model.clearances()?.clearance(q, self.scratch)?;
        let way = [0, 1, 2].map(|i| clearance.on_robot[i] - clearance.on_obstacle[i]);
        let length = (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]).sqrt();
        Some((clearance, way.map(|value| value / length)))
    }

    /// Sets `at` to `q` with the base translated by `by` in the direction `away`.
    fn shift(&mut self, q: &[f64], away: &[f64; 3], by: f64) {
        self.at.copy_from_slice(q);
        let base = self.cx.space.translations();
        self.at[..base].iter_mut().zip(away).for_each(|(value, share)| *value += by * share);
    }

    /// Whether the base can be translated in a direction.
    fn leads(&self, away: &[f64; 3]) -> bool {
        let base = self.cx.space.translations();
        away.iter().all(|share| share.is_finite())
            && base > 0
            && away[base..].iter().all(|share| share.abs() < 1e-6)
    }

    /// Moves a colliding configuration out of the obstacles, to within the tolerance of their surface.
    fn push_out(&mut self, q: &mut [f64]) -> Option<()> {
        if let Some((clearance, away)) = self.clearance(q)
            && self.leads(&away)
        {
            self.shift(q, &away, -clearance.distance - self.maprm.tolerance / 2.0);
            let there = self.at.clone();
            if !self.collides(&there)? {
                q.copy_from_slice(&there);
                return Some(());
            }
        }
        let found = self.walk(q, true)?;
        self.go(q, found.direction, found.length);
        q.copy_from_slice(&self.at);
        Some(())
    }

    /// The push away from the witness, which may also be a side of the bounds; `None` if the base cannot be pushed.
    fn way(&mut self, q: &[f64]) -> Option<Way> {
        let base = self.cx.space.translations();
        let nearest = self.clearance(q).map(|(clearance, away)| (clearance.distance, away));
        if nearest.is_some_and(|(_, away)| !self.leads(&away)) {
            return None;
        }
        let mut room = [[f64::INFINITY; 2]; 3];
        if self.maprm.bounds {
            for (axis, room) in room.iter_mut().enumerate().take(base) {
                *room = [-1.0, 1.0].map(|side| self.room(q, axis, side));
            }
        }
        let walls = (0..base).flat_map(|axis| {
            [0, 1].map(|side| {
                let mut away = [0.0; 3];
                away[axis] = [1.0, -1.0][side];
                (room[axis][side], away)
            })
        });
        let (distance, away) =
            nearest.into_iter().chain(walls).min_by(|a, b| a.0.total_cmp(&b.0))?;
        distance.is_finite().then_some(Way { distance, away, room })
    }

    /// How far the base can be translated along an axis (`side` gives the sign) before the robot is out of bounds. Since
    /// the bounds are convex, that can be bisected.
    fn room(&mut self, q: &[f64], axis: usize, side: f64) -> f64 {
        let FactorKind::Real { min, max } = self.cx.space.factors()[axis].kind else { return 0.0 };
        let most = if side < 0.0 { q[axis] - min } else { max - q[axis] };
        let mut away = [0.0; 3];
        away[axis] = side;
        let inside = |pusher: &mut Self, by: f64| {
            pusher.shift(q, &away, by);
            let state = pusher.cx.model.validity(&pusher.at, pusher.scratch);
            Some(state != Validity::OutOfBounds)
        };
        // Checked a little closer, since rounding may put the very end out of bounds.
        if inside(self, most * (1.0 - 1e-12)) == Some(true) {
            return most;
        }
        let fine = (1.0 - SHARE) * self.maprm.tolerance;
        halve((0.0, most), fine, |by| inside(self, by)).map_or(0.0, |(near, _)| near)
    }

    /// Pushes the base until another point of an obstacle, or of the bounds, is nearer than the witness.
    fn push(&mut self, q: &mut [f64], way: &Way) -> Option<()> {
        // Balls around the pushed robot that touch the witness contain all earlier ones. So a point that is nearer than
        // the witness once stays nearer, and strides may be doubled without missing it.
        let maprm = self.maprm;
        let exit = self.exit(q, &way.away);
        if self.still_nearest(q, way, exit) {
            return None;
        }
        let (mut near, mut far) = (0.0, maprm.step.min(exit));
        while far < exit && self.still_nearest(q, way, far) {
            (near, far) = (far, exit.min(2.0 * far));
        }
        let nearest = |by: f64| Some(self.still_nearest(q, way, by));
        let (near, _) = halve((near, far), SHARE * maprm.tolerance, nearest)?;
        self.shift(q, &way.away, near);
        q.copy_from_slice(&self.at);
        Some(())
    }

    /// How far the base can be translated in a direction within its intervals.
    fn exit(&self, q: &[f64], away: &[f64; 3]) -> f64 {
        let base = self.cx.space.translations();
        let axes = self.cx.space.factors()[..base].iter().zip(q).zip(away);
        axes.fold(f64::INFINITY, |exit, ((part, value), share)| match part.kind {
            FactorKind::Real { max, .. } if *share > 0.0 => exit.min((max - value) / share),
            FactorKind::Real { min, .. } if *share < 0.0 => exit.min((min - value) / share),
            _ => exit,
        })
    }

    /// Whether, after a push of length `by`, the witness is still the nearest point up to the tolerance.
    fn still_nearest(&mut self, q: &[f64], way: &Way, by: f64) -> bool {
        let least = way.distance + by - SHARE * self.maprm.tolerance;
        let mut room = way.room.iter().zip(way.away);
        if !room.all(|([low, high], share)| low + by * share >= least && high - by * share >= least)
        {
            return false;
        }
        self.shift(q, &way.away, by);
        let there = self.at.clone();
        self.clearance(&there).is_none_or(|(clearance, _)| clearance.distance >= least)
    }

    /// Sets `at` to the configuration at distance `length` from `q` in one of the random directions.
    fn go(&mut self, q: &[f64], direction: usize, length: f64) {
        while self.lines.len() < self.maprm.directions as usize / 2 {
            self.lines.push(self.cx.space.direction(&mut self.stream));
        }
        let length = if direction.is_multiple_of(2) { length } else { -length };
        self.cx.space.along(q, &self.lines[direction / 2], length, &mut self.at);
    }

    /// Goes there and returns whether the configuration collides.
    fn look(&mut self, q: &[f64], direction: usize, length: f64) -> Option<bool> {
        self.go(q, direction, length);
        collides(self.cx.model.validity(&self.at, self.scratch), self.maprm.bounds)
    }

    /// Walks from `q`, which collides (`inside`) or is free, in all random directions at once until in one of them it is
    /// the other way round. If that happens in several directions at the same step, the shortest walk counts, then the
    /// direction drawn first.
    fn walk(&mut self, q: &[f64], inside: bool) -> Option<Found> {
        let maprm = self.maprm;
        let mut going: Vec<usize> = (0..maprm.directions as usize).collect();
        for step in 1..=maprm.steps {
            let (last, here) = (f64::from(step - 1) * maprm.step, f64::from(step) * maprm.step);
            let mut best: Option<Found> = None;
            let mut on = Vec::with_capacity(going.len());
            for direction in going {
                let Some(collides) = self.look(q, direction, here) else { continue };
                if collides == inside {
                    // Outside the intervals of the space, which are convex, a walk never comes back.
                    if !inside || self.cx.space.within_bounds(&self.at) {
                        on.push(direction);
                    }
                    continue;
                }
                let same = |length: f64| Some(self.look(q, direction, length)? == inside);
                let Some((_, length)) = halve((last, here), maprm.tolerance, same) else {
                    continue;
                };
                if best.as_ref().is_none_or(|best| length < best.length) {
                    best = Some(Found { direction, length });
                }
            }
            if best.is_some() {
                return best;
            }
            going = on;
        }
        None
    }

    /// The push of a robot whose base cannot be pushed: moves away from the nearest collision in a random direction, in
    /// the opposite direction, until a collision in another direction is nearer.
    fn push_back(&mut self, q: &mut [f64]) -> Option<()> {
        let maprm = self.maprm;
        let witness = self.walk(q, false)?;
        let (mut near, mut far) = (0.0, maprm.step);
        let mut steps = 1;
        while self.walked_nearest(q, &witness, far)? {
            if steps == maprm.steps {
                return None;
            }
            steps += 1;
            (near, far) = (far, f64::from(steps) * maprm.step);
        }
        let nearest = |by: f64| self.walked_nearest(q, &witness, by);
        let (near, _) = halve((near, far), maprm.tolerance, nearest)?;
        self.go(q, witness.direction ^ 1, near);
        q.copy_from_slice(&self.at);
        Some(())
    }

    /// Whether, after moving away from the witness by `by`, no walk in another direction is shorter than the one back to
    /// the witness.
    fn walked_nearest(&mut self, q: &[f64], witness: &Found, by: f64) -> Option<bool> {
        if self.look(q, witness.direction ^ 1, by)? {
            return Some(false);
        }
        let there = self.at.clone();
        let least = witness.length + by - self.maprm.tolerance;
        let mut going: Vec<usize> = (0..self.maprm.directions as usize).collect();
        going.retain(|direction| *direction != witness.direction);
        let mut here = 0.0;
        while here < least {
            here = least.min(here + self.maprm.step);
            let mut on = Vec::with_capacity(going.len());
            for direction in going {
                match self.look(&there, direction, here) {
                    Some(true) => return Some(false),
                    Some(false) => on.push(direction),
                    None => {}
                }
            }
            going = on;
        }
        Some(true)
    }
}

/// Bisects the interval from `near`, for which `is_near` holds, to `far`, for which it does not, until it is no longer
/// than `tolerance`. `None` if `is_near` cannot decide somewhere.
fn halve(
    (mut near, mut far): (f64, f64),
    tolerance: f64,
    mut is_near: impl FnMut(f64) -> Option<bool>,
) -> Option<(f64, f64)> {
    while far - near > tolerance {
        let middle = near + (far - near) / 2.0;
        if middle <= near || middle >= far {
            break; // no number lies between
        }
        if is_near(middle)? {
            near = middle;
        } else {
            far = middle;
        }
    }
    Some((near, far))
}
