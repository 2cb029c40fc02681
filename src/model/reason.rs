use crate::space::{FactorKind, Space};
use serde::Serialize;
use std::fmt;

/// Why a configuration is not valid: one of the things that are wrong with it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "reason", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Reason {
    /// A value of the configuration is not in its interval: a joint beyond its limits, or a reference point out of bounds.
    Range {
        /// The name of the degree of freedom.
        dof: String,
        /// Its value.
        value: f64,
        /// Least value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A link reaches beyond the bounds.
    Bounds {
        /// The link's name; `robot` of a robot that has only one.
        link: String,
        /// The axis along which it does, `x`, `y` or `z`, with the sign of the side.
        side: String,
        /// How far, in the scene's unit of length.
        by: f64,
    },
    /// A body of a link touches an obstacle or a body of another link.
    Collision {
        /// The body that is moved.
        body: BodyName,
        /// What it touches.
        other: BodyName,
        /// How far the first body would have to move to be free of the other, in the scene's unit of length: the least that
        /// was found over several directions, so at least the penetration depth. 0 where the two only touch.
        depth: f64,
        /// The direction of this shortest way, a unit vector in the world's frame.
        direction: [f64; 3],
        /// How near to the first body the other is already in the way, a length: the padding of its link. The depth is
        /// that of the body with its padding.
        #[serde(skip_serializing_if = "is_zero")]
        padding: f64,
    },
    /// What another model says.
    Other {
        /// In words.
        text: String,
    },
}

fn is_zero(length: &f64) -> bool {
    *length == 0.0
}

/// The name of the link of a robot that has no other.
pub(crate) const SOLE_LINK: &str = "robot";

/// A link in a sentence.
pub(crate) fn link_named(link: &str) -> String {
    if link == SOLE_LINK { "the robot".to_owned() } else { format!("link `{link}`") }
}

/// A positive length to three digits.
fn short(length: f64) -> String {
    let (mut decimals, mut least) = (0, 100.0);
    while length < least && decimals < 7 {
        (decimals, least) = (decimals + 1, least / 10.0);
    }
    if decimals == 7 { format!("{length:.2e}") } else { format!("{length:.decimals$}") }
}

/// A body as people know it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(untagged)]
pub enum BodyName {
    /// A body of the robot.
    Link {
        /// The name of its link; `robot` of a robot that has only one.
        link: String,
        /// Its number in the link's list, from 0.
        body: usize,
        /// How many bodies the link has.
        of: usize,
    },
    /// An obstacle.
    Obstacle {
        /// Its number in the problem's list, from 0.
        obstacle: usize,
    },
}

impl fmt::Display for BodyName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BodyName::Link { link, of: 1, .. } => f.write_str(&link_named(link)),
            BodyName::Link { link, body, .. } => write!(f, "{} (bodies[{body}])", link_named(link)),
            BodyName::Obstacle { obstacle } => write!(f, "obstacles[{obstacle}]"),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::Range { dof, value, min, max } => {
                write!(f, "{dof} is {value}, {min} to {max} expected")
            }
            Reason::Bounds { link, side, by } => {
                write!(f, "{} reaches {} beyond the bounds at {side}", link_named(link), short(*by))
            }
            Reason::Collision { body, other, depth, direction: [x, y, z], padding } => {
                let padding = match *padding {
                    0.0 => String::new(),
                    padding => format!(" with its padding of {}", short(padding)),
                };
                if *depth == 0.0 {
                    return write!(f, "{body}{padding} touches {other}");
                }
                write!(
                    f,
                    "{body}{padding} collides with {other}, {} deep (free if moved by that along ({x:.2} {y:.2} {z:.2}))",
                    short(*depth)
                )
            }
            Reason::Other { text } => f.write_str(text),
        }
    }
}

/// The values that are not in their intervals.
pub(crate) fn out_of_range(space: &Space, q: &[f64]) -> Vec<Reason> {
    let mut reasons = Vec::new();
    for factor in space.factors() {
        let FactorKind::Real { min, max } = factor.kind else { continue };
        let value = q[factor.at];
        if !(min..=max).contains(&value) {
            let dof = space.dofs()[factor.at].name.clone();
            reasons.push(Reason::Range { dof, value, min, max });
        }
    }
    reasons
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_three_digits() {
        for (length, expected) in [
            (1234.5, "1234"),
            (123.4, "123"),
            (12.34, "12.3"),
            (0.16774, "0.168"),
            (0.000_123_4, "0.000123"),
            (1.234e-7, "1.23e-7"),
        ] {
            assert_eq!(short(length), expected);
        }
    }
}
