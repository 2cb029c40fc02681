//! Which links touch one another in all configurations, and which in none, as far as drawn configurations tell.
//!
//! MoveIt's Setup Assistant finds in the same way which pairs of links need no test (its *always* and *never* in
//! collision): Sucan and Chitta, <https://moveit.picknik.ai>.

use super::BodyScratch;
use super::bodies::BodyValidity;
use super::frame::Stance;
use super::meet::{Group, Meeting};
use super::piece::Piece;
use crate::model::Scratch;
use crate::seed::{Purpose, Seed};
use parry3d_f64::bounding_volume::BoundingVolume;
use parry3d_f64::math::Pose;

/// How often two links touch that must not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PairTouches {
    /// The indices of the two links, the lower first.
    pub links: (usize, usize),
    /// In how many of the drawn configurations they touch.
    pub touching: u64,
}

impl BodyValidity {
    /// How often each pair of links that must not touch does so in `samples` configurations drawn uniformly from the space;
    /// obstacles are not looked at. The configurations follow from the base seed alone.
    pub fn touching(&self, samples: u64, base_seed: u64) -> Vec<PairTouches> {
        let mut pairs: Vec<PairTouches> = self
            .own_meetings()
            .map(|meeting| PairTouches { links: links_of(&meeting), touching: 0 })
            .collect();
        let mut stream = Seed::of_evaluator(base_seed, "touching links").stream(Purpose::Sampling);
        let mut scratch = Scratch::new();
        let BodyScratch { stance, stacks, .. } = scratch.of_model();
        let mut q = vec![0.0; self.space.len()];
        for _ in 0..samples {
            self.space.sample_uniform(&mut stream, &mut q);
            self.robot.link_poses(&q, &mut stance.poses);
            stance.update_frames();
            for (meeting, pair) in self.own_meetings().zip(&mut pairs) {
                let touches =
                    meeting.surfaces_meet(stance, &mut stacks.pairs) || encloses(&meeting, stance);
                pair.touching += u64::from(touches);
            }
        }
        pairs
    }

    /// The pairs of links that must not touch.
    fn own_meetings(&self) -> impl Iterator<Item = Meeting<'_>> {
        self.meetings().filter(|meeting| meeting.still_link.is_some())
    }
}

fn links_of(meeting: &Meeting) -> (usize, usize) {
    let (one, other) = (meeting.mover_link, meeting.still_link.unwrap_or_default());
    (one.min(other), one.max(other))
}

/// Whether a solid mesh of one link encloses a part of the other, given that no surfaces meet.
fn encloses(meeting: &Meeting, stance: &Stance) -> bool {
    let Meeting { mover, still, .. } = meeting;
    if !(Group::is_hollow(mover) || Group::is_hollow(still)) {
        return false;
    }
    let (at, other_at) = (stance.pose(Some(meeting.mover_link)), stance.pose(meeting.still_link));
    let either = |one: &Piece, other: &Piece, at: &Pose, other_at: &Pose| {
        one.box_at(at).intersects(&other.box_at(other_at))
            && (one.encloses(at, other, other_at) || other.encloses(other_at, one, at))
    };
    mover
        .pieces
        .iter()
        .any(|one| still.pieces.iter().any(|other| either(one, other, &at, &other_at)))
}
