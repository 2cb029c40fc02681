//! Which points may be near one another: balls that hold points during a part of a motion, and balls that hold all of a
//! block.

use super::chain::{BLOCK, Chain};
use super::points::{self, LANES, Points, dot, minus, same};
use crate::lanes::{Lanes, with_lanes};
use crate::structure::Point;
use fearless_simd::f64x4;
use fearless_simd::prelude::*;
use std::ops::Range;

/// A ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub centre: Point,
    pub radius: f64,
}

impl Ball {
    /// Whether it is nearer to another than a distance.
    fn is_near(&self, other: &Ball, distance: f64) -> bool {
        let reach = self.radius + other.radius + distance;
        // What is no number is not far.
        let is_far = (other.centre - self.centre).norm_squared() >= reach * reach;
        !is_far
    }

    /// A ball that holds some others: around the one in their middle.
    #[inline(always)]
    fn around<S: Simd>(simd: S, balls: &Balls, which: Range<usize>) -> Option<Ball> {
        if which.is_empty() {
            return None;
        }
        let centre = balls.centres.at(which.start + which.len() / 2);
        let middle = same(simd, &centre);
        let mut radius: f64 = 0.0;
        for four in which.clone().step_by(LANES) {
            let between = minus(&balls.centres.load(simd, four), &middle);
            let reach = dot(&between, &between).sqrt() + points::load(simd, balls.radii, four);
            for reach in &reach.to_array()[..LANES.min(which.end - four)] {
                // Written so that what is no number holds everything.
                radius = if radius.is_nan() || *reach <= radius { radius } else { *reach };
            }
        }
        Some(Ball { centre, radius })
    }
}

/// Two points that may be nearer than they may come: the first by its number, the second likewise or as an obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    pub first: usize,
    pub second: usize,
    /// How near they may come, Å.
    pub limit: f64,
}

/// Balls, one for each of some points.
#[derive(Clone, Copy)]
pub(super) struct Balls<'a> {
    pub centres: &'a Points,
    pub radii: &'a [f64],
}

impl Balls<'_> {
    /// Adds those of a block's balls that are nearer to a ball than a distance, as seconds of pairs with `first`.
    #[inline(always)]
    fn near<S: Simd>(
        &self,
        simd: S,
        (first, ball): (usize, &Ball),
        seconds: Range<usize>,
        limit: f64,
        found: &mut Vec<Near>,
    ) {
        let centre = same(simd, &ball.centre);
        let least = f64x4::splat(simd, ball.radius + limit);
        for four in seconds.clone().step_by(LANES) {
            let between = minus(&self.centres.load(simd, four), &centre);
            let reach = points::load(simd, self.radii, four) + least;
            let far = dot(&between, &between).simd_ge(reach * reach).to_bitmask();
            let mut near = !far & ((1 << LANES.min(seconds.end - four)) - 1);
            while near != 0 {
                let second = four + near.trailing_zeros() as usize;
                found.push(Near { first, second, limit });
                near &= near - 1;
            }
        }
    }

    fn ball(&self, point: usize) -> Ball {
        Ball { centre: self.centres.at(point), radius: self.radii[point] }
    }
}

/// For every block, one ball around its Cα atoms and one around its side chains, if there are any.
pub(super) type Blocks = Vec<[Option<Ball>; 2]>;

/// The points of a block, Cα atoms and side chains.
fn points_of(chain: &Chain, block: usize) -> [Range<usize>; 2] {
    let residues = block * BLOCK..((block + 1) * BLOCK).min(chain.links.len());
    let side_chains = chain.side_chains_of(&residues);
    [residues, side_chains]
}

/// Puts balls around the blocks of some residues.
pub(super) fn gather(
    lanes: Lanes,
    chain: &Chain,
    balls: &Balls,
    residues: &Range<usize>,
    blocks: &mut Blocks,
) {
    blocks.resize(chain.links.len().div_ceil(BLOCK), [None; 2]);
    with_lanes!(lanes, simd => simd.vectorize(
        #[inline(always)]
        || {
            let which = residues.start / BLOCK..residues.end.div_ceil(BLOCK);
            for (block, around) in which.clone().zip(&mut blocks[which]) {
                let [alphas, side_chains] = points_of(chain, block);
                let around_alphas = Ball::around(simd, balls, alphas);
                *around = [around_alphas, Ball::around(simd, balls, side_chains)];
            }
        },
    ));
}

/// Finds the pairs of points of two ranges of blocks, the second after the first, that may be too near.
pub(super) fn across(
    lanes: Lanes,
    chain: &Chain,
    (balls, blocks): (&Balls, &Blocks),
    [ones, others]: [Range<usize>; 2],
    found: &mut Vec<Near>,
) {
    with_lanes!(lanes, simd => simd.vectorize(
        #[inline(always)]
        || {
            for one in ones {
                for (kind, firsts) in points_of(chain, one).into_iter().enumerate() {
                    let limit = [chain.limits.alpha, chain.limits.side_chain][kind];
                    let Some(ball) = blocks[one][kind] else { continue };
                    if limit <= 0.0 {
                        continue;
                    }
                    for other in others.clone() {
                        let Some(far_ball) = blocks[other][kind] else { continue };
                        if !ball.is_near(&far_ball, limit) {
                            continue;
                        }
                        let seconds = &points_of(chain, other)[kind];
                        for first in firsts.clone() {
                            let ball = balls.ball(first);
                            if ball.is_near(&far_ball, limit) {
                                balls.near(simd, (first, &ball), seconds.clone(), limit, found);
                            }
                        }
                    }
                }
            }
        },
    ));
}

/// The same of pairs of points within a block.
pub(super) fn within(
    lanes: Lanes,
    chain: &Chain,
    balls: &Balls,
    block: usize,
    found: &mut Vec<Near>,
) {
    with_lanes!(lanes, simd => simd.vectorize(
        #[inline(always)]
        || {
            for (kind, points) in points_of(chain, block).into_iter().enumerate() {
                let limit = [chain.limits.alpha, chain.limits.side_chain][kind];
                if limit <= 0.0 {
                    continue;
                }
                for first in points.clone() {
                    let ball = balls.ball(first);
                    balls.near(simd, (first, &ball), first + 1..points.end, limit, found);
                }
            }
        },
    ));
}

/// The same of all points with the chain's obstacles.
pub(super) fn obstacles(
    lanes: Lanes,
    chain: &Chain,
    (balls, blocks): (&Balls, &Blocks),
    obstacles: &Obstacles,
    found: &mut Vec<Near>,
) {
    let limits = [chain.limits.alpha_obstacle, chain.limits.side_chain_obstacle];
    let still = Balls { centres: &obstacles.points, radii: &obstacles.radii };
    with_lanes!(lanes, simd => simd.vectorize(
        #[inline(always)]
        || {
            for (block, of_block) in blocks.iter().enumerate() {
                for (kind, limit) in limits.into_iter().enumerate() {
                    let Some(ball) = of_block[kind] else { continue };
                    if limit <= 0.0 {
                        continue;
                    }
                    for (number, group) in obstacles.groups.iter().enumerate() {
                        if !ball.is_near(group, limit) {
                            continue;
                        }
                        let seconds = number * BLOCK..((number + 1) * BLOCK).min(obstacles.count);
                        for first in points_of(chain, block)[kind].clone() {
                            let ball = balls.ball(first);
                            still.near(simd, (first, &ball), seconds.clone(), limit, found);
                        }
                    }
                }
            }
        },
    ));
}

/// Points that stand still, and balls around as many of them as a block has residues.
#[derive(Clone, Debug)]
pub(super) struct Obstacles {
    pub points: Points,
    radii: Vec<f64>,
    groups: Vec<Ball>,
    count: usize,
}

impl Obstacles {
    pub fn new(of: &[Point]) -> Obstacles {
        let (mut points, mut radii) = (Points::default(), Vec::new());
        points.resize(of.len());
        points::resize(&mut radii, of.len());
        of.iter().enumerate().for_each(|(number, point)| points.put(number, *point));
        let balls = Balls { centres: &points, radii: &radii };
        let groups = (0..of.len()).step_by(BLOCK);
        let around = |from: usize| {
            let which = from..(from + BLOCK).min(of.len());
            with_lanes!(Lanes::widest(), simd => Ball::around(simd, &balls, which))
        };
        let groups = groups.filter_map(around).collect();
        Obstacles { groups, count: of.len(), points, radii }
    }
}
