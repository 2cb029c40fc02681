//! The one door to bincode: how values become bytes and come back.
//!
//! Fixed-width little-endian integers, lengths as u64. `wincode` writes the same bytes, should
//! bincode 2 have to be left.

use bincode::config::{Configuration, Fixint, Limit, LittleEndian, NoLimit};
use bincode::de::BorrowDecoder;
use bincode::error::DecodeError;
use bincode::{BorrowDecode, Decode, Encode};
use std::cell::Cell;

/// Bytes that are not what they should be.
#[derive(Debug, thiserror::Error)]
#[error("undecodable bytes: {0}")]
pub struct WireError(String);

impl WireError {
    /// An error about bytes that stand for a value that cannot be.
    pub(crate) fn unsound(why: impl Into<String>) -> WireError {
        WireError(why.into())
    }
}

fn format() -> Configuration<LittleEndian, Fixint, NoLimit> {
    bincode::config::standard().with_little_endian().with_fixed_int_encoding().with_no_limit()
}

/// The bytes of a value.
pub fn encode<T: Encode>(value: &T) -> Vec<u8> {
    match bincode::encode_to_vec(value, format()) {
        Ok(bytes) => bytes,
        Err(error) => unreachable!("encoding to memory cannot fail: {error}"),
    }
}

/// Appends the bytes of a value to others.
pub fn encode_to<T: Encode>(bytes: &mut Vec<u8>, value: &T) {
    match bincode::encode_into_std_write(value, bytes, format()) {
        Ok(_) => {}
        Err(error) => unreachable!("encoding to memory cannot fail: {error}"),
    }
}

/// The value that all of `bytes` stand for.
///
/// # Errors
/// When the bytes are cut off, too many, or no such value. A hostile length inside them makes it
/// allocate at most 1 MiB or 64 times their own length, whichever is larger.
pub fn decode<T: Decode<()>>(bytes: &[u8]) -> Result<T, WireError> {
    decode_borrowed::<Owned<T>>(bytes).map(|owned| owned.0)
}

/// The same for a value that borrows from the bytes.
///
/// # Errors
/// As [`decode`].
pub fn decode_borrowed<'a, T: BorrowDecode<'a, ()>>(bytes: &'a [u8]) -> Result<T, WireError> {
    // bincode's limit is a constant of the type, so the input's length picks one of a few. A value
    // takes at most four times its bytes in memory (padding).
    match bytes.len() {
        length if length <= 1 << 18 => decode_within::<T, { 1 << 20 }>(bytes),
        length if length <= 1 << 22 => decode_within::<T, { 1 << 24 }>(bytes),
        length if length <= 1 << 26 => decode_within::<T, { 1 << 28 }>(bytes),
        length if length <= 1 << 30 => decode_within::<T, { 1 << 32 }>(bytes),
        length => Err(WireError(format!("{length} bytes, at most 1 GiB expected"))),
    }
}

/// A value decoded as one that borrows nothing.
struct Owned<T>(T);

impl<'a, T: Decode<()>> BorrowDecode<'a, ()> for Owned<T> {
    fn borrow_decode<D: BorrowDecoder<'a, Context = ()>>(
        decoder: &mut D,
    ) -> Result<Owned<T>, DecodeError> {
        T::decode(decoder).map(Owned)
    }
}

/// How deep values may hold values of their own kind: beyond what any problem file can say.
const DEPTH_MAX: u32 = 100;

thread_local! {
    static DEPTH: Cell<u32> = const { Cell::new(0) };
}

/// Decodes what may hold values of its own kind. Without a bound a hostile value would be as deep as it
/// is long, and overflow the stack.
pub(crate) fn nested<T>(decode: impl FnOnce() -> Result<T, DecodeError>) -> Result<T, DecodeError> {
    let depth = DEPTH.get();
    if depth >= DEPTH_MAX {
        return Err(DecodeError::Other("nested too deeply"));
    }
    DEPTH.set(depth + 1);
    let value = decode();
    DEPTH.set(depth);
    value
}

/// Decoding, within [`nested`], of a structure with these fields.
macro_rules! decode_nested {
    ($type:ident { $($field:tt),+ }) => {
        impl<Context> bincode::Decode<Context> for $type {
            fn decode<D: bincode::de::Decoder<Context = Context>>(
                decoder: &mut D,
            ) -> Result<$type, bincode::error::DecodeError> {
                crate::wire::nested(|| {
                    Ok($type { $($field: bincode::Decode::decode(decoder)?),+ })
                })
            }
        }
        bincode::impl_borrow_decode!($type);
    };
}

pub(crate) use decode_nested;

fn decode_within<'a, T: BorrowDecode<'a, ()>, const MEMORY_BYTES_MAX: usize>(
    bytes: &'a [u8],
) -> Result<T, WireError> {
    let limited: Configuration<LittleEndian, Fixint, Limit<MEMORY_BYTES_MAX>> =
        format().with_limit::<MEMORY_BYTES_MAX>();
    let (value, used) = bincode::borrow_decode_from_slice(bytes, limited)
        .map_err(|error| WireError(error.to_string()))?;
    if used != bytes.len() {
        return Err(WireError(format!("{} bytes too many", bytes.len() - used)));
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_hostile_length_is_an_error_and_not_an_allocation() {
        let mut bytes = encode(&vec![1.0f64; 4]);
        bytes[..8].copy_from_slice(&u64::MAX.to_le_bytes());
        assert!(decode::<Vec<f64>>(&bytes).is_err());
        bytes[..8].copy_from_slice(&(1u64 << 40).to_le_bytes());
        assert!(decode::<Vec<f64>>(&bytes).is_err());
    }

    #[test]
    fn what_holds_its_own_kind_is_decoded_as_deep_as_problems_are_and_no_deeper() {
        use crate::evaluate::{EvaluatorKind, Not, Query, Verdict};
        use crate::model::Asked;
        let nest = |depth: u32| {
            let query = EvaluatorKind::Query(Query::default());
            (0..depth).fold(query, |inner, _| EvaluatorKind::Not(Not(Box::new(inner))))
        };
        assert_eq!(decode::<EvaluatorKind>(&encode(&nest(100))).unwrap(), nest(100));
        assert!(decode::<EvaluatorKind>(&encode(&nest(101))).is_err());
        // A failure leaves nothing behind.
        assert_eq!(decode::<EvaluatorKind>(&encode(&nest(100))).unwrap(), nest(100));
        // As deep as it is long: the bytes of a verdict up to its parts, over and over.
        let leaf = Verdict::at_least(1.0, 0.0, Asked::default());
        let one = Verdict { parts: vec![leaf.clone()], ..leaf.clone() };
        let tail = encode(&leaf).len() + encode(&Asked::default()).len();
        let bytes = encode(&one);
        let level = &bytes[..bytes.len() - tail];
        assert!(decode::<Verdict>(&level.repeat(100_000)).is_err());
    }

    proptest! {
        #[test]
        fn values_come_back_whole_and_never_from_less(
            value in proptest::collection::vec(any::<(u32, u64)>(), 0..20), cut in 0usize..1000,
        ) {
            let bytes = encode(&value);
            prop_assert_eq!(&decode::<Vec<(u32, u64)>>(&bytes).unwrap(), &value);
            let cut = cut % bytes.len();
            prop_assert!(decode::<Vec<(u32, u64)>>(&bytes[..cut]).is_err());
        }
    }
}
