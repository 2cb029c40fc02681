use super::best::{Best, Neighbor};
use super::margins::{MARGIN, ROTATION_MARGIN, TINY};
use super::search_trees::{SearchTree, SearchTrees, TreeQuery};
use crate::space::{Configs, FactorKind, Space};
use std::ops::Range;

/// A ball with at most so many configurations is not divided any more.
const LEAF: usize = 16;
/// What rounding may take from the triangle inequality besides the shared margins: per unit of the weights of angles, which wrap.
const ANGLE_MARGIN: f64 = 1e-11;

/// A metric tree (J. K. Uhlmann, *Satisfying general proximity/similarity queries with metric trees*, Information Processing Letters 40,
/// 1991; P. N. Yianilos, *Data structures and algorithms for nearest neighbor search in general metric spaces*, SODA 1993): configurations
/// are divided at the median of their distances from one of them, the *pivot*. All that a search knows is
/// distances and the triangle inequality, so the tree serves every metric.
///
/// The pivot is the one farthest from the first, which lies at the edge: from there distances differ most.
#[derive(Debug)]
pub(crate) struct MetricTree {
    /// The root is the first.
    balls: Vec<Ball>,
    /// Configurations of leaves, each with its distance from the last pivot above it.
    members: Vec<(u32, f64)>,
    /// See [`ANGLE_MARGIN`].
    margin: f64,
}

#[derive(Debug)]
enum Ball {
    Divided {
        pivot: u32,
        parts: [Part; 2],
    },
    /// Positions among the members.
    Leaf(Range<usize>),
}

/// A part of a ball: the least and largest distance from the pivot, and the index of the ball that has the part.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    least: f64,
    largest: f64,
    ball: usize,
}

impl Part {
    /// A lower bound on the distance of what lies in the part from what is `distance` away from the pivot.
    fn lower(&self, distance: f64, margin: f64) -> f64 {
        let lower = (self.least - distance).max(distance - self.largest);
        lower - MARGIN * (distance + self.largest) - margin
    }
}

impl SearchTree for MetricTree {
    fn new(space: &Space, configs: &Configs, ids: Range<u32>) -> MetricTree {
        let of_part = |kind| match kind {
            FactorKind::Real { .. } => 0.0,
            FactorKind::Angle => ANGLE_MARGIN,
            FactorKind::Rotation => ROTATION_MARGIN,
        };
        let margins = space.factors().iter().map(|part| part.weight * of_part(part.kind));
        let margin = margins.sum::<f64>() + TINY;
        let mut tree = MetricTree { balls: Vec::new(), members: Vec::new(), margin };
        let mut members: Vec<(u32, f64)> = ids.map(|id| (id, f64::INFINITY)).collect();
        let distance =
            |a: u32, b: u32| space.distance(configs.get(a as usize), configs.get(b as usize));
        tree.divide(&distance, &mut members);
        tree
    }

    fn search(&self, query: &TreeQuery, best: &mut Best<Neighbor>) {
        self.search_ball(query, 0, f64::INFINITY, best);
    }
}

impl MetricTree {
    /// Makes the ball of some configurations, and those within it; its index.
    fn divide(&mut self, distance: &impl Fn(u32, u32) -> f64, members: &mut [(u32, f64)]) -> usize {
        let ball = self.balls.len();
        let begin = self.members.len();
        self.balls.push(Ball::Leaf(begin..begin + members.len()));
        let pivot = (members.len() > LEAF).then(|| {
            let first = members[0].0;
            let far = members.iter().map(|(id, _)| (distance(first, *id), *id));
            far.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1))).expect("there are some")
        });
        // Where all are at one place nothing divides them.
        let Some((_, pivot)) = pivot.filter(|(farthest, _)| *farthest > 0.0) else {
            self.members.extend_from_slice(members);
            return ball;
        };
        let at = members.iter().position(|(id, _)| *id == pivot).expect("it is one of them");
        members[at..].rotate_left(1);
        let (_, rest) = members.split_last_mut().expect("there are some");
        rest.iter_mut().for_each(|(id, away)| *away = distance(pivot, *id));
        // In the order of distances, so that what the parts are is determined, and in which order.
        rest.sort_unstable_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let middle = rest.len() / 2;
        let parts = rest.split_at_mut(middle);
        let parts = [parts.0, parts.1].map(|part| {
            let (least, largest) = (part[0].1, part[part.len() - 1].1);
            Part { least, largest, ball: self.divide(distance, part) }
        });
        self.balls[ball] = Ball::Divided { pivot, parts };
        ball
    }

    /// `away` is the query's distance from the last pivot above the ball.
    fn search_ball(&self, query: &TreeQuery, ball: usize, away: f64, best: &mut Best<Neighbor>) {
        match &self.balls[ball] {
            Ball::Leaf(positions) => {
                for (id, of_member) in &self.members[positions.clone()] {
                    let at = Part { least: *of_member, largest: *of_member, ball };
                    let is_far = at.lower(away, self.margin) > best.bound();
                    if !is_far {
                        query.offer(*id, best);
                    }
                }
            }
            Ball::Divided { pivot, parts } => {
                let config = query.configs.get(*pivot as usize);
                let away = query.space.distance(query.q, config);
                if (query.is_eligible)(*pivot) {
                    best.offer(Neighbor { distance: away, id: *pivot });
                }
                let mut ways = parts.map(|part| (part.lower(away, self.margin), part.ball));
                ways.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                for (lower, ball) in ways {
                    let is_far = lower > best.bound();
                    if !is_far {
                        self.search_ball(query, ball, away, best);
                    }
                }
            }
        }
    }
}

impl SearchTrees<MetricTree> {
    /// The at most `k` nearest to `q` of the first `count` of `configs` that are eligible, nearest first, ties by id. The trees must
    /// be those of `count` configurations, and `q` in stored form.
    pub fn nearest(
        &self,
        space: &Space,
        configs: &Configs,
        count: u32,
        is_eligible: &dyn Fn(u32) -> bool,
        q: &[f64],
        k: usize,
    ) -> Vec<Neighbor> {
        self.k_nearest(&TreeQuery { space, configs, q, epsilon: 0.0, is_eligible }, count, k)
    }
}
