use crate::model::bodies::robot::Drive;
use crate::scene::Pose;
use parry3d_f64::math::{Matrix, Pose as ParryPose, Vector};

/// A pose with its rotation as a matrix, for placing many points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub turn: Matrix,
    pub shift: Vector,
}

impl Frame {
    #[inline]
    pub fn of(pose: &ParryPose) -> Frame {
        Frame { turn: Matrix::from_quat(pose.rotation), shift: pose.translation }
    }

    #[inline]
    pub fn point(&self, p: Vector) -> Vector {
        self.turn * p + self.shift
    }

    #[inline]
    pub fn direction(&self, v: Vector) -> Vector {
        self.turn * v
    }

    /// Three points.
    #[inline(always)]
    pub fn points(&self, [a, b, c]: &[Vector; 3]) -> [Vector; 3] {
        [self.point(*a), self.point(*b), self.point(*c)]
    }

    /// This frame expressed in another, both being given in the same frame.
    #[inline]
    pub fn seen_from(&self, other: &Frame) -> Frame {
        let back = other.turn.transpose();
        Frame { turn: back * self.turn, shift: back * (self.shift - other.shift) }
    }
}

/// The velocities of the points of a rigid body at some time: of a point at p it is `at_origin + turning × p`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Velocities {
    pub at_origin: Vector,
    pub turning: Vector,
}

impl Velocities {
    #[inline]
    pub fn at(&self, p: Vector) -> Vector {
        self.at_origin + self.turning.cross(p)
    }
}

/// The poses of all links in the world's frame at one configuration.
#[derive(Clone, Debug, Default)]
pub(super) struct Stance {
    pub poses: Vec<Pose>,
    pub frames: Vec<Frame>,
}

impl Stance {
    /// Computes the frames from the poses.
    pub fn update_frames(&mut self) {
        self.frames.clear();
        self.frames.extend(self.poses.iter().map(|pose| Frame::of(&pose.to_parry())));
    }

    /// The pose of a link; without a link, that of the world.
    #[inline]
    pub fn pose(&self, link: Option<usize>) -> ParryPose {
        link.map_or(ParryPose::IDENTITY, |link| self.poses[link].to_parry())
    }

    /// The frame of a link expressed in that of another link, or in the world's.
    #[inline]
    pub fn seen(&self, link: usize, from: Option<usize>) -> Frame {
        match from {
            None => self.frames[link],
            Some(from) => self.frames[link].seen_from(&self.frames[from]),
        }
    }

    /// How fast the points of a link move as seen from another link or from the world, in whose frame points and velocities
    /// are given. `drives` are those of the two ([`Hops::drives`](crate::model::bodies::robot::Hops::drives)).
    pub fn velocities(&self, drives: &[Drive], from: Option<usize>) -> Velocities {
        let (mut at_origin, mut turning) = (Vector::ZERO, Vector::ZERO);
        for Drive { parent, origin, turn, slide } in drives {
            let (origin, turn, slide) = match parent {
                None => (self.frames[0].shift, *turn, *slide),
                Some(parent) => {
                    let frame = &self.frames[*parent as usize];
                    (frame.point(*origin), frame.direction(*turn), frame.direction(*slide))
                }
            };
            turning += turn;
            at_origin += slide - turn.cross(origin);
        }
        match from {
            None => Velocities { at_origin, turning },
            Some(from) => {
                let frame = &self.frames[from];
                let back = frame.turn.transpose();
                let at_origin = back * (at_origin + turning.cross(frame.shift));
                Velocities { at_origin, turning: back * turning }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::bodies::robot::mimics_tests::drawn_with_mimics;
    use crate::model::bodies::robot::rates_tests::{MOTIONS, drawn_robot};
    use crate::model::bodies::robot::{Hops, Robot};
    use crate::numbers::Ordinal;
    use crate::seed::{Purpose, Seed, Stream};
    use proptest::prelude::*;

    /// Velocities against differences of the places that points have shortly before and after.
    fn are_those_of_points(robot: &Robot, stream: &mut Stream) -> Result<(), TestCaseError> {
        const STEP: f64 = 1e-5;
        let hops = Hops::new(robot);
        let space = robot.space([-2.0; 3], [2.0; 3], 1.0);
        let (mut a, mut b) = (vec![0.0; space.len()], vec![0.0; space.len()]);
        space.sample_uniform(stream, &mut a);
        space.sample_uniform(stream, &mut b);
        let time = STEP + (1.0 - 2.0 * STEP) * stream.unit();
        let stances = [time - STEP, time, time + STEP].map(|t| {
            let (mut q, mut stance) = (a.clone(), Stance::default());
            space.interpolate(&a, &b, t, &mut q);
            robot.link_poses(&q, &mut stance.poses);
            stance.update_frames();
            stance
        });
        let mut drives = Vec::new();
        for to in 0..robot.links.len() {
            for from in std::iter::once(None).chain((0..to).map(Some)) {
                hops.drives(from, to, (&a, &b), &mut drives);
                let point = Vector::new(stream.normal(), stream.normal(), stream.normal());
                let [before, at, after] =
                    [0, 1, 2].map(|i: usize| stances[i].seen(to, from).point(point));
                let velocity = stances[1].velocities(&drives, from).at(at);
                let expected = (after - before) / (2.0 * STEP);
                let rates = hops.rates(from, to, (&a, &b), &mut Vec::new());
                let scale = 1.0 + rates.speed_at(point.length());
                let error = (velocity - expected).length();
                // The differences are off by the third derivative times the square of the step.
                prop_assert!(
                    error < 1e-6 * scale * (1.0 + rates.spin) * (1.0 + rates.spin),
                    "{} of {}",
                    error,
                    scale
                );
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn velocities_are_those_of_points(ordinal in any::<u64>()) {
            let mut stream = Seed::of_set(5, "velocities", Ordinal(ordinal)).stream(Purpose::Sampling);
            for motion in MOTIONS {
                let robots =
                    [drawn_robot(&mut stream, motion, 6, 6), drawn_with_mimics(&mut stream, motion, 8)];
                for robot in robots {
                    are_those_of_points(&robot, &mut stream)?;
                }
            }
        }
    }
}
