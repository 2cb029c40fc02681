//! The bytes of a robot, which ledgers and worker processes know.
//!
//! A robot without padding has the bytes that it had before there was any: the number that says how its base moves says also
//! whether a padding follows.

use super::{Link, Robot};
use crate::scene::Pose;
use crate::space::BaseJoint;
use bincode::de::Decoder;
use bincode::enc::Encoder;
use bincode::error::{DecodeError, EncodeError};
use bincode::{Decode, Encode};

/// How the base moves, and the padding of the links if there is any. The first five have the numbers of [`BaseJoint`].
#[derive(Encode, Decode)]
enum First {
    Fixed,
    Translation2d,
    Rigid2d,
    Translation3d,
    Rigid3d,
    Padded(BaseJoint, Vec<f64>), // new ones at the end, since ledgers know them by number
}

impl First {
    fn of(robot: &Robot) -> First {
        match robot.motion {
            motion if !robot.padding.is_empty() => First::Padded(motion, robot.padding.clone()),
            BaseJoint::Fixed => First::Fixed,
            BaseJoint::Translation2d => First::Translation2d,
            BaseJoint::Rigid2d => First::Rigid2d,
            BaseJoint::Translation3d => First::Translation3d,
            BaseJoint::Rigid3d => First::Rigid3d,
        }
    }

    fn split(self) -> (BaseJoint, Vec<f64>) {
        let alone = match self {
            First::Padded(motion, padding) => return (motion, padding),
            First::Fixed => BaseJoint::Fixed,
            First::Translation2d => BaseJoint::Translation2d,
            First::Rigid2d => BaseJoint::Rigid2d,
            First::Translation3d => BaseJoint::Translation3d,
            First::Rigid3d => BaseJoint::Rigid3d,
        };
        (alone, Vec::new())
    }
}

impl Encode for Robot {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        // Without `..`: whoever adds a field has to say where it is kept.
        let Robot { motion: _, base, links, may_touch, padding: _ } = self;
        First::of(self).encode(encoder)?;
        base.encode(encoder)?;
        links.encode(encoder)?;
        may_touch.encode(encoder)
    }
}

impl<Context> Decode<Context> for Robot {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<Robot, DecodeError> {
        let (motion, padding) = First::decode(decoder)?.split();
        Ok(Robot {
            motion,
            base: Pose::decode(decoder)?,
            links: Vec::<Link>::decode(decoder)?,
            may_touch: Decode::decode(decoder)?,
            padding,
        })
    }
}
bincode::impl_borrow_decode!(Robot);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::internal::wire;

    /// The fields of a robot as they were encoded before there was a padding.
    #[derive(Encode)]
    struct Unpadded(BaseJoint, Pose, Vec<Link>, Vec<(u32, u32)>);

    #[test]
    fn only_a_padding_changes_the_bytes_and_every_robot_is_read_back() {
        let motions = [
            BaseJoint::Fixed,
            BaseJoint::Translation2d,
            BaseJoint::Rigid2d,
            BaseJoint::Translation3d,
            BaseJoint::Rigid3d,
        ];
        for motion in motions {
            let plain = Robot { may_touch: vec![(0, 0)], ..Robot::rigid(motion, Vec::new()) };
            let Robot { base, links, may_touch, .. } = plain.clone();
            let before = wire::encode(&Unpadded(motion, base, links, may_touch));
            assert_eq!(wire::encode(&plain), before);
            let padded = Robot { padding: vec![0.25], ..plain.clone() };
            assert_ne!(wire::encode(&padded), before);
            for robot in [plain, padded] {
                let read: Robot = wire::decode(&wire::encode(&robot)).unwrap();
                assert_eq!(read, robot);
            }
        }
    }
}
