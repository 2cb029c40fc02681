//! The one source of randomness.
//!
//! A node set is named by the label of its strategy and its ordinal within that label. Its seed
//! is a pure function of the base seed and that name, the three inputs that TR05-007 §3.1 asks
//! for: *"we reseed the random number generator for each set based on the base seed of the
//! program, the type of node generation method, and the number of sets completed by that node
//! generation method so far"*. BLAKE3 derives it, ChaCha8 draws from it.

use crate::math;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// What a stream of random numbers inside a set is for. Each purpose has its own stream, so that
/// one more draw for one purpose never shifts the numbers of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Proposing configurations.
    Sampling = 0,
    /// Deciding which proposals are kept.
    Accepting = 1,
    /// Choosing what to connect.
    Connecting = 2,
}

/// The seed of one node set or of one evaluator.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Seed([u8; 32]);

impl std::fmt::Display for Seed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl Seed {
    /// Seed of the set `ordinal` (counted from 0) of the strategy `label`.
    pub fn of_set(base_seed: u64, label: &str, ordinal: u64) -> Seed {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 set seed");
        hasher.update(&base_seed.to_le_bytes());
        hasher.update(&(label.len() as u64).to_le_bytes());
        hasher.update(label.as_bytes());
        hasher.update(&ordinal.to_le_bytes());
        Seed(*hasher.finalize().as_bytes())
    }

    /// Seed of the evaluator at `path` in the evaluator tree.
    pub fn of_evaluator(base_seed: u64, path: &str) -> Seed {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 evaluator");
        hasher.update(&base_seed.to_le_bytes());
        hasher.update(path.as_bytes());
        Seed(*hasher.finalize().as_bytes())
    }

    /// The stream of random numbers of one purpose, from its beginning.
    pub fn stream(&self, purpose: Purpose) -> Stream {
        let mut generator = ChaCha8Rng::from_seed(self.0);
        generator.set_stream(purpose as u64);
        Stream(generator)
    }
}

/// A stream of random numbers. It converts bits to numbers itself: a library's conversions may
/// change between releases, and with them every roadmap.
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// Uniform in `[0, 1)`, a multiple of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Normal with mean 0 and deviation 1 (G. E. P. Box, M. E. Muller 1958), from two draws.
    pub fn normal(&mut self) -> f64 {
        let (share, turn) = (1.0 - self.unit(), self.unit());
        (-2.0 * math::ln(share)).sqrt() * math::cos(math::TURN * turn)
    }

    /// Uniform in `[low, high]`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        (low + self.unit() * (high - low)).clamp(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_labels_ordinals_and_purposes_have_their_own_numbers() {
        let mut seen = std::collections::BTreeSet::new();
        for base_seed in [0, 1] {
            for label in ["uniform", "bridge"] {
                for ordinal in [0, 1] {
                    for purpose in [Purpose::Sampling, Purpose::Accepting, Purpose::Connecting] {
                        let mut stream = Seed::of_set(base_seed, label, ordinal).stream(purpose);
                        assert!(seen.insert(stream.unit().to_bits()));
                    }
                }
            }
        }
    }

    #[test]
    fn the_first_numbers_of_a_set_are_golden() {
        let mut stream = Seed::of_set(1, "uniform", 0).stream(Purpose::Sampling);
        let drawn = [stream.unit(), stream.unit()].map(f64::to_bits);
        assert_eq!(drawn, GOLDEN, "bits of a given seed changed: bump BITS_VERSION");
    }
    const GOLDEN: [u64; 2] = [4605283773480867618, 4604761783744469923];
}
