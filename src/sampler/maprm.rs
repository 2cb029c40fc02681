use super::{GaveUp, Sampler, collect, collides, no_attempts, no_length, obstructed};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::{Clearance, Scratch, Validity};
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed, Stream};
use crate::space::{Direction, PartKind};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Medial axis sampling: milestones as far from the nearest obstacle as from a second one (S. A. Wilmarth,
/// N. M. Amato, P. F. Stiller, *MAPRM: A probabilistic roadmap planner with sampling on the medial axis of
/// the free space*, 1999; J.-M. Lien, S. L. Thomas, N. M. Amato, *A general framework for sampling on the
/// medial axis of the free space*, 2003; TR05-007 §4.1).
///
/// Draws a configuration uniformly. If it collides it is moved out along the least penetration. Then it is
/// pushed away from its witness, the nearest point of an obstacle, until something else is nearer, and the
/// last stretch is halved down to the tolerance.
///
/// *Clearance.* The base of a robot that moves about is pushed straight away from the witness, turned and
/// bent as it is: its clearance in the workspace is exactly how far it can be translated anywhere, and along
/// the push it grows as fast as the robot moves for as long as the witness stays the nearest. So for a robot
/// that does not turn, as a point, both are exact; for others they are exact among the configurations that
/// are turned and bent alike. In the many dimensions of the others a few random directions would say less,
/// at a higher price. Where there is no such push (a base that stands still, nothing but links that must not
/// touch one another, in the plane an obstacle that is nearest above or below) clearance is approximate: the least
/// length, over random directions, of the walk in steps that ends in a collision.
///
/// *Penetration.* Where the nearest surface of an obstacle is where what collides gets free, as for a point
/// inside a mesh or a box, it is exact. Else it is approximate: the shortest walk, over random
/// directions, that gets free. The random directions are drawn anew for each configuration, come in
/// opposite pairs, and lead through the whole space, rotations and joints included.
///
/// A configuration that gets out of bounds is dropped, unless `bounds` says that this is to collide.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Maprm {
    /// Length of the steps of a walk in a random direction and of the first push, in the space's metric. Walks
    /// leap over what is thinner; pushes do not.
    pub step: f64,
    /// How much nearer the witness of a milestone may be than the second one, or farther.
    pub tolerance: f64,
    /// How many random directions: an even number.
    #[serde(default = "default_directions")]
    pub directions: u32,
    /// The most steps of a walk.
    #[serde(default = "default_steps")]
    pub steps: u32,
    /// Whether to be out of bounds is to collide, so that milestones also lie between obstacles and bounds.
    #[serde(default)]
    pub bounds: bool,
    /// The most configurations drawn for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
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
/// The tolerance is no smaller a share of the step.
const FINEST: f64 = 1e-9;
/// Of the tolerance a push takes so much; the rest is for the distances of bounds.
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
        collect((count, self.attempts), out, |q| pusher.milestone(q))
    }

    fn complaint(&self) -> Option<Complaint> {
        let lengths =
            no_length("step", self.step).or_else(|| no_length("tolerance", self.tolerance));
        if lengths.is_some() {
            return lengths;
        }
        if !(self.step * FINEST..=self.step).contains(&self.tolerance) {
            let expected = "a billionth of the step up to the step";
            return Some(("tolerance", self.tolerance.to_string(), expected));
        }
        if !(1..=DIRECTIONS_MAX).contains(&self.directions) || !self.directions.is_multiple_of(2) {
            return Some(("directions", self.directions.to_string(), "an even number, 2 to 1000"));
        }
        if self.steps == 0 {
            return Some(("steps", "0".to_owned(), "at least 1"));
        }
        no_attempts(self.attempts)
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        obstructed(cx, self.bounds)
    }
}

/// Makes drawn configurations milestones.
struct Pusher<'a> {
    maprm: &'a Maprm,
    cx: &'a Context,
    stream: Stream,
    scratch: &'a mut Scratch,
    /// Of the configuration at hand, each for two opposite directions; drawn when first needed.
    lines: Vec<Direction>,
    /// What is looked at.
    at: Vec<f64>,
}

/// The way from a witness to the robot, and on.
struct Way {
    distance: f64,
    /// Where the robot is pushed: of unit length.
    away: [f64; 3],
    /// How far it could be translated before it gets out of bounds, to either side of every axis; without
    /// end if bounds do not collide.
    room: [[f64; 2]; 3],
}

/// Where a walk in a random direction meets what is looked for.
struct Found {
    direction: usize,
    /// Length of the walk to just behind it.
    length: f64,
}

impl Pusher<'_> {
    /// Draws a configuration and pushes it to the axis; whether it got there.
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

    /// The shortest way to an obstacle, and its direction from there. Counts as one configuration asked for.
    fn clearance(&mut self, q: &[f64]) -> Option<(Clearance, [f64; 3])> {
        self.scratch.count_configuration();
        let clearance = self.cx.model.clearances()?.clearance(q, self.scratch)?;
        let way = [0, 1, 2].map(|i| clearance.on_robot[i] - clearance.on_obstacle[i]);
        let length = (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]).sqrt();
        Some((clearance, way.map(|value| value / length)))
    }

    /// Moves the base.
    fn shift(&mut self, q: &[f64], away: &[f64; 3], by: f64) {
        self.at.copy_from_slice(q);
        let base = self.cx.space.translations();
        self.at[..base].iter_mut().zip(away).for_each(|(value, share)| *value += by * share);
    }

    /// Whether the base can be moved so.
    fn leads(&self, away: &[f64; 3]) -> bool {
        let base = self.cx.space.translations();
        away.iter().all(|share| share.is_finite())
            && base > 0
            && away[base..].iter().all(|share| share.abs() < 1e-6)
    }

    /// Moves what collides out of the obstacles, to within the tolerance of their surface.
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

    /// The way from the witness, if the base can be moved along it.
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

    /// How far the base can move to a side before the robot is out of bounds, which are convex.
    fn room(&mut self, q: &[f64], axis: usize, side: f64) -> f64 {
        let PartKind::Real { min, max } = self.cx.space.parts()[axis].kind else { return 0.0 };
        let most = if side < 0.0 { q[axis] - min } else { max - q[axis] };
        let mut away = [0.0; 3];
        away[axis] = side;
        let inside = |pusher: &mut Self, by: f64| {
            pusher.shift(q, &away, by);
            let state = pusher.cx.model.validity(&pusher.at, pusher.scratch);
            Some(state != Validity::OutOfBounds)
        };
        // A little less than the most, which rounding may put outside.
        if inside(self, most * (1.0 - 1e-12)) == Some(true) {
            return most;
        }
        let fine = (1.0 - SHARE) * self.maprm.tolerance;
        halve((0.0, most), fine, |by| inside(self, by)).map_or(0.0, |(near, _)| near)
    }

    /// Pushes the base along a way until something else is nearer than the witness.
    fn push(&mut self, q: &mut [f64], way: &Way) -> Option<()> {
        // The balls about the pushed robot that touch the witness lie in one another, so what is nearer once
        // stays so, and the strides may grow.
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

    /// How far the base can be moved within its intervals.
    fn exit(&self, q: &[f64], away: &[f64; 3]) -> f64 {
        let base = self.cx.space.translations();
        let axes = self.cx.space.parts()[..base].iter().zip(q).zip(away);
        axes.fold(f64::INFINITY, |exit, ((part, value), share)| match part.kind {
            PartKind::Real { max, .. } if *share > 0.0 => exit.min((max - value) / share),
            PartKind::Real { min, .. } if *share < 0.0 => exit.min((min - value) / share),
            _ => exit,
        })
    }

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

    /// The configuration so far from `q` in a direction, into `at`.
    fn go(&mut self, q: &[f64], direction: usize, length: f64) {
        while self.lines.len() < self.maprm.directions as usize / 2 {
            self.lines.push(self.cx.space.direction(&mut self.stream));
        }
        let length = if direction.is_multiple_of(2) { length } else { -length };
        self.cx.space.along(q, &self.lines[direction / 2], length, &mut self.at);
    }

    fn look(&mut self, q: &[f64], direction: usize, length: f64) -> Option<bool> {
        self.go(q, direction, length);
        collides(self.cx.model.validity(&self.at, self.scratch), self.maprm.bounds)
    }

    /// Walks in all directions at once until, in one of them, what collided is free or what was free
    /// collides. Of several at the same step it is the nearest, then the one drawn first.
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
                    // The intervals are convex: a walk never comes back into them.
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

    /// Steps back from the nearest collision in a random direction until one in another is nearer.
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

    /// Whether no other direction collides sooner than that of the witness, so far back from it.
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

/// Halves an interval whose near end is `near` and whose far end is not, always to the part with two unlike
/// ends, until it is no longer than `tolerance`. `None` where `near` cannot be told.
fn halve(
    (mut near, mut far): (f64, f64),
    tolerance: f64,
    mut is_near: impl FnMut(f64) -> Option<bool>,
) -> Option<(f64, f64)> {
    while far - near > tolerance {
        let middle = near + (far - near) / 2.0;
        if middle <= near || middle >= far {
            break; // as fine as numbers are
        }
        if is_near(middle)? {
            near = middle;
        } else {
            far = middle;
        }
    }
    Some((near, far))
}
