//! The numbers by which the parts of a build are known, each a type of its own, so that none can stand where another
//! is meant. All of them count from 0, and each is encoded as the integer in it.
//!
//! How many there are of something is a plain integer and not one of these numbers.
//!
//! ```
//! use roadmill::numbers::SetNumber;
//!
//! let first = SetNumber(8);
//! assert_eq!(first + 2, SetNumber(10));
//! assert_eq!((first + 2).since(first), 2);
//! assert_eq!(first.to_string(), "8");
//! ```

use bincode::{Decode, Encode};
use serde::Serialize;
use std::fmt;
use std::ops::{Add, Range};

/// The most nodes a roadmap may have: ids take 32 bits, and two more name start and goal.
pub const NODES_MAX: u64 = u32::MAX as u64 - 2;

/// Declares a number that counts from 0.
macro_rules! number {
    ($(#[$about:meta])* $name:ident($integer:ty)) => {
        $(#[$about])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Encode, Decode,
            Serialize,
        )]
        #[repr(transparent)]
        pub struct $name(pub $integer);

        impl $name {
            /// The number after this one.
            pub fn next(self) -> $name {
                self + 1
            }

            /// How many there are from `earlier`, which is not larger, up to this one.
            pub fn since(self, earlier: $name) -> $integer {
                self.0 - earlier.0
            }

            /// The numbers of a range, in order.
            pub fn each(range: Range<$name>) -> impl Iterator<Item = $name> + Clone {
                (range.start.0..range.end.0).map($name)
            }

            /// The number as an index into a slice that has an element for each, from 0.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        /// The number that comes so many after this one.
        impl Add<$integer> for $name {
            type Output = $name;

            fn add(self, count: $integer) -> $name {
                $name(self.0 + count)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

number! {
    /// A node set, by its number in the one sequence of all sets of a build.
    SetNumber(u64)
}

number! {
    /// A node set, by its number among the sets of its strategy: with the strategy's label it names the set, and
    /// its seed follows from the two.
    Ordinal(u64)
}

number! {
    /// A round.
    RoundNumber(u64)
}

number! {
    /// A strategy, by its position in [`Problem::strategies`](crate::problem::Problem::strategies).
    StrategyIndex(u32)
}

number! {
    /// An evaluator, by its position in [`Problem::evaluators`](crate::problem::Problem::evaluators).
    EvaluatorIndex(u32)
}

number! {
    /// A node: of a roadmap, or within a set before the set is folded, where its nodes count from 0. Many at once, as
    /// in searches of neighbours, are plain positions among the configurations: the integers in the ids.
    NodeId(u32)
}

/// What names a node set whatever else is built: its strategy, and its number among the strategy's sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SetName {
    /// The strategy.
    pub strategy: StrategyIndex,
    /// The set's number within it.
    pub ordinal: Ordinal,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire;

    #[test]
    fn numbers_are_encoded_as_the_integers_in_them() {
        assert_eq!(wire::encode(&SetNumber(7)), wire::encode(&7u64));
        assert_eq!(wire::encode(&StrategyIndex(7)), wire::encode(&7u32));
        let named = (SetNumber(3), StrategyIndex(1), Ordinal(2));
        assert_eq!(wire::encode(&named), wire::encode(&(3u64, 1u32, 2u64)));
        assert_eq!(wire::decode::<RoundNumber>(&wire::encode(&9u64)).unwrap(), RoundNumber(9));
        assert!(wire::decode::<RoundNumber>(&wire::encode(&9u32)).is_err());
    }

    #[test]
    fn a_range_is_walked_in_order() {
        let numbers: Vec<_> = Ordinal::each(Ordinal(4)..Ordinal(6)).collect();
        assert_eq!(numbers, [Ordinal(4), Ordinal(4).next()]);
        assert_eq!(Ordinal::each(Ordinal(4)..Ordinal(4)).next(), None);
    }
}
