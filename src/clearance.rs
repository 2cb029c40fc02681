//! How far the nearest obstacle is along motions, edges and paths: the least and the mean distance.
//!
//! Distances are those of [`Clearances`]: between the robot's surface and that of the nearest
//! obstacle, in the scene's unit, the bounds being none. They are exact at a configuration. Along a motion they are looked at
//! where it takes: no point of the robot moves farther than a bound that the model knows, so that between two
//! configurations the distance is known as well as that bound says, and a stretch is halved until what is known suffices for the
//! tolerance, but no more than 24 times. So both the least and the mean are certain to within the tolerance, or to within a 2²⁴th of the way if that is more.
//!
//! ```
//! use roadmill::{clearance, model::Scratch, problem::Problem};
//!
//! // A ball of radius 0.5 flies past a slab.
//! let cx = Problem::load("tests/problems/slide.toml".as_ref())?.context();
//! let (from, to, scratch) = ([-3.0, -3.0, -3.0], [-3.0, 3.0, -3.0], &mut Scratch::new());
//! let found = clearance::of_motion(&cx, &from, &to, 0.01, scratch).expect("there are obstacles");
//! assert!(found.least <= found.mean);
//! # Ok::<(), roadmill::problem::ProblemError>(())
//! ```

use crate::context::Context;
use crate::local::Planner;
use crate::model::{Clearances, Scratch};
use crate::roadmap::{Configs, Edge, Roadmap};
use rayon::prelude::*;

/// The clearance along a motion or a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlongMotion {
    /// The least distance of the nearest obstacle: it is found at a configuration of the motion, and none on it is nearer by more than the
    /// tolerance.
    pub least: f64,
    /// The mean distance over the length of the motion in the space's metric, to within the tolerance.
    pub mean: f64,
    /// The length of the motion in the space's metric.
    pub length: f64,
}

impl AlongMotion {
    /// The clearance along this motion and one that follows it.
    fn then(self, next: AlongMotion) -> AlongMotion {
        let length = self.length + next.length;
        let mean = match length > 0.0 {
            true => (self.mean * self.length + next.mean * next.length) / length,
            false => self.mean,
        };
        AlongMotion { least: self.least.min(next.least), mean, length }
    }
}

/// The most halvings of a motion; finer than that nothing is looked at.
const HALVINGS: u32 = 24;

/// The clearance along the motion from `a` to `b` by [`Space::interpolate`](crate::space::Space::interpolate), certain to within
/// `tolerance`, a length above 0. `None` of a model that has no distances to obstacles, where there are no obstacles, and where the tolerance is not above 0. Every configuration that is
/// looked at counts as one asked for.
pub fn of_motion(
    cx: &Context,
    a: &[f64],
    b: &[f64],
    tolerance: f64,
    scratch: &mut Scratch,
) -> Option<AlongMotion> {
    let clearances = cx.model.clearances().filter(|_| tolerance > 0.0)?;
    let farthest = clearances.farthest(a, b);
    let mut walk = Walk { cx, clearances, ends: [a, b], farthest, tolerance, at: a.to_vec() };
    let [first, last] = [0.0, 1.0].map(|time| walk.distance(time, scratch));
    let (first, last) = (first?, last?);
    let mut found =
        AlongMotion { least: first.min(last), mean: 0.0, length: cx.space.distance(a, b) };
    walk.between([(0.0, first), (1.0, last)], 0, &mut found, scratch);
    Some(found)
}

/// The clearance along a path: the motions between its configurations one after the other; of one configuration alone what it is there.
/// `None` as in [`of_motion`], and of no configurations.
pub fn of_path(
    cx: &Context,
    configs: &Configs,
    tolerance: f64,
    scratch: &mut Scratch,
) -> Option<AlongMotion> {
    let last = configs.len().checked_sub(1)?;
    let legs = (0..last.max(1)).map(|i| (configs.get(i), configs.get(last.min(i + 1))));
    let mut whole: Option<AlongMotion> = None;
    for (a, b) in legs {
        let leg = of_motion(cx, a, b, tolerance, scratch)?;
        whole = Some(whole.map_or(leg, |before| before.then(leg)));
    }
    whole
}

/// The clearance along an edge of a roadmap: along its planner's motion between its nodes. `None` as in [`of_motion`].
pub fn of_edge(
    cx: &Context,
    edge: &Edge,
    [low, high]: [&[f64]; 2],
    tolerance: f64,
    scratch: &mut Scratch,
) -> Option<AlongMotion> {
    let motion = Planner::from_tag(edge.planner)?.motion(cx, low, high);
    of_path(cx, &motion, tolerance, scratch)
}

/// The clearance along every edge of a roadmap, in their order, found in several threads; the outcome does not depend on
/// how many. `None` as in [`of_motion`].
pub fn of_edges(cx: &Context, roadmap: &Roadmap, tolerance: f64) -> Option<Vec<AlongMotion>> {
    cx.model.clearances()?;
    let edges: Vec<Edge> = roadmap.edges().iter().collect();
    let of_one = |scratch: &mut Scratch, edge: &Edge| {
        let ends = [edge.low, edge.high].map(|node| roadmap.configs().get(node.index()));
        of_edge(cx, edge, ends, tolerance, scratch)
    };
    edges.par_iter().map_init(Scratch::new, of_one).collect()
}

/// The clearance at every node of a roadmap, in their order. `None` as in [`of_motion`].
pub fn of_nodes(cx: &Context, roadmap: &Roadmap) -> Option<Vec<f64>> {
    let configs: Vec<&[f64]> = roadmap.configs().iter().collect();
    of_configs(cx, &configs)
}

/// The clearance at each of several configurations in stored form, in their order, found in several threads. `None` as in [`of_motion`].
pub fn of_configs(cx: &Context, configs: &[&[f64]]) -> Option<Vec<f64>> {
    cx.model.clearances()?;
    let of_one = |scratch: &mut Scratch, q: &&[f64]| {
        Some(cx.model.clearances()?.clearance(q, scratch)?.distance)
    };
    configs.par_iter().map_init(Scratch::new, of_one).collect()
}

/// A motion along which clearances are looked at.
struct Walk<'a> {
    cx: &'a Context,
    clearances: &'a dyn Clearances,
    ends: [&'a [f64]; 2],
    /// A bound on the way of any robot point, all of it at constant speeds.
    farthest: f64,
    tolerance: f64,
    /// The configuration that is looked at.
    at: Vec<f64>,
}

impl Walk<'_> {
    fn distance(&mut self, time: f64, scratch: &mut Scratch) -> Option<f64> {
        let [a, b] = self.ends;
        match time {
            0.0 => self.at.copy_from_slice(a),
            1.0 => self.at.copy_from_slice(b),
            _ => self.cx.space.interpolate(a, b, time, &mut self.at),
        }
        scratch.count_configuration();
        self.clearances.clearance(&self.at, scratch).map(|clearance| clearance.distance)
    }

    /// Adds what lies between two times at which distances are known to the integral of the distance, which is the mean, and to the
    /// least.
    fn between(
        &mut self,
        [first, last]: [(f64, f64); 2],
        depth: u32,
        found: &mut AlongMotion,
        scratch: &mut Scratch,
    ) {
        let moved = self.farthest * (last.0 - first.0);
        let change = (last.1 - first.1).abs();
        // Between the two the distance is at most so much below the nearer one and above the farther one. The mean of the ends is
        // off from the mean by at most (moved² − change²) / (4 moved), which is no more.
        let unknown = (moved - change) / 2.0;
        let middle = first.0 + (last.0 - first.0) / 2.0;
        let known = match unknown > self.tolerance && depth < HALVINGS {
            true => self.distance(middle, scratch),
            false => None,
        };
        match known {
            Some(distance) => {
                found.least = found.least.min(distance);
                self.between([first, (middle, distance)], depth + 1, found, scratch);
                self.between([(middle, distance), last], depth + 1, found, scratch);
            }
            None => found.mean += (last.0 - first.0) * (first.1 + last.1) / 2.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Problem;

    fn context(scene: &str) -> Context {
        let problem = Problem::parse("scene.toml".as_ref(), scene);
        problem.unwrap_or_else(|error| panic!("{error}")).context()
    }

    const BALL: &str = "[space]\nmotion = \"MOTION\"\nmin = [-9, -9, -9]\nmax = [9, 9, 9]\nbounds = \"reference\"\n\
         [robot]\nbodies = [{ shape = BODY }]\n[[obstacles]]\nshape = { sphere = { radius = 1.0 } }\n";

    /// A point on a straight line past a ball: the distance is √(x² + 4) − 1, and its mean has a closed form.
    #[test]
    fn a_point_that_passes_a_ball_has_the_clearance_of_the_closed_form() {
        let scene = BALL.replace("MOTION", "translation-3d").replace("BODY", "{ point = {} }");
        let cx = context(&scene);
        let root = |x: f64| (x * x + 4.0).sqrt();
        let integral = |x: f64| 0.5 * (x * root(x) + 4.0 * crate::math::ln(x + root(x))) - x;
        for (from, to) in [(-3.0, 5.0), (1.0, 4.0), (-2.0, -0.5)] {
            for tolerance in [0.1, 0.001] {
                let scratch = &mut Scratch::new();
                let [a, b] = [from, to].map(|x| [x, 2.0, 0.0]);
                let found = of_motion(&cx, &a, &b, tolerance, scratch).unwrap();
                let nearest =
                    if from < 0.0 && to > 0.0 { 0.0 } else { f64::min(from.abs(), to.abs()) };
                let least = root(nearest) - 1.0;
                let mean = (integral(to) - integral(from)) / (to - from);
                let about = least - 1e-12..=least + tolerance;
                assert!(about.contains(&found.least), "{found:?} {least}");
                assert!((found.mean - mean).abs() <= tolerance, "{found:?} {mean}");
                assert_eq!(found.length, to - from);
                let asked = scratch.take_asked().configurations as f64;
                assert!(asked <= 2.0 + 2.0 * (to - from) / tolerance, "{asked}");
            }
        }
    }

    /// A rod turns about its middle beside a ball: it is nearest in the middle of the turn, where neither end of the motion
    /// tells.
    #[test]
    fn a_rod_that_turns_past_a_ball_is_seen_where_it_is_nearest() {
        let body = "{ box = { size = [4.0, 0.2, 0.2] } }";
        let cx = context(
            &BALL
                .replace("MOTION", "rigid-2d")
                .replace("BODY", body)
                .replace("-9, -9, -9", "-9, -9")
                .replace("9, 9, 9", "9, 9"),
        );
        let turn = std::f64::consts::FRAC_PI_2 * 0.9;
        let [a, b] = [[3.5, 0.0, -turn], [3.5, 0.0, turn]];
        let found = of_motion(&cx, &a, &b, 0.01, &mut Scratch::new()).unwrap();
        // A corner of the rod's end is nearest.
        let least = 2.5 - (4.01f64).sqrt();
        assert!((least - 1e-9..=least + 0.01).contains(&found.least), "{found:?}");
        assert!(found.mean > 1.0 && found.mean < 2.4, "{found:?}");
        // A motion that stands still, and a path of two legs.
        let still = of_motion(&cx, &a, &a, 0.01, &mut Scratch::new()).unwrap();
        assert_eq!((still.length, still.least), (0.0, still.mean));
        let mut configs = Configs::new(3);
        for q in [&a, &b, &a] {
            configs.push(q);
        }
        let there_and_back = of_path(&cx, &configs, 0.01, &mut Scratch::new()).unwrap();
        assert!((there_and_back.mean - found.mean).abs() < 1e-9);
        assert_eq!(there_and_back.length, 2.0 * found.length);
    }

    #[test]
    fn without_obstacles_there_is_no_clearance() {
        let scene = BALL.split("[[obstacles]]").next().unwrap();
        let cx =
            context(&scene.replace("MOTION", "translation-3d").replace("BODY", "{ point = {} }"));
        assert_eq!(of_motion(&cx, &[0.0; 3], &[1.0; 3], 0.1, &mut Scratch::new()), None);
    }
}
