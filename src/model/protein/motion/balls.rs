//! Which points may be near one another: balls that hold points during a part of a motion, and balls that hold all of a
//! block.

use super::chain::{BLOCK, Chain};
use crate::structure::Point;
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
        // Written so that what is no number is near.
        !((other.centre - self.centre).norm_squared() >= reach * reach)
    }

    /// A ball that holds some others.
    fn around(balls: &[Ball]) -> Option<Ball> {
        let first = balls.first()?.centre;
        let (mut low, mut high) = (first, first);
        for ball in balls {
            low = low.inf(&ball.centre);
            high = high.sup(&ball.centre);
        }
        let centre = (low + high) * 0.5;
        let radius = balls
            .iter()
            .fold(0.0, |radius: f64, ball| radius.max((ball.centre - centre).norm() + ball.radius));
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

/// The balls of a chain's points.
#[derive(Clone, Debug, Default)]
pub(super) struct Balls {
    /// One for every point.
    pub of_points: Vec<Ball>,
    /// For every block, one around its Cα atoms and one around its side chains, if there are any.
    of_blocks: Vec<[Option<Ball>; 2]>,
}

/// The points of a block, Cα atoms and side chains.
fn points_of(chain: &Chain, block: usize) -> [Range<usize>; 2] {
    let residues = block * BLOCK..((block + 1) * BLOCK).min(chain.links.len());
    let side_chain = |residue: usize| chain.links.len() + chain.side_chains_before[residue];
    [residues.clone(), side_chain(residues.start)..side_chain(residues.end)]
}

impl Balls {
    /// Puts balls around the blocks of some residues, whose points have theirs.
    pub fn gather(&mut self, chain: &Chain, residues: &Range<usize>) {
        self.of_blocks.resize(chain.links.len().div_ceil(BLOCK), [None; 2]);
        for block in residues.start / BLOCK..residues.end.div_ceil(BLOCK) {
            self.of_blocks[block] =
                points_of(chain, block).map(|points| Ball::around(&self.of_points[points]));
        }
    }

    /// Visits pairs of points of two ranges of blocks, the second after the first, that may be too near. Stops where
    /// `visit` says `false`, and says so.
    pub fn across(
        &self,
        chain: &Chain,
        [first, second]: [Range<usize>; 2],
        visit: &mut impl FnMut(Near) -> bool,
    ) -> bool {
        let limits = [chain.limits.alpha, chain.limits.side_chain];
        for one in first {
            for other in second.clone() {
                for kind in 0..2 {
                    let limit = limits[kind];
                    let blocks = (self.of_blocks[one][kind], self.of_blocks[other][kind]);
                    let (Some(a), Some(b)) = blocks else { continue };
                    if limit <= 0.0 || !a.is_near(&b, limit) {
                        continue;
                    }
                    let (firsts, seconds) = (
                        points_of(chain, one)[kind].clone(),
                        points_of(chain, other)[kind].clone(),
                    );
                    for i in firsts {
                        let ball = self.of_points[i];
                        if !ball.is_near(&b, limit) {
                            continue;
                        }
                        for j in seconds.clone() {
                            if ball.is_near(&self.of_points[j], limit)
                                && (kind == 1 || chain.keeps_apart(i, j))
                                && !visit(Near { first: i, second: j, limit })
                            {
                                return false;
                            }
                        }
                    }
                }
            }
        }
        true
    }

    /// The same of the pairs of points within a block.
    pub fn within(
        &self,
        chain: &Chain,
        block: usize,
        visit: &mut impl FnMut(Near) -> bool,
    ) -> bool {
        let limits = [chain.limits.alpha, chain.limits.side_chain];
        for (kind, points) in points_of(chain, block).into_iter().enumerate() {
            let limit = limits[kind];
            if limit <= 0.0 {
                continue;
            }
            for i in points.clone() {
                for j in i + 1..points.end {
                    if self.of_points[i].is_near(&self.of_points[j], limit)
                        && (kind == 1 || chain.keeps_apart(i, j))
                        && !visit(Near { first: i, second: j, limit })
                    {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// The same of points and obstacles, whose balls are of radius 0, `obstacle_balls` holding as many of them as a block
    /// has residues.
    pub fn obstacles(
        &self,
        chain: &Chain,
        obstacles: &[Point],
        obstacle_balls: &[Ball],
        visit: &mut impl FnMut(Near) -> bool,
    ) -> bool {
        let limits = [chain.limits.alpha_obstacle, chain.limits.side_chain_obstacle];
        for (block, balls) in self.of_blocks.iter().enumerate() {
            for kind in 0..2 {
                let limit = limits[kind];
                let Some(ball) = balls[kind] else { continue };
                if limit <= 0.0 {
                    continue;
                }
                for (number, group) in obstacle_balls.iter().enumerate() {
                    if !ball.is_near(group, limit) {
                        continue;
                    }
                    for i in points_of(chain, block)[kind].clone() {
                        for j in number * BLOCK..((number + 1) * BLOCK).min(obstacles.len()) {
                            let obstacle = Ball { centre: obstacles[j], radius: 0.0 };
                            if self.of_points[i].is_near(&obstacle, limit)
                                && !visit(Near { first: i, second: j, limit })
                            {
                                return false;
                            }
                        }
                    }
                }
            }
        }
        true
    }
}

/// Balls around as many points as a block has residues each.
pub(super) fn groups(points: &[Point]) -> Vec<Ball> {
    let group = |points: &[Point]| {
        let balls: Vec<Ball> =
            points.iter().map(|point| Ball { centre: *point, radius: 0.0 }).collect();
        Ball::around(&balls)
    };
    points.chunks(BLOCK).filter_map(group).collect()
}
