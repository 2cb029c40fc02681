//! How much of the world a picture shows.

use crate::context::Ends;
use crate::model::Figure;
use crate::problem::Problem;
use crate::query::Path;
use crate::roadmap::Roadmap;
use crate::scene::{Body, Shape};

/// Nodes at which the robot is looked at.
const NODES: usize = 60;
/// How far beyond the robot and the bounds obstacles are shown, as a share of the largest extent of these.
const BEYOND: f64 = 0.2;

/// A box along the axes: its least and its largest corner.
pub(super) type Bounds = [[f64; 3]; 2];

/// How much of the world a picture shows. Of planar problems the boxes lie at z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extent {
    /// The box that holds what is shown.
    pub all: Bounds,
    /// The box whose lowest side is drawn as the floor: the problem's bounds as far as they are within `all`.
    pub floor: Bounds,
}

impl Extent {
    /// What there is to see: the bounds, the robot at the query's ends, at some nodes and along paths, and obstacles near these.
    ///
    /// A robot whose base stands still reaches only a part of what its bounds allow, so that of these bounds no more is shown
    /// than the robot reaches.
    pub fn of(
        problem: &Problem,
        figure: &dyn Figure,
        roadmap: Option<&Roadmap>,
        paths: &[&Path],
    ) -> Extent {
        let planar = figure.is_planar();
        let mut robot = EMPTY;
        let mut is_fixed = false;
        let ends = problem.query.iter().flat_map(Ends::all);
        let on_paths = paths.iter().flat_map(|path| path.configs.iter());
        let configs = roadmap.into_iter().flat_map(|roadmap| {
            let step = roadmap.configs().len().div_ceil(NODES).max(1);
            roadmap.configs().iter().step_by(step)
        });
        for q in ends.chain(on_paths).chain(configs) {
            is_fixed |= figure.placement(q).marked.is_some();
            hold(&mut robot, figure.marker(q));
            for body in figure.bodies_at(q) {
                corners(&body).into_iter().for_each(|corner| hold(&mut robot, corner));
            }
        }
        let bounds = figure.bounds();
        let shown = if is_fixed { robot } else { union(robot, bounds) };
        let mut all = with_obstacles(shown, figure.obstacles());
        if planar {
            all = all.map(|[x, y, _]| [x, y, 0.0]);
        }
        let floor = intersection(bounds, all);
        let is_sound = (0..2).all(|axis| floor[0][axis] < floor[1][axis]);
        Extent { all, floor: if is_sound { floor } else { all } }
    }

    /// The length of the diagonal of what is shown.
    pub fn diagonal(&self) -> f64 {
        let side = |axis: usize| self.all[1][axis] - self.all[0][axis];
        (0..3).map(|axis| side(axis) * side(axis)).sum::<f64>().sqrt()
    }

    /// Corners of the box of the floor; bit `axis` of the index chooses the largest value.
    pub fn floor_corners(&self) -> [[f64; 3]; 8] {
        corners_of(self.floor)
    }

    /// Corners of the box that holds what is shown.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        corners_of(self.all)
    }
}

/// A box, made larger by what of the obstacles is near it.
pub(super) fn with_obstacles(shown: Bounds, obstacles: &[Body]) -> Bounds {
    // What is very flat is given some depth, so that there is a box at all.
    let size = (0..3).map(|axis| shown[1][axis] - shown[0][axis]).fold(0.0, f64::max);
    let beyond = BEYOND * size;
    let near = [0, 1].map(|side| {
        [0, 1, 2].map(|axis| shown[side][axis] + if side == 0 { -beyond } else { beyond })
    });
    let mut all = shown;
    for body in obstacles {
        let mut obstacle = EMPTY;
        corners(body).into_iter().for_each(|corner| hold(&mut obstacle, corner));
        let shown = intersection(obstacle, near);
        if (0..3).all(|axis| shown[0][axis] <= shown[1][axis]) {
            all = union(all, shown);
        }
    }
    all
}

const EMPTY: Bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

fn hold(bounds: &mut Bounds, point: [f64; 3]) {
    for axis in 0..3 {
        bounds[0][axis] = bounds[0][axis].min(point[axis]);
        bounds[1][axis] = bounds[1][axis].max(point[axis]);
    }
}

fn union(a: Bounds, b: Bounds) -> Bounds {
    [[0, 1, 2].map(|i| a[0][i].min(b[0][i])), [0, 1, 2].map(|i| a[1][i].max(b[1][i]))]
}

fn intersection(a: Bounds, b: Bounds) -> Bounds {
    [[0, 1, 2].map(|i| a[0][i].max(b[0][i])), [0, 1, 2].map(|i| a[1][i].min(b[1][i]))]
}

fn corners_of(bounds: Bounds) -> [[f64; 3]; 8] {
    [0, 1, 2, 3, 4, 5, 6, 7].map(|i: usize| [0, 1, 2].map(|axis| bounds[i >> axis & 1][axis]))
}

/// The corners of the box around a body in the body's own frame, placed where the body stands.
fn corners(body: &Body) -> [[f64; 3]; 8] {
    let around = |high: [f64; 3]| [high.map(|value| -value), high];
    let own = match &body.shape {
        Shape::Point => around([0.0; 3]),
        Shape::Box { size } => around(size.map(|side| side / 2.0)),
        Shape::Sphere { radius } => around([*radius; 3]),
        Shape::Cylinder { radius, height } => around([*radius, *radius, height / 2.0]),
        Shape::Capsule { radius, height } => around([*radius, *radius, height / 2.0 + radius]),
        Shape::Mesh(mesh) => {
            let (min, max) = mesh.bounding_box();
            [min, max]
        }
    };
    corners_of(own).map(|corner| body.pose.apply(corner))
}
