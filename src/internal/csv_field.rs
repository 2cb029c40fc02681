//! Texts as fields of CSV tables (RFC 4180).

use std::borrow::Cow;

/// A text as a field: in quotes, its own doubled, where it would not stay one field.
pub fn csv_field(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}
