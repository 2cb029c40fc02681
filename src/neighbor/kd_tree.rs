use super::best::{Best, Neighbor};
use super::margins::{MARGIN, ROTATION_MARGIN, TINY};
use super::search_trees::{SearchTree, SearchTrees, TreeQuery};
use crate::math;
use crate::space::{Configs, FactorKind, Space};
use std::ops::Range;

/// A cell with at most so many configurations is not cut any more.
const LEAF: usize = 8;
/// What rounding may take from a distance besides the shared margins: for every coordinate, relative to the largest one, since
/// coordinates are rounded where they are multiplied by a weight.
const COORDINATE_MARGIN: f64 = 1e-14;

/// A k-d tree (J. L. Bentley 1975; J. H. Friedman, J. L. Bentley, R. A. Finkel 1977): cells are cut at the median of the axis along which
/// their points spread most. Each cell knows the bounding box of its points, which is smaller than the cell.
///
/// Configurations are points of a Euclidean space: a real value is one coordinate, an angle one that wraps, a rotation four,
/// its quaternion times two, of which the opposite is the same rotation; all times their weights. Points are never farther
/// apart than configurations, since a chord is no longer than its arc, so the distance of a query's point from a box
/// bounds the distances of the configurations in it from below.
#[derive(Debug)]
pub(crate) struct KdTree {
    axes: Axes,
    /// The root is the first. A cell's box is at its index times twice the number of axes.
    cells: Vec<Cell>,
    /// Per cell the least coordinates, then the largest.
    boxes: Vec<f64>,
    ids: Vec<u32>,
}

#[derive(Debug)]
enum Cell {
    /// Two cells, by their indices.
    Cut([u32; 2]),
    /// Positions among the ids.
    Leaf(Range<u32>),
}

#[derive(Clone, Copy, Debug)]
enum Axis {
    Real,
    /// With the length of a full turn.
    Angle(f64),
    /// The first of four; the others follow.
    Rotation,
}

/// The coordinates of a space's points.
#[derive(Debug)]
struct Axes {
    /// What begins at each part of the space, where its values begin in a configuration, and by what they are multiplied.
    parts: Vec<(Axis, usize, f64)>,
    count: usize,
    /// See [`ROTATION_MARGIN`].
    margin: f64,
}

impl Axes {
    fn of(space: &Space) -> Axes {
        let (mut parts, mut count, mut margin) = (Vec::new(), 0, 0.0);
        for part in space.factors().iter().filter(|part| part.weight > 0.0) {
            let (axis, scale, axes) = match part.kind {
                FactorKind::Real { .. } => (Axis::Real, part.weight, 1),
                FactorKind::Angle => (Axis::Angle(math::TURN * part.weight), part.weight, 1),
                FactorKind::Rotation => {
                    margin += part.weight * ROTATION_MARGIN;
                    (Axis::Rotation, 2.0 * part.weight, 4)
                }
            };
            parts.push((axis, part.at, scale));
            count += axes;
        }
        Axes { parts, count, margin }
    }

    fn embed(&self, q: &[f64], out: &mut Vec<f64>) {
        for (axis, at, scale) in &self.parts {
            let values = if matches!(axis, Axis::Rotation) { 4 } else { 1 };
            out.extend(q[*at..*at + values].iter().map(|value| value * scale));
        }
    }

    /// The distance of a point from a box, whose least coordinates come before its largest.
    fn distance(&self, point: &[f64], sides: &[f64]) -> f64 {
        let (least, largest) = sides.split_at(self.count);
        let outside = |value: f64, at: usize| (least[at] - value).max(value - largest[at]).max(0.0);
        let (mut sum, mut at) = (0.0, 0);
        for (axis, _, _) in &self.parts {
            match axis {
                Axis::Real => {
                    let difference = outside(point[at], at);
                    sum += difference * difference;
                    at += 1;
                }
                Axis::Angle(turn) => {
                    let value = point[at];
                    let around = turn - (largest[at] - value).max(value - least[at]);
                    let difference = outside(value, at).min(around.max(0.0));
                    sum += difference * difference;
                    at += 1;
                }
                Axis::Rotation => {
                    let (mut same, mut opposite) = (0.0, 0.0);
                    for (at, value) in point.iter().enumerate().skip(at).take(4) {
                        let [a, b] = [*value, -value].map(|value| outside(value, at));
                        same += a * a;
                        opposite += b * b;
                    }
                    sum += f64::min(same, opposite);
                    at += 4;
                }
            }
        }
        sum.sqrt()
    }
}

impl SearchTree for KdTree {
    fn new(space: &Space, configs: &Configs, ids: Range<u32>) -> KdTree {
        let axes = Axes::of(space);
        let first = ids.start;
        let mut points = Vec::with_capacity(ids.len() * axes.count);
        ids.clone().for_each(|id| axes.embed(configs.get(id as usize), &mut points));
        let mut order: Vec<u32> = ids.collect();
        let mut tree = KdTree { axes, cells: Vec::new(), boxes: Vec::new(), ids: Vec::new() };
        let (end, count) = (order.len(), tree.axes.count);
        let point = |id: u32| {
            let at = (id - first) as usize * count;
            &points[at..at + count]
        };
        tree.cut(&point, &mut order, 0..end);
        tree.ids = order;
        tree
    }

    fn search(&self, query: &TreeQuery, best: &mut Best<Neighbor>) {
        let mut point = Vec::with_capacity(self.axes.count);
        self.axes.embed(query.q, &mut point);
        let lower = self.axes.distance(&point, self.sides(0));
        let largest =
            point.iter().chain(self.sides(0)).fold(0.0f64, |most, value| most.max(value.abs()));
        let of_coordinates = COORDINATE_MARGIN * self.axes.count as f64 * largest;
        let margin = self.axes.margin + of_coordinates + TINY;
        self.search_cell(query, &Point { coordinates: point, margin }, (0, lower), best);
    }
}

/// The point of a query, and what rounding may take from its distances besides [`MARGIN`].
struct Point {
    coordinates: Vec<f64>,
    margin: f64,
}

impl KdTree {
    fn sides(&self, cell: u32) -> &[f64] {
        let length = 2 * self.axes.count;
        &self.boxes[cell as usize * length..(cell as usize + 1) * length]
    }

    /// Makes the cell of some positions of `order`, and those below it; its index. Which configurations a cell has is determined
    /// by their coordinates and ids.
    fn cut<'a>(
        &mut self,
        point: &impl Fn(u32) -> &'a [f64],
        order: &mut [u32],
        positions: Range<usize>,
    ) -> u32 {
        let axes = self.axes.count;
        let cell = self.cells.len();
        self.cells.push(Cell::Leaf(positions.start as u32..positions.end as u32));
        let mut sides = vec![f64::INFINITY; axes];
        sides.resize(2 * axes, f64::NEG_INFINITY);
        for id in &order[positions.clone()] {
            for (axis, value) in point(*id).iter().enumerate() {
                sides[axis] = sides[axis].min(*value);
                sides[axes + axis] = sides[axes + axis].max(*value);
            }
        }
        let mut widest = (0, 0.0);
        for axis in 0..axes {
            let spread = sides[axes + axis] - sides[axis];
            if spread > widest.1 {
                widest = (axis, spread);
            }
        }
        self.boxes.extend(sides);
        let (axis, spread) = widest;
        if positions.len() <= LEAF || spread == 0.0 {
            return cell as u32;
        }
        let middle = positions.len() / 2;
        order[positions.clone()].select_nth_unstable_by(middle, |a, b| {
            point(*a)[axis].total_cmp(&point(*b)[axis]).then(a.cmp(b))
        });
        let middle = positions.start + middle;
        let low = self.cut(point, order, positions.start..middle);
        let high = self.cut(point, order, middle..positions.end);
        self.cells[cell] = Cell::Cut([low, high]);
        cell as u32
    }

    /// `lower` is the distance of the query's point from the cell's box.
    fn search_cell(
        &self,
        query: &TreeQuery,
        point: &Point,
        (cell, lower): (u32, f64),
        best: &mut Best<Neighbor>,
    ) {
        // What is passed over is, as distances are computed, farther than the bound divided by 1 + ε.
        let least = lower * (1.0 - MARGIN) - point.margin;
        if least * (1.0 + query.epsilon) > best.bound() {
            return;
        }
        match &self.cells[cell as usize] {
            Cell::Leaf(positions) => {
                let ids = &self.ids[positions.start as usize..positions.end as usize];
                ids.iter().for_each(|id| query.offer(*id, best));
            }
            Cell::Cut(cells) => {
                let lower = |cell| self.axes.distance(&point.coordinates, self.sides(cell));
                let mut ways = cells.map(|cell| (cell, lower(cell)));
                ways.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
                for way in ways {
                    self.search_cell(query, point, way, best);
                }
            }
        }
    }
}

impl SearchTrees<KdTree> {
    /// About the `k` nearest to `q` of the first `count` of `configs` that are eligible, nearest first, ties by id. The i-th of them is
    /// at most 1 + `epsilon` times as far as the i-th of those that are nearest; with 0 it is the same. The trees must be those
    /// of `count` configurations, and `q` in stored form.
    #[allow(clippy::too_many_arguments, reason = "a search is told where, from where and what")]
    pub fn approximately_nearest(
        &self,
        space: &Space,
        configs: &Configs,
        count: u32,
        is_eligible: &dyn Fn(u32) -> bool,
        q: &[f64],
        k: usize,
        epsilon: f64,
    ) -> Vec<Neighbor> {
        self.k_nearest(&TreeQuery { space, configs, q, epsilon, is_eligible }, count, k)
    }
}
