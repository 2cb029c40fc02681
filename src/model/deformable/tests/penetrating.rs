//! Robots that may overlap obstacles.

use super::*;
use crate::model::{Cost, Scratch, Validity};

/// A ball of radius 1 that translates, and a wall whose side is at x = 0. Its distance to the nearest free configuration is how
/// deep it overlaps the wall.
const WALL: &str = r#"
[space]
motion = "translation-3d"
min = [-1.5, -2.0, -2.0]
max = [4.0, 2.0, 2.0]
bounds = "reference"
resolution = 0.05
edges = "sampled"
[robot]
bodies = [{ shape = { sphere = { radius = 1.0 } } }]
[[obstacles]]
shape = { box = { size = [8.0, 40.0, 40.0] } }
position = [-4.0, 0.0, 0.0]
[deformable]
"#;

fn model(feasibility: &str) -> Box<dyn Model> {
    deformable(&format!("{WALL}feasibility = {feasibility}\n")).prepare()
}

fn depth(model: &dyn Model, q: &[f64], scratch: &mut Scratch) -> Option<f64> {
    let mut values = Vec::new();
    model.values(q, &mut values, scratch);
    model.is_valid(q, scratch).then_some(values[0])
}

#[test]
fn depths_are_at_least_those_of_the_overlap_and_near_them_with_many_vectors() {
    let (few, many) = (model("{ depth = 0.8 }"), model("{ depth = 0.8, vectors = 4000 }"));
    let scratch = &mut Scratch::new();
    let mut counts = [0, 0];
    for step in 0..=300u32 {
        let x = -0.5 + 0.01 * f64::from(step);
        let overlap = f64::max(1.0 - x, 0.0);
        let q = [x, 0.3, -0.2];
        let found = [&few, &many].map(|model| depth(&**model, &q, scratch));
        for depth in found.into_iter().flatten() {
            assert!(depth >= overlap - 1e-12 && depth <= 0.8, "{depth} for {overlap}");
        }
        // Where the ball touches the wall, rounding decides.
        if (x - 1.0).abs() > 1e-6 {
            assert_eq!(found[1] == Some(0.0), x > 1.0, "{x}");
        }
        if overlap > 0.8 {
            assert_eq!(found, [None, None]);
        } else if overlap < 0.7 {
            // Among 4000 vectors one goes nearly straight out, and is hardly longer than need be.
            let depth = found[1].expect("there is a vector that frees it");
            assert!(depth < overlap + 0.1, "{depth} for {overlap}");
        }
        counts[usize::from(found[0].is_some())] += 1;
        scratch.poison(u64::from(step));
    }
    assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
}

#[test]
fn the_robot_itself_must_be_within_the_bounds() {
    let (model, scratch) = (model("{ depth = 0.8 }"), &mut Scratch::new());
    assert_eq!(model.validity(&[5.0, 0.0, 0.0], scratch), Validity::OutOfBounds);
    assert!(!model.reasons(&[5.0, 0.0, 0.0], false).is_empty());
    assert_eq!(model.validity(&[-1.0, 0.0, 0.0], scratch), Validity::Invalid);
    assert!(!model.reasons(&[-1.0, 0.0, 0.0], false).is_empty());
    assert!(model.reasons(&[2.0, 0.0, 0.0], false).is_empty());
}

/// Every motion against its steps, one by one.
#[test]
fn a_motion_is_feasible_at_all_its_steps() {
    let text = with("feasibility = { depth = 0.6, vectors = 20 }").replace("padding = 0.05", "");
    let described = deformable(&text);
    let (model, bodies) = (described.prepare(), described.bodies.validity());
    let space = model.space();
    let (scratch, own) = (&mut Scratch::new(), &mut Scratch::new());
    let (mut stream, mut q) = (draws("penetrating"), vec![0.0; space.len()]);
    let mut ends: Vec<(Vec<f64>, f64)> = Vec::new();
    while ends.len() < 16 {
        space.sample_uniform(&mut stream, &mut q);
        ends.extend(depth(&*model, &q, own).map(|depth| (q.clone(), depth)));
    }
    let (mut valid, mut deep) = (0, 0);
    for (index, (a, from)) in ends.iter().enumerate() {
        for (b, to) in &ends[..index] {
            let steps = bodies.steps(a, b, 1);
            let (first, last) = if b < a { (b, a) } else { (a, b) };
            let peak = (0..=steps).try_fold(0.0f64, |peak, step| {
                match step {
                    0 => q.copy_from_slice(first),
                    step if step == steps => q.copy_from_slice(last),
                    step => space.interpolate(first, last, step as f64 / steps as f64, &mut q),
                }
                Some(peak.max(depth(&*model, &q, own)?))
            });
            let cost = model.motion(a, b, 1, scratch);
            assert_eq!(cost, model.motion(b, a, 1, scratch));
            scratch.poison(index as u64);
            assert_eq!(cost.is_some(), peak.is_some(), "{a:?} to {b:?}");
            let Some(Cost::Directed(cost)) = cost else { continue };
            assert_eq!(Some(cost.peak), peak);
            let share = 1e-6 * space.distance(a, b) / space.diameter();
            assert!((cost.forward - (from + to) - share).abs() < 1e-12);
            (valid, deep) = (valid + 1, deep + usize::from(cost.peak > 0.0));
        }
    }
    let pairs = ends.len() * (ends.len() - 1) / 2;
    assert!(valid > 10 && valid < pairs - 10 && deep > 3 && deep < valid, "{valid} {deep}");
}
