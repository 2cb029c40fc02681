//! The search for a time at which two points are too near.

use super::balls::{self, Balls, Blocks, Near, Obstacles};
use super::chain::{BLOCK, Chain, Pairs, Segment};
use super::cubic::{self, Cubic, Verdict};
use super::curves::{self, Part, TURN_MAX, Ways};
use super::points;
use super::sample::{Sample, Stage};
use super::straight::Straight;
use crate::lanes::Lanes;
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
    stage: Stage,
    ways: Ways,
    /// The radii of points at one time.
    nothing: Vec<f64>,
    blocks: Blocks,
    near: Vec<Near>,
    /// Segments that are still to be looked at, and pairs: those of the part at hand are the last.
    segments: Vec<usize>,
    open: Vec<Open>,
}

impl MotionScratch {
    /// Fills it with what could mislead.
    pub fn poison(&mut self, rubbish: u64) {
        let seed = rubbish as usize % 97;
        let rubbish = if rubbish.is_multiple_of(2) { f64::NAN } else { rubbish as f64 };
        for values in [&mut self.motion.first, &mut self.motion.turns, &mut self.motion.sums] {
            values.fill(rubbish);
            values.push(rubbish);
        }
        for sample in &mut self.samples {
            sample.points.fill(rubbish);
            sample.velocities.fill(rubbish);
        }
        self.stage.poison();
        self.samples.truncate(1 + seed % 4);
        self.ways.poison(rubbish);
        self.nothing.push(rubbish);
        self.blocks.truncate(seed % 3);
        let near = Near { first: 1 << 40, second: 1 << 40, limit: rubbish };
        self.near.push(near);
        self.segments.push(seed);
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
    obstacles: &Obstacles,
    a: &[f64],
    b: &[f64],
    scratch: &mut MotionScratch,
) -> bool {
    if a.len() != chain.torsions || b.len() != chain.torsions || !scratch.motion.set(a, b) {
        return false;
    }
    let mut search = Search { chain, obstacles, lanes: Lanes::widest(), scratch };
    search.place(2, 0.5);
    if !search.keeps_apart(2) {
        return false;
    }
    search.place(0, 0.0);
    search.place(1, 1.0);
    search.scratch.segments.clear();
    search.scratch.open.clear();
    search.scratch.segments.extend(0..chain.segments.len());
    search.scratch.ways.resize(chain.points());
    let whole = Stretch { from: 0, to: 1, start: 0.0, length: 1.0, halvings: 0 };
    search.part(whole, 0, 0)
}

/// Whether the chain keeps its limits at the times k/`steps` of that motion, the ends among them.
pub(super) fn is_valid_at(
    chain: &Chain,
    obstacles: &Obstacles,
    (a, b): (&[f64], &[f64]),
    steps: usize,
    scratch: &mut MotionScratch,
) -> bool {
    if a.len() != chain.torsions || b.len() != chain.torsions || !scratch.motion.set(a, b) {
        return false;
    }
    let mut search = Search { chain, obstacles, lanes: Lanes::widest(), scratch };
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
    obstacles: &'a Obstacles,
    lanes: Lanes,
    scratch: &'a mut MotionScratch,
}

impl Search<'_> {
    /// Makes a sample.
    fn place(&mut self, sample: usize, time: f64) {
        let scratch = &mut *self.scratch;
        if scratch.samples.len() <= sample {
            scratch.samples.resize_with(sample + 1, Sample::default);
        }
        let stage = &mut scratch.stage;
        scratch.samples[sample].place(self.chain, &scratch.motion, time, stage);
    }

    /// Whether the points of a sample keep apart.
    fn keeps_apart(&mut self, sample: usize) -> bool {
        let Search { chain, lanes, obstacles, .. } = *self;
        let scratch = &mut *self.scratch;
        let points = &scratch.samples[sample].points;
        scratch.nothing.clear();
        points::resize(&mut scratch.nothing, chain.points());
        let balls = Balls { centres: points, radii: &scratch.nothing };
        balls::gather(lanes, chain, &balls, &(0..chain.links.len()), &mut scratch.blocks);
        let (found, blocks) = (&mut scratch.near, &scratch.blocks);
        let far = |first: Point, second: Point, limit: f64| {
            let least = limit - 2.0 * chain.rounding;
            (second - first).norm_squared() >= least * least
        };
        found.clear();
        for block in 0..blocks.len() {
            balls::within(lanes, chain, &balls, block, found);
            let others = [block..block + 1, block + 1..blocks.len()];
            balls::across(lanes, chain, (&balls, blocks), others, found);
            let keeps = |near: &Near| {
                chain.leaves_alone(near.first, near.second)
                    || far(points.at(near.first), points.at(near.second), near.limit)
            };
            if !found.iter().all(keeps) {
                return false;
            }
            found.clear();
        }
        balls::obstacles(lanes, chain, (&balls, blocks), obstacles, found);
        let keeps =
            |near: &Near| far(points.at(near.first), obstacles.points.at(near.second), near.limit);
        found.iter().all(keeps)
    }

    /// Whether all keep apart during a part, of the segments and pairs from these places of the lists on. The lists are
    /// left as long as they were up to there.
    fn part(&mut self, stretch: Stretch, first_segment: usize, first_open: usize) -> bool {
        let Search { chain, lanes, obstacles, .. } = *self;
        let scratch = &mut *self.scratch;
        let samples = [stretch.from, stretch.to].map(|sample| &scratch.samples[sample]);
        let part = Part { length: stretch.length, from: samples[0], to: samples[1] };
        // What stays undecided follows what was given.
        let (segments_end, open_end) = (scratch.segments.len(), scratch.open.len());
        for place in first_open..open_end {
            let Open { segment, near, fourth } = scratch.open[place];
            let Segment { frame, pairs, .. } = chain.segments[segment];
            let frames = samples.map(|sample| sample.frame(frame));
            let mut way = |point| scratch.ways.cubic_of(lanes, &part, frames, point);
            let first = way(near.first);
            let second = match pairs {
                Pairs::Obstacles => [obstacles.points.at(near.second); 4],
                _ => way(near.second),
            };
            let error = curves::leaves_cubic(fourth, stretch.length) + chain.rounding;
            match held(&first, &second, near.limit, error) {
                Verdict::Apart => {}
                Verdict::Close => return false,
                Verdict::Between if error > KNOWN => {
                    scratch.open.push(Open { segment, near, fourth });
                }
                Verdict::Between => return false,
            }
        }
        for place in first_segment..segments_end {
            let number = scratch.segments[place];
            let segment = &chain.segments[number];
            if curves::turn(chain, segment, &scratch.motion) * stretch.length > TURN_MAX {
                scratch.segments.push(number);
                continue;
            }
            let ways = &mut scratch.ways;
            curves::find(lanes, chain, segment, &scratch.motion, &part, ways);
            let found = &mut scratch.near;
            found.clear();
            let balls = Balls { centres: &ways.centres, radii: &ways.radii };
            let residues = &segment.residues;
            let blocks = residues.start / BLOCK..residues.end.div_ceil(BLOCK);
            if segment.pairs == Pairs::Within {
                balls::within(lanes, chain, &balls, blocks.start, found);
            } else {
                balls::gather(lanes, chain, &balls, residues, &mut scratch.blocks);
                let both = (&balls, &scratch.blocks);
                if segment.pairs == Pairs::Across {
                    let middle = segment.frame / BLOCK;
                    let sides = [blocks.start..middle, middle..blocks.end];
                    balls::across(lanes, chain, both, sides, found);
                } else {
                    balls::obstacles(lanes, chain, both, obstacles, found);
                }
            }
            for near in found {
                let (second, own) = match segment.pairs {
                    Pairs::Obstacles => ([obstacles.points.at(near.second); 4], 0.0),
                    _ if chain.leaves_alone(near.first, near.second) => continue,
                    _ => (ways.cubic(near.second), ways.fourth(near.second)),
                };
                let fourth = ways.fourth(near.first) + own;
                let error = curves::leaves_cubic(fourth, stretch.length) + chain.rounding;
                match held(&ways.cubic(near.first), &second, near.limit, error) {
                    Verdict::Apart => {}
                    Verdict::Close => return false,
                    Verdict::Between if error > KNOWN => {
                        scratch.open.push(Open { segment: number, near: *near, fourth });
                    }
                    Verdict::Between => return false,
                }
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

/// Holds the ways of two points against their limit: each leaves its cubic so that together they err by `error`.
fn held(first: &Cubic, second: &Cubic, limit: f64, error: f64) -> Verdict {
    let between: Cubic = std::array::from_fn(|k| second[k] - first[k]);
    cubic::verdict(&between, limit + error, limit - error)
}
