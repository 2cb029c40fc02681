//! The random steps that samplers near obstacles take: their length, and the distribution of directions.

use super::statistics::follows;
use super::{SCENE, context};
use crate::numbers::Ordinal;
use crate::seed::{Purpose, Seed};
use crate::space::{BaseJoint, rigid_space};

#[test]
fn steps_have_the_length_asked_for() {
    let cx = context(SCENE);
    let mut stream = Seed::of_set(3, "steps", Ordinal(0)).stream(Purpose::Sampling);
    let (mut q, mut far) = (vec![0.0; 7], vec![0.0; 7]);
    for i in 0..200 {
        cx.space.sample_uniform(&mut stream, &mut q);
        let length = 0.01 * f64::from(i);
        cx.space.step(&q, length, &mut stream, &mut far);
        let distance = cx.space.distance(&q, &far);
        assert!(distance <= length + 1e-7, "{distance} {length}");
        // Within half a turn of the rotation nothing wraps.
        if length < 1.5 {
            assert!((distance - length).abs() < 1e-7, "{distance} {length}");
        }
    }
}

/// Of a uniform point of the unit sphere every coordinate is uniform (Archimedes); here x, y and the turn,
/// in the metric.
#[test]
fn directions_are_uniform_in_the_metric() {
    let space = rigid_space(BaseJoint::Rigid2d, [0.0; 3], [1.0; 3], 0.4);
    let mut stream = Seed::of_set(3, "directions", Ordinal(0)).stream(Purpose::Sampling);
    let mut coordinates = [(); 3].map(|()| Vec::new());
    for _ in 0..4000 {
        let mut q = [0.0; 3];
        space.step(&[0.0; 3], 1.0, &mut stream, &mut q);
        let shares = [q[0], q[1], 0.4 * q[2]];
        coordinates.iter_mut().zip(shares).for_each(|(sample, share)| sample.push(share));
    }
    coordinates.into_iter().for_each(|sample| follows(sample, |share| (share + 1.0) / 2.0));
}
