//! What both samplers of the medial axis, MAPRM and UMAPRM, are tested by.

use super::{context, sampler, sets};
use crate::context::Context;
use crate::model::Scratch;
use crate::roadmap::Configs;

/// The tolerance of the samplers that are tested, with a little more for rounding.
pub const TOLERANCE: f64 = 0.01 * (1.0 + 1e-9);

/// A set of milestones by a sampler, as a problem file names it.
pub fn milestones(cx: &Context, text: &str, count: usize) -> Configs {
    sets(cx, &sampler(text), 0..1, count, &mut Scratch::new())
}

/// The two least distances, which are from two different obstacles or sides, differ by no more than some tolerances.
pub fn on_axis(mut distances: Vec<f64>, tolerances: f64) {
    distances.sort_by(f64::total_cmp);
    let gap = distances[1] - distances[0];
    assert!(distances[0] > 0.0 && gap <= tolerances * TOLERANCE, "{distances:?}");
}

/// A ball that could also turn, and a point, among balls: of so many milestones by a sampler two balls are equally near, or, by one to which
/// the sides of the bounds are obstacles, a ball and a side.
pub fn among_balls([without_bounds, with_bounds]: [&str; 2], count: usize) {
    let balls =
        [[1.0, 1.0, 1.0, 0.8], [3.0, 1.2, 0.5, 0.6], [2.0, 3.0, 2.0, 0.9], [1.0, 2.5, 3.5, 0.4]];
    for (motion, body, radius) in
        [("rigid-3d", "sphere = { radius = 0.15 }", 0.15), ("translation-3d", "point = {}", 0.0)]
    {
        let mut scene = format!(
            "[space]\nmotion = \"{motion}\"\nmin = [0, 0, 0]\nmax = [4, 4, 4]\nbounds = \"body\"\n\
             [robot]\nbodies = [{{ shape = {{ {body} }} }}]\n"
        );
        for [x, y, z, radius] in balls {
            scene += &format!(
                "[[obstacles]]\nshape = {{ sphere = {{ radius = {radius} }} }}\n\
                 position = [{x}, {y}, {z}]\n"
            );
        }
        let cx = context(&scene);
        for (text, bounds) in [(without_bounds, false), (with_bounds, true)] {
            for q in milestones(&cx, text, count).iter() {
                let mut distances: Vec<f64> = balls
                    .iter()
                    .map(|ball| {
                        let way = [0, 1, 2].map(|i| q[i] - ball[i]);
                        let far = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
                        far.sqrt() - ball[3] - radius
                    })
                    .collect();
                if bounds {
                    distances.extend(q[..3].iter().flat_map(|x| [x - radius, 4.0 - x - radius]));
                }
                on_axis(distances, 1.0);
            }
        }
    }
}
