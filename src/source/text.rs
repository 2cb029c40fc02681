//! From the bytes of a file to text: byte order marks, encodings, line ends.

use std::borrow::Cow;

/// What tells that a file is no text, or none that can be read.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct NoText {
    /// The line, counted from 1.
    pub line: usize,
    /// What was found.
    pub found: String,
}

/// The text of a file of lines and words, UTF-8 or UTF-16 with a byte order mark, which is dropped.
///
/// Bytes that are not UTF-8 become U+FFFD, as they come in comments and names that older programs wrote, and
/// where a number or a word is expected U+FFFD is an error of its own. A line that ends in CR alone ends in LF.
///
/// # Errors
/// A NUL byte: the file is binary.
pub(crate) fn text_of(bytes: &[u8]) -> Result<Cow<'_, str>, NoText> {
    let text = match marked_utf16(bytes)? {
        Some(text) => Cow::Owned(text),
        None => {
            let bytes = without_mark(bytes);
            if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
                let found = "binary data (a byte 0) found".to_owned();
                return Err(NoText { line: line_at(bytes, at), found });
            }
            String::from_utf8_lossy(bytes)
        }
    };
    let bytes = text.as_bytes();
    let ends_line = |at: usize| bytes[at] == b'\r' && bytes.get(at + 1) != Some(&b'\n');
    if !(0..bytes.len()).any(ends_line) {
        return Ok(text);
    }
    let mut lines = String::with_capacity(text.len());
    for (at, c) in text.char_indices() {
        lines.push(if ends_line(at) { '\n' } else { c });
    }
    Ok(Cow::Owned(lines))
}

/// The text of an XML file: UTF-8, UTF-16 with or without a byte order mark, or Latin-1 or ASCII where the file
/// declares it. In each the byte order mark is dropped.
///
/// # Errors
/// Bytes that are none of these, or another encoding declared.
pub(crate) fn xml_text(bytes: &[u8]) -> Result<Cow<'_, str>, NoText> {
    if let Some(text) = marked_utf16(bytes)? {
        return Ok(Cow::Owned(text));
    }
    let bytes = without_mark(bytes);
    let order = match bytes {
        [b'<', 0, ..] => Some(u16::from_le_bytes as fn([u8; 2]) -> u16),
        [0, b'<', ..] => Some(u16::from_be_bytes as fn([u8; 2]) -> u16),
        _ => None,
    };
    if let Some(order) = order {
        return utf16(bytes, order).map(Cow::Owned);
    }
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok(Cow::Borrowed(text)),
        Err(error) => error,
    };
    let line = line_at(bytes, error.valid_up_to());
    match declared_encoding(bytes) {
        // Windows-1252 differs from Latin-1 in some marks of punctuation, which mean nothing here.
        Some(name)
            if ["iso-8859-1", "latin1", "latin-1", "us-ascii", "ascii", "windows-1252"]
                .contains(&name.to_ascii_lowercase().as_str()) =>
        {
            Ok(Cow::Owned(bytes.iter().map(|byte| char::from(*byte)).collect()))
        }
        Some(name) if !name.eq_ignore_ascii_case("utf-8") => {
            let found = format!(
                "encoding `{name}` declared; UTF-8, UTF-16, ISO-8859-1 or US-ASCII expected"
            );
            Err(NoText { line: 1, found })
        }
        _ => {
            Err(NoText { line, found: "not UTF-8 text, and no other encoding declared".to_owned() })
        }
    }
}

/// The bytes without the byte order mark of UTF-8 before them.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// The text of a file that begins with a byte order mark of UTF-16.
fn marked_utf16(bytes: &[u8]) -> Result<Option<String>, NoText> {
    match bytes {
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes).map(Some),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes).map(Some),
        _ => Ok(None),
    }
}

fn utf16(bytes: &[u8], order: fn([u8; 2]) -> u16) -> Result<String, NoText> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let text: Result<String, _> =
        char::decode_utf16(pairs.iter().map(|pair| order(*pair))).collect();
    match text {
        Ok(text) if rest.is_empty() && !text.contains('\0') => Ok(text),
        _ => {
            Err(NoText { line: 1, found: "UTF-16 text that is cut off or broken found".to_owned() })
        }
    }
}

/// The encoding that an XML declaration names. Before the name stand ASCII letters only.
fn declared_encoding(bytes: &[u8]) -> Option<&str> {
    let end = bytes.iter().take(1000).position(|byte| *byte == b'>')?;
    let head = std::str::from_utf8(&bytes[..end]).ok()?.strip_prefix("<?xml")?;
    let (_, value) = head.split_once("encoding")?;
    let value = value.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    value[1..].split(quote).next()
}

/// The line of a byte, counted from 1.
fn line_at(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn utf16_of(text: &str, order: fn(u16) -> [u8; 2]) -> Vec<u8> {
        text.encode_utf16().flat_map(order).collect()
    }

    #[test]
    fn marks_are_dropped_and_line_ends_made_one() {
        let marked = [b"\xef\xbb\xbf".as_slice(), "ü 1".as_bytes()].concat();
        assert_eq!(text_of(&marked).unwrap(), "ü 1");
        assert_eq!(text_of(b"a\rb\r\nc\r").unwrap(), "a\nb\r\nc\n");
        assert_eq!(text_of(b"W\xfcrfel").unwrap(), "W\u{fffd}rfel");
        for order in [u16::to_le_bytes, u16::to_be_bytes] {
            assert_eq!(text_of(&utf16_of("\u{feff}ü\r1", order)).unwrap(), "ü\n1");
        }
        assert_eq!(text_of(b"a\nb\0").unwrap_err().line, 2);
        assert!(text_of(b"\xff\xfea").is_err());
    }

    #[test]
    fn xml_is_read_in_the_encoding_that_it_is_in() {
        let declared = |name: &str| format!("<?xml version=\"1.0\" encoding='{name}'?>\n<a>ü</a>");
        for order in [u16::to_le_bytes, u16::to_be_bytes] {
            for mark in ["", "\u{feff}"] {
                let text = declared("utf-16");
                let bytes = utf16_of(&format!("{mark}{text}"), order);
                assert_eq!(xml_text(&bytes).unwrap(), text);
            }
        }
        let latin = |name| -> Vec<u8> { declared(name).chars().map(|c| c as u8).collect() };
        assert_eq!(xml_text(&latin("ISO-8859-1")).unwrap(), declared("ISO-8859-1"));
        assert_eq!(xml_text(declared("ISO-8859-1").as_bytes()).unwrap(), declared("ISO-8859-1"));
        let error = xml_text(&latin("utf-8")).unwrap_err();
        assert_eq!((error.line, error.found.starts_with("not UTF-8")), (2, true));
        let error = xml_text(&latin("shift_jis")).unwrap_err();
        assert!(error.found.starts_with("encoding `shift_jis` declared"), "{error:?}");
    }
}
