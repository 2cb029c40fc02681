use super::shares::{Shares, default_block};
use super::{GaveUp, Sampler, default_attempts, zero};
use crate::context::Context;
use crate::methods::Complaint;
use crate::model::Scratch;
use crate::roadmap::Configs;
use crate::seed::{Purpose, Seed};
use bincode::{Decode, Encode};
use serde::{Deserialize, Serialize};

/// Quasi-random sampling by Halton's sequence (J. H. Halton 1960; for roadmaps M. S. Branicky,
/// S. M. LaValle, K. Olson, L. Yang, *Quasi-randomized path planning*, 2001), scrambled: the digits at each
/// place are permuted at random, each dimension and place by a permutation of its own (A. B. Owen, *A
/// randomized Halton algorithm in R*, 2017).
///
/// Dimension i counts in the i-th prime number b. Of any b^k consecutive points each of the b^k intervals of
/// length b^−k holds one, and the same is true of boxes made of such intervals in several dimensions.
/// Scrambling keeps that, makes every point uniform, takes away the correlation of dimensions with large
/// primes, and gives every seed its own points. Rotations take three dimensions
/// ([`Space::of_cube`](crate::space::Space::of_cube)). Invalid points are passed over. `shares.rs` says how
/// sets share the points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Encode, Decode)]
#[serde(deny_unknown_fields)]
pub struct Halton {
    /// Number of consecutive points that a set owns of each sequence; best the number of nodes per set.
    #[serde(default = "default_block")]
    pub block: u32,
    /// The most points tried for one milestone.
    #[serde(default = "default_attempts")]
    pub attempts: u64,
}

/// The most dimensions: with larger primes a roadmap has too few points for more than a digit or two.
const DIMENSIONS_MAX: usize = 40;

impl Default for Halton {
    fn default() -> Halton {
        Halton { block: default_block(), attempts: default_attempts() }
    }
}

impl Sampler for Halton {
    fn sample(
        &self,
        cx: &Context,
        seed: &Seed,
        count: usize,
        scratch: &mut Scratch,
        out: &mut Configs,
    ) -> Result<(), GaveUp> {
        let primes = primes(cx.space.cube_dimensions());
        let shares = Shares { block: self.block, attempts: self.attempts };
        shares.sample(cx, seed, count, scratch, out, |seed| {
            let mut stream = seed.stream(Purpose::Sampling);
            let places: Vec<Places> =
                primes.iter().map(|prime| Places::scrambled(*prime, |n| stream.below(n))).collect();
            move |number, point: &mut [f64]| {
                for (coordinate, places) in point.iter_mut().zip(&places) {
                    *coordinate = places.inverse(number);
                }
            }
        })
    }

    fn complaint(&self) -> Option<Complaint> {
        zero("block", self.block).or_else(|| zero("attempts", self.attempts))
    }

    fn suits(&self, cx: &Context) -> Result<(), String> {
        let dimensions = cx.space.cube_dimensions();
        if dimensions > DIMENSIONS_MAX {
            let message = format!("halton for {dimensions} degrees of freedom found");
            return Err(format!("{message}; at most {DIMENSIONS_MAX} expected"));
        }
        Ok(())
    }
}

/// The first prime numbers.
fn primes(count: usize) -> Vec<u64> {
    let mut primes: Vec<u64> = Vec::with_capacity(count);
    let mut number = 2;
    while primes.len() < count {
        if primes.iter().all(|prime| number % prime != 0) {
            primes.push(number);
        }
        number += 1;
    }
    primes
}

/// The places of a number system after the point, as many as matter, with a permutation of the digits at
/// each.
struct Places {
    base: u64,
    permutations: Vec<Vec<u8>>,
}

impl Places {
    /// Draws the permutations (Fisher and Yates); `below` draws a number below its argument.
    fn scrambled(base: u64, mut below: impl FnMut(u64) -> u64) -> Places {
        let mut permutations = Vec::new();
        let mut reach: u64 = 1;
        while reach < 1 << 53 {
            let mut digits: Vec<u8> = (0..base as u8).collect();
            for last in (1..digits.len()).rev() {
                digits.swap(last, below(last as u64 + 1) as usize);
            }
            permutations.push(digits);
            reach *= base;
        }
        Places { base, permutations }
    }

    /// The digits of a number, the lowest first, permuted, written after the point: in `[0, 1]`.
    fn inverse(&self, mut number: u64) -> f64 {
        let mut digits = [0; 53];
        for (digit, permutation) in digits.iter_mut().zip(&self.permutations) {
            *digit = permutation[(number % self.base) as usize];
            number /= self.base;
        }
        let used = &digits[..self.permutations.len()];
        used.iter().rev().fold(0.0, |value, digit| (value + f64::from(*digit)) / self.base as f64)
    }
}
