//! Deforming a robot along one motion.
//!
//! Frames are put along the motion until no vertex moves farther from one to the next than
//! [`DeformableRobot::longest_movement`](super::DeformableRobot::longest_movement) allows. Two frames that are too far apart are halved: the robot
//! is deformed at the configuration between them. All gaps of the whole motion are halved before any is halved again, so that a motion that
//! cannot be deformed is known early.
//!
//! Once the poses of two frames are near one another but their shapes are not, their shapes are blended: vertices go in straight lines from one
//! shape to the other while the pose goes on, each such shape is tested for obstacles, and a motion from shape to shape is found without any
//! further deformation. Where a blend meets an obstacle the gap is halved again, until the poses are so near that it is the shape that jumps.

use super::path::movement;
use super::robot::{Shape, Shapes, placed};
use super::{DeformableRobot, DeformedPath, Frame, Refusal};
use crate::cancel::Cancel;
use crate::scene::Pose;
use crate::space::Configs;

/// The most frames of one motion.
const FRAMES_MAX: usize = 1 << 16;

/// A shape jumps where the robot at rest moves less far than this share of the longest movement, and the shape farther than the whole of it
/// without a free blend.
const JUMP: f64 = 1.0 / 16.0;

/// A motion along which the robot is deformed.
#[derive(Clone, Debug)]
pub(super) struct DeformedMotion {
    stops: Vec<Stop>,
}

/// Why a motion has no deformation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unfinished {
    Refused(Refusal),
    Cancelled,
}

impl From<Refusal> for Unfinished {
    fn from(refusal: Refusal) -> Unfinished {
        Unfinished::Refused(refusal)
    }
}

/// A frame of a motion while it is made.
#[derive(Clone, Debug)]
struct Stop {
    /// Where on the motion it is: the number of the leg, and as its fraction the share of the leg.
    at: f64,
    configuration: Vec<f64>,
    pose: Pose,
    shape: Shape,
    is_blend: bool,
    /// Whether the next frame is near enough.
    is_closed: bool,
}

impl Stop {
    fn world(&self) -> Vec<[f64; 3]> {
        placed(&self.shape.vertices, &self.pose)
    }
}

/// What lies between two frames.
enum Gap {
    /// Nothing: they are near enough, or these blends between them are.
    Closed(Vec<Stop>),
    /// A frame at this place of the motion is to come.
    Halved(f64),
}

/// Deforms the robot along a motion through these configurations, at least one.
pub(super) fn deform_motion(
    motion: &Configs,
    shapes: &mut Shapes,
    cancel: &Cancel,
) -> Result<DeformedMotion, Unfinished> {
    let turns = motion.len().saturating_sub(1);
    // The ends first: they are the ends of other motions, too, and may be known.
    let mut ends = Vec::new();
    for index in [0, turns] {
        ends.push(stop(motion, index as f64, shapes, cancel)?);
    }
    let last = ends.pop().filter(|_| turns > 0);
    let mut stops = ends;
    for index in 1..turns {
        stops.push(stop(motion, index as f64, shapes, cancel)?);
    }
    stops.extend(last);
    loop {
        let (mut finer, mut is_done) = (Vec::with_capacity(2 * stops.len()), true);
        let mut stops_after = stops.into_iter();
        let Some(mut before) = stops_after.next() else {
            return Ok(DeformedMotion { stops: finer });
        };
        for next in stops_after {
            let gap = match before.is_closed {
                true => Gap::Closed(Vec::new()),
                // What is refused after the end of the search is no verdict, as the method may have been stopped.
                false => match gap(motion, [&before, &next], shapes) {
                    Err(_) if cancel.is_cancelled() => return Err(Unfinished::Cancelled),
                    found => found?,
                },
            };
            match gap {
                Gap::Closed(blends) => {
                    finer.push(Stop { is_closed: true, ..before });
                    finer.extend(blends);
                }
                Gap::Halved(at) => {
                    is_done = false;
                    finer.push(before);
                    finer.push(stop(motion, at, shapes, cancel)?);
                }
            }
            if finer.len() > FRAMES_MAX.min(shapes.room) {
                return Err(Refusal::Frames.into());
            }
            before = next;
        }
        finer.push(before);
        if is_done {
            shapes.room = shapes.room.saturating_sub(finer.len());
            return Ok(DeformedMotion { stops: finer });
        }
        stops = finer;
    }
}

/// The frame at a place of a motion, by the method of deformation.
fn stop(
    motion: &Configs,
    at: f64,
    shapes: &mut Shapes,
    cancel: &Cancel,
) -> Result<Stop, Unfinished> {
    if cancel.is_cancelled() {
        return Err(Unfinished::Cancelled);
    }
    let configuration = configuration(motion, at, shapes);
    let is_turn = at.fract() == 0.0;
    let shape = if is_turn { shapes.at_end(&configuration) } else { shapes.at(&configuration) };
    // A deformation may take long. What it came to after the end of the search is no verdict of the search.
    if cancel.is_cancelled() {
        return Err(Unfinished::Cancelled);
    }
    let shape = shape?;
    let pose = (shapes.robot.pose)(&configuration);
    Ok(Stop { at, configuration, pose, shape, is_blend: false, is_closed: false })
}

fn configuration(motion: &Configs, at: f64, shapes: &Shapes) -> Vec<f64> {
    let leg = at as usize;
    let mut q = motion.get(leg).to_vec();
    if at.fract() > 0.0 {
        let (from, to) = (motion.get(leg), motion.get(leg + 1));
        shapes.robot.space.interpolate(from, to, at.fract(), &mut q);
    }
    q
}

/// What is to lie between two neighbouring frames of one leg.
fn gap(motion: &Configs, [from, to]: [&Stop; 2], shapes: &mut Shapes) -> Result<Gap, Refusal> {
    let longest = shapes.robot.longest_movement();
    let moved = movement(&from.world(), &to.world());
    if moved <= longest {
        return Ok(Gap::Closed(Vec::new()));
    }
    // A vertex moves by the longest movement at most from frame to frame, so that there would be more frames than this.
    if moved / longest > FRAMES_MAX.min(shapes.room) as f64 {
        return Err(Refusal::Frames);
    }
    let rigid = shapes.robot.rigid_movement(&from.pose, &to.pose);
    if rigid <= longest {
        if let Some(blends) = blends(motion, [from, to], moved, shapes) {
            return Ok(Gap::Closed(blends));
        }
        if rigid <= JUMP * longest {
            return Err(Refusal::Jump(moved));
        }
    }
    let middle = from.at + (to.at - from.at) / 2.0;
    // So near to one another are only frames between which no movement can be made shorter.
    let is_between = from.at < middle && middle < to.at;
    if is_between { Ok(Gap::Halved(middle)) } else { Err(Refusal::Jump(moved)) }
}

/// Blends of the shapes of two frames, as few as are needed so that no vertex moves farther than it may from one to the next; `None` where
/// one of them is not accepted.
fn blends(
    motion: &Configs,
    [from, to]: [&Stop; 2],
    moved: f64,
    shapes: &mut Shapes,
) -> Option<Vec<Stop>> {
    let longest = shapes.robot.longest_movement();
    let pieces = (moved / longest).ceil();
    if pieces >= FRAMES_MAX.min(shapes.room) as f64 {
        return None;
    }
    // The pose turns meanwhile, so that the pieces are unequal by a little.
    (pieces as usize..=pieces as usize + 4)
        .find_map(|count| {
            let blend = |index: usize| {
                let share = index as f64 / count as f64;
                let at = from.at + (to.at - from.at) * share;
                let configuration = configuration(motion, at, shapes);
                let pose = (shapes.robot.pose)(&configuration);
                let shape = from.shape.blended(&to.shape, share);
                Stop { at, configuration, pose, shape, is_blend: true, is_closed: true }
            };
            let blends: Vec<Stop> = (1..count).map(blend).collect();
            let all = [from].into_iter().chain(&blends).chain([to]);
            let worlds: Vec<_> = all.map(Stop::world).collect();
            let is_near = |pair: &[Vec<[f64; 3]>]| movement(&pair[0], &pair[1]) <= longest;
            worlds.windows(2).all(is_near).then_some(blends)
        })
        .filter(|blends| blends.iter().all(|blend| shapes.accept_blend(&blend.pose, &blend.shape)))
}

impl DeformedMotion {
    /// The frames, in the direction of the motion or against it.
    fn stops(&self, is_forward: bool) -> impl Iterator<Item = &Stop> {
        let count = self.stops.len();
        (0..count).map(move |index| &self.stops[if is_forward { index } else { count - 1 - index }])
    }
}

/// The path along deformed motions, each of which begins where the one before it ends, in its own direction or against it. There is at least
/// one motion.
pub(super) fn joined(motions: &[(&DeformedMotion, bool)], robot: &DeformableRobot) -> DeformedPath {
    let mut frames: Vec<Frame> = Vec::new();
    for (edge, (motion, is_forward)) in motions.iter().enumerate() {
        // The end of one motion is the beginning of the next, and is there already.
        for stop in motion.stops(*is_forward).skip(usize::from(edge > 0)) {
            let length = frames.last().map_or(0.0, |before| {
                before.share + robot.space.distance(&before.configuration, &stop.configuration)
            });
            frames.push(Frame {
                configuration: stop.configuration.clone(),
                pose: stop.pose,
                vertices: stop.shape.vertices.clone(),
                energy: stop.shape.energy,
                volume: robot.body.volume_share(&stop.shape.vertices),
                share: length,
                edge,
                is_blend: stop.is_blend,
            });
        }
    }
    // So far the shares are lengths from the start.
    let whole = frames.last().map_or(0.0, |last| last.share);
    frames.iter_mut().filter(|_| whole > 0.0).for_each(|frame| frame.share /= whole);
    DeformedPath::new(frames, motions.len(), robot.clearance)
}
