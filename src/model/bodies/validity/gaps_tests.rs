//! Gaps of a C and of a slit whose measures are known.

use crate::model::{Model, Scratch};
use crate::problem::Problem;
use std::path::Path;

/// A wall of four boxes around a slit that is 0.8 by 1.6, in the middle of the scene.
const SLIT: &str = r#"
[space]
motion = "rigid-3d"
min = [0.0, 0.0, 0.0]
max = [6.0, 4.0, 4.0]
bounds = "body"
[[obstacles]]
shape = { box = { size = [0.2, 1.6, 4.0] } }
position = [3.0, 0.8, 2.0]
[[obstacles]]
shape = { box = { size = [0.2, 1.6, 4.0] } }
position = [3.0, 3.2, 2.0]
[[obstacles]]
shape = { box = { size = [0.2, 0.8, 1.2] } }
position = [3.0, 2.0, 0.6]
[[obstacles]]
shape = { box = { size = [0.2, 0.8, 1.2] } }
position = [3.0, 2.0, 3.4]
"#;

/// A back and two arms, whose inner sides are 0.8 apart.
const C: &str = r#"[robot]
bodies = [
    { shape = { box = { size = [0.2, 1.2, 0.2] } }, position = [-0.5, 0.0, 0.0] },
    { shape = { box = { size = [1.0, 0.2, 0.2] } }, position = [0.1, 0.5, 0.0] },
    { shape = { box = { size = [1.0, 0.2, 0.2] } }, position = [0.1, -0.5, 0.0] },
]
"#;

fn model(text: &str) -> Box<dyn Model> {
    let problem = Problem::parse(Path::new("gaps.toml"), text);
    problem.unwrap_or_else(|error| panic!("{error}")).model().description().prepare()
}

#[test]
fn the_narrowest_gaps_are_as_wide_as_they_are() {
    let model = model(&format!("{SLIT}{C}"));
    let gaps = model.gaps().expect("both have gaps");
    let widths: Vec<[f64; 2]> = (0..gaps.pairs()).map(|pair| gaps.widths(pair)).collect();
    assert!(widths.iter().flatten().all(|width| *width >= 0.8 - 1e-9), "{widths:?}");
    let [own, theirs] = widths[0];
    assert!((own - 0.8).abs() < 1e-6 && (theirs - 0.8).abs() < 1e-6, "{widths:?}");
}

#[test]
fn aligned_gaps_have_the_offset_and_nothing_turns() {
    let model = model(&format!("{SLIT}{C}"));
    let gaps = model.gaps().expect("both have gaps");
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for pair in 0..gaps.pairs() {
        let [mut one, mut other] =
            [[1.0, 1.0, 1.0, half, 0.0, half, 0.0], [5.0, 2.0, 3.0, half, 0.0, half, 0.0]];
        gaps.align(pair, [0.0; 3], &mut one);
        gaps.align(pair, [0.1, -0.2, 0.3], &mut other);
        assert_eq!((&one[3..], &other[3..]), (&[half, 0.0, half, 0.0][..], &one[3..]));
        for (axis, offset) in [0.1, -0.2, 0.3].into_iter().enumerate() {
            assert!((other[axis] - one[axis] - offset).abs() < 1e-12, "{one:?} {other:?}");
        }
        // The middle of the C's gap is between its arms, and that of the slit in the wall's plane or beside it by less than the slit is wide.
        assert!((one[0] - 3.0).abs() < 1.5, "{one:?}");
    }
    // With the slit's middle between its arms the C stands free around nothing: an arm at either side of it is in the wall.
    let mut q = [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    gaps.align(0, [0.0; 3], &mut q);
    assert!(!model.is_valid(&q, &mut Scratch::new()));
}

#[test]
fn what_is_convex_has_no_gaps_and_what_moves_in_the_plane_none_that_help() {
    let bar = "[robot]\nbodies = [{ shape = { box = { size = [1.0, 0.2, 0.2] } } }]\n";
    assert!(model(&format!("{SLIT}{bar}")).gaps().is_none());
    let planar = SLIT
        .replace("rigid-3d", "rigid-2d")
        .replace("[0.0, 0.0, 0.0]", "[0.0, 0.0]")
        .replace("[6.0, 4.0, 4.0]", "[6.0, 4.0]");
    assert!(model(&format!("{planar}{C}")).gaps().is_none());
    let (space, _) = SLIT.split_once("[[obstacles]]").expect("there are obstacles");
    assert!(model(&format!("{space}{C}")).gaps().is_none(), "nothing to be at");
}
