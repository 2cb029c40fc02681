use super::*;
use crate::problem::Problem;
use std::path::Path;

/// A bar that fits through a door only lengthwise, in the plane.
const DOOR: &str = r#"
[space]
motion = "rigid-2d"
min = [0.0, 0.0]
max = [8.0, 4.0]
bounds = "body"
[robot]
bodies = [{ shape = { box = { size = [1.6, 0.1, 0.1] } } }]
[[obstacles]]
shape = { box = { size = [2.0, 1.7, 1.0] } }
position = [4.0, 0.85, 0.0]
[[obstacles]]
shape = { box = { size = [2.0, 1.7, 1.0] } }
position = [4.0, 3.15, 0.0]
"#;

#[test]
fn rotate_at_translates_turns_and_translates() {
    let cx = Problem::parse(Path::new("door.toml"), DOOR).unwrap().context();
    let (a, b) = ([2.0, 2.0, 0.0], [6.0, 2.0, 1.5]);
    let motion = Planner::RotateAt(RotateAt { percent: 75 }).motion(&cx, &a, &b);
    let expected = [a, [5.0, 2.0, 0.0], [5.0, 2.0, 1.5], b];
    assert!(motion.iter().eq(expected.iter().map(|q| &q[..])));
    assert_eq!(Planner::StraightLine.motion(&cx, &a, &b).len(), 2);
}

#[test]
fn manhattan_changes_one_degree_of_freedom_after_the_other() {
    let cx = Problem::parse(Path::new("door.toml"), DOOR).unwrap().context();
    let motion = |a: &[f64], b: &[f64]| {
        let motion = Planner::Manhattan(Manhattan {}).motion(&cx, a, b);
        motion.iter().map(<[f64]>::to_vec).collect::<Vec<_>>()
    };
    let (a, b) = ([2.0, 2.0, 0.0], [6.0, 1.0, 1.5]);
    assert_eq!(motion(&a, &b), [a.to_vec(), vec![6.0, 2.0, 0.0], vec![6.0, 1.0, 0.0], b.to_vec()]);
    let turned = [2.0, 2.0, 1.5];
    assert_eq!(motion(&a, &turned), [a, turned], "what does not change makes no turn");
    assert_eq!(motion(&a, &a), [a, a]);
}

#[test]
fn the_first_planner_that_succeeds_is_recorded() {
    let cx = Problem::parse(Path::new("door.toml"), DOOR).unwrap().context();
    let (a, b) = ([1.0, 2.0, 0.0], [7.0, 2.0, 1.5]);
    let scratch = &mut Scratch::new();
    // In the door it must lie lengthwise: a straight motion turns too early, and so does one half way.
    let (early, late) =
        (Planner::RotateAt(RotateAt { percent: 50 }), Planner::RotateAt(RotateAt { percent: 100 }));
    assert_eq!(connect(&cx, &[Planner::StraightLine, early], (&a, &b), 1, scratch), None);
    let found = connect(&cx, &[Planner::StraightLine, late, early], (&a, &b), 1, scratch);
    let (planner, cost) = found.expect("turning behind the door is free");
    assert_eq!(planner, late);
    let turn = cx.space.distance(&[0.0, 0.0, 0.0], &[0.0, 0.0, 1.5]);
    assert!((cost.forward() - (6.0 + turn)).abs() < 1e-12);
    // Turned around, it would have to turn in front of the door.
    assert_eq!(connect(&cx, &[late], (&b, &a), 1, scratch), None);
}

/// The last tag that names a planner.
const LAST_TAG: u8 = 102;

#[test]
fn tags_name_planners_and_no_other_numbers_do() {
    for tag in 0..=u8::MAX {
        match Planner::from_tag(tag) {
            Some(planner) => assert_eq!(planner.tag(), tag),
            None => assert!(tag > LAST_TAG),
        }
    }
}
