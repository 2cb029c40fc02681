//! The one source of randomness.
//!
//! A node set is named by the label of its strategy and its ordinal within that label. Its seed
//! is a pure function of the base seed and that name, the three inputs that TR05-007 §3.1 asks
//! for: *"we reseed the random number generator for each set based on the base seed of the
//! program, the type of node generation method, and the number of sets completed by that node
//! generation method so far"*. BLAKE3 derives it, ChaCha8 draws from it.

use crate::math;
use crate::numbers::Ordinal;
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
    /// Choosing what to connect within the set, or to what it grows from.
    Connecting = 2,
    /// Choosing what of a set to connect with what came before it.
    Joining = 3,
}

/// The seed of one node set, of one evaluator, or of what is found before either.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Seed {
    own: [u8; 32],
    /// What the sets of one label have in common.
    common: [u8; 32],
    ordinal: Ordinal,
}

impl std::fmt::Display for Seed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.own.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl Seed {
    /// Seed of the set `ordinal` of the strategy `label`.
    pub fn of_set(base_seed: u64, label: &str, ordinal: Ordinal) -> Seed {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 set seed");
        hasher.update(&base_seed.to_le_bytes());
        hasher.update(&(label.len() as u64).to_le_bytes());
        hasher.update(label.as_bytes());
        let common = derived("roadmill 1 label seed", hasher.finalize().as_bytes(), 0);
        hasher.update(&ordinal.0.to_le_bytes());
        Seed { own: *hasher.finalize().as_bytes(), common, ordinal }
    }

    /// Seed of the evaluator at `path` in the evaluator tree.
    pub fn of_evaluator(base_seed: u64, path: &str) -> Seed {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 evaluator");
        hasher.update(&base_seed.to_le_bytes());
        hasher.update(path.as_bytes());
        let own = *hasher.finalize().as_bytes();
        Seed { own, common: own, ordinal: Ordinal(0) }
    }

    /// Seed of what is found once about the strategy `label`, before any of its sets is made.
    pub fn of_calibration(base_seed: u64, label: &str) -> Seed {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 calibration");
        hasher.update(&base_seed.to_le_bytes());
        hasher.update(label.as_bytes());
        let own = *hasher.finalize().as_bytes();
        Seed { own, common: own, ordinal: Ordinal(0) }
    }

    /// The base seed of the problem of a level of a relaxation, the one that is tried as this number: below 2⁶³, as a problem file
    /// can say it.
    pub(crate) fn base_of_level(base_seed: u64, number: u32) -> u64 {
        let mut hasher = blake3::Hasher::new_derive_key("roadmill 1 level");
        hasher.update(&base_seed.to_le_bytes());
        hasher.update(&number.to_le_bytes());
        let [a, b, c, d, e, f, g, h, ..] = *hasher.finalize().as_bytes();
        u64::from_le_bytes([a, b, c, d, e, f, g, h]) >> 1
    }

    /// The ordinal of the set within its label, so that sets can share out points that stand in a fixed
    /// order; 0 for an evaluator.
    pub fn ordinal(&self) -> Ordinal {
        self.ordinal
    }

    /// Seed `index` of those that are the same for all sets of the label.
    pub fn common(&self, index: u64) -> Seed {
        let own = derived("roadmill 1 common seed", &self.common, index);
        Seed { own, common: own, ordinal: Ordinal(0) }
    }

    /// The seed of the same set for part `index` of a method that is made of several.
    pub fn part(&self, index: u64) -> Seed {
        let part = |bytes| derived("roadmill 1 part seed", bytes, index);
        Seed { own: part(&self.own), common: part(&self.common), ordinal: self.ordinal }
    }

    /// The stream of random numbers of one purpose, from its beginning.
    pub fn stream(&self, purpose: Purpose) -> Stream {
        let mut generator = ChaCha8Rng::from_seed(self.own);
        generator.set_stream(purpose as u64);
        Stream(generator)
    }
}

fn derived(context: &str, bytes: &[u8; 32], index: u64) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new_derive_key(context);
    hasher.update(bytes);
    hasher.update(&index.to_le_bytes());
    *hasher.finalize().as_bytes()
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

    /// Uniform among `0..count`, which is far below 2⁵³.
    pub fn below(&mut self, count: u64) -> u64 {
        (self.unit() * count as f64) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PURPOSES: [Purpose; 4] =
        [Purpose::Sampling, Purpose::Accepting, Purpose::Connecting, Purpose::Joining];

    #[test]
    fn sets_labels_ordinals_and_purposes_have_their_own_numbers() {
        let mut seen = std::collections::BTreeSet::new();
        for base_seed in [0, 1] {
            for label in ["uniform", "bridge"] {
                for ordinal in [0, 1].map(Ordinal) {
                    for purpose in PURPOSES {
                        let mut stream = Seed::of_set(base_seed, label, ordinal).stream(purpose);
                        assert!(seen.insert(stream.unit().to_bits()));
                    }
                }
            }
        }
    }

    #[test]
    fn sets_of_a_label_have_common_seeds_and_parts_of_their_own() {
        let [first, second, other] = [("a", 0), ("a", 1), ("b", 0)]
            .map(|(label, ordinal)| Seed::of_set(0, label, Ordinal(ordinal)));
        assert_eq!(first.common(0), second.common(0));
        assert_eq!(first.part(1).common(0), second.part(1).common(0));
        let ordinals = [first, second, second.part(1)].map(|seed| seed.ordinal().0);
        assert_eq!(ordinals, [0, 1, 1]);
        let mut seeds = vec![first, second, other];
        for seed in [first, other] {
            seeds.extend([seed.common(0), seed.common(1), seed.part(0).common(0)]);
        }
        for seed in [first, second, other] {
            seeds.extend([seed.part(0), seed.part(1), seed.part(0).part(0)]);
        }
        let drawn = |seed: &Seed| seed.stream(Purpose::Sampling).unit().to_bits();
        let distinct: std::collections::BTreeSet<u64> = seeds.iter().map(drawn).collect();
        assert_eq!(distinct.len(), seeds.len());
    }

    #[test]
    fn the_first_numbers_of_a_set_are_golden() {
        let mut stream = Seed::of_set(1, "uniform", Ordinal(0)).stream(Purpose::Sampling);
        let drawn = [stream.unit(), stream.unit()].map(f64::to_bits);
        assert_eq!(drawn, GOLDEN, "bits of a given seed changed: bump BITS_VERSION");
    }
    const GOLDEN: [u64; 2] = [4605283773480867618, 4604761783744469923];
}
