//! Robots that may be smaller.

use super::*;
use crate::model::{Cost, ScaleAxes, ScaleCentre, ScaleRobot, Scratch, Validity};

const SCALES: [f64; 4] = [1.0, 0.8, 0.5, 0.2];
const CENTRE: [f64; 3] = [0.1, 0.0, 0.0];

fn described() -> Deformable {
    deformable(&with("feasibility = { scales = [1.0, 0.8, 0.5, 0.2], centre = [0.1, 0, 0] }"))
}

/// The bodies at each scale as the relaxation of bodies makes them: a way of its own to the same robots.
fn judges(described: &Deformable) -> Vec<Box<dyn Model>> {
    let relaxed = |scale: f64| {
        let (axes, centre) = (ScaleAxes::All, ScaleCentre::Point(CENTRE));
        let asked = Relaxation::ScaleRobot(ScaleRobot { least: scale, centre, axes });
        described.bodies.relaxed(&asked, 0.0).expect("it can be scaled").model
    };
    let at = |scale: &f64| match *scale {
        1.0 => described.bodies.prepare(),
        scale => relaxed(scale).description().prepare(),
    };
    SCALES.iter().map(at).collect()
}

#[test]
fn a_configuration_has_the_largest_scale_at_which_the_robot_is_free() {
    let described = described();
    let (model, judges) = (described.prepare(), judges(&described));
    let (scratch, own) = (&mut Scratch::new(), &mut Scratch::new());
    let (mut stream, mut q) = (draws("scaled"), vec![0.0; model.space().len()]);
    let mut counts = [0; SCALES.len() + 1];
    for draw in 0..2000 {
        model.space().sample_uniform(&mut stream, &mut q);
        let largest = judges.iter().position(|judge| judge.is_valid(&q, own));
        own.take_asked();
        let least = judges[SCALES.len() - 1].validity(&q, own);
        let expected = largest.map_or(least, |_| Validity::Valid);
        assert_eq!(model.validity(&q, scratch), expected, "{q:?}");
        let looks = largest.map_or(SCALES.len(), |rung| rung + 1) as u64;
        assert_eq!(scratch.take_asked().configurations, looks);
        let mut values = Vec::new();
        model.values(&q, &mut values, scratch);
        assert_eq!(values, [SCALES[largest.unwrap_or(SCALES.len() - 1)]]);
        assert_eq!(model.reasons(&q, false).is_empty(), largest.is_some());
        counts[largest.unwrap_or(SCALES.len())] += 1;
        scratch.poison(draw);
    }
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
}

#[test]
fn a_motion_is_that_of_the_smaller_of_its_ends_robots() {
    let described = described();
    let (model, judges) = (described.prepare(), judges(&described));
    let space = model.space();
    let (scratch, own) = (&mut Scratch::new(), &mut Scratch::new());
    let (mut stream, mut q) = (draws("motions"), vec![0.0; space.len()]);
    let mut ends: Vec<(Vec<f64>, usize)> = Vec::new();
    while ends.len() < 60 {
        space.sample_uniform(&mut stream, &mut q);
        let largest = judges.iter().position(|judge| judge.is_valid(&q, own));
        ends.extend(largest.map(|rung| (q.clone(), rung)));
    }
    let mut counts = [0, 0];
    for (index, (a, from)) in ends.iter().enumerate() {
        for (b, to) in &ends[..index] {
            let rung = *from.max(to);
            let judge = &judges[rung];
            let free = judge.is_valid(a, own) && judge.is_valid(b, own);
            let valid = free && judge.motion(a, b, 1, own).is_some();
            let expected = valid.then(|| {
                let shrinks = (1.0 - SCALES[*from]) + (1.0 - SCALES[*to]);
                (shrinks, 1.0 - SCALES[rung])
            });
            let cost = model.motion(a, b, 1, scratch);
            assert_eq!(cost, model.motion(b, a, 1, scratch));
            let found = cost.map(|cost| match cost {
                Cost::Directed(cost) => {
                    assert_eq!(cost.forward, cost.backward);
                    cost
                }
                Cost::Metric => panic!("weights expected"),
            });
            assert_eq!(found.is_some(), expected.is_some(), "{a:?} to {b:?}");
            if let (Some(found), Some((weight, peak))) = (found, expected) {
                let length = found.forward - weight;
                let share = 1e-6 * space.distance(a, b) / space.diameter();
                assert!((length - share).abs() < 1e-12, "{length} for {share}");
                assert_eq!(found.peak, peak);
            }
            counts[usize::from(valid)] += 1;
            scratch.poison(index as u64);
        }
    }
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}

/// A ring whose smaller copy, about a point beside it, lies where the ring itself does not.
#[test]
fn ends_are_judged_by_the_smaller_robot_too() {
    let text = r#"
[space]
motion = "translation-2d"
min = [-10.0, -10.0]
max = [10.0, 10.0]
bounds = "reference"
[robot]
bodies = [{ shape = { box = { size = [1.0, 1.0, 1.0] } }, position = [4.0, 0.0, 0.0] }]
[[obstacles]]
shape = { sphere = { radius = 0.4 } }
position = [2.0, 0.0, 0.0]
[[obstacles]]
shape = { sphere = { radius = 0.4 } }
position = [4.0, 5.0, 0.0]
[deformable]
feasibility = { scales = [1.0, 0.5], centre = [0, 0, 0] }
"#;
    let (model, scratch) = (deformable(text).prepare(), &mut Scratch::new());
    let scale = |q: [f64; 2], scratch: &mut Scratch| {
        let mut values = Vec::new();
        assert!(model.is_valid(&q, scratch));
        model.values(&q, &mut values, scratch);
        values[0]
    };
    // At the origin the robot is free, and its smaller copy meets the first ball.
    let (whole, smaller, beside) = ([0.0, 0.0], [0.0, 5.0], [0.0, 2.0]);
    assert_eq!([whole, smaller, beside].map(|q| scale(q, scratch)), [1.0, 0.5, 1.0]);
    assert_eq!(model.motion(&whole, &smaller, 1, scratch), None);
    assert!(model.motion(&beside, &smaller, 1, scratch).is_some());
    assert!(model.motion(&whole, &beside, 1, scratch).is_some());
}
