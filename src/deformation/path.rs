use super::SoftBody;
use super::robot::placed;
use crate::scene::Pose;
use std::sync::Arc;

/// A path along which the robot is deformed where it has to be: frame by frame where the robot is and what shape it has. From one frame to
/// the next every vertex moves in a straight line in the world's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct DeformedPath {
    /// The frames, from the path's start to its goal; at least one.
    pub frames: Vec<Frame>,
    /// How many motions the path is made of: edges of a roadmap, or legs of a path that was given.
    pub edges: usize,
    /// What is known of the motion between the frames.
    pub between: Between,
}

/// The robot at one moment of a [`DeformedPath`].
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The configuration of the rigid robot, as [`Space::interpolate`](crate::space::Space::interpolate) gives it: a quaternion may be the
    /// negative of its stored form.
    pub configuration: Vec<f64>,
    /// The pose of the robot's frame in the world's at this configuration.
    pub pose: Pose,
    /// The vertices in the robot's frame, in the order of the robot's at rest. Frames in which the robot is at rest share one list.
    pub vertices: Arc<[[f64; 3]]>,
    /// The energy of the deformation, as the method of deformation says; of a blend of two shapes a bound above it.
    pub energy: f64,
    /// The volume that the shape encloses, as a share of the volume at rest.
    pub volume: f64,
    /// How far along the path the frame is, by the length of the configurations' motion in the space's metric: from 0 to 1.
    pub share: f64,
    /// Which edge of the path leads to the frame, counted from 0; the first frame belongs to edge 0.
    pub edge: usize,
    /// Whether the shape is a blend of those of two frames nearby, instead of what the method of deformation gives at the configuration.
    pub is_blend: bool,
}

impl Frame {
    /// The vertices in the world's frame.
    pub fn in_world(&self) -> Vec<[f64; 3]> {
        placed(&self.vertices, &self.pose)
    }
}

/// What is known of the motion of a deformed robot between two frames of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Between {
    /// The surface keeps at least this distance from the obstacles between any two frames as well, a length above 0: half of the largest
    /// movement of a vertex is less than the clearance at the frames, and this is the difference.
    Proved {
        /// The least distance.
        clearance: f64,
    },
    /// The robot is free at the frames, and nothing is known of the motion between two of them.
    Sampled,
}

impl DeformedPath {
    /// The path with these frames, at which the robot keeps a clearance from the obstacles.
    pub(super) fn new(frames: Vec<Frame>, edges: usize, clearance: f64) -> DeformedPath {
        let path = DeformedPath { frames, edges, between: Between::Sampled };
        // A point of the surface is at most half of the movement away from where it is at one of the two frames.
        let kept = clearance - path.largest_movement() / 2.0;
        match kept > 0.0 {
            true => DeformedPath { between: Between::Proved { clearance: kept }, ..path },
            false => path,
        }
    }

    /// The farthest that a vertex moves from one frame to the next, in the world's frame, a length.
    pub fn largest_movement(&self) -> f64 {
        let mut largest = 0.0;
        let mut before: Option<Vec<[f64; 3]>> = None;
        for frame in &self.frames {
            let now = frame.in_world();
            if let Some(before) = &before {
                largest = f64::max(largest, movement(before, &now));
            }
            before = Some(now);
        }
        largest
    }

    /// The highest energy of a frame.
    pub fn highest_energy(&self) -> f64 {
        self.frames.iter().map(|frame| frame.energy).fold(0.0, f64::max)
    }

    /// The least and the greatest volume of a frame, as shares of the volume at rest.
    pub fn volumes(&self) -> [f64; 2] {
        let of = |pick: fn(f64, f64) -> f64| {
            self.frames.iter().map(|frame| frame.volume).reduce(pick).unwrap_or(1.0)
        };
        [of(f64::min), of(f64::max)]
    }
}

/// The farthest that a vertex moves between two shapes of one robot, both in the world's frame.
pub(super) fn movement(from: &[[f64; 3]], to: &[[f64; 3]]) -> f64 {
    let squares = from.iter().zip(to).map(|(a, b)| {
        let [x, y, z] = [0, 1, 2].map(|axis| b[axis] - a[axis]);
        x * x + y * y + z * z
    });
    squares.fold(0.0, f64::max).sqrt()
}

impl SoftBody {
    /// The volume of a shape as a share of the volume at rest; 1 of a surface without volume at rest.
    pub fn volume_share(&self, vertices: &[[f64; 3]]) -> f64 {
        let whole = self.volume(self.vertices());
        if whole > 0.0 { self.volume(vertices) / whole } else { 1.0 }
    }
}
