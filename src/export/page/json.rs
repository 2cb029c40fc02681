//! The data of a page as JSON: numbers as text, and long columns of numbers as bytes in base64.

use base64::prelude::{BASE64_STANDARD, Engine};

/// A list of values that are JSON already.
pub(in crate::export) fn list(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(","))
}

/// An object of values that are JSON already, its keys in this order.
pub(in crate::export) fn object(entries: &[(&str, String)]) -> String {
    let entries = entries.iter().map(|(key, value)| format!("\"{key}\":{value}"));
    format!("{{{}}}", entries.collect::<Vec<_>>().join(",\n"))
}

/// A list of numbers, rounded to the 24 bits that graphics cards draw with.
pub(in crate::export) fn numbers(values: impl IntoIterator<Item = f64>) -> String {
    list(values.into_iter().map(number))
}

/// A number, rounded to 24 bits; one that JSON cannot say becomes `null`.
pub(in crate::export) fn number(value: f64) -> String {
    let value = value as f32 + 0.0;
    if value.is_finite() { value.to_string() } else { "null".to_owned() }
}

/// A column of numbers of 32 bits with the lowest byte first, as a string of base64.
pub(super) fn floats(values: impl IntoIterator<Item = f64>) -> String {
    column(values.into_iter().map(|value| (value as f32 + 0.0).to_le_bytes()))
}

/// A column of integers of 32 bits with the lowest byte first, as a string of base64.
pub(in crate::export) fn integers(values: impl IntoIterator<Item = u32>) -> String {
    column(values.into_iter().map(u32::to_le_bytes))
}

fn column(values: impl Iterator<Item = [u8; 4]>) -> String {
    bytes(values.flatten())
}

/// Bytes as a string of base64.
pub(in crate::export) fn bytes(values: impl Iterator<Item = u8>) -> String {
    format!("\"{}\"", BASE64_STANDARD.encode(values.collect::<Vec<u8>>()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_bytes_and_numbers_are_never_broken() {
        assert_eq!(floats([1.0, -0.0]), "\"AACAPwAAAAA=\"");
        assert_eq!(integers([1, 256]), "\"AQAAAAABAAA=\"");
        assert_eq!(numbers([0.1, f64::NAN, 1e300, -0.0]), "[0.1,null,null,0]");
        assert_eq!(object(&[("a", number(2.0)), ("b", list([]))]), "{\"a\":2,\n\"b\":[]}");
    }
}
