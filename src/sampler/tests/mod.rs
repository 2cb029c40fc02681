//! What samplers promise: laws that all of them keep, and per method the distribution that its paper says.

mod energy;
mod gaps;
mod laws;
mod ligands;
mod maprm;
mod medial_axis;
mod mix;
mod obprm;
mod pairs;
mod segments;
mod sequences;
pub(crate) mod statistics;
mod steps;
mod torsion_noise;
mod umaprm;

use super::SamplerKind;
use crate::context::Context;
use crate::model::Scratch;
use crate::numbers::Ordinal;
use crate::problem::Problem;
use crate::roadmap::Configs;
use crate::seed::Seed;
use std::path::Path;

/// A rod in 3D among two balls.
const SCENE: &str = r#"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, -2.0]
max = [4.0, 4.0, 2.0]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.0, 0.2, 0.2] } } }]
[[obstacles]]
shape = { sphere = { radius = 1.0 } }
position = [2.0, 1.5, 0.0]
[[obstacles]]
shape = { sphere = { radius = 0.5 } }
position = [2.0, 3.3, 0.0]
"#;

fn context(scene: &str) -> Context {
    Problem::parse(Path::new("scene.toml"), scene)
        .unwrap_or_else(|error| panic!("{error}"))
        .context()
}

/// A sampler as a problem file names it.
fn sampler(text: &str) -> SamplerKind {
    toml::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The milestones of several sets, of `count` each.
fn sets(
    cx: &Context,
    sampler: &SamplerKind,
    ordinals: std::ops::Range<u64>,
    count: usize,
    scratch: &mut Scratch,
) -> Configs {
    let mut configs = Configs::new(cx.space.len());
    for ordinal in ordinals {
        let seed = Seed::of_set(7, "laws", Ordinal(ordinal));
        let done = sampler.method().sample(cx, &seed, count, scratch, &mut configs);
        assert_eq!(done, Ok(()), "{sampler:?}");
    }
    configs
}

/// A point in the plane, in a box from the origin, among boxes given as x, y, width, height.
fn plane(width: f64, height: f64, boxes: &[[f64; 4]]) -> Context {
    let mut scene = format!(
        "[space]\nmotion = \"translation-2d\"\nmin = [0, 0]\nmax = [{width}, {height}]\n\
         bounds = \"reference\"\n[robot]\nbodies = [{{ shape = {{ point = {{}} }} }}]\n"
    );
    for [x, y, width, height] in boxes {
        scene += &format!(
            "[[obstacles]]\nshape = {{ box = {{ size = [{width}, {height}, 1] }} }}\n\
             position = [{}, {}, 0]\n",
            x + width / 2.0,
            y + height / 2.0
        );
    }
    context(&scene)
}

/// The milestones of the first set of a sampler, for a point in the plane.
fn points(cx: &Context, text: &str, count: usize) -> Vec<[f64; 2]> {
    let configs = sets(cx, &sampler(text), 0..1, count, &mut Scratch::new());
    configs.iter().map(|q| [q[0], q[1]]).collect()
}
