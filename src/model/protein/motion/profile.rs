//! The energy along a motion, and what the motion costs by it.
//!
//! The energies are taken at equal steps from end to end. A step from energy E to E′ has the probability
//! exp(−(E′ − E)/kT) if E′ > E, else 1, and a motion costs the sum of −ln of its steps' probabilities (N. M. Amato,
//! G. Song, *Using motion planning to study protein folding pathways*, J. Comput. Biol. 9, 2002): the sum of its climbs,
//! in units of kT.

use super::straight;
use crate::math;
use bincode::de::Decoder;
use bincode::enc::Encoder;
use bincode::error::{DecodeError, EncodeError};
use bincode::{Decode, Encode};

/// The energies along a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// The sum of the climbs on the way from the first configuration to the second, in units of kT.
    pub forward: f64,
    /// The same on the way back.
    pub backward: f64,
    /// The highest energy that was seen, in the unit of the energies.
    pub peak: f64,
}

/// More steps are not taken, whatever the resolution.
const STEPS_MAX: f64 = 1_048_576.0;

/// How far apart the configurations of a motion are at which its energy is computed, in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EnergySteps {
    /// At most so far in the metric of the space, the Euclidean length of all turns together.
    Length(f64),
    /// No torsion turns by more than this from one to the next.
    Turn(f64),
}

impl EnergySteps {
    /// The number of radians.
    pub fn radians(self) -> f64 {
        match self {
            EnergySteps::Length(radians) | EnergySteps::Turn(radians) => radians,
        }
    }

    /// So many times finer.
    pub fn finer(self, times: u32) -> EnergySteps {
        match self {
            EnergySteps::Length(length) => EnergySteps::Length(length / f64::from(times)),
            EnergySteps::Turn(turn) => EnergySteps::Turn(turn / f64::from(times)),
        }
    }
}

/// As one number: what is not positive is a turn. Ledgers were written when there were lengths alone, each a positive number.
impl Encode for EnergySteps {
    fn encode<E: Encoder>(&self, encoder: &mut E) -> Result<(), EncodeError> {
        let number = match self {
            EnergySteps::Length(length) => *length,
            EnergySteps::Turn(turn) => -turn,
        };
        number.encode(encoder)
    }
}

impl<Context> Decode<Context> for EnergySteps {
    fn decode<D: Decoder<Context = Context>>(decoder: &mut D) -> Result<EnergySteps, DecodeError> {
        let number = f64::decode(decoder)?;
        // Written so that what is no number is a length, which is refused.
        Ok(if number < 0.0 { EnergySteps::Turn(-number) } else { EnergySteps::Length(number) })
    }
}

bincode::impl_borrow_decode!(EnergySteps);

/// In how many steps a motion is looked at: so many that no step is longer than `resolution`. At least one. The same both ways.
pub fn steps(a: &[f64], b: &[f64], resolution: EnergySteps) -> usize {
    let turns = a.iter().zip(b).map(|(a, b)| math::wrap_angle(b - a));
    let of_one = match resolution {
        EnergySteps::Length(_) => turns.map(|turn| turn * turn).sum::<f64>().sqrt(),
        EnergySteps::Turn(_) => turns.fold(0.0, |widest, turn| turn.abs().max(widest)),
    };
    (of_one / resolution.radians()).ceil().clamp(1.0, STEPS_MAX) as usize
}

/// The profile of the motion from `a` to `b` in [`steps`]; `kt` is kT in the unit of the energies, `energy` gives the
/// energy of a configuration, `between` is working memory. The other way round, the two sums are exchanged, to the bit.
/// `None` where an energy is no finite number.
pub fn profile(
    (a, b): (&[f64], &[f64]),
    resolution: EnergySteps,
    kt: f64,
    between: &mut Vec<f64>,
    mut energy: impl FnMut(&[f64]) -> f64,
) -> Option<Profile> {
    let is_backward = straight::is_backward(a, b);
    let (from, to) = if is_backward { (b, a) } else { (a, b) };
    let count = steps(from, to, resolution);
    let mut last = energy(from);
    if !last.is_finite() {
        return None;
    }
    let (mut up, mut down, mut peak) = (0.0, 0.0, last);
    for step in 1..=count {
        let next = if step == count {
            energy(to)
        } else {
            let time = step as f64 / count as f64;
            let torsion = |(from, to): (&f64, &f64)| {
                math::wrap_angle(from + time * math::wrap_angle(to - from))
            };
            between.clear();
            between.extend(from.iter().zip(to).map(torsion));
            energy(between)
        };
        up += (next - last).max(0.0) / kt;
        down += (last - next).max(0.0) / kt;
        peak = next.max(peak);
        // A sum that is no number stays none; `max` would hide it.
        if !next.is_finite() {
            return None;
        }
        last = next;
    }
    let (forward, backward) = if is_backward { (down, up) } else { (up, down) };
    (forward.is_finite() && backward.is_finite() && peak.is_finite()).then_some(Profile {
        forward,
        backward,
        peak,
    })
}
