//! The search for a time at which two points are too near.

use super::balls::{Ball, Balls, Near};
use super::chain::{BLOCK, Chain, Pairs};
use super::cubic::{self, Cubic, Verdict};
use super::curves::{self, Part, TURN_MAX, Way};
use super::sample::Sample;
use super::straight::Straight;
use crate::structure::Point;

/// A motion is refused if points come nearer than their limit and this, Å.
pub(super) const TOLERANCE: f64 = 1e-6;

/// A pair is given up for the part's halves only while its ways are known less well than this, Å.
const KNOWN: f64 = TOLERANCE / 4.0;

/// More halvings of a motion would tell times apart that rounding does not.
const HALVINGS_MAX: usize = 40;

/// A pair that is not decided.
#[derive(Clone, Copy, Debug)]
struct Open {
    segment: usize,
    near: Near,
    /// A bound on the fourth derivative of the way of one as seen from the other, Å.
    fourth: f64,
}

/// Working memory. What it holds from before changes no verdict.
#[derive(Clone, Debug, Default)]
pub struct MotionScratch {
    motion: Straight,
    /// The chain at the motion's ends, then at the middle of every part that is being looked at.
    samples: Vec<Sample>,
    ways: Vec<Way>,
    balls: Balls,
    /// Segments that are still to be looked at, and pairs: those of the part at hand are the last.
    segments: Vec<usize>,
    open: Vec<Open>,
}

impl MotionScratch {
    /// Fills it with what could mislead: for tests of the law that it never does.
    pub fn poison(&mut self, seed: u64) {
        let rubbish = if seed % 2 == 0 { f64::NAN } else { seed as f64 };
        let point = Point::new(rubbish, 1.0, -rubbish);
        for values in [&mut self.motion.first, &mut self.motion.turns, &mut self.motion.sums] {
            values.fill(rubbish);
            values.push(rubbish);
        }
        for moving in self.samples.iter_mut().flat_map(|sample| &mut sample.points) {
            (moving.at, moving.velocity) = (point, point);
        }
        self.samples.truncate(1 + seed as usize % 4);
        self.ways.fill(Way { cubic: [point; 4], fourth: rubbish });
        self.ways.truncate(seed as usize % 50);
        self.balls.of_points.fill(Ball { centre: point, radius: rubbish });
        self.balls.of_points.extend([Ball { centre: point, radius: rubbish }; 7]);
        self.segments.push(seed as usize);
        let near = Near { first: 1 << 40, second: 1 << 40, limit: rubbish };
        self.open.push(Open { segment: 1 << 40, near, fourth: rubbish });
    }
}

/// The part from sample `from` to sample `to`.
#[derive(Clone, Copy)]
struct Stretch {
    from: usize,
    to: usize,
    start: f64,
    length: f64,
    halvings: usize,
}

/// Whether the chain keeps its limits during the whole of the motion from `a` to `b`.
pub(super) fn is_valid(
    chain: &Chain,
    obstacle_groups: &[Ball],
    a: &[f64],
    b: &[f64],
    scratch: &mut MotionScratch,
) -> bool {
    if a.len() != chain.torsions || b.len() != chain.torsions || !scratch.motion.set(a, b) {
        return false;
    }
    let mut search = Search { chain, obstacle_groups, scratch };
    search.place(2, 0.5);
    if !search.keeps_apart(2) {
        return false;
    }
    search.place(0, 0.0);
    search.place(1, 1.0);
    search.scratch.segments.clear();
    search.scratch.open.clear();
    search.scratch.segments.extend(0..chain.segments.len());
    let nowhere = Way { cubic: [Point::zeros(); 4], fourth: 0.0 };
    search.scratch.ways.resize(chain.points(), nowhere);
    let whole = Stretch { from: 0, to: 1, start: 0.0, length: 1.0, halvings: 0 };
    search.part(whole, 0, 0)
}

/// Whether the chain keeps its limits at the times k/`steps` of that motion, the ends among them.
pub(super) fn is_valid_at(
    chain: &Chain,
    obstacle_groups: &[Ball],
    (a, b): (&[f64], &[f64]),
    steps: usize,
    scratch: &mut MotionScratch,
) -> bool {
    if a.len() != chain.torsions || b.len() != chain.torsions || !scratch.motion.set(a, b) {
        return false;
    }
    let mut search = Search { chain, obstacle_groups, scratch };
    let mut keeps_at = |step: usize| {
        search.place(2, step as f64 / steps as f64);
        search.keeps_apart(2)
    };
    // Ever finer, since what is in the way half way is met more often.
    let mut stride = steps.next_power_of_two();
    while stride > 0 {
        if !(stride..steps).step_by(2 * stride).all(&mut keeps_at) {
            return false;
        }
        stride /= 2;
    }
    keeps_at(0) && keeps_at(steps)
}

struct Search<'a> {
    chain: &'a Chain,
    obstacle_groups: &'a [Ball],
    scratch: &'a mut MotionScratch,
}

impl Search<'_> {
    /// Makes a sample.
    fn place(&mut self, sample: usize, time: f64) {
        let scratch = &mut *self.scratch;
        if scratch.samples.len() <= sample {
            scratch.samples.resize_with(sample + 1, Sample::default);
        }
        scratch.samples[sample].place(self.chain, &scratch.motion, time);
    }

    /// Whether the points of a sample keep apart.
    fn keeps_apart(&mut self, sample: usize) -> bool {
        let (chain, balls) = (self.chain, &mut self.scratch.balls);
        let points = &self.scratch.samples[sample].points;
        balls.of_points.clear();
        balls.of_points.extend(points.iter().map(|point| Ball { centre: point.at, radius: 0.0 }));
        balls.gather(chain, &(0..chain.links.len()));
        let far = |first: Point, second: Point, limit: f64| {
            let least = limit - 2.0 * chain.rounding;
            (second - first).norm_squared() >= least * least
        };
        let mut keeps = |near: Near| far(points[near.first].at, points[near.second].at, near.limit);
        let blocks = chain.links.len().div_ceil(BLOCK);
        (0..blocks).all(|block| {
            balls.within(chain, block, &mut keeps)
                && balls.across(chain, [block..block + 1, block + 1..blocks], &mut keeps)
        }) && balls.obstacles(chain, &chain.obstacles, self.obstacle_groups, &mut |near| {
            far(points[near.first].at, chain.obstacles[near.second], near.limit)
        })
    }

    /// Whether all keep apart during a part, of the segments and pairs from these places of the lists on. The lists are
    /// left as long as they were up to there.
    fn part(&mut self, stretch: Stretch, first_segment: usize, first_open: usize) -> bool {
        let chain = self.chain;
        let scratch = &mut *self.scratch;
        let samples = [stretch.from, stretch.to].map(|sample| &scratch.samples[sample]);
        let part = Part { length: stretch.length, from: samples[0], to: samples[1] };
        // What stays undecided follows what was given.
        let (segments_end, open_end) = (scratch.segments.len(), scratch.open.len());
        for place in first_open..open_end {
            let Open { segment, near, fourth } = scratch.open[place];
            let frame = chain.segments[segment].frame;
            let frames = samples.map(|sample| sample.frame(frame));
            let first = curves::cubic(&part, frames, near.first);
            let second = match chain.segments[segment].pairs {
                Pairs::Obstacles => [chain.obstacles[near.second]; 4],
                _ => curves::cubic(&part, frames, near.second),
            };
            let error = curves::leaves_cubic(fourth, stretch.length) + chain.rounding;
            match held(&first, &second, near.limit, error) {
                Verdict::Apart => {}
                Verdict::Close => return false,
                Verdict::Between if !(error > KNOWN) => return false,
                Verdict::Between => scratch.open.push(Open { segment, near, fourth }),
            }
        }
        for place in first_segment..segments_end {
            let number = scratch.segments[place];
            let segment = &chain.segments[number];
            if curves::turn(chain, segment, &scratch.motion) * stretch.length > TURN_MAX {
                scratch.segments.push(number);
                continue;
            }
            curves::find(chain, segment, &scratch.motion, &part, &mut scratch.ways);
            let ways = &scratch.ways;
            let of_points = &mut scratch.balls.of_points;
            let nothing = Ball { centre: Point::zeros(), radius: 0.0 };
            of_points.resize(chain.points(), nothing);
            let side_chain = |residue: usize| chain.links.len() + chain.side_chains_before[residue];
            let residues = &segment.residues;
            let side_chains = side_chain(residues.start)..side_chain(residues.end);
            for point in residues.clone().chain(side_chains) {
                of_points[point] = ball(&ways[point], stretch.length, chain.rounding);
            }
            scratch.balls.gather(chain, residues);
            let open = &mut scratch.open;
            let mut look = |near: Near, second: &Cubic, fourth: f64| {
                let fourth = fourth + ways[near.first].fourth;
                let error = curves::leaves_cubic(fourth, stretch.length) + chain.rounding;
                match held(&ways[near.first].cubic, second, near.limit, error) {
                    Verdict::Apart => true,
                    Verdict::Close => false,
                    Verdict::Between if !(error > KNOWN) => false,
                    Verdict::Between => {
                        open.push(Open { segment: number, near, fourth });
                        true
                    }
                }
            };
            let mut look_at_points =
                |near: Near| look(near, &ways[near.second].cubic, ways[near.second].fourth);
            let blocks = residues.start / BLOCK..residues.end.div_ceil(BLOCK);
            let middle = segment.frame / BLOCK;
            let keeps = match segment.pairs {
                Pairs::Within => scratch.balls.within(chain, blocks.start, &mut look_at_points),
                Pairs::Across => {
                    let sides = [blocks.start..middle, middle..blocks.end];
                    scratch.balls.across(chain, sides, &mut look_at_points)
                }
                Pairs::Obstacles => scratch.balls.obstacles(
                    chain,
                    &chain.obstacles,
                    self.obstacle_groups,
                    &mut |near| look(near, &[chain.obstacles[near.second]; 4], 0.0),
                ),
            };
            if !keeps {
                return false;
            }
        }
        let keeps = self.halves(stretch, segments_end, open_end);
        self.scratch.segments.truncate(segments_end);
        self.scratch.open.truncate(open_end);
        keeps
    }

    /// Goes on with the two halves of a part, if anything is left.
    fn halves(&mut self, stretch: Stretch, first_segment: usize, first_open: usize) -> bool {
        if self.scratch.segments.len() == first_segment && self.scratch.open.len() == first_open {
            return true;
        }
        if stretch.halvings == HALVINGS_MAX {
            return false;
        }
        let length = stretch.length * 0.5;
        let middle = stretch.start + length;
        let sample = stretch.halvings + 2;
        if stretch.halvings > 0 {
            // That of the whole motion is there.
            self.place(sample, middle);
        }
        let halvings = stretch.halvings + 1;
        let early = Stretch { to: sample, length, halvings, ..stretch };
        let late = Stretch { from: sample, start: middle, length, halvings, ..stretch };
        // What is nearer to the middle of the whole motion is more often in the way of something.
        let order = if middle < 0.5 { [late, early] } else { [early, late] };
        order.into_iter().all(|half| self.part(half, first_segment, first_open))
    }
}

/// The ball around a way.
fn ball(way: &Way, length: f64, rounding: f64) -> Ball {
    let cubic = &way.cubic;
    let centre = (cubic[0] + cubic[3]) * 0.5;
    let reach = cubic.iter().map(|point| (point - centre).norm_squared()).fold(0.0, f64::max);
    Ball { centre, radius: reach.sqrt() + curves::leaves_cubic(way.fourth, length) + rounding }
}

/// Holds the ways of two points against their limit: each leaves its cubic so that together they err by `error`.
fn held(first: &Cubic, second: &Cubic, limit: f64, error: f64) -> Verdict {
    let between: Cubic = std::array::from_fn(|k| second[k] - first[k]);
    cubic::verdict(&between, limit + error, limit - error)
}
