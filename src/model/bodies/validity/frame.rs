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

    /// This frame expressed in another, both being given in the same frame.
    #[inline]
    pub fn seen_from(&self, other: &Frame) -> Frame {
        let back = other.turn.transpose();
        Frame { turn: back * self.turn, shift: back * (self.shift - other.shift) }
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
}
